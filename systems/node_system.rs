//! What a node system is: what a system does to nodes, row by row, in passes that it shares with its neighbours in the
//! step.

use super::node_shares::{ShareOf, WantedShares, share_of, wanted_shares};
use super::node_slopes::NodeSlopes;
use super::node_views::{Before, ForceSlopes, MiddleOfStep, NodesAtRest};
use super::rows::{RowSet, Rows, row_set};
use super::runs_on::HostSystem;
use super::stage::Stage;
use crate::backend::cpu::{Cpu, Declared, NodeColumns, NodeShare};
use crate::components::*;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::IntoSystem;
use bevy_ecs::world::FilteredEntityRef;
use bumpalo::Bump;
use smallvec::SmallVec;
use std::mem::needs_drop;

/// What a system does to the nodes of a body, row by row. Its component calls for it: each entity that has one and
/// [`OfBody`] acts on that body, and a body that has one itself is acted on.
///
/// Neighbours of a step share a pass: a task takes some rows through all of them, one after the other. So a system sees
/// no rows but its own there; what it needs of others it finds out beforehand, in [`prepare`](Self::prepare).
pub trait NodeSystem: Component {
    /// The node columns that it reads (`&Mass`) and writes (`&mut ExternalForce`), as a bevy query names them. Whether
    /// it shares a pass with its neighbours follows from these; asking [`NodeColumns`] for any other is an error.
    type Columns: QueryData + 'static;
    /// What a step needs beside the component.
    type Prepared: Send + Sync;
    /// Whether it sums the forces of elements and clears the loads of the last step: for nodes inside a patch, that has
    /// done so.
    const SUMS_FORCES: bool = false;
    /// Whether it uses these sums up, by moving the nodes.
    const MOVES_NODES: bool = false;
    /// Numbers that it keeps of each node for itself: 0 at the start, there from step to step, in snapshots and on a
    /// GPU. See [`NodeColumns::own`]; in WGSL `own(node, i)` and `set_own(node, i, value)`.
    const OWN_NUMBERS: usize = 0;
    /// Columns, by name ([`Column::NAME`]), of which its WGSL looks at rows of other nodes than the one that it is
    /// called for. It shares no kernel with what writes them: other invocations would do so meanwhile.
    const READS_ELSEWHERE: &'static [&'static str] = &[];

    /// Rows of the body's nodes that it is for, in any order, when the simulation is made; `None`: all of them, for
    /// good. A program may have it act on others while it runs
    /// ([`choose_nodes`](crate::Simulation::choose_nodes)). [`NodeColumns::chosen`] goes through them; in WGSL the
    /// system's function is called for no others.
    fn choose(&self, _: &NodesAtRest<'_>) -> Option<Vec<u32>> {
        None
    }

    /// For which rows of the body's nodes it is, where it does not [choose](Self::choose) them: what the plan of a step
    /// says of it (`sinew explain`). A system that goes through a list of its own in [`act`](Self::act) gives the list.
    fn rows(&self) -> Rows<'_> {
        Rows::All
    }

    /// What its WGSL is called for on a GPU and reads beside columns and parameters, when the simulation is made: one
    /// [`Stage`] after the other. Left out: one, for the nodes that [`rows`](Self::rows) says.
    fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
        vec![Stage::of(self.rows())]
    }

    /// Finds out what this step needs, before any node of the body moves.
    fn prepare(&self, before: &Before<'_>) -> Self::Prepared;

    /// How fast the forces that it adds grow with displacements and velocities, for the stable step: the largest of all
    /// nodes, 0 or above. A stiff force of which the step does not know makes a run unstable, so there is no default:
    /// what adds no forces, or such as depend on neither, says [`ForceSlopes::NONE`].
    ///
    /// ```compile_fail,E0046
    /// use sinew::prelude::*;
    /// use sinew::systems::{Before, Cpu, NodeColumns, NodeSystem, SimdScalar};
    ///
    /// #[derive(Component)]
    /// struct Silent;
    ///
    /// impl NodeSystem for Silent {
    ///     type Columns = &'static mut ExternalForce;
    ///     type Prepared = ();
    ///     fn prepare(&self, _: &Before<'_>) {}
    ///     fn act<T: SimdScalar>(&self, _: &(), _: &Cpu, _: &mut NodeColumns<'_, T>) {}
    ///     // error: missing `slopes`
    /// }
    /// ```
    fn slopes(&self, nodes: &NodesAtRest<'_>) -> ForceSlopes;

    /// The same node by node: `each` takes a row and the slopes of a force there, once for every force. Forces at the
    /// same node make the step smaller together, those at others do not. Left out: `slopes` at all nodes that it is
    /// for, as [`rows`](Self::rows) says; a system whose nodes change, or that [chooses](Self::choose) them, at all.
    fn slopes_by_row(&self, nodes: &NodesAtRest<'_>, each: &mut dyn FnMut(usize, ForceSlopes)) {
        let slopes = self.slopes(nodes);
        match self.rows() {
            Rows::List(rows) => rows.iter().for_each(|&row| each(row as usize, slopes)),
            Rows::All | Rows::Changing => (0..nodes.mass.len()).for_each(|row| each(row, slopes)),
        }
    }

    /// The energy (J) that it holds and gives back, as a spring does, of the nodes' places in the middle of a step. It
    /// is told with the others ([`Energies::held`]); the work of all loads is counted in any case.
    fn energy(&self, _: &MiddleOfStep<'_>) -> Option<f64> {
        None
    }

    /// Does it to some rows of the body, which no other task has.
    fn act<T: SimdScalar>(&self, prepared: &Self::Prepared, cpu: &Cpu, nodes: &mut NodeColumns<'_, T>);
}

/// A node system bound to a step.
pub(super) trait OnRows: Sync {
    fn single(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f32>);
    fn double(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f64>);
    fn sums_forces(&self) -> bool;
}

struct Bound<'a, S: NodeSystem> {
    system: &'a S,
    prepared: S::Prepared,
    share: NodeShare,
    declared: Declared,
}

impl<S: NodeSystem> OnRows for Bound<'_, S> {
    fn single(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f32>) {
        nodes.turn_to(self.share, self.declared);
        self.system.act(&self.prepared, cpu, nodes);
    }
    fn double(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f64>) {
        nodes.turn_to(self.share, self.declared);
        self.system.act(&self.prepared, cpu, nodes);
    }
    fn sums_forces(&self) -> bool {
        S::SUMS_FORCES
    }
}

