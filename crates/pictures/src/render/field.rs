//! Which numbers give the colour: a field's name, found among the arrays of a frame.

use super::RenderError;
use super::frame::{FieldAssociation, FrameFile};

/// A field that can be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// What its rows belong to.
    pub place: FieldAssociation,
    /// What it is, in words.
    pub quantity: String,
    /// Its SI unit; empty for a plain number.
    pub unit: &'static str,
    /// Left out: only the size matters. Else the value between two sides, 0 for a pressure.
    pub centre: Option<f32>,
    /// Whether its values may be averaged.
    pub real: bool,
    array: String,
    pick: Pick,
}

/// What becomes of a row of the array.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pick {
    Length,
    Component(usize),
}

/// What is known of arrays: name in the file, other name, what it is, its length in words, unit, middle.
const KNOWN: [(&str, &str, &str, &str, Option<f32>); 22] = [
    ("displacement", "", "displacement", "m", None),
    ("velocity", "speed", "speed", "m/s", None),
    ("von_mises", "", "von Mises stress", "Pa", None),
    ("pressure", "", "pressure", "Pa", Some(0.0)),
    ("J", "volume_ratio", "volume ratio J", "", Some(1.0)),
    ("stress", "", "Cauchy stress", "Pa", Some(0.0)),
    ("alive", "", "alive", "", None),
    ("reaction", "", "reaction", "N", None),
    ("internal_force", "", "internal force", "N", None),
    ("external_force", "", "external force", "N", None),
    ("contact_force", "", "contact force", "N", None),
    ("contact_traction", "", "contact traction", "Pa", None),
    ("contact_pressure", "", "contact pressure", "Pa", None),
    ("contact_area", "", "contact area", "m²", None),
    ("contact_gap", "", "contact gap", "m", Some(0.0)),
    ("contact_slip", "", "contact slip", "m", None),
    ("green_strain", "", "Green-Lagrange strain", "", Some(0.0)),
    ("energy_density", "", "energy density", "J/m³", None),
    ("fibre_stretch", "", "stretch of fibres", "", Some(1.0)),
    ("hourglass_share", "", "share of hourglass control", "", None),
    ("relative_amplitude", "", "relative amplitude", "", None),
    ("quality", "", "quality", "", None),
];

/// What is known of an array by its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// What it is, in words.
    pub quantity: &'static str,
    /// Its SI unit; empty for a plain number.
    pub unit: &'static str,
    /// The value between two sides, where it has one.
    pub centre: Option<f32>,
}

/// What is known of an array, by its name in files.
pub fn known(array: &str) -> Option<Known> {
    let (_, _, quantity, unit, centre) = *KNOWN.iter().find(|known| known.0 == array)?;
    Some(Known { quantity, unit, centre })
}

const AXES: [&str; 3] = ["x", "y", "z"];
const TENSOR: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

impl Field {
    /// Finds a field by name: that of an array with one value a row, of a vector array (its length), or of a component:
    /// `displacement.z`, `stress.xy`.
    pub fn find(frame: &FrameFile, name: &str) -> Result<Field, RenderError> {
        let (array, component) = name.split_once('.').map_or((name, None), |(array, part)| (array, Some(part)));
        let known = KNOWN.iter().find(|known| array == known.0 || (array == known.1 && !array.is_empty()));
        let array = known.map_or(array, |known| known.0);
        let found =
            frame.entry(FieldAssociation::Points, array).or_else(|| frame.entry(FieldAssociation::Cells, array));
        let unknown =
            || RenderError::UnknownField { field: name.to_string(), path: frame.path.clone(), known: names(frame) };
        let entry = found.ok_or_else(unknown)?;
        let pick = match (entry.components, component) {
            (1, None) => Pick::Component(0),
            (3, None) => Pick::Length,
            (components, Some(part)) => {
                let place = component_names(components).iter().position(|name| *name == part);
                Pick::Component(place.ok_or_else(unknown)?)
            }
            _ => return Err(unknown()),
        };
        let quantity = match (known, component) {
            (Some(("velocity", ..)), Some(part)) => format!("velocity {part}"),
            (_, Some(part)) => format!("{} {part}", known.map_or(array, |known| known.2)),
            (known, None) => known.map_or(array, |known| known.2).to_string(),
        };
        let centre = match component {
            Some(_) => Some(0.0),
            None => known.map_or(Some(0.0).filter(|_| pick != Pick::Length), |known| known.4),
        };
        let unit = known.map_or("", |known| known.3);
        let real = entry.is_real();
        Ok(Field { place: entry.place, quantity, unit, centre, real, array: array.to_string(), pick })
    }

    /// The field in a frame, one number a point or cell.
    pub fn values(&self, frame: &FrameFile) -> Result<Vec<f32>, RenderError> {
        let missing = || RenderError::damaged(&frame.path, format!("the array {} is missing", self.array));
        let entry = frame.entry(self.place, &self.array).ok_or_else(missing)?;
        let rows = frame.floats(entry)?;
        let rows = rows.chunks_exact(entry.components.max(1));
        match self.pick {
            Pick::Length => Ok(rows.map(|row| row.iter().map(|part| part * part).sum::<f32>().sqrt()).collect()),
            Pick::Component(part) if part < entry.components => Ok(rows.map(|row| row[part]).collect()),
            Pick::Component(_) => Err(missing()),
        }
    }
}

fn component_names(components: usize) -> &'static [&'static str] {
    match components {
        3 => &AXES,
        6 => &TENSOR,
        _ => &[],
    }
}

/// All names that could be asked for.
fn names(frame: &FrameFile) -> Vec<String> {
    let mut names = Vec::new();
    for entry in frame.entries.iter().filter(|entry| entry.place != FieldAssociation::Mesh) {
        if matches!(entry.components, 1 | 3) {
            names.push(entry.name.clone());
        }
        names.extend(component_names(entry.components).iter().map(|part| format!("{}.{part}", entry.name)));
    }
    names
}
