//! From a scene to a simulation.

use super::history::History;
use super::inputs::Tape;
use super::interval::RunInterval;
use super::known::Known;
use super::observer::observer;
use super::options::{BackendChoice, Chosen, choose};
use super::plan::{Over, Pass, Plan, each_once};
use super::prepare::{Prepared, add_loads, counts, prepare};
use super::rounding::warn_of_places;
use super::schedule::Scheduled;
use super::scheme::{fill_gpu, fit_workgroups, sum_forces, summed};
use super::solver::Solver;
use super::step_kernels::step_kernels;
use super::{Facts, Job, Options, ScheduledPass, Simulation};
use crate::assembly::Assembly;
use crate::backend::cpu::Cpu;
use crate::backend::device::Device;
use crate::backend::gpu::Gpu;
use crate::backend::kernel::KernelId;
use crate::components::*;
use crate::error::Error;
use crate::observation::{GuardKernels, Observer, WrittenFields};
use crate::scene::SceneFile;
use crate::scene::schema::Scene;
use crate::snapshot::{Keeping, identity};
use crate::systems::{
    HostSystem, NodePass, NodeRows, OnHost, Phase, Registry, System, give_shares, node_pass, patch_pass, shared_pass,
};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemAccess;
use std::time::Duration;
use web_time::Instant;

impl Simulation {
    /// Makes a simulation of a scene with the built-in systems.
    ///
    /// # Errors
    /// All that is wrong with the scene; no GPU where one is asked for.
    pub fn new(scene: &SceneFile, options: &Options) -> Result<Self, Error> {
        Self::with_systems(scene, options, &Registry::default())
    }