/// A number type of a run.
pub(super) trait OfRun: SimdScalar {
    /// Does what a bound system does to some rows.
    fn act(system: &dyn OnRows, cpu: &Cpu, nodes: &mut NodeColumns<'_, Self>);
}

impl OfRun for f32 {
    fn act(system: &dyn OnRows, cpu: &Cpu, nodes: &mut NodeColumns<'_, f32>) {
        system.single(cpu, nodes);
    }
}

impl OfRun for f64 {
    fn act(system: &dyn OnRows, cpu: &Cpu, nodes: &mut NodeColumns<'_, f64>) {
        system.double(cpu, nodes);
    }
}

/// What calls for one system, and the body that it acts on; where several systems do the same, for which of them.
type CallersOf<'w, 's, S> = Query<'w, 's, (Entity, &'static S, Option<&'static OfBody>, Option<&'static OfSystem>)>;

/// What calls for any system of a pass: one query for all, which several bodies can look through at a time.
pub(super) type Callers<'w, 's> = Query<'w, 's, FilteredEntityRef<'static, 'static>>;

/// A system bound to a body.
pub(super) enum BoundSystem<'a> {
    /// In memory that is there from step to step.
    Lent(&'a (dyn OnRows + 'a)),
    /// What it prepared has something of its own to give back.
    Own(Box<dyn OnRows + 'a>),
}

impl BoundSystem<'_> {
    pub(super) fn on_rows(&self) -> &dyn OnRows {
        match self {
            Self::Lent(system) => *system,
            Self::Own(system) => system.as_ref(),
        }
    }
}

/// Systems bound to a body, in their order. More are rare, and ask for memory.
pub(super) type BoundSystems<'a> = SmallVec<[BoundSystem<'a>; 32]>;

