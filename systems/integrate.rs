//! `integrate`: moves the nodes. `shaders/integrate.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, ROWS_A_TASK};
use crate::backend::kernel::{Fragment, Kernel, Uniform, WEBGPU_STORAGE_BUFFERS, uniform};
use crate::backend::step::{step_number, with_step};
use crate::components::*;
use crate::math::Scalar;
use crate::shader;
use bevy_ecs::prelude::*;

/// Central differences in velocity form, damping centred: with a = cΔt/(2m),
/// d ← ((1 − a) d + Δt² (R − F)/m)/(1 + a), u ← u + d.
///
/// The first step starts half way, d ← (1 − a) d + ½Δt² (R − F)/m with d = v₀Δt, so that free fall is exact. Stable iff
/// ωΔt ≤ 2 for any damping. The classical form with three coefficients loses 2 to 10 % in f32, this one 1e-6; with
/// [`DisplacementCompensation`] the sum of steps is as good as in f64. Where Δt changes, d is scaled to the new one
/// beforehand, and forces act over the mean of both, (Δt + Δt')/2 in place of Δt in the push and in a. Constrained axes take the step that `boundary`
/// wrote; nodes without mass are parked.
///
/// In a static analysis the same recursion relaxes: the mass is [`FictitiousMass`], a is one number for all nodes, and
/// forces are multiplied with a gain ([`Relaxation`]).
pub fn system() -> System {
    System::built_in(
        "integrate",
        Phase::Integrate,
        "moves the nodes by one step of central differences",
        "bodies",
        |world| super::registry::count::<Displacement>(world, "body", "bodies"),
        integrate,
    )
    .on_device(kernels)
}

/// What a step multiplies forces and damping with.
#[derive(Clone, Copy)]
struct Factors<T> {
    /// Δt times the time between the middles of the last and of this step (see [`Clock::between_middles`]), times the gain
    /// of a static analysis (s²).
    force: T,
    /// Half the time between the middles, in the first step Δt/2 (s).
    half_step: T,
    /// 1, in the first step 0.
    divide: T,
    /// 1/Δt (1/s).
    rate: T,
    /// Share of a step's work that is booked, the time between the middles over Δt: 1, in the first step ½.
    booked: T,
    /// a of a static analysis, else 0.
    relaxation: T,
}

impl<T: Scalar> Factors<T> {
    fn of(clock: &Clock) -> Self {
        let (dt, between, first) = (clock.time_step, clock.between_middles(), clock.step == 0);
        let (gain, damping) = clock.relaxation.map_or((1.0, 0.0), |relaxation| (relaxation.gain, relaxation.damping));
        Self {
            force: T::from_f64(gain * dt * between),
            half_step: T::from_f64(0.5 * if first { dt } else { between }),
            divide: T::from_f64(if first { 0.0 } else { 1.0 }),
            rate: T::from_f64(1.0 / dt),
            booked: T::from_f64(between / dt),
            relaxation: T::from_f64(damping),
        }
    }
}

type BodyQuery<'a> = (
    (&'a Mass, Option<&'a FictitiousMass>),
    &'a InternalForce,
    Option<&'a ExternalForce>,
    &'a ConstrainedAxes,
    Option<&'a DampingCoefficient>,
    &'a mut Displacement,
    &'a mut DisplacementStep,
    Option<&'a mut DisplacementCompensation>,
    Option<&'a mut Work>,
    &'a mut FirstNonFinite,
);

fn integrate(clock: Res<Clock>, cpu: Res<Cpu>, mut bodies: Query<BodyQuery>) {
    for (masses, internal, external, axes, damping, mut u, mut step, compensation, work, mut first) in &mut bodies {
        let mass = masses.1.map_or(&masses.0.0, |fictitious| &fictitious.0);
        macro_rules! run {
            ($variant:ident) => {
                if let (Reals::$variant(u), Reals::$variant(step)) = (&mut u.0, &mut step.0) {
                    let fixed = Inputs {
                        mass: mass.slice(),
                        internal: internal.slice(),
                        external: external.map(|e| e.slice()),
                        axes,
                        damping: damping.map(|d| d.slice()),
                        factors: Factors::of(&clock),
                        kept: &[],
                    };
                    let compensation = compensation.map(|c| c.into_inner().0.slice_mut());
                    let work = work.map(|w| w.into_inner().0.slice_mut());
                    let words = first.0.get_mut(SPENT_AT..).unwrap_or_default();
                    let sums = words.len().min(before_at(fixed.axes.len()) - SPENT_AT);
                    let (spent, kept) = words.split_at_mut(sums);
                    let fixed = Inputs { kept, ..fixed };
                    move_nodes(&cpu, &fixed, u, step, compensation, work, spent)
                } else {
                    None
                }
            };
        }
        let bad = match u.0 {
            Reals::F32(_) => run!(F32),
            Reals::F64(_) => run!(F64),
        };
        if let (Some(bad), u32::MAX) = (bad, first[0]) {
            (first[0], first[1]) = (bad, step_number(&clock));
        }
    }
}

