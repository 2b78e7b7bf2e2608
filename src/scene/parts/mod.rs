//! Scenes made of parts: files are read into the text of the scene, and what they hold is placed and named in it.
//!
//! The text becomes one: behind each `scene: "eye.ron"` what the file holds goes in as `content`, so that the text is
//! whole wherever it is taken, and each byte knows its file. In the tree of that text what parts hold stands beside
//! what the scene itself holds, under the names that it has in the scene; and in the same way the scene read from it
//! has no parts any more.

mod flatten;
mod merge;
mod naming;
mod placement;
mod read;

pub(super) use flatten::{Problem, flatten};
pub(super) use merge::{find, merged};
pub(super) use read::{Together, read};
