//! The physics against closed forms: pointwise laws, elements, whole scenes; in f64, f32 and on the GPU.
//!
//! E = 3000 Pa, ν = .45, ρ = 1000 kg/m³ (so μ = 1034.4828, λ = 9310.3448, κ = 10000 Pa) unless a file says otherwise.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod auto_bound;
mod bars;
mod changing_step;
mod clock_and_limit;
mod columns;
mod configurations;
mod conservation;
mod copies;
mod determinism;
mod elements;
mod endings;
mod equilibrium;
mod far_away;
mod frames;
mod frequency_bound;
mod grab;
mod grids;
mod guards;
mod history;
mod hourglass;
mod inputs;
mod inversion;
mod laws;
mod loads;
mod locking;
mod manufactured;
mod modes;
mod motions;
mod node_sets;
mod one_pass;
mod output_fields;
mod overlaps;
mod own_systems;
mod pick;
mod points;
mod precision;
mod preload;
mod probes;
mod programs;
mod random;
mod refined_lists;
mod removal;
mod snapshots;
mod statics;
mod stiffness_damping;
mod strains;
mod tables;
mod true_limit;
mod unload;
mod unstable_elements;
mod user_laws;
mod viscosity;
mod viscous_pressure;
