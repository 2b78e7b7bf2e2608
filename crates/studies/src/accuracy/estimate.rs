//! How far the scene as it is written is off: what meshes differ by, the order that shows, and what follows from both.

use super::advice::percent;
use super::configuration::Factor;
use super::field::FieldReference;
use super::plan::Varied;
use super::quantities::{Reading, distance, readings};
use super::reference::{Error, FIELD, Reference};
use super::solver::Solution;
use super::study::Row;
use serde::Serialize;
use std::collections::BTreeMap;

/// A component of a probe is spoken of if it is at least this share of the probe's largest one.
const SPOKEN_OF: f64 = 0.5;

/// The runs that a reference is made of, from the coarsest mesh on.
#[derive(Clone, Debug, Default)]
pub struct Refined {
    /// Their places among the rows of the study.
    pub places: Vec<usize>,
    /// Their meshes.
    pub meshes: Vec<Factor>,
    /// Their solutions.
    pub solutions: Vec<Solution>,
}

/// How far a quantity of the scene as it is written is off.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The quantity.
    pub quantity: String,
    /// What the scene as it is written says, and its unit; none for fields, and where it did not run.
    pub value: Option<(f64, String)>,
    /// About how far it is off, relative.
    pub about: f64,
    /// The most, relative.
    pub at_most: f64,
    /// Whether `about` can be told from what the reference may be off by itself.
    pub is_clear: bool,
    /// The meshes that it was told from, against the scene's; none where the reference is not made of meshes.
    pub meshes: Vec<Factor>,
    /// How far results on each two neighbouring meshes are apart, relative.
    pub differences: Vec<f64>,
    /// The observed order in the cell size; `None` where two meshes show none, or three follow none.
    pub order: Option<f64>,
}

/// Estimates for the quantity judged by, and for the final values of all probes.
pub fn estimates(
    rows: &[Row],
    solutions: &[Option<Solution>],
    reference: &Reference,
    refined: &Refined,
    judged_by: &str,
) -> Vec<Estimate> {
    let written = rows.iter().zip(solutions).find(|(row, _)| row.varied == Varied::Nothing);
    let solution = written.and_then(|(_, solution)| solution.as_ref());
    let readings = solution.map(readings).unwrap_or_default();
    // where the scene itself takes too long, the finest mesh that ran speaks for it
    let finest = refined.places.last().map(|&place| &rows[place]);
    let row = written.map(|(row, _)| row).filter(|row| row.measured().is_some()).or(finest);
    let Some(row) = row else { return Vec::new() };
    let mut names = vec![judged_by.to_string()];
    names.extend(solution.map(spoken_of).unwrap_or_default().into_iter().filter(|name| name != judged_by));
    let estimate = |quantity: String| {
        let error = *row.errors.get(&quantity)?;
        let differences = differences(refined, &quantity);
        let order = match FIELD.contains(&quantity.as_str()) {
            true => reference.field.as_ref().and_then(|field| field.order),
            false => reference.entries.get(&quantity).and_then(|entry| entry.order),
        };
        let [about, at_most] = as_written(row, error, order);
        let value = readings.get(&quantity).and_then(|reading| Some((*reading.values.last()?, reading.unit.clone())));
        let (is_clear, meshes) = (error.is_clear(), refined.meshes.clone());
        Some(Estimate { quantity, value, about, at_most, is_clear, meshes, differences, order })
    };
    names.into_iter().filter_map(estimate).collect()
}

/// The error of a row and the most that it can be, both carried to the scene's own mesh where the row has a coarser
/// one: by the order that shows, or 1; the most stays the most, since it can but fall.
fn as_written(row: &Row, error: Error, order: Option<f64>) -> [f64; 2] {
    let finer = (1.0 / row.configuration.mesh.value()).max(1.0);
    [error.error / finer.powf(order.unwrap_or(1.0)), error.at_most()]
}

/// Final values of probes: of each its components that are not small beside its largest.
fn spoken_of(solution: &Solution) -> Vec<String> {
    let end = |name: &str| solution.channel(name).and_then(|c| c.values.last()).map_or(0.0, |value| value.abs());
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for channel in &solution.channels {
        let most = largest.entry(&channel.group).or_default();
        *most = most.max(end(&channel.name));
    }
    let counts = |group: &str, name: &str| end(name) > 0.0 && end(name) >= SPOKEN_OF * largest[group];
    let probes = solution.channels.iter().filter(|channel| channel.group != "energy");
    probes.filter(|channel| counts(&channel.group, &channel.name)).map(|channel| channel.name.clone()).collect()
}

/// How far the results on each two neighbouring meshes are apart, relative to the finer one's.
fn differences(refined: &Refined, quantity: &str) -> Vec<f64> {
    let apart = |pair: &[Solution]| {
        let [coarse, fine] = pair else { return None };
        if let Some(place) = FIELD.iter().position(|name| *name == quantity) {
            let fine = FieldReference::given(fine.field.clone()?, 0.0);
            return fine.error_of(coarse.field.as_ref()?).map(|error| error.all()[place]);
        }
        let (coarse, fine): (BTreeMap<String, Reading>, _) = (readings(coarse), readings(fine));
        let (coarse, fine) = (coarse.get(quantity)?, fine.get(quantity)?);
        Some(distance(&coarse.values, &fine.values) / fine.scale).filter(|apart| apart.is_finite())
    };
    refined.solutions.windows(2).filter_map(apart).collect()
}

impl Estimate {
    /// A sentence: how far it is off, at most, and from what that is told.
    pub fn sentence(&self) -> String {
        let about = if self.is_clear { format!("off by about {}, ", percent(self.about)) } else { "off by ".into() };
        format!("{about}at most {}{}", percent(self.at_most), self.grounds())
    }

    fn grounds(&self) -> String {
        if self.differences.is_empty() {
            return String::new();
        }
        let meshes: Vec<String> = self.meshes.iter().map(ToString::to_string).collect();
        let apart: Vec<String> = self.differences.iter().map(|apart| percent(*apart)).collect();
        let grow = self.differences.windows(2).any(|pair| pair[1] >= pair[0]);
        let order = match (self.order, self.meshes.len()) {
            (Some(order), _) => format!("order {order:.1}"),
            (None, 2) => "two meshes show no order".into(),
            (None, _) if grow => "they do not come closer yet".into(),
            (None, _) => "no order shows".into(),
        };
        format!(" (meshes {} differ by {}; {order})", meshes.join(", "), apart.join(" and "))
    }
}
