//! A cube that falls on a plate that pushes back: a node system of a program's own, which says how stiff it is.

use super::super::Trial;
use bevy_ecs::prelude::*;
use sinew::Error;
use sinew::backend::cpu::{Cpu, NodeColumns};
use sinew::components::{Displacement, ExternalForce, RestPosition};
use sinew::glam::DVec3;
use sinew::math::SimdScalar;
use sinew::systems::{Before, ForceSlopes, MiddleOfStep, NodeSystem, NodesAtRest, Phase, Registry, System};

/// Pushes nodes up that are below z = 0. What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
struct Plate {
    /// Force a depth and node (N/m).
    stiffness: f64,
}

impl NodeSystem for Plate {
    type Columns = (&'static RestPosition, &'static Displacement, &'static mut ExternalForce);
    type Prepared = ();

    fn prepare(&self, _: &Before<'_>) {}

    /// Any node may come to bear it, and the lightest is the quickest.
    fn slopes(&self, nodes: &NodesAtRest<'_>) -> ForceSlopes {
        let moving = (0..nodes.rest.0.len()).filter(|&row| nodes.moves(row));
        let lightest = moving.map(|row| nodes.mass.get(row)).fold(f64::INFINITY, f64::min);
        ForceSlopes { stiffness: self.stiffness / lightest, damping: 0.0 }.letting_go()
    }

    fn energy(&self, nodes: &MiddleOfStep<'_>) -> Option<f64> {
        let depth = |row: usize| (-nodes.place(row).z).max(0.0);
        Some((0..nodes.mass.len()).map(|row| 0.5 * self.stiffness * depth(row).powi(2)).sum())
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let height = nodes.place(row).z;
            if height < 0.0 {
                nodes.add_load(row, DVec3::new(0.0, 0.0, -self.stiffness * height));
            }
        }
    }
}

/// H26.
pub fn impact(trial: &mut Trial<'_>) -> Result<(), Error> {
    let registry = Registry::default().with(
        System::of_nodes::<Plate>("plate", Phase::Loads, "pushes up what is below z = 0")
            .on_each_body::<Plate>()
            .with_shader::<Plate>("plate.wgsl", include_str!("plate.wgsl")),
    );
    let (young, cell) = (1e7, 0.0125);
    // drivers that compute on the CPU take long for steps of so small a body
    let few = trial.configuration.is_gpu() && !trial.full;
    for &speed in if few { &[50.0][..] } else { &[10.0, 50.0][..] } {
        for &times in if few { &[10.0][..] } else { &[1.0, 10.0, 100.0][..] } {
            let stiffness = times * young * cell;
            let sets = [
                format!("parameters={{\"plate\": (stiffness: {stiffness:e})}}"),
                format!("bodies.body.velocity=(0, 0, -{speed})"),
            ];
            let mut simulation = trial.start_with(&sets, &registry)?;
            let start = simulation.energies()?.kinetic;
            let name = format!("{speed} m/s, penalty ×{times}");
            if !trial.is_implicit() {
                let lightest = simulation.masses("body")?.into_iter().fold(f64::INFINITY, f64::min);
                let alone = 2.0 / (stiffness / lightest).sqrt();
                trial.most(format!("step over that of the penalty alone, {name}"), simulation.time_step() / alone, 1.0);
            }
            let (mut deepest, mut most) = (0.0_f64, 0.0_f64);
            for samples_left in (1..=30).rev() {
                let left = simulation.planned_steps().saturating_sub(simulation.step_count());
                let ended = simulation.advance_towards_end(left.div_ceil(samples_left));
                if ended.is_err() {
                    trial.stops(&name, ended, &["element"]);
                    break;
                }
                let (rest, moved) = (simulation.rest_positions("body")?, simulation.displacements("body")?);
                let e = simulation.energies()?;
                let sum = e.kinetic + e.strain + e.hourglass + e.held.unwrap_or(f64::INFINITY);
                // what is not a number must not go by
                most = if sum <= most || most.is_nan() { most } else { sum };
                let depths = rest.iter().zip(&moved).map(|(rest, moved)| -(*rest + *moved).z);
                deepest = depths.fold(deepest, f64::max);
            }
            if deepest > 0.0 {
                trial.most(format!("energy over that at the start, {name}"), most / start, 1.01);
                trial.report(format!("deepest in cells, {name}"), deepest / cell);
            }
        }
    }
    Ok(())
}
