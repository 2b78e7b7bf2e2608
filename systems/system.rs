//! What a system is.

use super::host_forces::HostSlopes;
use super::node_stages::Twin;
use super::node_system::{NodeRows, NodeSystem};
use super::repeat::Repeat;
use super::runs_on::{DescribeKernels, HostSystem, OnDevice, OnHost};
use super::stage::Stage;
use crate::backend::Buffers;
use crate::backend::kernel::Fragment;
use crate::backend::kernel::Kernel;
use crate::backend::node_stage::NodeStage;
use crate::components::{Body, HeldEnergy, LoadedRows, OfBody};
use crate::error::{Error, missing};
use crate::snapshot::StateAccess;
use bevy_ecs::prelude::*;
use bevy_ecs::system::IntoSystem;
use std::sync::Arc;

/// Where in the step a system has its place. A schedule may leave phases out but not turn them round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// Says where constrained nodes go in this step.
    Boundary,
    /// Takes means around nodes that element forces need.
    NodalMeans,
    /// Fills in the forces of elements.
    ElementForces,
    /// Sums them at the nodes, and clears the loads of the last step.
    Gather,
    /// Adds to the external forces.
    Loads,
    /// Adds forces that depend on where the others would move nodes.
    Contact,
    /// Moves the nodes; after it the clock shows the end of the step.
    Integrate,
    /// Takes elements away.
    Removal,
    /// Reads.
    Observe,
}

/// Does what must be done before steps are submitted; gives how many there may be at most, one or more.
pub(crate) type BeforeSteps = fn(&mut World) -> Result<u64, Error>;

/// One system of the step.
pub struct System {
    /// Its name in scenes, reports and (with `.rs` and `.wgsl`) its files.
    pub name: String,
    /// Its place in the step.
    pub phase: Phase,
    /// What it does, in a few words.
    pub does: String,
    /// What in a scene calls for it.
    pub called_for_by: &'static str,
    /// Why it takes part where a scene writes no `schedule`; `None` when it does not. A schedule that is written out
    /// must hold all built-in systems that would.
    pub because: Because,
    /// What runs on the host.
    pub host: OnHost,
    /// Describes the kernels that do the same on a GPU.
    pub device: OnDevice,
    /// Whether it fetches what it reads from the device by itself, and says when it next has to run.
    pub(crate) observes: bool,
    /// Steps between two runs (host systems only), at least 1.
    pub every: u64,
    /// Whether, in a world, a GPU has it.
    pub(crate) device_when: fn(&World) -> bool,
    /// What must be done on the host before steps are submitted to a GPU, and how many there may be at most.
    pub(crate) before_steps: Option<BeforeSteps>,
    /// Whether, in a world, it concerns only nodes of surfaces ([`SurfaceRows`](crate::components::SurfaceRows)).
    pub(crate) shared_only: fn(&World) -> bool,
    /// Whether it says before any force is known, by where nodes are, if it does something in a step
    /// ([`SurfaceSleep`](crate::components::SurfaceSleep)).
    pub(crate) may_sleep: bool,
    /// What of it a step repeats, in a world: on a GPU the kernels that say so.
    pub(crate) repeats: fn(&World) -> Option<Repeat>,
    /// Whether it is not one of the engine's own.
    pub(crate) custom: bool,
    /// Reads its parameters and inserts them as a resource.
    pub(crate) parameters: Option<ReadParameters>,
    /// Whether what it was given fits its twin on a GPU; what does not, as an error.
    pub(crate) check: Option<CheckParameters>,
    /// How fast the forces of a system on the host grow, and what energy it holds, where it says so.
    pub(crate) slopes: Option<HostSlopes>,
    pub(crate) energy: Option<HeldEnergy>,
    /// How its state gets into snapshots and back.
    pub(crate) state: Option<StateAccess>,
    /// What has a load of a scene call for it, where it is for one.
    pub(crate) load: Option<PutLoad>,
}

