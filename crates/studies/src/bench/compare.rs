//! Two records of the same cases.

use super::{Case, Record};

/// A case that takes another time than it did.
#[derive(Clone, Debug)]
pub struct Change {
    /// The case.
    pub case: Case,
    /// ns an element and step, then and now.
    pub ns: [f64; 2],
}

impl Change {
    /// Now over then.
    pub fn ratio(&self) -> f64 {
        self.ns[1] / self.ns[0]
    }
}

/// Cases of both records, the worst first.
pub fn compare(then: &Record, now: &Record) -> Vec<Change> {
    let before = |case: &Case| then.rows.iter().find(|row| row.case == *case).map(|row| row.ns_per_element_step);
    let change = |row: &super::Row| {
        before(&row.case).map(|then| Change { case: row.case.clone(), ns: [then, row.ns_per_element_step] })
    };
    let mut changes: Vec<Change> = now.rows.iter().filter_map(change).collect();
    changes.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
    changes
}
