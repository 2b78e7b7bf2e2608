//! `boundary`: where constrained nodes go in this step. `shaders/boundary.wgsl` is its twin.

use super::places_within;
use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::kernel::{Fragment, Uniform, uniform};
use crate::backend::node_stage::{NodeStage, rows_of};
use crate::components::*;
use crate::error::missing;
use crate::math::Scalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Prescribed nodes: u(t + Δt) = A·(X − center) + b. The step that leads there is written to [`DisplacementStep`] on the
/// constrained axes, and `integrate` adds it as it adds all others. Fixed axes have a step of 0 from the start and need no
/// work.
pub fn system() -> System {
    System::built_in(
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
        boundary,
    )
    .on_nodes(stages)
}

fn boundary(
    signals: Res<Signals>,
    constraints: Query<(&Prescribed, &OfBody)>,
    mut bodies: Query<(
        &Displacement,
        Option<&DisplacementCompensation>,
        &mut DisplacementStep,
        Option<&mut PreviousPrescribedStep>,
    )>,
) {
    for (prescribed, body) in &constraints {
        let Ok((displacement, compensation, mut step, mut previous)) = bodies.get_mut(body.0) else {
            missing("a column of a body");
            continue;
        };
        let previous = previous.as_mut().map_or(&mut [][..], |previous| previous.as_mut_slice());
        let rows = &signals.values()[prescribed.signal..prescribed.signal + 3];
        match &mut step.0 {
            Reals::F32(step) => {
                move_rows(prescribed, rows, 0, displacement.slice(), compensation.map(|c| c.slice()), step, previous)
            }
            Reals::F64(step) => {
                move_rows(prescribed, rows, 0, displacement.slice(), compensation.map(|c| c.slice()), step, previous)
            }
        }
    }
}

/// Where those nodes from row `first` on go that the columns have.
pub(super) fn move_rows<T: Scalar>(
    prescribed: &Prescribed,
    motion: &[[f64; 4]],
    first: usize,
    displacement: &[T],
    compensation: Option<&[T]>,
    step: &mut [T],
    previous: &mut [f32],
) {
    let own = places_within(&prescribed.rows, first, step.len() / 3);
    for (&row, arm) in prescribed.rows[own.clone()].iter().zip(&prescribed.arms[own]) {
        let row = row as usize - first;
        for axis in (0..3).filter(|axis| prescribed.axes >> axis & 1 == 1) {
            let [x, y, z, shift] = motion[axis];
            let place = 3 * row + axis;
            let target = T::from_f64(x * arm.x + y * arm.y + z * arm.z + shift);
            let lost = compensation.map_or(T::default(), |c| c[place]);
            // for the work that integrate accumulates
            if let Some(previous) = previous.get_mut(place) {
                *previous = step[place].to_f64() as f32;
            }
            step[place] = (target - displacement[place]) + lost;
        }
    }
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Motion {
    axes: u32,
    signal: u32,
}
uniform!(Motion { axes, signal });

/// One stage for each prescribed set.
fn stages(world: &mut World, buffers: &mut dyn Buffers) -> Vec<NodeStage> {
    let sets: Vec<(Prescribed, Entity)> =
        world.query::<(&Prescribed, &OfBody)>().iter(world).map(|(set, body)| (set.clone(), body.0)).collect();
    let mut stages = Vec::new();
    for (set, body) in sets {
        let motion = Motion { axes: set.axes, signal: set.signal as u32 };
        let arms: Vec<[f32; 3]> = set.arms.iter().map(|arm| arm.as_vec3().to_array()).collect();
        let nodes = rows_of(body, world);
        let mut stage = NodeStage::new("boundary", "boundary", body, nodes, shader!("boundary"))
            .bind_uniform::<Motion>("motion", buffers.uniform("boundary".into(), &motion.bytes()))
            .bind("arms", buffers.constants("arms of boundary".into(), bytemuck::cast_slice(&arms)))
            .column(Displacement::NAME, buffers.column(body, Displacement::NAME))
            .column(DisplacementStep::NAME, buffers.column(body, DisplacementStep::NAME))
            .of_rows(set.rows);
        stage = if world.get::<DisplacementCompensation>(body).is_some() {
            let lost = buffers.column(body, DisplacementCompensation::NAME);
            stage.shared(shader!("lost")).column(DisplacementCompensation::NAME, lost)
        } else {
            stage.shared(Fragment::new(
                "generated: sums that are not compensated",
                "fn lost_of(node: u32, axis: u32) -> f32 {\n    return 0.0;\n}\n",
            ))
        };
        stage = if world.get::<PreviousPrescribedStep>(body).is_some() {
            let diagnostics = buffers.column(body, PreviousPrescribedStep::NAME);
            let place = place_in_buffer::<PreviousPrescribedStep>(body, world);
            let place = Fragment::new(
                "generated: where previous steps lie",
                format!("const PREVIOUS_PRESCRIBED_AT: u32 = {place}u;\n"),
            );
            stage.shared(shader!("previous_prescribed_step")).shared(place).column(FirstNonFinite::BUFFER, diagnostics)
        } else {
            stage.shared(Fragment::new("generated: previous steps are not kept", "fn keep_previous_step(at: u32) {}\n"))
        };
        stages.push(stage.with_step(world));
    }
    stages
}
