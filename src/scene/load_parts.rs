//! What the rest of the program knows of the loads of scenes, whatever their kind.

use super::schema::{Curve, PerCopy, Select, Share};
use glam::DVec3;
use std::ops::RangeInclusive;

/// What the rest of the program knows of a load, whatever its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadParts<'a> {
    /// Its word in scenes, by which its system is found.
    pub word: &'static str,
    /// What it is called in words.
    pub name: &'static str,
    /// The body; none: the only one, or all if it acts on all.
    pub body: Option<&'a String>,
    /// What it acts on.
    pub on: On<'a>,
    /// The field with what the course multiplies, and its unit.
    pub field: (&'static str, &'static str),
    /// What the course multiplies, in that unit; of a number the first of three.
    pub amplitude: DVec3,
    /// Whether that has a direction.
    pub is_vector: bool,
    /// Between what amplitudes it usually is, where something can be said of all scenes.
    pub usual: Option<&'static Usual>,
    /// Its course in time.
    pub curve: &'a Curve,
}

/// Amplitudes that a load usually has, in the unit of its field.
#[derive(Clone, Debug, PartialEq)]
pub struct Usual {
    /// From the least to the largest.
    pub range: RangeInclusive<f64>,
    /// What another unit, the likely mistake, would make of it.
    pub hint: &'static str,
}

/// What a load acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum On<'a> {
    /// The whole body, or all bodies where it names none, rigid ones too: the amplitude is an acceleration of all mass;
    /// and its factors on the copies of a body that it names.
    Bodies(Option<&'a PerCopy>),
    /// Nodes; how it is shared among them, and its factors on the body's copies.
    Nodes(&'a Select, Share, Option<&'a PerCopy>),
    /// Faces of the surface, and the factors.
    Faces(&'a Select, Option<&'a PerCopy>),
}

impl<'a> On<'a> {
    /// The selection, where it is not all.
    pub fn select(self) -> Option<&'a Select> {
        match self {
            Self::Bodies(_) => None,
            Self::Nodes(on, ..) | Self::Faces(on, _) => Some(on),
        }
    }

    /// Its factors on the body's copies, where they differ.
    pub fn per_copy(self) -> Option<&'a PerCopy> {
        match self {
            Self::Bodies(per_copy) | Self::Nodes(.., per_copy) | Self::Faces(_, per_copy) => per_copy,
        }
    }
}

/// What of a load may be written anew.
pub struct LoadPartsMut<'a> {
    /// The body that it names.
    pub body: &'a mut Option<String>,
    /// What it acts on; none where that is all.
    pub on: Option<&'a mut Select>,
    /// What its course multiplies.
    pub amplitude: &'a mut dyn Amplitude,
    /// Its course in time.
    pub curve: &'a mut Curve,
}

/// What the course of a load multiplies: a vector in space, or a number.
pub trait Amplitude {
    /// Whether it has a direction.
    fn is_vector(&self) -> bool;

    /// As a vector; a number is its first component.
    fn vector(&self) -> DVec3;

    /// Sets it likewise.
    fn set(&mut self, amplitude: DVec3);

    /// What turns where space does.
    fn direction(&mut self) -> Option<&mut DVec3>;
}

impl Amplitude for DVec3 {
    fn is_vector(&self) -> bool {
        true
    }

    fn vector(&self) -> DVec3 {
        *self
    }

    fn set(&mut self, amplitude: DVec3) {
        *self = amplitude;
    }

    fn direction(&mut self) -> Option<&mut DVec3> {
        Some(self)
    }
}

impl Amplitude for f64 {
    fn is_vector(&self) -> bool {
        false
    }

    fn vector(&self) -> DVec3 {
        DVec3::X * *self
    }

    fn set(&mut self, amplitude: DVec3) {
        *self = amplitude.x;
    }

    fn direction(&mut self) -> Option<&mut DVec3> {
        None
    }
}
