//! `boundary`: where constrained nodes go in this step. `shaders/boundary.wgsl` is its twin.

use super::node_system::NodeSystem;
use super::node_views::{Before, ForceSlopes, NodesAtRest};
use super::places_within;
use super::rows::Rows;
use super::stage::Stage;
use super::system::{Phase, System};
use crate::backend::cpu::{Asked, Cpu, NodeColumns};
use crate::components::*;
use crate::math::SimdScalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Prescribed nodes: u(t + Δt) = A·(X − center) + b. The step that leads there is written to [`DisplacementIncrement`]
/// on the constrained axes, and `integrate` adds it as it adds all others. Fixed axes have a step of 0 from the start
/// and need no work.
pub fn system() -> System {
    System::built_in_nodes::<Prescribed>(
        "boundary",
        Phase::Boundary,
        "says where fixed and prescribed nodes go",
        "`Fixed(...)` or `Prescribed(...)` under `constraints`",
        |world| {
            let fixed = super::registry::count::<Fixed>(world, "fixed set", "fixed sets");
            let prescribed = super::registry::count::<Prescribed>(world, "prescribed set", "prescribed sets");
            match (fixed, prescribed) {
                (Some(f), Some(p)) => Some(format!("{f}, {p}")),
                (some, None) | (None, some) => some,
            }
        },
    )
    .with_shader::<Prescribed>("shaders/boundary.wgsl", include_str!("../shaders/boundary.wgsl"))
}

impl NodeSystem for Prescribed {
    type Columns = (
        &'static Displacement,
        Option<&'static DisplacementCompensation>,
        &'static mut DisplacementIncrement,
        Option<&'static mut PreviousPrescribedIncrement>,
    );
    /// Rows of A and b.
    type Prepared = [[f64; 4]; 3];

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn stages(&self, body: Entity, world: &World) -> Vec<Stage> {
        let arms: Vec<f32> = self.arms.iter().flat_map(|arm| arm.as_vec3().to_array()).collect();
        let stage = Stage::of(self.rows()).reals("arms", &arms);
        let stage = match world.get::<DisplacementCompensation>(body) {
            Some(_) => stage.fragment(shader!("compensation")),
            None => stage.text(
                "generated: sums that are not compensated",
                "fn compensation_of(node: u32, axis: u32) -> f32 {\n    return 0.0;\n}\n",
            ),
        };
        if world.get::<PreviousPrescribedIncrement>(body).is_none() {
            return vec![stage.text("generated: previous steps are not kept", "fn keep_previous_step(at: u32) {}\n")];
        }
        let place = place_in_buffer::<PreviousPrescribedIncrement>(body, world);
        let place = format!("const PREVIOUS_PRESCRIBED_AT: u32 = {place}u;\n");
        let stage = stage.fragment(shader!("previous_prescribed_increment"));
        let stage = stage.text("generated: where previous steps lie", place);
        vec![stage.column(FirstNonFinite::BUFFER, body, PreviousPrescribedIncrement::NAME)]
    }

    fn prepare(&self, before: &Before<'_>) -> [[f64; 4]; 3] {
        [0, 1, 2].map(|axis| before.signals.values()[self.signal + axis])
    }

    /// None: it sets displacements, and adds no forces.
    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, motion: &[[f64; 4]; 3], _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        nodes.reads(Asked::Displacement);
        nodes.writes(Asked::DisplacementIncrement);
        let compensation = nodes.compensation.as_ref().map(|[of_u, _]| &**of_u);
        let own = places_within(&self.rows, nodes.first, nodes.rows());
        for (&row, arm) in self.rows[own.clone()].iter().zip(&self.arms[own]) {
            let row = row as usize - nodes.first;
            for axis in (0..3).filter(|axis| self.axes >> axis & 1 == 1) {
                let [x, y, z, shift] = motion[axis];
                let place = 3 * row + axis;
                let target = T::from_f64(x * arm.x + y * arm.y + z * arm.z + shift);
                let compensation = compensation.map_or(T::default(), |compensation| compensation[place]);
                // for the work that integrate accumulates
                if let Some(previous) = nodes.previous_prescribed.get_mut(place) {
                    *previous = nodes.step[place].to_f64() as f32;
                }
                nodes.step[place] = (target - nodes.u[place]) + compensation;
            }
        }
    }
}