/// What puts on an entity, with what a load acts on and its signal, what calls for the system.
pub(crate) type PutLoad = Arc<dyn Fn(&LoadedRows, usize, &mut EntityWorldMut<'_>) + Send + Sync>;

/// Why a world needs a system; `None` when it does not.
pub type Because = Arc<dyn Fn(&mut World) -> Option<String> + Send + Sync>;

/// Turns what a scene gives as a system's parameters into a resource; else says why it cannot.
type ReadParameters = fn(ron::Value, &mut World) -> Result<(), String>;

/// Says why what calls for a system in a world does not fit its twin on a GPU, where it does not.
type CheckParameters = Arc<dyn Fn(&mut World) -> Result<(), String> + Send + Sync>;

/// What in a scene calls for a system that takes parameters.
const GIVEN: &str = "its `parameters`";

/// What a system of one's own may return.
pub trait Outcome: 'static {
    /// How it ended.
    ///
    /// # Errors
    /// What ends the run.
    fn outcome(self) -> Result<(), Error>;
}

impl Outcome for () {
    fn outcome(self) -> Result<(), Error> {
        Ok(())
    }
}

impl Outcome for Result<(), Error> {
    fn outcome(self) -> Result<(), Error> {
        self
    }
}

impl System {
    /// A system of one's own, run on the host on both backends, once a step. `system` is any bevy system function: its
    /// queries say which columns it reads (they are brought to the host before it runs) and which it writes (they go
    /// back to the device after). It takes part in all scenes, at its phase, or as it says by [`when`](Self::when).
    ///
    /// It returns nothing or a `Result<(), Error>`, whose error ends the run. `system` is called through a function
    /// without captures, so that each simulation gets its own copy.
    pub fn custom<M, O: Outcome>(
        name: impl Into<String>,
        phase: Phase,
        does: impl Into<String>,
        system: impl IntoSystem<(), O, M> + Clone + Send + Sync + 'static,
    ) -> Self {
        let host = move || -> HostSystem { Box::new(IntoSystem::into_system(system.clone().map(O::outcome))) };
        Self::new(name, phase, does, OnHost::System(Box::new(host)))
    }

    fn new(name: impl Into<String>, phase: Phase, does: impl Into<String>, host: OnHost) -> Self {
        Self {
            name: name.into(),
            phase,
            does: does.into(),
            called_for_by: "the program",
            because: Arc::new(|_| Some("the program has added it".into())),
            host,
            device: OnDevice::None,
            observes: false,
            every: 1,
            device_when: |_| true,
            before_steps: None,
            shared_only: |_| false,
            may_sleep: false,
            repeats: |_| None,
            custom: true,
            parameters: None,
            check: None,
            slopes: None,
            energy: None,
            state: None,
            load: None,
        }
    }

    /// A custom system that takes parameters from the scene: what stands under its name in `parameters` is read as a
    /// `P`, which the system finds as `Res<P>`. What does not fit is an error when the scene is loaded.
    ///
    /// Numbers, texts, truth values, lists and structs can be read; a field that may be left out needs
    /// `#[serde(default)]`. The name `every` is taken: it is the time between two runs (s). Where a scene writes no
    /// `schedule`, the system takes part if the scene gives its parameters.
    pub fn with_parameters<P: Resource + serde::de::DeserializeOwned>(mut self) -> Self {
        self.parameters = Some(|value, world| {
            let parameters: P = value.into_rust().map_err(|error| error.to_string())?;
            world.insert_resource(parameters);
            Ok(())
        });
        self.when(GIVEN, |world| world.contains_resource::<P>().then(|| "the scene gives its `parameters`".into()))
    }

    /// Says when it takes part where a scene writes no `schedule`: when `because` gives a reason, which `explain`
    /// shows, when the simulation is made; `called_for_by` is what in a scene brings that about. Several have to agree,
    /// those of [parameters](Self::with_parameters) among them.
    pub fn when(
        mut self,
        called_for_by: &'static str,
        because: impl Fn(&mut World) -> Option<String> + Send + Sync + 'static,
    ) -> Self {
        let before = self.because;
        self.because = Arc::new(move |world| before(world).and_then(|_| because(world)));
        self.called_for_by = called_for_by;
        self
    }

