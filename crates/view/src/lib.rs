//! The live viewer of sinew: a driven simulation in a window, or in a page.
//!
//! `driver` (in the engine) runs it, [`scene3d`] draws it by a graphics device into a texture, [`surfaces`] makes what
//! is drawn of its state, `panels` are what stands around that, [`App`] is all of it.

mod app;
mod camera;
mod editor;
mod elements;
mod files;
mod marks;
mod mouse;
mod panels;
pub mod playback;
pub mod scene3d;
pub mod screen;
mod settings;
mod shot;
mod source;
mod stage;
pub mod surfaces;
mod traces;

// what a page has not: files to write, programs to call, threads, and what waits for the device
#[cfg(not(target_arch = "wasm32"))]
pub mod film;
#[cfg(not(target_arch = "wasm32"))]
mod films;
#[cfg(target_arch = "wasm32")]
#[path = "films/absent.rs"]
mod films;
#[cfg(not(target_arch = "wasm32"))]
pub mod headless;
#[cfg(not(target_arch = "wasm32"))]
pub mod measure;

pub use app::{App, Start};
pub use editor::Bundle;
pub use settings::{FIELDS, Settings};
pub use shot::Shot;
pub use source::Steps;