/// Finds what calls for a system on a body and binds it to a step.
type Bind = for<'a> fn(&'a Callers<'_, '_>, Option<OfSystem>, Entity, &Before<'_>, &'a Bump, &mut BoundSystems<'a>);

/// A node system without its type: how a pass finds what calls for it, and what it touches.
#[derive(Clone, Copy)]
pub struct NodeRows {
    callers: fn(&mut QueryBuilder<FilteredEntityRef<'static, 'static>>),
    with_callers: fn(&mut QueryBuilder),
    bind: Bind,
    touches: fn() -> HostSystem,
    slopes: fn(Option<OfSystem>, f64, &mut World, &mut NodeSlopes) -> ForceSlopes,
    energy: fn(Option<OfSystem>, &mut World) -> Option<f64>,
    wanted_shares: fn(Option<OfSystem>, f64, &mut World) -> WantedShares,
    give_share: fn(&mut World, Entity, NodeShare),
    share_of: fn(&mut World, Entity) -> Option<NodeShare>,
    row_set: fn(Option<OfSystem>, &mut World) -> RowSet,
    /// Only what is for this one of several systems calls for it.
    pub(super) of: Option<OfSystem>,
    /// See [`NodeSystem::SUMS_FORCES`].
    pub sums_forces: bool,
    /// See [`NodeSystem::MOVES_NODES`].
    pub moves_nodes: bool,
    /// See [`NodeSystem::OWN_NUMBERS`].
    pub own_numbers: usize,
}

impl NodeRows {
    /// That of a system.
    pub fn of<S: NodeSystem>() -> Self {
        Self {
            callers: |query| {
                query.data::<(Option<&S>, Option<&OfBody>, Option<&OfSystem>, Option<&ShareOf<S>>)>();
            },
            with_callers: |query| {
                query.with::<S>();
            },
            bind: bind::<S>,
            touches: || {
                type Own<'w, 's> = Query<'w, 's, &'static mut OwnNumbers>;
                let nothing = |_: Query<S::Columns>, _: CallersOf<S>, _: Res<Clock>, _: Res<Signals>| Ok(());
                let with_own = |_: Query<S::Columns>, _: Own, _: CallersOf<S>, _: Res<Clock>, _: Res<Signals>| Ok(());
                match S::OWN_NUMBERS {
                    0 => Box::new(IntoSystem::into_system(nothing)),
                    _ => Box::new(IntoSystem::into_system(with_own)),
                }
            },
            slopes: slopes::<S>,
            energy: energy::<S>,
            wanted_shares: wanted_shares::<S>,
            give_share: |world, caller, share| {
                world.entity_mut(caller).insert(ShareOf::<S>::new(share));
            },
            share_of: share_of::<S>,
            row_set: row_set::<S>,
            of: None,
            sums_forces: S::SUMS_FORCES,
            moves_nodes: S::MOVES_NODES,
            own_numbers: S::OWN_NUMBERS,
        }
    }

    /// The same for one of several systems: only what has its number as [`OfSystem`] calls for it.
    pub(super) fn of_system(self, number: usize) -> Self {
        Self { of: Some(OfSystem(number)), ..self }
    }

    /// Has a query look at what calls for the systems of a pass.
    pub(super) fn callers_of(all: &[&Self], query: &mut QueryBuilder<FilteredEntityRef<'static, 'static>>) {
        all.iter().for_each(|system| (system.callers)(query));
        query.or(|query| all.iter().for_each(|system| (system.with_callers)(query)));
    }

