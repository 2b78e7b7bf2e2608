//! `integrate`: moves the nodes. `shaders/integrate.wgsl` is its twin.

use super::registry::{Phase, System};
use crate::backend::Buffers;
use crate::backend::cpu::{Cpu, Factors, NodeColumns, move_nodes};
use crate::backend::kernel::{Fragment, Kernel, Uniform, WEBGPU_STORAGE_BUFFERS, uniform};
use crate::backend::step::{step_number, with_step};
use crate::components::*;
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
                    let fixed = NodeColumns {
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
                    let fixed = NodeColumns { kept, ..fixed };
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
