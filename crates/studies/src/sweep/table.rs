//! The file of a sweep: which variants there are.

use super::{SweepError, check_times};
use fastrand::Rng;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};

/// Variants at most: a mistake in a grid is told, not begun.
const MOST_VARIANTS: usize = 1_000_000;

/// A file of a sweep.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepFile {
    /// The scene, from the file's folder.
    pub scene: PathBuf,
    /// What differs.
    pub variants: Variants,
    /// Probes of the scene, whose numbers are kept.
    pub keep: Vec<String>,
    /// When they are asked (s), ascending; at the end where it is left out.
    #[serde(default)]
    pub at: Vec<f64>,
}

/// A value that is put in at a place of the scene: a number, true or false, or a text, which is RON as it stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// true or false.
    Word(bool),
    /// A number.
    Number(f64),
    /// Anything else, in RON.
    Text(String),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Word(word) => word.fmt(f),
            Value::Number(number) => number.fmt(f),
            Value::Text(text) => text.fmt(f),
        }
    }
}

/// Which values are put in, at places as `--set` has them, such as `materials.tissue.density`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Variants {
    /// Every combination, the last place changing fastest.
    Grid(Vec<(String, Vec<Value>)>),
    /// Rows, each with a value for every place.
    Table {
        /// The places.
        places: Vec<String>,
        /// The rows.
        rows: Vec<Vec<Value>>,
    },
    /// So many rows whose numbers, from low to high of each place, are one in each of as many equal intervals (McKay,
    /// Beckman & Conover 1979). The same seed gives the same rows.
    LatinHypercube {
        /// How many.
        count: usize,
        /// Of the random numbers.
        seed: u64,
        /// Each with its lowest and its highest number.
        places: Vec<(String, (f64, f64))>,
    },
}

impl SweepFile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong, and where.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let text = std::fs::read_to_string(path).map_err(|error| SweepError::Files(path.into(), error))?;
        Self::from_text(&text).map_err(|what| SweepError::File(format!("{}{what}", path.display())))
    }

    /// Reads a text; errors begin with a colon, for the file's name to stand before.
    pub(super) fn from_text(text: &str) -> Result<Self, String> {
        let file: Self = ron::from_str(text).map_err(|wrong| format!(":{}: {}", wrong.span.start, wrong.code))?;
        file.check().map_err(|what| format!(": {what}"))?;
        Ok(file)
    }

    fn check(&self) -> Result<(), String> {
        if self.keep.is_empty() {
            return Err("keep: name at least one probe, or nothing comes of the sweep".into());
        }
        check_times(&self.at)?;
        self.variants.check()
    }
}

impl Variants {
    /// Where values are put in.
    pub fn places(&self) -> Vec<&str> {
        match self {
            Variants::Grid(places) => places.iter().map(|(place, _)| place.as_str()).collect(),
            Variants::Table { places, .. } => places.iter().map(String::as_str).collect(),
            Variants::LatinHypercube { places, .. } => places.iter().map(|(place, _)| place.as_str()).collect(),
        }
    }

    /// How many there are; `None` where that is no number.
    fn count(&self) -> Option<usize> {
        match self {
            Variants::Grid(places) => {
                places.iter().try_fold(1_usize, |count, (_, values)| count.checked_mul(values.len()))
            }
            Variants::Table { rows, .. } => Some(rows.len()),
            Variants::LatinHypercube { count, .. } => Some(*count),
        }
    }

    /// Whether they make sense.
    ///
    /// # Errors
    /// What is wrong, in one sentence.
    pub fn check(&self) -> Result<(), String> {
        let places = self.places();
        if places.is_empty() {
            return Err("variants: name at least one place, such as \"materials.tissue.density\"".into());
        }
        if let Some(place) = places.iter().enumerate().find(|(i, place)| places[..*i].contains(place)) {
            return Err(format!("variants: {:?} stands there twice", place.1));
        }
        if let Some(place) = places.iter().find(|place| place.is_empty() || place.contains('=')) {
            return Err(format!("variants: {place:?} is no place of a scene, such as \"materials.tissue.density\""));
        }
        match self.count() {
            Some(0) => return Err("variants: there are none".into()),
            Some(count) if count <= MOST_VARIANTS => {}
            count => {
                let found = count.map_or("more than can be counted".into(), |count| count.to_string());
                return Err(format!("variants: there are {found}; {MOST_VARIANTS} are allowed"));
            }
        }
        match self {
            Variants::Grid(_) => Ok(()),
            Variants::Table { rows, .. } => match rows.iter().position(|row| row.len() != places.len()) {
                Some(row) => Err(format!(
                    "variants: row {row} (counted from 0) has {} values for {} places",
                    rows[row].len(),
                    places.len()
                )),
                None => Ok(()),
            },
            Variants::LatinHypercube { places, .. } => {
                // not a number is not below anything
                let is_range = |(low, high): (f64, f64)| low < high && low.is_finite() && high.is_finite();
                match places.iter().find(|(_, range)| !is_range(*range)) {
                    Some((place, (low, high))) => Err(format!(
                        "variants: {place:?} goes from {low} to {high}: the first must be below the second"
                    )),
                    None => Ok(()),
                }
            }
        }
    }

