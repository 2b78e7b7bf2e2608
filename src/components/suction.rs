//! Tools that suck at faces.

use super::column::columns;
use super::{FaceCorners, Pose, Reals, Signals};
use crate::tools::share_in_disc;
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

    /// What share of a face is in the mouth, by its corners in the tool's frame, a triangle's last twice: of what is
    /// seen of it along the axis, if its centroid is in reach. A face that is turned away from the mouth, on the far
    /// side of the tissue or of a hole in it, is not in it; one that stands nearly along the axis by less and less, so
    /// that a wall beside the mouth, which closes none of it, is not pulled at by all of it or not, as it leans.
    pub fn share_in_mouth(&self, corners: [DVec3; 4]) -> f32 {
        let [a, b, c, d] = corners;
        let twice = (c - a).cross(d - b);
        // false also of what is no number
        if centroid(&corners).z.abs() <= self.reach && twice.z > 0.0 {
            let turned = (twice.z / (STEEP * twice.length())).min(1.0);
            (share_in_disc(&corners.map(DVec3::truncate), self.bore) * turned) as f32
        } else {
            0.0
        }
    }

    /// Whether a face is behind another, by their corners in the tool's frame: its centroid, seen along the axis from
    /// within the tool.
    pub(crate) fn is_hidden(&self, corners: &[DVec3; 4], by: &[DVec3; 4]) -> bool {
        let at = centroid(corners);
        let [a, b, c, d] = *by;
        [[a, b, c], [a, c, d]].into_iter().any(|triangle| {
            let [p, q, r] = triangle.map(|corner| corner.truncate() - at.truncate());
            let parts = DVec3::new(q.perp_dot(r), r.perp_dot(p), p.perp_dot(q));
            let area = parts.element_sum();
            let height = parts.dot(DVec3::from_array(triangle.map(|corner| corner.z)));
            // false of what has no area
            parts.min_element() >= 0.0 && area > 0.0 && height / area > at.z + APART * self.bore
        })
    }

    /// Takes over what the body's columns say.
    pub fn renew(&mut self, marks: &[u32], pressure: &Reals) {
        let first = self.first_mark();
        self.active = self.faces.marked(&marks[first..first + self.faces.words()]);
        self.now = pressure.get(SUCTION_NUMBERS * self.number);
    }
}

/// Faces whose normals' cosine with the axis of a mouth is below this (84°) are sucked by less.
pub(crate) const STEEP: f64 = 0.1;

/// Layers of faces are no nearer than this, in radii of the mouth.
pub(crate) const APART: f64 = 1e-4;

/// The middle of a face's corners, of which a triangle has its last twice (m).
fn centroid(corners: &[DVec3; 4]) -> DVec3 {
    let count = if corners[2] == corners[3] { 3 } else { 4 };
    corners[..count].iter().sum::<DVec3>() / count as f64
}

/// The share that a mark of a face stands for.
pub fn share(mark: u32) -> f64 {
    f64::from(f32::from_bits(mark))
}
