//! Points of bodies that are tied to faces.

use super::Reals;
use super::column::columns;
use bevy_ecs::prelude::*;
use glam::DVec3;

columns! {
    /// What each tie is to the body that its point is of, [`TIE_NUMBERS`] a tie: 0 while it holds, 1 where it broke, 2
    /// where the tissue of one side has gone; when that was (s); the force on the point in the last step (N); what it
    /// has taken since the start (J).
    TieState(Reals) = "tie_state", State of Touch, Other;
}

/// Numbers a tie in [`TieState`].
pub const TIE_NUMBERS: usize = 6;

/// What a tie bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Whatever pulls.
    Any,
    /// So large a force (N).
    Force(f64),
    /// On its area (m²) so large a stress (Pa), pulled off and along the surface; infinite where there is no bound.
    Stress {
        /// The area.
        area: f64,
        /// Pulled off.
        normal: f64,
        /// Along.
        shear: f64,
    },
}

impl Strength {
    /// Whether a force (N) on the point of a tie is too much for it. `out` is the unit normal of the face.
    pub fn is_exceeded(&self, force: DVec3, out: DVec3) -> bool {
        match *self {
            Self::Any => false,
            Self::Force(most) => force.length() >= most,
            Self::Stress { area, normal, shear } => {
                // what is pulled off is held back towards the face
                let off = (-force.dot(out)).max(0.0) / (area * normal);
                let along = (force - out * force.dot(out)).length() / (area * shear);
                off * off + along * along >= 1.0
            }
        }
    }
}

/// A point of a body that is tied to a face.
#[derive(Clone, Debug, PartialEq)]
pub struct TiedPoint {
    /// Its place in [`Glue::bodies`], and that of the face's body.
    pub bodies: [usize; 2],
    /// Rows of nodes, with weights that are 1 together.
    pub nodes: Vec<(u32, f64)>,
    /// Rows of the face's corners, and what each has of the place on it.
    pub corners: [u32; 3],
    /// See there.
    pub weights: [f64; 3],
    /// Of a point that is off the face the row of a node of the element behind, and what it has: with those of the
    /// corners, some beyond 1 or below 0, these weights give the point's own place. So the force on the point and those
    /// on the face's body are of one line, and no moment is made.
    pub behind: Option<(u32, f64)>,
    /// The element behind the face: the block, and the row there.
    pub element: (Entity, u32),
    /// Where the point is as seen from the place of these weights, in the frame of the face (m): along its first side,
    /// across that, and out; but for rounding 0.
    pub gap: DVec3,
    /// What it bears.
    pub strength: Strength,
    /// Its place in [`TieState`] of the point's body.
    pub place: usize,
    /// The attachment of the scene that it is of.
    pub number: usize,
    /// The node that it is, by the author's number, if it is one.
    pub node: Option<u64>,
}

impl TiedPoint {
    /// Rows of the nodes of the face's body that bear it, and what each has of the place on it.
    pub fn bearers(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let corners = self.corners.into_iter().zip(self.weights);
        corners.chain(self.behind).filter(|(_, weight)| *weight != 0.0)
    }
}

/// All that is tied.
#[derive(Resource, Clone, Debug, Default)]
pub struct Glue {
    /// The bodies.
    pub bodies: Vec<Entity>,
    /// The ties, in the order of the scene.
    pub ties: Vec<TiedPoint>,
    /// How often the forces are corrected in a step.
    pub sweeps: usize,
    /// A point near the bodies (m), from which places are counted.
    pub reference: DVec3,
}

/// Axes of the frame of a triangle: along its first side, across that, and out; none where it has no area.
pub fn frame_of([a, b, c]: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let along = (b - a).normalize_or_zero();
    let out = (b - a).cross(c - a).normalize_or_zero();
    (along != DVec3::ZERO && out != DVec3::ZERO).then(|| [along, out.cross(along), out])
}
