//! The study of accuracy against time: its parts on made-up problems whose answer is known, and the command on a small
//! scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod answers;
mod contact;
mod extrapolation;
mod interpolation;
mod made_up;
mod plots;
mod references;
mod refinement;
mod solvers;
mod studies;