    /// A custom system whose resource `S` belongs to the state of a simulation: snapshots hold it, and what goes on
    /// from one has it back. `S` is anything that RON can hold, infinite numbers too; it is put into the world by the
    /// system's parameters or by [`Simulation::world_mut`](crate::Simulation::world_mut). A system's `Local`s are not
    /// kept.
    pub fn with_state<S: Resource + serde::Serialize + serde::de::DeserializeOwned>(mut self) -> Self {
        self.state = Some(StateAccess {
            keep: |world| {
                let state = world.get_resource::<S>().ok_or("it is not in the world")?;
                ron::to_string(state).map_err(|error| error.to_string())
            },
            take_back: |kept, world| {
                let state: S = ron::from_str(kept).map_err(|error| error.to_string())?;
                world.insert_resource(state);
                Ok(())
            },
        });
        self
    }

    /// Runs a custom system in every `steps`-th step only: on the GPU the columns travel that much less often. `every`
    /// in the scene's parameters goes before it. Loads last for one step: a system that adds forces in every tenth step
    /// pushes in every tenth step.
    pub fn every(mut self, steps: u64) -> Self {
        self.every = steps.max(1);
        self
    }

    /// A system of one's own that works node by node, each entity with an `S` on its body: see [`NodeSystem`]. It
    /// shares passes with its neighbours in the step. It takes part in all scenes, at its phase, or as it says by
    /// [`when`](Self::when).
    pub fn of_nodes<S: NodeSystem>(name: impl Into<String>, phase: Phase, does: impl Into<String>) -> Self {
        Self::new(name, phase, does, OnHost::Nodes(NodeRows::of::<S>()))
    }

    /// With its twin on a GPU, a WGSL text that holds `fn NAME(node: u32)` of the system's name, and `path` under which
    /// errors name it. Without it the system runs on the host.
    ///
    /// The text sees its own node's rows only. It finds each of its [columns](NodeSystem::Columns) under its name, as
    /// `array<f32>` (or `array<u32>`), three numbers a vector, and `rest_position` likewise; what the scene gave in a
    /// uniform `parameters`; `step.time` and `step.time_step` (s). In place of columns of forces there are functions:
    /// `internal_force_of(node)`, `external_force_of(node)` and `add_load(node, force)`. Where it keeps
    /// [numbers](NodeSystem::OWN_NUMBERS), there are `own(node, i)` and `set_own(node, i, value)`; where it
    /// [chooses](NodeSystem::choose) nodes, it is called for these. One that goes through a [list](NodeSystem::rows) of
    /// its own, which must ascend then, is called for that, as `fn NAME(i: u32, node: u32)` with the place in it; what
    /// else it reads, its [stages](NodeSystem::stages) say.
    pub fn with_shader<S: NodeSystem + serde::Serialize>(self, path: &'static str, text: &'static str) -> Self {
        let name = self.name.clone();
        self.with_twin::<S>(name, Fragment::new(path, text), |system, stage| stage.uniform("parameters", system))
    }

    /// The same for components that are no structs of numbers: what there is of such, `component` adds, and kernels
    /// call the function `call`.
    pub(crate) fn with_twin<S: NodeSystem>(
        mut self,
        call: impl Into<String>,
        shader: Fragment,
        component: fn(&S, Stage) -> Stage,
    ) -> Self {
        let of = self.host.nodes().and_then(|rows| rows.of);
        let twin = Arc::new(Twin { name: self.name.clone(), call: call.into(), shader, of, component });
        let checked = twin.clone();
        self.check = Some(Arc::new(move |world| checked.check(world)));
        self.device = OnDevice::Stages(Arc::new(move |world, buffers| twin.stages(world, buffers)));
        self
    }