struct Inputs<'a, T> {
    mass: &'a [T],
    internal: &'a [T],
    external: Option<&'a [T]>,
    axes: &'a [u32],
    damping: Option<&'a [T]>,
    factors: Factors<T>,
    /// Bits of the last steps (m) along prescribed axes; none where nothing is moved as told or all work is booked.
    kept: &'a [u32],
}

/// Returns the lowest row whose displacement is no longer finite.
fn move_nodes<T: Scalar>(
    cpu: &Cpu,
    inputs: &Inputs<'_, T>,
    u: &mut [T],
    step: &mut [T],
    compensation: Option<&mut [T]>,
    work: Option<&mut [T]>,
    spent: &mut [u32],
) -> Option<u32> {
    let bad = std::sync::atomic::AtomicU32::new(u32::MAX);
    let mut compensations = compensation.map(|c| c.chunks_mut(COMPENSATION_NUMBERS * ROWS_A_TASK));
    let mut works = work.map(|w| w.chunks_mut(WORK_NUMBERS * ROWS_A_TASK));
    // none where the whole work is booked
    let mut sums = spent.chunks_mut(2 * ROWS_A_TASK / SPENT_ROWS);
    let tasks = u.chunks_mut(3 * ROWS_A_TASK).zip(step.chunks_mut(3 * ROWS_A_TASK)).enumerate().map(|(task, rows)| {
        (
            task * ROWS_A_TASK,
            rows,
            compensations.as_mut().and_then(Iterator::next),
            works.as_mut().and_then(Iterator::next),
            sums.next().unwrap_or_default(),
        )
    });
    cpu.for_each(tasks, |(first, (u, step), mut compensation, mut work, sums)| {
        let (mut spent, rows) = (0.0, u.len() / 3);
        for row in 0..rows {
            let at = 3 * row..3 * row + 3;
            let lost = COMPENSATION_NUMBERS * row..COMPENSATION_NUMBERS * (row + 1);
            let lost = compensation.as_mut().map(|c| &mut c[lost]);
            let mut sum = Sum { u: &mut u[at.clone()], step: &mut step[at], lost };
            let work = work.as_mut().map(|w| &mut w[WORK_NUMBERS * row..WORK_NUMBERS * (row + 1)]);
            spent += move_node(inputs, first + row, &mut sum, work);
            if (row + 1).is_multiple_of(SPENT_ROWS) || row + 1 == rows {
                add_to_sum(sums.get_mut(2 * (row / SPENT_ROWS)..), std::mem::take(&mut spent));
            }
            // what is not finite in one component is not finite in the sum
            if !(sum.u[0] + sum.u[1] + sum.u[2]).to_f64().is_finite() {
                bad.fetch_min((first + row) as u32, std::sync::atomic::Ordering::Relaxed);
            }
        }
    });
    Some(bad.into_inner()).filter(|&row| row != u32::MAX)
}

/// A displacement and its step, summed with what rounding left out of both.
struct Sum<'a, T> {
    u: &'a mut [T],
    step: &'a mut [T],
    lost: Option<&'a mut [T]>,
}

impl<T: Scalar> Sum<'_, T> {
    /// Makes the step longer. At a small Δt the change has few digits in common with the step, and is lost without
    /// compensation.
    #[inline(always)]
    fn push(&mut self, i: usize, change: T) {
        match &mut self.lost {
            None => self.step[i] += change,
            Some(lost) => compensated_add(&mut self.step[i], &mut lost[3 + i], change),
        }
    }

    /// Takes the step.
    #[inline(always)]
    fn go(&mut self, i: usize, constrained: bool) {
        match &mut self.lost {
            None => self.u[i] += self.step[i],
            Some(lost) => {
                // what boundary wrote is the whole of a constrained step
                if constrained {
                    lost[3 + i] = T::default();
                }
                let exact = self.step[i] - lost[3 + i];
                compensated_add(&mut self.u[i], &mut lost[i], exact);
            }
        }
    }
}

