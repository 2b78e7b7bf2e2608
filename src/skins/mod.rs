//! Skins: fine surfaces that meshes carry, for pictures and for whoever touches what is seen.
//!
//! A point of a skin goes with an element of the mesh, its host: x = Σ w_a x_a over the host's nodes. In the element
//! the weights are its shape functions; outside they go on linearly, up to one size of the element, and what lies
//! farther off is carried along by the element's rotation. So affine motions are exact for all points but those.

mod carrier;
mod embedding;
mod skin;

pub use carrier::Carrier;
pub use embedding::{Embedding, NodalForces};
pub use skin::{Pictured, Skin, normals};