    /// Binds what calls for the system on a body to a step.
    pub(super) fn bind<'a>(
        &self,
        callers: &'a Callers<'_, '_>,
        body: Entity,
        before: &Before<'_>,
        arena: &'a Bump,
        all: &mut BoundSystems<'a>,
    ) {
        (self.bind)(callers, self.of, body, before, arena, all);
    }

    /// Adds how fast the forces that it adds grow, in a scene that lasts so long (s): see [`NodeSystem::slopes`]. Gives
    /// the largest.
    pub(super) fn slopes(&self, duration: f64, world: &mut World, all: &mut NodeSlopes) -> ForceSlopes {
        (self.slopes)(self.of, duration, world, all)
    }

    /// The energy (J) that it holds, where it says so: see [`NodeSystem::energy`].
    pub(crate) fn energy(&self, world: &mut World) -> Option<f64> {
        (self.energy)(self.of, world)
    }

    /// What it would have of bodies for itself, in a scene that lasts so long (s); else a row that it is for and that
    /// is none, and how many there are.
    pub(super) fn wanted_shares(&self, duration: f64, world: &mut World) -> WantedShares {
        (self.wanted_shares)(self.of, duration, world)
    }

    /// Gives it, to what calls for the system.
    pub(super) fn give_share(&self, world: &mut World, caller: Entity, share: NodeShare) {
        (self.give_share)(world, caller, share);
    }

    /// What it has of a body for itself, if it has something.
    pub(crate) fn share_of(&self, body: Entity, world: &mut World) -> Option<NodeShare> {
        (self.share_of)(world, body)
    }

    /// For which nodes it is.
    pub(crate) fn row_set(&self, world: &mut World) -> RowSet {
        (self.row_set)(self.of, world)
    }

    /// A system that does nothing and touches what this one does: for the order in which systems may run.
    pub(crate) fn touches(&self) -> HostSystem {
        (self.touches)()
    }

    /// What it may ask of a body's columns.
    pub(super) fn declared(&self, world: &mut World) -> Declared {
        let access = self.touches().initialize(world);
        Declared::of(&access, world)
    }
}

fn bind<'a, S: NodeSystem>(
    callers: &'a Callers<'_, '_>,
    of_system: Option<OfSystem>,
    body: Entity,
    before: &Before<'_>,
    arena: &'a Bump,
    all: &mut BoundSystems<'a>,
) {
    for caller in callers.iter() {
        let Some(system) = caller.get::<S>() else { continue };
        let of = caller.get::<OfBody>().map_or(caller.id(), |of| of.0);
        if of == body && caller.get::<OfSystem>().copied() == of_system {
            let share = caller.get::<ShareOf<S>>().map(|share| share.share).unwrap_or_default();
            let prepared = system.prepare(&Before { bit: share.bit, ..*before });
            let bound = Bound { system, prepared, share, declared: before.declared };
            all.push(match needs_drop::<S::Prepared>() {
                true => BoundSystem::Own(Box::new(bound)),
                false => BoundSystem::Lent(arena.alloc(bound)),
            });
        }
    }
}

/// Of all that calls for a system.
fn slopes<S: NodeSystem>(
    of_system: Option<OfSystem>,
    duration: f64,
    world: &mut World,
    all: &mut NodeSlopes,
) -> ForceSlopes {
    let mut largest = ForceSlopes::NONE;
    let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>)>();
    for (entity, system, of, _) in callers.iter(world).filter(|caller| caller.3.copied() == of_system) {
        let body = of.map_or(entity, |of| of.0);
        if let Some(nodes) = NodesAtRest::of(world, body, duration) {
            let mut of_body = all.of_body(body);
            system.slopes_by_row(&nodes, &mut |row, slopes| {
                // a negative norm would take from the others; what is no number is the guards' business
                let slopes = slopes.larger(ForceSlopes::NONE);
                largest = largest.larger(slopes);
                // what acts on no node has no step
                if row < nodes.mass.len() {
                    of_body.add(row, slopes);
                }
            });
        }
    }
    largest
}

/// Of all that calls for a system, on all bodies together.
fn energy<S: NodeSystem>(of_system: Option<OfSystem>, world: &mut World) -> Option<f64> {
    let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>, Option<&ShareOf<S>>)>();
    let mut sum: Option<f64> = None;
    for (entity, system, of, _, share) in callers.iter(world).filter(|caller| caller.3.copied() == of_system) {
        let body = of.map_or(entity, |of| of.0);
        let share = share.map(|share| share.share).unwrap_or_default();
        let Some(middle) = MiddleOfStep::of(world, body, share) else { continue };
        if let Some(energy) = system.energy(&middle) {
            *sum.get_or_insert(0.0) += energy;
        }
    }
    sum
}