/// sum += change, where `lost` is what rounding has made of the sum too much (Kahan 1965).
#[inline(always)]
fn compensated_add<T: Scalar>(sum: &mut T, lost: &mut T, change: T) {
    let exact = change - *lost;
    let rounded = *sum + exact;
    *lost = (rounded - *sum) - exact;
    *sum = rounded;
}

/// Adds to a number that is kept as two of f32, as bits.
fn add_to_sum(sum: Option<&mut [u32]>, part: f64) {
    let Some([high, low, ..]) = sum else { return };
    let total = f64::from(f32::from_bits(*high)) + f64::from(f32::from_bits(*low)) + part;
    let rounded = total as f32;
    *high = rounded.to_bits();
    *low = ((total - f64::from(rounded)) as f32).to_bits();
}

/// Returns the work against internal forces (J).
#[inline(always)]
fn move_node<T: Scalar>(inputs: &Inputs<'_, T>, node: usize, sum: &mut Sum<'_, T>, mut work: Option<&mut [T]>) -> f64 {
    let (zero, one) = (T::default(), T::from_f64(1.0));
    let Factors { force: force_factor, half_step, divide, rate, booked, relaxation } = inputs.factors;
    let (mass, axes) = (inputs.mass[node], inputs.axes[node]);
    if mass <= zero {
        sum.step.fill(zero);
        return 0.0;
    }
    let per_mass = one / mass;
    let coefficient = inputs.damping.map_or(zero, |c| c[node]);
    let a = coefficient * half_step * per_mass + relaxation;
    let shrink = if a > zero { one / (one + divide * a) } else { one };
    let mut spent = zero;
    for i in 0..3 {
        let internal = inputs.internal[3 * node + i];
        let external = inputs.external.map_or(zero, |r| r[3 * node + i]);
        let constrained = axes >> i & 1 == 1;
        let before = sum.step[i];
        if !constrained {
            let pushed = force_factor * ((external - internal) * per_mass);
            sum.push(i, (pushed - (one + divide) * a * before) * shrink);
        }
        sum.go(i, constrained);
        let step = sum.step[i];
        let last = match inputs.kept.get(3 * node + i) {
            Some(&bits) if constrained => T::from_f64(f64::from(f32::from_bits(bits))),
            _ => before,
        };
        spent += internal * (last + step);
        if let Some(work) = &mut work {
            // forces at the beginning of the step work along the mean of the steps before and after, in the first step
            // along half of it: so the balance of the scheme is exact in the middle of each step
            let before = if constrained { std::mem::replace(&mut work[4 + i], step) } else { before };
            let mean = T::from_f64(0.5) * (before + step);
            let along = booked * mean;
            let lost = coefficient * rate * mean * along;
            work[0] += external * along;
            work[1] += lost;
            work[3] += internal * along;
            if constrained {
                work[2] += (internal - external) * along + lost;
            }
        }
    }
    0.5 * (booked * spent).to_f64()
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Integrate {
    count: u32,
}
uniform!(Integrate { count });

/// One kernel for each body, of what the body has columns for; two where that is more than a kernel may have.
fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut query = world.query::<(Entity, &Mass, Has<ExternalForce>, Has<DampingCoefficient>, Has<Work>)>();
    let bodies: Vec<_> = query.iter(world).map(|(body, mass, e, d, w)| (body, mass.len() as u32, [e, d, w])).collect();
    let mut kernels = Vec::new();
    for (body, count, optional) in bodies {
        let relaxed = world.get_resource::<Clock>().is_some_and(|clock| clock.relaxation.is_some());
        let noticed = world.get::<FirstNonFinite>(body).map_or(0, |noticed| noticed.len());
        let (spent, at) = (noticed > SPENT_AT, before_at(count as usize));
        let kept = (noticed > at).then_some(at);
        let fictitious = world.get::<FictitiousMass>(body).is_some();
        let column = |name: &'static str| if fictitious && name == Mass::NAME { FictitiousMass::NAME } else { name };
        let compensated = world.get::<DisplacementCompensation>(body).is_some();
        let nodes = buffers.uniform("integrate".into(), &Integrate { count }.bytes());
        let mut kernel = |entry: &'static str, columns: &[&'static str]| {
            let kernel = Kernel::new(entry, entry)
                .fragment(shader!("integrate"))
                .fragment(shader!("row"))
                .bind_uniform::<Integrate>("nodes", nodes)
                .threads(count);
            let kernel =
                columns.iter().fold(kernel, |kernel, name| kernel.bind(name, buffers.column(body, column(name))));
            with_step(with_optional(kernel, optional, compensated, relaxed, (spent, kept)), world)
        };
        let [external, damped, worked] = optional;
        let mut push = vec![Mass::NAME, InternalForce::NAME, ConstrainedAxes::NAME, DisplacementStep::NAME];
        push.extend(external.then_some(ExternalForce::NAME));
        push.extend(damped.then_some(DampingCoefficient::NAME));
        push.extend(worked.then_some(Work::NAME));
        let mut displace = vec![Displacement::NAME, FirstNonFinite::NAME];
        let lost = compensated.then_some(DisplacementCompensation::NAME);
        if push.len() + displace.len() + usize::from(compensated) <= WEBGPU_STORAGE_BUFFERS {
            push.extend(displace);
            push.extend(lost);
            kernels.push(kernel("integrate", &push));
        } else {
            displace.extend([DisplacementStep::NAME, ConstrainedAxes::NAME]);
            push.extend(spent.then_some(FirstNonFinite::NAME));
            push.extend(lost);
            displace.extend(lost);
            kernels.push(kernel("integrate_push", &push));
            kernels.push(kernel("integrate_move", &displace));
        }
    }
    kernels
}

