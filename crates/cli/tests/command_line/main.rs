//! The built command: its outputs, what it says, and how it ends.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod sinew;

mod advises;
mod benches;
mod documented;
mod ends;
mod explains;
mod interrupted;
mod locked;
mod modes;
mod renders;
mod runs;
mod sweeps;
mod threads;
mod unloads;
mod views;
mod words;
