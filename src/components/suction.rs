//! Tools that suck at faces.

use super::column::columns;
use super::{FaceCorners, Pose, Reals, Signals};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::sync::Arc;

columns! {
    /// For each of a body's [`Suction`]s two numbers: the pressure by which faces are sucked (Pa), and the share of the
    /// mouth that they close. Exists where something sucks.
    SuctionPressure(Reals) = "suction_pressure", State of Suction, Other;
    /// For each of a body's [`Suction`]s and each of [`BodyFaces`] the bits of the share (f32) of it that is sucked;
    /// then for each of the faces' nodes 1 where one of its faces is, else 0. Exists where something sucks.
    SuctionMarks(Vec<u32>) = "suction_marks", State of Suction, Other;
    /// For each of [`BodyFaces`] 1 while its element is there, else 0. Exists where something sucks.
    FacePresence(Vec<u32>) = "face_presence", Scratch of Suction, Other;
}

/// Numbers of a tool in [`SuctionPressure`].
pub const SUCTION_NUMBERS: usize = 2;

/// No face.
pub const NO_FACE: u32 = u32::MAX;

/// The faces of a body that may be sucked: of all elements where these can go, else those of the surface.
#[derive(Clone, Debug, Default)]
pub struct BodyFaces {
    /// Rows of each face's corners, outward normal by the right hand; a triangle repeats its last.
    pub corners: Vec<[u32; 4]>,
    /// The element behind each: place of its block in the body's list, and its row there.
    pub elements: Vec<(u32, u32)>,
    /// The face of the other element, seen from there; [`NO_FACE`]: none. A face is exposed while its element is there
    /// and the one behind this is not.
    pub opposites: Vec<u32>,
    /// The flat faces that all of them are loaded as, by the nodes that they load.
    pub parts: FaceCorners,
    /// Of each of these the face.
    pub of_part: Vec<u32>,
}

impl BodyFaces {
    /// How many.
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// Words of a tool in [`SuctionMarks`].
    pub fn words(&self) -> usize {
        self.len() + self.parts.rows.len()
    }

    /// What is loaded while these marks are set.
    pub fn marked(&self, marks: &[u32]) -> FaceCorners {
        let all = &self.parts;
        let mut some = FaceCorners { starts: vec![0], ..FaceCorners::default() };
        let mut places = vec![NO_FACE; all.faces.len()];
        for (part, &face) in self.of_part.iter().enumerate().filter(|(_, face)| marks[**face as usize] != 0) {
            places[part] = some.faces.len() as u32;
            some.faces.push(all.faces[part]);
            some.weights.push(all.weights[part] * share(marks[face as usize]));
            some.elements.push(self.elements[face as usize]);
        }
        for (i, &row) in all.rows.iter().enumerate().filter(|(i, _)| marks[self.len() + i] == 1) {
            let corners = &all.corners[all.starts[i] as usize..all.starts[i + 1] as usize];
            let there = corners.iter().filter(|&&corner| places[corner as usize / 4] != NO_FACE);
            some.corners.extend(there.map(|&corner| 4 * places[corner as usize / 4] + corner % 4));
            some.rows.push(row);
            some.starts.push(some.corners.len() as u32);
        }
        some.alive.change(|marks| marks.resize(some.faces.len(), 1));
        some
    }
}

/// A tool that sucks at faces of a body.
#[derive(Component, Clone, Debug)]
pub struct Suction {
    /// The tool's name.
    pub tool: String,
    /// Its place among those of the body.
    pub number: usize,
    /// The mouth's place among all: one that sucks at several bodies has one of these for each.
    pub mouth: usize,
    /// The first of six slots of [`Signals`]: see [`Signal::Pose`](super::Signal::Pose), from `reference`.
    pub pose: usize,
    /// A point near the body (m), from which places are counted.
    pub reference: DVec3,
    /// Slot of the pressure (Pa) by which the mouth sucks when it is closed.
    pub pressure: usize,
    /// Radius of the mouth (m), a disc about the tool's origin, across its axis.
    pub bore: f64,
    /// How far before and behind it faces are sucked (m).
    pub reach: f64,
    /// The time in which pressure follows (s).
    pub delay: f64,
    /// The body's faces.
    pub faces: Arc<BodyFaces>,
    /// Those that are sucked now.
    pub active: FaceCorners,
    /// The pressure by which they are sucked (Pa).
    pub now: f64,
}

impl Suction {
    /// Where the tool is at the end of the step, seen from the reference.
    pub fn pose_in(&self, signals: &Signals) -> Pose {
        Pose::of_slots(&signals.values()[self.pose..])
    }

    /// Where the share of the mouth that is closed stands in [`SuctionPressure`].
    pub fn share_at(&self) -> usize {
        SUCTION_NUMBERS * self.number + 1
    }

    /// Where its part of [`SuctionMarks`] begins.
    pub fn first_mark(&self) -> usize {
        self.number * self.faces.words()
    }

    /// What share of a face is in the mouth, by its corners in the tool's frame, a triangle's last twice: as if the
    /// distance to the mouth's edge were linear between them, and whether in reach, as its centroid is. A face that is
    /// turned away from the mouth, on the far side of the tissue or of a hole in it, is not in it.
    pub fn share_in_mouth(&self, corners: [DVec3; 4]) -> f32 {
        let [a, b, c, d] = corners;
        let count = if c == d { 3 } else { 4 };
        let (mut inside, mut sizes, mut height) = (0.0, 0.0, 0.0);
        for y in &corners[..count] {
            let off = self.bore - y.truncate().length();
            inside += off.max(0.0);
            sizes += off.abs();
            height += y.z;
        }
        let is_turned_here = (c - a).truncate().perp_dot((d - b).truncate()) > 0.0;
        let in_reach = f64::abs(height) <= self.reach * count as f64;
        if is_turned_here && in_reach && inside > 0.0 { (inside / sizes) as f32 } else { 0.0 }
    }

    /// Takes over what the body's columns say.
    pub fn renew(&mut self, marks: &[u32], pressure: &Reals) {
        let first = self.first_mark();
        self.active = self.faces.marked(&marks[first..first + self.faces.words()]);
        self.now = pressure.get(SUCTION_NUMBERS * self.number);
    }
}

/// The share that a mark of a face stands for.
pub fn share(mark: u32) -> f64 {
    f64::from(f32::from_bits(mark))
}