/// Fragments of the columns a body has, and a line for each that it has not.
fn with_optional(
    kernel: Kernel,
    [external, damped, worked]: [bool; 3],
    compensated: bool,
    relaxed: bool,
    (spent, kept): (bool, Option<usize>),
) -> Kernel {
    let mut without = String::new();
    let mut fragments = Vec::new();
    if external {
        fragments.push(shader!("external_force"));
    } else {
        without += "fn external_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n";
    }
    if damped {
        fragments.push(shader!("damping_coefficient"));
    } else if relaxed {
        fragments.push(shader!("relaxation"));
    } else {
        without += "fn damped(node: u32, before: vec3<f32>, pushed: vec3<f32>, per_mass: f32) -> vec3<f32> {\n    \
                    return pushed;\n}\n";
    }
    if worked {
        fragments.push(shader!("work"));
        if !damped {
            without += "fn coefficient_of(node: u32) -> f32 {\n    return 0.0;\n}\n";
        }
    } else {
        without += "fn book_work(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, \
                    inner: vec3<f32>, outer: vec3<f32>) {}\n";
    }
    if spent {
        fragments.push(shader!("spent"));
        without += &format!("const SPENT_AT: u32 = {SPENT_AT}u;\nfn step_before(node: u32) -> vec3<f32> {{\n");
        without += &match kept {
            None => "    return vec3<f32>(0.0);\n}\n".to_string(),
            Some(at) => {
                let word = |i: usize| format!("bitcast<f32>(atomicLoad(&first_non_finite[{}u + 3u * node]))", at + i);
                format!("    return vec3<f32>({}, {}, {});\n}}\n", word(0), word(1), word(2))
            }
        };
    } else {
        without += "fn spend(node: u32, before: vec3<f32>, after: vec3<f32>, constrained: vec3<bool>, inner: vec3<f32>) {}\n\
                    fn add_up_spent(local: u32, node: u32) {}\n";
    }
    if compensated {
        fragments.push(shader!("displacement_compensation"));
    } else {
        without += "fn add_to_step(node: u32, before: vec3<f32>, change: vec3<f32>) -> vec3<f32> {\n    \
                    return before + change;\n}\nfn forget_step(node: u32) {}\n\
                    fn add_step(node: u32, u: vec3<f32>, d: vec3<f32>, constrained: vec3<bool>) -> vec3<f32> {\n    \
                    return u + d;\n}\n";
    }
    let kernel = fragments.into_iter().fold(kernel, Kernel::fragment);
    kernel.fragment(Fragment::new("generated: what the body has and lacks", without))
}