    /// Makes a simulation whose scene may also name one's own systems.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_systems(scene: &SceneFile, options: &Options, registry: &Registry) -> Result<Self, Error> {
        Self::on_springs(scene, options, registry, None)
    }

    /// The same, with the springs on which bodies come to rest where these are those of a motion.
    pub(super) fn on_springs(
        scene: &SceneFile,
        options: &Options,
        registry: &Registry,
        springs: Option<SolvedSprings>,
    ) -> Result<Self, Error> {
        let started = Instant::now();
        let mut diagnostics = scene.diagnostics();
        let mut world = World::new();
        let known = Known::of(registry, &scene.scene);
        if scene.scene.follows_path() && options.precision == Precision::F32 {
            diagnostics
                .error_at(
                    "analysis",
                    "a path by arc length is followed in f64: differences of forces are too inexact in f32",
                )
                .note("run it with `--precision f64`; of a program, `Options::precision` is `Precision::F64`");
        }
        let prepared = prepare(scene, (options, springs), &known, &mut world, &mut diagnostics);
        let Some(Prepared { assembly, clock, stability, steps, schedule }) =
            prepared.filter(|_| !diagnostics.has_errors())
        else {
            return Err(diagnostics.into());
        };
        super::step_change::remember_the_start(&mut world);
        let (nodes, elements) = counts(&assembly);
        let observer = observer(scene, &clock, steps, &mut world);
        world.insert_resource(observer);
        world.insert_resource(WrittenFields::from(&scene.scene.output));
        let mut hosts = Vec::new();
        let mut access = Vec::new();
        for entry in &schedule {
            let mut system = match &entry.system.host {
                OnHost::System(make) | OnHost::Elements(make) => make(),
                OnHost::Nodes(rows) => rows.touches(),
            };
            access.push(system.initialize(&mut world));
            hosts.push(Some(system));
        }
        add_called_for_columns(&schedule, &access, &assembly, &mut world);
        let node_systems: Vec<(String, NodeRows)> =
            schedule.iter().filter_map(|entry| Some((entry.system.name.clone(), entry.system.host.nodes()?))).collect();
        let named = node_systems.iter().map(|(name, rows)| (name.as_str(), *rows));
        give_shares(named, scene.scene.duration, options.precision, &mut world)?;
        let held = schedule.iter().filter_map(|entry| entry.system.held_energy());
        world.insert_resource(HeldEnergies(held.collect()));
        // Newton's iterations need the forces without what moves nodes
        let fuse = scene.scene.fuse && !scene.scene.is_static_by_newton();
        let mut plan = Plan::of(&schedule, &access, fuse, &mut world);
        let mut solver = Solver::of(&scene.scene, options.precision, &mut world);

        let Chosen { gpu, mut why } = chosen(&scene.scene, &schedule, options)?;
        if let Some(gpu) = &gpu {
            why += &fit_workgroups(&mut world);
            if options.scheme.is_none() && !gpu.report().software {
                why += &fill_gpu(&mut world);
            }
        }
        let gpu_name = gpu.as_ref().map(|gpu| gpu.report().name.clone());
        let kernels = match gpu {
            None => None,
            Some(gpu) => match kernels_on(gpu, &schedule, &mut plan, &mut world) {
                Ok(kernels) => Some(kernels),
                // a GPU that was not asked for need not be up to the scene
                Err(Error::Gpu(reason)) if options.backend == BackendChoice::Auto => {
                    why = format!("the GPU cannot take this scene: {reason}");
                    world.remove_resource::<Device>();
                    world.remove_resource::<GuardKernels>();
                    sum_forces(options.scheme.unwrap_or_default(), &mut world);
                    None
                }
                Err(error) => return Err(error),
            },
        };
        plan.summed = summed(&mut world);
        let on_gpu = kernels.is_some();
        let backend = match gpu_name.filter(|_| on_gpu) {
            Some(name) => format!("GPU ({name})"),
            None => world.resource::<Cpu>().describe(),
        };
        let entries = entries(&schedule, hosts, &plan, kernels, &mut world);
        let keeping = keeping(scene, options.precision, &schedule, &plan, &mut world);
        // who writes more than loads makes energy
        let external = ExternalForce::NAME;
        let foreign = keeping.written.iter().any(|name| *name != external);
        world.insert_resource(keeping);
        world.insert_resource(GuardMemory::default());
        world.insert_resource(SurfaceSleep::default());
        world.insert_resource(ContactGain::default());
        if world.resource::<Clock>().relaxation.is_none() {
            crate::observation::begin_to_guard(&mut world)?;
        }
        if on_gpu {
            warn_of_places(&mut world);
        }
        let mut observer = world.resource_mut::<Observer>();
        (observer.guard_settings.foreign, observer.on_gpu) = (foreign, on_gpu);
        // what shares passes leaves no step to the host
        let alone = |entry: &Scheduled<'_>| match on_gpu {
            true => !entry.on_device,
            false => entry.system.host.nodes().is_none(),
        };
        let custom = schedule.iter().any(|entry| entry.system.custom && alone(entry));
        let is_of_host = |entry: &Scheduled<'_>| !entry.on_device && !entry.system.observes;
        observer.all_on_device = on_gpu && !schedule.iter().any(is_of_host);
        let facts = Facts {
            on_gpu,
            custom,
            backend,
            why,
            precision: options.precision,
            stability,
            steps,
            nodes,
            elements,
            initial_mass: crate::observation::mass(&mut world)?,
            setup: started.elapsed(),
            forgets_start: options.forgets_start,
            node_systems,
            slopes: schedule.iter().filter_map(|entry| entry.system.slopes()).collect(),
            warnings: diagnostics,
        };
        let settling = super::preload::settling(scene, options, world.resource::<Clock>())?;
        // rest shapes have gone into the world
        let mut file = scene.clone();
        file.rest_shapes.clear();
        solver.begin(&scene.scene, &facts.stability, facts.initial_mass, &mut world);
        Ok(Self {
            world,
            plan,
            entries,
            scene: scene.scene.clone(),
            file,
            changed: None,
            facts,
            settling,
            preload: None,
            solver,
            tape: Tape::default(),
            ports: super::ports::Ports::of(&scene.scene),
            metronome: Default::default(),
            history: History::default(),
            restored: 0,
            surfaces: Default::default(),
            grabs: Default::default(),
            next_grab: 0,
            lineage: Default::default(),
            seconds_a_step: None,
            elapsed: Duration::ZERO,
            running: None,
            frames: Default::default(),
            began: (0, 0.0),
            failure: None,
        })
    }
}

