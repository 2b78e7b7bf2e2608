//! Parts of scenes: what stands in files of its own, and may stand in a scene several times.

use super::{Attachment, Body, Constraint, Contact, Load, Material, Probe, Removal, Suction, Tool};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A part of a scene: a file, and where what it holds stands in the scene.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The file (.ron), its path relative to the file that names it.
    #[serde(default)]
    pub scene: Option<String>,
    /// What the file holds: then it is not read.
    #[serde(default)]
    pub content: Option<PartScene>,
    /// Multiplies all lengths of the part, before anything else.
    #[serde(default = "one")]
    pub scale: f64,
    /// Turns the part about the axes x, then y, then z through the origin (degrees).
    #[serde(default)]
    pub rotate: DVec3,
    /// Moves the part (m), after scale and rotation.
    #[serde(default)]
    pub translate: DVec3,
    /// Values put into the part in place of the file's, by their paths in it, as by `--set`.
    #[serde(default)]
    pub set: BTreeMap<String, ron::Value>,
}

fn one() -> f64 {
    1.0
}

/// What a part holds. Its names begin with the part's in the whole scene: `lens` in the part `eye` is `eye.lens`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct PartScene {
    /// What the part is, in a few words.
    pub title: String,
    /// Parts of the part, by name.
    pub parts: BTreeMap<String, Part>,
    /// The bodies, by name.
    pub bodies: BTreeMap<String, Body>,
    /// The materials, by name.
    pub materials: BTreeMap<String, Material>,
    /// What holds or moves nodes of its bodies.
    pub constraints: Vec<Constraint>,
    /// What pushes and pulls its bodies; gravity is the whole scene's.
    pub loads: Vec<Load>,
    /// Rigid tools, by name.
    pub tools: BTreeMap<String, Tool>,
    /// What touches what in it; where it has no body, how its tools touch that of the scene around it.
    pub contacts: Vec<Contact>,
    /// What holds what in it.
    pub attachments: Vec<Attachment>,
    /// Its tools that suck; where it has no body, at that of the scene around it.
    pub suction: Vec<Suction>,
    /// Which elements of its bodies go, and when; where it has none, what its tools take of the scene's body around it.
    pub removal: Vec<Removal>,
    /// What to observe of it, by name.
    pub probes: BTreeMap<String, Probe>,
}

/// Fields of a scene that only the whole has.
pub const OF_THE_WHOLE: [&str; 12] = [
    "duration",
    "analysis",
    "start",
    "systems",
    "integration",
    "schedule",
    "fuse",
    "parameters",
    "output",
    "guards",
    "picture",
    "accuracy",
];