    /// All rows, each with a value for every place, in the order of [`places`](Self::places).
    pub fn rows(&self) -> Vec<Vec<Value>> {
        match self {
            Variants::Grid(places) => {
                let count: usize = places.iter().map(|(_, values)| values.len()).product();
                let row = |number: usize| {
                    let mut left = number;
                    let mut row: Vec<Value> = places
                        .iter()
                        .rev()
                        .map(|(_, values)| {
                            let value = values[left % values.len()].clone();
                            left /= values.len();
                            value
                        })
                        .collect();
                    row.reverse();
                    row
                };
                (0..count).map(row).collect()
            }
            Variants::Table { rows, .. } => rows.clone(),
            Variants::LatinHypercube { count, seed, places } => {
                let mut random = Rng::with_seed(*seed);
                let mut rows = vec![Vec::with_capacity(places.len()); *count];
                for (_, (low, high)) in places {
                    let mut intervals: Vec<usize> = (0..*count).collect();
                    random.shuffle(&mut intervals);
                    for (row, interval) in rows.iter_mut().zip(intervals) {
                        let share = (interval as f64 + random.f64()) / *count as f64;
                        row.push(Value::Number(low + share * (high - low)));
                    }
                }
                rows
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn file(variants: &str) -> Result<SweepFile, String> {
        SweepFile::from_text(&format!("(scene: \"a.ron\", variants: {variants}, keep: [\"tip\"])"))
    }

    #[test]
    fn a_grid_has_every_combination_and_the_last_place_changes_fastest() {
        let grid = file("Grid([(\"a\", [1, 2.5]), (\"b\", [true, \"(0, 0, 1)\", 3])])").unwrap();
        let rows = grid.variants.rows();
        let texts: Vec<String> = rows.iter().map(|row| format!("{} {}", row[0], row[1])).collect();
        assert_eq!(texts, ["1 true", "1 (0, 0, 1)", "1 3", "2.5 true", "2.5 (0, 0, 1)", "2.5 3"]);
    }

    #[test]
    fn a_latin_hypercube_has_one_number_in_each_interval_of_each_place() {
        let text =
            |seed: u64| format!("LatinHypercube(count: 50, seed: {seed}, places: [(\"a\", (2, 4)), (\"b\", (-1, 0))])");
        let of = |seed| file(&text(seed)).unwrap().variants.rows();
        let rows = of(7);
        assert_eq!(rows, of(7), "the same seed");
        assert_ne!(rows, of(8), "another seed");
        for (place, (low, high)) in [(2.0, 4.0), (-1.0, 0.0)].into_iter().enumerate() {
            let mut seen = [0; 50];
            for row in &rows {
                let Value::Number(number) = row[place] else { unreachable!("numbers only") };
                seen[((number - low) / (high - low) * 50.0) as usize] += 1;
            }
            assert_eq!(seen, [1; 50], "place {place}");
        }
        // columns are shuffled apart from each other
        let first = |row: &Vec<Value>, place: usize| row[place].to_string().parse::<f64>().unwrap();
        let matched = rows
            .iter()
            .filter(|row| ((first(row, 0) - 2.0) / 2.0 * 50.0) as usize == ((first(row, 1) + 1.0) * 50.0) as usize);
        assert!(matched.count() < 10);
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        for (variants, words) in [
            ("Grid([])", "name at least one place"),
            ("Grid([(\"a\", [])])", "there are none"),
            ("Grid([(\"a\", [1]), (\"a\", [2])])", "\"a\" stands there twice"),
            ("Table(places: [\"a\", \"b\"], rows: [[1, 2], [3]])", "row 1 (counted from 0) has 1 values for 2 places"),
            ("LatinHypercube(count: 3, seed: 1, places: [(\"a\", (2, 2))])", "\"a\" goes from 2 to 2"),
            ("LatinHypercube(count: 3, seed: 1, places: [(\"a\", (NaN, 2))])", "\"a\" goes from NaN to 2"),
            ("LatinHypercube(count: 30000000, seed: 1, places: [(\"a\", (1, 2))])", "1000000 are allowed"),
            ("Grid([(\"a=b\", [1])])", "is no place of a scene"),
            ("Grit([])", "`Grid`"),
        ] {
            let told = file(variants).unwrap_err();
            assert!(told.contains(words), "{variants}: {told}");
        }
        for (text, words) in [
            ("(scene: \"a\", variants: Grid([(\"a\", [1])]), keep: [], at: [1])", "keep: name at least one probe"),
            ("(scene: \"a\", variants: Grid([(\"a\", [1])]), keep: [\"t\"], at: [2, 1])", "1 s stands after 2 s"),
            ("(scene: \"a\", variants: Grid([(\"a\", [1])]), keep: [\"t\"], at: [-1])", "-1 is no time"),
            ("(scene: \"a\", keep: [\"t\"])", "variants"),
            ("(scene: \"a\",\n keeps: [\"t\"])", ":2:"),
        ] {
            let told = SweepFile::from_text(text).unwrap_err();
            assert!(told.contains(words), "{text}: {told}");
        }
    }
}
