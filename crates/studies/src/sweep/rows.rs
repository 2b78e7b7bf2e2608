//! The table of results.

use super::{Done, SweepError};
use std::path::Path;

/// Writes the table: number, a column for each place, how it ended, how far it came, and what was kept, empty where a
/// variant ended before. Nothing in it depends on the machine.
pub(super) fn write(path: &Path, places: &[&str], columns: &[String], rows: &[Done]) -> Result<(), SweepError> {
    let failed = |error: csv::Error| SweepError::Files(path.into(), error.into());
    let beside = path.with_extension("csv.partial");
    {
        let mut table = csv::Writer::from_path(&beside).map_err(failed)?;
        let fixed = ["ended", "time (s)"];
        let header = ["variant"].into_iter().chain(places.iter().copied()).chain(fixed);
        table.write_record(header.chain(columns.iter().map(String::as_str))).map_err(failed)?;
        for row in rows {
            let mut record = vec![row.number.to_string()];
            record.extend(row.values.iter().map(|value| value.to_string()));
            record.extend([row.ended.to_string(), row.time.to_string()]);
            record.extend(
                row.kept.iter().flatten().map(|number| number.map_or(String::new(), |number| number.to_string())),
            );
            record.resize(1 + places.len() + fixed.len() + columns.len(), String::new());
            table.write_record(record).map_err(failed)?;
        }
        table.flush().map_err(|error| SweepError::Files(path.into(), error))?;
    }
    // a table is there whole, or not yet
    std::fs::rename(&beside, path).map_err(|error| SweepError::Files(path.into(), error))
}
