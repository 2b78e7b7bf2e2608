//! What heads a column of a table.

use std::fmt;

/// A column's name and its unit, `1` of a plain number. As text it is "ux (m)", a plain number's its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heading {
    /// What it is of.
    pub name: &'static str,
    /// In what.
    pub unit: &'static str,
}

impl Heading {
    /// Those of some columns.
    pub(super) fn all(columns: &[(&'static str, &'static str)]) -> Vec<Self> {
        columns.iter().map(|&(name, unit)| Self { name, unit }).collect()
    }

    /// Some headings as texts.
    pub(super) fn texts(all: &[Self]) -> Vec<String> {
        all.iter().map(Self::to_string).collect()
    }
}

impl fmt::Display for Heading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unit {
            "1" => f.write_str(self.name),
            unit => write!(f, "{} ({unit})", self.name),
        }
    }
}
