//! The step's record, as kernels see it; `shaders/step.wgsl` is its twin.

use super::kernel::{Fragment, Kernel, STEP_VARIABLE, Uniform, uniform};
use crate::components::{Clock, Signals};
use bevy_ecs::prelude::*;

/// What is the same for all rows of a step. The record is this, then a slot of four numbers for every signal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Step {
    /// Δt times the time between the middles of the last and of this step, which is Δt but in the first step and after
    /// a change of Δt; times the force scale of a static analysis (s²).
    pub force_factor: f32,
    /// Half the time between the middles, in the first step Δt/2 (s).
    pub half_step: f32,
    /// 1, in the first step 0.
    pub after_first: f32,
    /// 1/Δt (1/s).
    pub rate: f32,
    /// Index of the step, from 0; stops at the largest number.
    pub number: u32,
    /// Always 0, which no compiler knows: a number combined with it keeps its rounding.
    pub zero: u32,
    /// a = cΔt/2 of a static analysis, else 0.
    pub relaxation: f32,
    /// Share of a step's work that is counted: the time between the middles over Δt.
    pub work_factor: f32,
    /// 1 in steps after which somebody may look at forces, else 0: kernels need not leave them in memory.
    pub observed: u32,
    /// 1 where forces are only tried, which leave histories as they are; else 0.
    pub trying: u32,
    /// Time at the beginning of the step (s).
    pub time: f32,
    /// Δt (s).
    pub time_step: f32,
}

uniform!(Step {
    force_factor,
    half_step,
    after_first,
    rate,
    number,
    zero,
    relaxation,
    work_factor,
    observed,
    trying,
    time,
    time_step
});

impl Step {
    /// The step that begins at the clock's time.
    pub fn of(clock: &Clock) -> Self {
        let (dt, between, first) = (clock.time_step, clock.half_step_interval(), clock.step == 0);
        let (force_scale, damping) =
            clock.relaxation.map_or((1.0, 0.0), |relaxation| (relaxation.force_scale, relaxation.damping));
        Self {
            force_factor: (force_scale * dt * between) as f32,
            half_step: (0.5 * if first { dt } else { between }) as f32,
            after_first: if first { 0.0 } else { 1.0 },
            rate: (1.0 / dt) as f32,
            number: step_number(clock),
            zero: 0,
            relaxation: damping as f32,
            work_factor: (between / dt) as f32,
            observed: 1,
            trying: 0,
            time: clock.time() as f32,
            time_step: dt as f32,
        }
    }
}

/// Index of the clock's step as kernels and what they note have it: it stops at the largest number.
pub(crate) fn step_number(clock: &Clock) -> u32 {
    u32::try_from(clock.step).unwrap_or(u32::MAX)
}

/// Slots for signals in the record: WGSL has no arrays of none.
fn slots(signals: &Signals) -> usize {
    signals.values().len().max(1)
}

/// One step's record for the device; the signals must have been evaluated for the step. `observed`: whether somebody
/// may look at forces after it.
pub fn record(clock: &Clock, signals: &Signals, observed: bool) -> Vec<u8> {
    with_signals(Step { observed: observed.into(), ..Step::of(clock) }, signals)
}

fn with_signals(step: Step, signals: &Signals) -> Vec<u8> {
    let mut bytes = step.bytes();
    for slot in signals.values() {
        bytes.extend_from_slice(bytemuck::bytes_of(&slot.map(|value| value as f32)));
    }
    bytes.resize(record_size(signals), 0);
    bytes
}

/// That of forces at the end of an implicit step, where the clock stands: what they note is of the step that ends.
/// `trying`: whether nothing of them is kept.
pub fn trial_record(clock: &Clock, signals: &Signals, trying: bool) -> Vec<u8> {
    let ending = Clock { step: clock.step.saturating_sub(1), ..*clock };
    let step = Step { number: step_number(&ending), trying: trying.into(), ..Step::of(clock) };
    with_signals(step, signals)
}

/// Bytes of a record.
pub fn record_size(signals: &Signals) -> usize {
    size_of::<Step>() + 16 * slots(signals)
}

/// Adds to a kernel the fragments that declare `step` for a world's signals.
pub(crate) fn with_step(kernel: Kernel, world: &World) -> Kernel {
    step_fragments(world).into_iter().fold(kernel, Kernel::fragment)
}

/// The fragments that declare `step` for a world's signals.
pub(crate) fn step_fragments(world: &World) -> [Fragment; 3] {
    let [step, signals] = step_record(world);
    [step, signals, step_in_a_uniform()]
}

/// The fragments that declare a step's record for a world's signals, but not where it is.
pub(crate) fn step_record(world: &World) -> [Fragment; 2] {
    let slots = world.get_resource::<Signals>().map_or(1, slots);
    let signals = Fragment::new("generated: signals of the scene", format!("const SIGNALS: u32 = {slots}u;\n"));
    [crate::shader!("step"), signals]
}

/// Declares `step` where a kernel is dispatched once a step.
pub(crate) fn step_in_a_uniform() -> Fragment {
    Fragment::new(
        "generated: where the step's record is",
        format!("@group(0) @binding(0) var<uniform> {STEP_VARIABLE}: Step;\n"),
    )
}

/// Declares `step` where a workgroup takes many steps, from one record to the next.
pub(crate) fn step_in_a_workgroup() -> Fragment {
    Fragment::new("generated: where the step's record is", format!("var<workgroup> {STEP_VARIABLE}: Step;\n"))
}
