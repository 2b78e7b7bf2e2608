//! What solutions are measured against: numbers that an author gives, files of an earlier run, or a solution made for
//! it.

use super::field::{FieldReference, same_mesh};
use super::points::PointReference;
use super::quantities::{Reading, distance, mean_square, readings};
use super::richardson::{Limit, doubt_of_contact, extrapolate, extrapolate_two};
use super::solver::{Field, Solution};
use serde::Serialize;
use std::collections::BTreeMap;

/// Names of what is measured of the displacement field: at the end, over time, and its largest distance at the end.
pub const FIELD: [&str; 3] = ["displacement", "displacement.over_time", "displacement.largest"];

/// What is said of a reference that knows no uncertainty.
pub const EXACTLY: &str = ", taken for exact";

/// An error is told from the reference's own when it is so many times larger.
pub const CLEARLY: f64 = 3.0;

/// Where a reference comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum ReferenceSource {
    /// The author's numbers.
    Values,
    /// Files of an earlier run.
    Files,
    /// Made for this study from three meshes, or two.
    SelfMade,
    /// There is none.
    None,
}

/// What solutions are measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Where it comes from.
    pub source: ReferenceSource,
    /// A sentence on it.
    pub told: String,
    /// Quantities by name.
    pub entries: BTreeMap<String, ReferenceQuantity>,
    /// The displacement field on meshes.
    pub field: Option<FieldReference>,
    /// The displacements of single points.
    pub points: Option<PointReference>,
}

/// The reference of a quantity.
#[derive(Clone, Debug)]
pub struct ReferenceQuantity {
    /// Its values.
    pub values: Vec<f64>,
    /// How far they may be off, root mean square (in its unit).
    pub uncertainty: f64,
    /// What errors are divided by; `None`: the value itself, or what the solution says where that is 0.
    pub scale: Option<f64>,
    /// The observed order in the cell size, where it was extrapolated.
    pub order: Option<f64>,
}

/// An error and how well it is known, both relative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Error {
    /// The distance from the reference.
    pub error: f64,
    /// How far the reference may be off.
    pub uncertainty: f64,
}

impl Error {
    /// The most that it can be.
    pub fn at_most(&self) -> f64 {
        self.error + self.uncertainty
    }

    /// Whether it is the solution's error and not the reference's.
    pub fn is_clear(&self) -> bool {
        self.error > CLEARLY * self.uncertainty
    }

    /// The size by which configurations are ranked: the error, or what the reference cannot tell from none.
    pub fn vouched(&self) -> f64 {
        self.error.max(CLEARLY * self.uncertainty)
    }
}

/// The limit of results on two or three meshes.
fn limit(sizes: &[f64], values: &[&[f64]]) -> Option<Limit> {
    match (sizes, values) {
        (&[a, b, c], &[one, two, three]) => Some(extrapolate([a, b, c], [one, two, three], mean_square)),
        (&[a, b], &[one, two]) => Some(extrapolate_two([a, b], [one, two], mean_square)),
        _ => None,
    }
}

impl Reference {
    /// None: nothing has an error.
    pub fn none(why: &str) -> Self {
        let (entries, told) = (BTreeMap::new(), format!("none: {why}"));
        Self { source: ReferenceSource::None, told, entries, field: None, points: None }
    }

    /// From an author's numbers, by quantity.
    pub fn of_values(values: &BTreeMap<String, f64>) -> Self {
        let entry = |(name, value): (&String, &f64)| {
            let entry = ReferenceQuantity { values: vec![*value], uncertainty: 0.0, scale: None, order: None };
            (name.clone(), entry)
        };
        let entries = values.iter().map(entry).collect();
        let told = format!("values that the scene names{EXACTLY}");
        Self { source: ReferenceSource::Values, told, entries, field: None, points: None }
    }

    /// The same, if quantities may themselves be off by so much (in their units).
    pub fn off_by(mut self, uncertainty: &BTreeMap<String, f64>) -> Self {
        for (name, entry) in &mut self.entries {
            entry.uncertainty = entry.uncertainty.max(uncertainty.get(name).copied().unwrap_or(0.0));
        }
        if !uncertainty.is_empty()
            && let Some(told) = self.told.strip_suffix(EXACTLY)
        {
            self.told = told.to_string();
        }
        self
    }

