//! The live viewer of sinew: a driven simulation in a window.
//!
//! `driver` (in the engine) runs it, [`scene3d`] draws it by a graphics device into a texture, [`surfaces`] makes what
//! is drawn of its state, `panels` are what stands around that, [`App`] is all of it.

mod app;
mod camera;
mod elements;
mod files;
pub mod film;
mod films;
pub mod headless;
mod marks;
pub mod measure;
mod mouse;
mod panels;
pub mod playback;
pub mod scene3d;
mod settings;
mod shot;
mod source;
mod stage;
pub mod surfaces;
mod traces;

pub use app::{App, Start};
pub use settings::{FIELDS, Settings};
pub use shot::Shot;