    /// A system of nodes that takes parameters from the scene: what stands under its name in `parameters` is read as an
    /// `S` for each body. What does not fit is an error when the scene is loaded. Where a scene writes no `schedule`,
    /// the system takes part if the scene gives its parameters.
    pub fn on_each_body<S: NodeSystem + Clone + serde::de::DeserializeOwned>(mut self) -> Self {
        self.parameters = Some(|value, world| {
            let system: S = value.into_rust().map_err(|error| error.to_string())?;
            let bodies: Vec<Entity> = world.query_filtered::<Entity, With<Body>>().iter(world).collect();
            world.spawn_batch(bodies.into_iter().map(|body| (system.clone(), OfBody(body))).collect::<Vec<_>>());
            Ok(())
        });
        self.when(GIVEN, |world| {
            super::registry::count::<S>(world, "body with its `parameters`", "bodies with its `parameters`")
        })
    }

    /// A built-in system of nodes.
    pub(crate) fn built_in_nodes<S: NodeSystem>(
        name: &str,
        phase: Phase,
        does: &str,
        called_for_by: &'static str,
        because: fn(&mut World) -> Option<String>,
    ) -> Self {
        Self { called_for_by, because: Arc::new(because), custom: false, ..Self::of_nodes::<S>(name, phase, does) }
    }

    /// A system of nodes that a scene has of its own, and what it is.
    pub(crate) fn of_scene(
        name: &str,
        phase: Phase,
        rows: NodeRows,
        does: &str,
        called_for_by: &'static str,
        what: String,
    ) -> Self {
        let because: Because = Arc::new(move |_| Some(what.clone()));
        Self { called_for_by, because, custom: false, ..Self::new(name, phase, does, OnHost::Nodes(rows)) }
    }

    /// A built-in system.
    pub(crate) fn built_in<M, O: Outcome>(
        name: &str,
        phase: Phase,
        does: &str,
        called_for_by: &'static str,
        because: fn(&mut World) -> Option<String>,
        system: impl IntoSystem<(), O, M> + Clone + Send + Sync + 'static,
    ) -> Self {
        Self { called_for_by, because: Arc::new(because), custom: false, ..Self::custom(name, phase, does, system) }
    }

    /// Its kernels by itself, as often as a step runs them.
    #[doc(hidden)]
    pub fn kernels(&self, world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
        let kernels = self.device.kernels(world, buffers);
        match (self.repeats)(world) {
            Some(repeat) => repeat.spread(&kernels, &kernels),
            None => kernels,
        }
    }

    /// That finds the forces of elements, patch by patch.
    pub(crate) fn of_elements(self) -> Self {
        let host = match self.host {
            OnHost::System(make) => OnHost::Elements(make),
            host => host,
        };
        Self { host, ..self }
    }

    /// With its kernels.
    pub(crate) fn on_device(mut self, kernels: DescribeKernels) -> Self {
        self.device = OnDevice::Kernels(kernels);
        self
    }

    /// It is for a load of scenes (`src/scene/schema/load.rs`), which becomes what calls for it; `None` where that acts
    /// on something else.
    pub(crate) fn for_load<S: NodeSystem + Bundle>(mut self, load: fn(&LoadedRows, usize) -> Option<S>) -> Self {
        let put_on: PutLoad = Arc::new(move |on, signal, entity| match load(on, signal) {
            Some(load) => drop(entity.insert(load)),
            None => debug_assert!(false, "{}", missing("what a load acts on")),
        });
        self.load = Some(put_on);
        self
    }

    /// The same where a column stands in the place of another (`InertialMass` in that of `Mass`), which no author of a
    /// text could know, or where one system is two kernels on devices that bind few buffers: `integrate`, and what
    /// foresees where it moves nodes.
    pub(crate) fn on_nodes(
        mut self,
        stages: impl Fn(&mut World, &mut dyn Buffers) -> Vec<NodeStage> + Send + Sync + 'static,
    ) -> Self {
        self.device = OnDevice::Stages(Arc::new(stages));
        self
    }
}