    /// From solutions on two or three meshes with cells of `sizes`, descending, each mesh's nodes nodes of the next:
    /// extrapolated to cells of no size. `told`: a sentence on them. `None` for another number of meshes.
    pub fn of_meshes(sizes: &[f64], solutions: &[&Solution], told: String) -> Option<Self> {
        let all: Vec<BTreeMap<String, Reading>> = solutions.iter().map(|solution| readings(solution)).collect();
        let (finest, coarser) = all.split_last()?;
        let mut entries = BTreeMap::new();
        for (name, reading) in finest {
            let mut values: Vec<&[f64]> = Vec::new();
            values.extend(coarser.iter().filter_map(|readings| Some(readings.get(name)?.values.as_slice())));
            values.push(&reading.values);
            if values.len() < all.len() || values.iter().any(|list| list.len() != reading.values.len()) {
                continue;
            }
            let limit = limit(sizes, &values)?;
            let (scale, order) = (Some(reading.scale), limit.order);
            entries.insert(
                name.clone(),
                ReferenceQuantity { values: limit.values, uncertainty: limit.uncertainty, scale, order },
            );
        }
        let fields: Option<Vec<Field>> = solutions.iter().map(|solution| solution.field.clone()).collect();
        let field = fields.and_then(|fields| match (sizes, fields.len()) {
            (&[a, b, c], 3) => FieldReference::of_three([a, b, c], <[Field; 3]>::try_from(fields).ok()?, true),
            (&[a, b], 2) => FieldReference::of_two([a, b], <[Field; 2]>::try_from(fields).ok()?, true),
            _ => None,
        });
        Some(Self { source: ReferenceSource::SelfMade, told, entries, field, points: None })
    }

    /// The same, of three meshes on which surfaces touch: at least as uncertain as that makes it
    /// ([`doubt_of_contact`]).
    pub fn of_contact(mut self, sizes: &[f64], solutions: &[&Solution]) -> Self {
        let (&[a, b, c], &[_, middle, fine]) = (sizes, solutions) else { return self };
        let (one, other) = (readings(middle), readings(fine));
        for (name, entry) in &mut self.entries {
            let (Some(one), Some(other), Some(order)) = (one.get(name), other.get(name), entry.order) else { continue };
            let doubt = doubt_of_contact([a, b, c], order) * distance(&one.values, &other.values);
            entry.uncertainty = entry.uncertainty.max(doubt);
        }
        let near = fine.field.clone().zip(middle.field.as_ref());
        let near = near.and_then(|(fine, middle)| FieldReference::given(fine, 0.0).error_of(middle));
        if let (Some(field), Some(near)) = (&mut self.field, near)
            && let Some(order) = field.order
        {
            let doubt = doubt_of_contact([a, b, c], order);
            field.uncertainty.iter_mut().zip(near.all()).for_each(|(own, near)| *own = own.max(doubt * near));
        }
        self.told += "; where surfaces touch bounds are those of order 1";
        self
    }

    /// The same, more uncertain by `times` the distance of two solutions on one mesh.
    pub fn blurred_by(mut self, a: &Solution, b: &Solution, times: f64) -> Self {
        let (one, other) = (readings(a), readings(b));
        for (name, entry) in &mut self.entries {
            let (Some(one), Some(other)) = (one.get(name), other.get(name)) else { continue };
            let apart = times * distance(&one.values, &other.values);
            entry.uncertainty += if apart.is_finite() { apart } else { 0.0 };
        }
        let apart = a.field.as_ref().zip(b.field.as_ref()).and_then(|(a, b)| same_mesh(a, b));
        if let (Some(field), Some(apart)) = (&mut self.field, apart) {
            field.uncertainty.iter_mut().zip(apart.all()).for_each(|(own, apart)| *own += times * apart);
        }
        self
    }

    /// The errors of a solution, by quantity.
    pub fn errors(&self, solution: &Solution) -> BTreeMap<String, Error> {
        let mut errors = BTreeMap::new();
        let own = readings(solution);
        for (name, entry) in &self.entries {
            let Some(reading) = own.get(name) else { continue };
            let value = mean_square(&entry.values);
            let scale = entry.scale.unwrap_or(if value > 0.0 { value } else { reading.scale });
            let error = Error {
                error: distance(&reading.values, &entry.values) / scale,
                uncertainty: entry.uncertainty / scale,
            };
            if error.error.is_finite() && error.uncertainty.is_finite() {
                errors.insert(name.clone(), error);
            }
        }
        let Some(field) = &solution.field else { return errors };
        if let Some(found) = self.field.as_ref().and_then(|reference| Some((reference, reference.error_of(field)?))) {
            let (reference, found) = found;
            for ((name, error), uncertainty) in FIELD.iter().zip(found.all()).zip(reference.uncertainty) {
                if field.times.len() > 1 || *name != FIELD[1] {
                    errors.insert((*name).into(), Error { error, uncertainty });
                }
            }
        } else if let Some([at_end, largest]) = self.points.as_ref().and_then(|points| points.error_of(field)) {
            errors.insert(FIELD[0].into(), Error { error: at_end, uncertainty: 0.0 });
            errors.insert(FIELD[2].into(), Error { error: largest, uncertainty: 0.0 });
        }
        errors
    }
}