/// What of a scene's step keeps its solver on the CPU, and what instead does not.
fn of_the_cpu(scene: &Scene, schedule: &[Scheduled<'_>]) -> Option<[String; 2]> {
    let (who, instead) = match (scene.is_implicit(), scene.is_static_by_newton()) {
        (true, _) => ("implicit steps", "`solver: Explicit`"),
        (_, true) => ("Newton's iterations", "`method: Relaxation`"),
        _ if scene.rests_on_springs() => ("rest with springs of contact", "the kinematic law"),
        _ => return None,
    };
    let told = |what: &str, why: &str| [format!("`{what}` {why}"), instead.to_string()];
    let lists = [
        ("contacts", scene.contacts.is_empty()),
        ("attachments", scene.attachments.is_empty()),
        ("suction", scene.suction.is_empty()),
    ];
    if let Some((list, _)) = lists.into_iter().find(|(_, is_empty)| !is_empty) {
        return Some(told(list, &format!("take part in {who} on the CPU only")));
    }
    if scene.follows_path() {
        return Some(told("arc", "is followed on the CPU only"));
    }
    let on_host = schedule.iter().find(|entry| !entry.on_device && !entry.system.observes)?;
    Some(told(&on_host.system.name, &format!("runs on the host, where {who} on a GPU do not call it")))
}

/// The GPU to run on, if any.
fn chosen(scene: &Scene, schedule: &[Scheduled<'_>], options: &Options) -> Result<Chosen, Error> {
    let solves = scene.is_implicit() || scene.is_static_by_newton();
    if solves && options.backend == BackendChoice::Auto {
        return Ok(Chosen { gpu: None, why: "what solves for its steps takes a GPU where one is asked for".into() });
    }
    choose(options, of_the_cpu(scene, schedule))
}

/// Takes a GPU for the run, which says in the plan how it takes bodies through it, and makes the kernels of all its
/// passes ready, in the order in which a step dispatches them.
fn kernels_on(
    gpu: Gpu,
    schedule: &[Scheduled<'_>],
    plan: &mut Plan,
    world: &mut World,
) -> Result<Vec<Vec<KernelId>>, Error> {
    world.insert_resource(Device::new(gpu));
    let clock = world.resource::<Clock>();
    if clock.relaxation.is_none() && !clock.velocities_at_ends {
        crate::systems::add_guard_columns(world);
        let kernels_of_guards = Device::prepare(world, crate::systems::guard_kernels)?;
        world.insert_resource(GuardKernels(kernels_of_guards));
    }
    let systems: Vec<&System> = schedule.iter().map(|scheduled| scheduled.system).collect();
    let (mut dispatches, mut decided) = (Vec::new(), Vec::new());
    let all = Device::prepare(world, |world, buffers| {
        let (kernels, dispatched) = step_kernels(plan, &systems, world, buffers);
        decided = dispatched;
        let mut first = 0;
        for (kernels, pass) in kernels.iter().zip(plan.passes(true)) {
            let places: Vec<usize> = (first..first + kernels.len()).collect();
            dispatches.push(pass.spread(kernels, &places));
            first += kernels.len();
        }
        kernels.into_iter().flatten().collect()
    })?;
    plan.dispatched = Some(decided);
    let ids = |places: Vec<usize>| places.into_iter().map(|place| all[place]).collect();
    Ok(dispatches.into_iter().map(ids).collect())
}

/// The running schedule: an entry a pass. `kernels`: those of each pass on a GPU, where it runs there.
fn entries(
    schedule: &[Scheduled<'_>],
    mut hosts: Vec<Option<HostSystem>>,
    plan: &Plan,
    kernels: Option<Vec<Vec<KernelId>>>,
    world: &mut World,
) -> Vec<ScheduledPass> {
    let on_gpu = kernels.is_some();
    let mut kernels = kernels.into_iter().flatten();
    let mut entries = Vec::new();
    for pass in plan.passes(on_gpu) {
        let first = pass.systems[0];
        let kernels = kernels.next().filter(|_| plan.systems[first].on_device);
        let of_nodes = |places: &[usize], world: &mut World| {
            let systems = places.iter().map(|&place| schedule[place].system);
            NodePass::new(systems.filter_map(|system| Some((system.name.as_str(), system.host.nodes()?))), world)
        };
        let host = hosts[first].take();
        let job = match (kernels, pass.over, host) {
            (Some(kernels), ..) => Job::Kernels(kernels),
            (None, Over::Elements, _) => {
                let (pass_of_nodes, ahead) = (of_nodes(&pass.systems, world), of_nodes(&pass.ahead, world));
                host_job(patch_pass(pass_of_nodes, ahead, world), schedule, plan, pass)
            }
            (None, Over::Shared, _) => {
                let shared = of_nodes(&pass.systems, world);
                host_job(shared_pass(shared, world), schedule, plan, pass)
            }
            // what a GPU has no kernels for may be one of nodes on the host
            (None, _, Some(host)) if schedule[first].system.host.nodes().is_none() => {
                host_job(host, schedule, plan, pass)
            }
            (None, ..) => {
                let nodes = of_nodes(&pass.systems, world);
                host_job(node_pass(nodes, world), schedule, plan, pass)
            }
        };
        let names: Vec<&str> = plan.systems_of(pass).map(|system| system.name.as_str()).collect();
        let phase = plan.systems_of(pass).map(|system| system.phase).max().unwrap_or(plan.systems[first].phase);
        let name = names.join(" + ");
        let before_steps = match &job {
            Job::Kernels(_) => pass.systems.iter().find_map(|&place| schedule[place].system.before_steps),
            Job::Host { .. } => None,
        };
        let systems = pass.systems.clone();
        let reads = each_once(plan.systems_of(pass).flat_map(|system| &system.reads).copied());
        let finds_forces = plan.systems_of(pass).any(|system| system.finds_forces);
        entries.push(ScheduledPass {
            name,
            phase,
            finds_forces,
            systems,
            job,
            reads,
            sleepers: pass.sleepers,
            before_steps,
            time: Duration::ZERO,
            runs: 0,
        });
    }
    entries
}

fn host_job(system: HostSystem, schedule: &[Scheduled<'_>], plan: &Plan, pass: &Pass) -> Job {
    let first = &schedule[pass.systems[0]];
    Job::Host {
        system,
        interval: RunInterval::new(first.every, first.interval),
        observes: first.system.observes,
        writes: each_once(plan.systems_of(pass).flat_map(|system| &system.writes).copied()),
    }
}

/// Columns that custom systems write although the scene does not call for them.
fn add_called_for_columns(
    schedule: &[Scheduled<'_>],
    access: &[SystemAccess],
    assembly: &Assembly<'_>,
    world: &mut World,
) {
    let Some(external) = world.component_id::<ExternalForce>() else { return };
    let custom = schedule.iter().zip(access).filter(|(entry, _)| entry.system.custom);
    if custom.into_iter().any(|(_, access)| Touched(access).writes(external)) {
        let bodies: Vec<Entity> = assembly.bodies.values().map(|body| body.entity).collect();
        add_loads(&bodies, assembly.precision, world);
    }
}

/// What snapshots must know of the simulation.
fn keeping(
    scene: &SceneFile,
    precision: Precision,
    schedule: &[Scheduled<'_>],
    plan: &Plan,
    world: &mut World,
) -> Keeping {
    let custom = || schedule.iter().zip(&plan.systems).filter(|(entry, _)| entry.system.custom);
    let mut identity = identity(&scene.scene, world);
    // a schedule that is written out names them
    let acting = custom().filter(|(_, planned)| !planned.writes.is_empty()).map(|(entry, _)| &*entry.system.name);
    let acting: Vec<&str> = acting.filter(|_| scene.scene.schedule.is_none()).collect();
    if !acting.is_empty() {
        identity.insert("systems of the program".into(), acting.join(", "));
    }
    Keeping {
        identity,
        precision,
        written: each_once(custom().flat_map(|(_, planned)| &planned.writes).copied()),
        systems: schedule.iter().filter_map(|entry| Some((entry.system.name.clone(), entry.system.state?))).collect(),
    }
}

/// Whether a phase comes after the clock has been moved on.
pub(super) fn after_the_step(phase: Phase) -> bool {
    phase > Phase::Integrate
}
