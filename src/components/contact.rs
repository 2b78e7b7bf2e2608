//! What bodies do to each other where their surfaces meet.

use super::Reals;
use super::column::columns;
use bevy_ecs::prelude::*;
use std::collections::HashMap;

columns! {
    /// Force of other bodies, and of the body itself, on the node in the last step (N), a vector a node. Exists where
    /// the body may meet others or itself.
    ContactForce(Reals) = "contact_force", State of Touch, Nodes(3);
    /// What each node carries on as a point of a surface, [`MEETING_NUMBERS`] a node: how far it has slipped
    /// elastically (m, a vector); how deep it may be inside (m, 0 or negative); a [`PointState`] of the last step; how
    /// far it was outside of what it faced before the step, after it in implicit steps, of two the less (m); since the
    /// start the length it has slid (m), and what contact has taken of the node's energy (J), also where it is the
    /// faces around it that are touched; into how many shares the mass of the node was split in the last step among
    /// what presses there, by the kinematic law. Exists with [`ContactForce`].
    SurfaceTouch(Reals) = "surface_touch", State of Touch, Nodes(MEETING_NUMBERS);
    /// The same of each point of faces, but that energy is counted at nodes alone: those of a facet after another, as
    /// the body's surface has them, or where [`FacePlaces`] says, and as [`face_points`](crate::contact::face_points)
    /// orders them. Exists where points of the body's faces meet others.
    FaceTouch(Reals) = "face_touch", State of Touch, Other;
}

/// What a point did in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Did {
    /// It faced nothing.
    #[default]
    Free,
    /// It faced something.
    Faces,
    /// It stuck to it.
    Sticks,
    /// It slid.
    Slides,
}

/// What a point did in a step, and whether it faced two walls of a corner: a number in [`SurfaceTouch`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PointState {
    /// What it did.
    pub did: Did,
    /// Whether there were two walls.
    pub in_corner: bool,
}

impl PointState {
    /// So much is added where there were two walls.
    pub const IN_CORNER: u32 = 4;

    /// What a number tells.
    pub fn of(number: f64) -> Self {
        let number = number as u32;
        let did = [Did::Free, Did::Faces, Did::Sticks, Did::Slides][(number % Self::IN_CORNER) as usize];
        Self { did, in_corner: number >= Self::IN_CORNER }
    }

    /// Its number.
    pub fn number(self) -> f64 {
        f64::from(self.did as u32 + Self::IN_CORNER * u32::from(self.in_corner))
    }

    /// Whether the point touched something.
    pub fn touched(self) -> bool {
        self.did >= Did::Sticks
    }
}

/// The bodies that contact keeps away from this one.
#[derive(Component, Clone, Debug)]
pub(crate) struct Meets(pub Vec<Met>);

/// How points of a body meet faces of another, or of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Met {
    /// That one.
    pub body: Entity,
    /// How far they stay apart (m).
    pub thickness: f64,
    /// Whether the points are those of faces, and not nodes.
    pub faces: bool,
    /// Whether springs keep them out, and not the kinematic law.
    pub spring: bool,
    /// The length of an edge of that one, and the smaller of both (m).
    pub edge_of_body: f64,
    pub edge: f64,
}

/// A spring in place of the kinematic law of contact (`Penalty`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSpring {
    /// Its stiffness times the square of the step over the mass that it acts on.
    pub share: f64,
    /// Its damping ratio.
    pub damping: f64,
}

impl ContactSpring {
    /// The gap (m) that the kinematic law would have to close for the force that the spring has, where a point is so
    /// far outside (m; negative inside) and goes outwards by so much in a step (m), by that of the last step. 0 where
    /// there is no force: springs do not pull. That is of a step like the one before; in others the force of a gap is
    /// another by the time between their middles over Δt, with which who asks multiplies it.
    pub fn gap(&self, outside: f64, outwards: f64) -> f64 {
        // what is no number is told by guards, not lost
        if outside >= 0.0 {
            return 0.0;
        }
        let gap = self.share * outside + 2.0 * self.damping * self.share.sqrt() * outwards;
        if gap >= 0.0 { 0.0 } else { gap }
    }
}

/// Numbers a node in [`SurfaceTouch`], and a point in [`FaceTouch`].
pub const MEETING_NUMBERS: usize = 9;

/// Rows of the nodes of a body's surface that may meet others or be tied to one, ascending: in steps in which something
/// acts on surfaces no patch moves them as some of its own, so that all forces on them are known before they move. On
/// bodies whose surface stays the same.
#[derive(Component, Clone, Debug)]
pub struct SurfaceRows(pub Vec<u32>);

/// Whether anything acts on surfaces in a step once the forces of elements are known. What may do so is asked before
/// that, and says whether it does by where nodes are: while all of it sleeps, nodes of surfaces move with their
/// patches.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceSleep {
    /// Whether systems are asked now, and must do no more than answer.
    pub asked: bool,
    /// Whether all sleep; who does not says so.
    pub asleep: bool,
}

/// What contact between surfaces gave that its law cannot give, of steps after which somebody looks.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactGain {
    /// How many these were.
    pub steps: u64,
    /// The energy (J): see [`ContactSet::beyond_bound`](crate::contact::ContactSet::beyond_bound).
    pub energy: f64,
}

/// Where in [`FaceTouch`] the points of each facet are that the body's elements have. Exists on bodies that may lose
/// elements: each point keeps its place while others go and are laid bare. A facet between two elements is there once,
/// since only one side of it can be bare.
#[derive(Component, Clone, Debug, Default)]
pub struct FacePlaces {
    /// The first point of a facet, by its corners.
    firsts: HashMap<[u32; 4], usize>,
    points: usize,
}

/// The corners of a facet, whichever way it is seen and begun; a triangle repeats its last one.
fn corners([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    let mut corners = [a, b, c, if c == d { u32::MAX } else { d }];
    corners.sort_unstable();
    corners
}

impl FacePlaces {
    /// Of facets by the author's nodes of their corners, each with how many points it has; some may be there twice.
    pub fn of(facets: impl Iterator<Item = ([u32; 4], usize)>) -> Self {
        let mut places = Self::default();
        for (facet, count) in facets {
            places.firsts.entry(corners(facet)).or_insert_with(|| {
                places.points += count;
                places.points - count
            });
        }
        places
    }

    /// How many points there are.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The first point of each of such facets, of a body that has places for them or one after the other.
    pub fn firsts(places: Option<&Self>, facets: impl Iterator<Item = ([u32; 4], usize)>) -> Vec<usize> {
        let mut next = 0;
        let first = |(facet, count): ([u32; 4], usize)| {
            next += count;
            match places {
                Some(places) => places.firsts.get(&corners(facet)).copied().unwrap_or(places.points),
                None => next - count,
            }
        };
        facets.map(first).collect()
    }
}
