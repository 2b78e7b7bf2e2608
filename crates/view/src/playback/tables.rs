//! Tables of a finished run: what probes saw, and energies.

use std::path::Path;

/// What plots show of the energies, as their table has it.
const ENERGIES: [&str; 3] = ["kinetic (J)", "strain (J)", "load work (J)"];

/// Curves for plots: energies, then all numbers of all probes, each as points (time, number).
#[derive(Clone, Debug, Default)]
pub struct Curves(Vec<Vec<[f64; 2]>>);

impl Curves {
    /// The tables in an output folder, as far as they are there; and what each probe's numbers are.
    pub fn read<'a>(folder: &Path, probes: impl Iterator<Item = &'a String>) -> (Self, Vec<(String, Vec<String>)>) {
        let energies = Table::read(&folder.join("energy.csv"));
        let mut curves: Vec<Vec<[f64; 2]>> = ENERGIES
            .iter()
            .map(|name| energies.names.iter().position(|column| column == name))
            .map(|column| column.map(|column| energies.points(column)).unwrap_or_default())
            .collect();
        let mut named = Vec::new();
        for probe in probes {
            let table = Table::read(&folder.join(format!("probe_{probe}.csv")));
            curves.extend((0..table.names.len()).map(|column| table.points(column)));
            named.push((probe.clone(), table.names));
        }
        (Self(curves), named)
    }

    /// A curve by its number.
    pub fn points(&self, column: usize) -> Vec<[f64; 2]> {
        self.0.get(column).cloned().unwrap_or_default()
    }
}

/// A table whose first column are times.
#[derive(Default)]
struct Table {
    /// Of the other columns.
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let mut lines = text.lines();
        let names = lines.next().into_iter().flat_map(|line| line.split(',').skip(1)).map(|name| name.trim().into());
        let number = |word: &str| word.trim().parse().unwrap_or(f64::NAN);
        let names = names.collect();
        Self { names, rows: lines.map(|line| line.split(',').map(number).collect()).collect() }
    }

    fn points(&self, column: usize) -> Vec<[f64; 2]> {
        let points = self.rows.iter().filter_map(|row| Some([*row.first()?, *row.get(column + 1)?]));
        points.filter(|point| point.iter().all(|number| number.is_finite())).collect()
    }
}
