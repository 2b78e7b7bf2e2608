//! Bodies that meet each other and themselves, in f64, f32 and on the GPU.
//!
//! E = 3000 Pa, ν = .45, ρ = 1000 kg/m³ (so c = 3.373 m/s) unless a test says otherwise.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod asleep;
mod attachments;
mod bits;
mod blades;
mod capstan;
#[path = "../physics/configurations.rs"]
mod configurations;
mod contact_fields;
mod copies;
mod curved_tools;
mod discs;
mod edges;
mod edges_apart;
mod elements_under_tools;
mod faces;
mod first_touch;
#[allow(dead_code)]
#[path = "../physics/frames.rs"]
mod frames;
mod free_friction;
mod free_tools;
mod given_back;
mod glue;
mod glue_gaps;
mod glue_partners;
mod glued_grasps;
mod grasp;
mod grasped_surfaces;
mod grip_strength;
mod grooves;
mod held_by_tools;
mod implicit;
mod implicit_books;
mod implicit_grasps;
mod implicit_ties;
mod ironing;
mod kinematic_rest;
mod last_touches;
mod lifted_tools;
mod loads_that_grow;
mod lost_surfaces;
mod memory;
mod notches;
mod quiet_books;
mod rest;
mod rims;
mod rounded_places;
mod scanned;
mod spring_starts;
mod static_friction;
mod stiffer_springs;
mod surfaces;
mod sutures;
mod sweeps;
mod thickness;
mod ties;
mod tips;
mod to_rounding;
mod trays;
mod turned_friction;
mod two_grasps;
mod written;
