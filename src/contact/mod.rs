//! Surfaces of bodies that meet: which face a point faces, the search for it, and the law that keeps bodies apart. All
//! in f64, of places that are counted from a point near the bodies.

mod boxes;
mod candidates;
mod edges;
mod face_points;
mod facing;
mod immersed;
mod law;
mod lists;
mod neighbourhoods;
mod parts;
mod rims;
mod shortlist;
mod surfaces;
mod ties;

pub use boxes::Tree;
pub use candidates::{Kept, Listed};
pub use edges::{Crossing, Edge, distance};
pub use face_points::{bilinear, face_points};
pub use facing::{Faced, Facing, Own, TURNED_AWAY};
pub use immersed::immersed;
pub use law::{Beginning, Contact, ContactSet};
pub use lists::{Finder, Lists};
pub use neighbourhoods::Neighbourhoods;
pub use parts::Parts;
pub use shortlist::{Lately, Shortlist, Stays};
pub use surfaces::{DEEPEST, Near, Placed, Point, Surfaces, triangles_of};
pub use ties::{Tie, TieSet};
