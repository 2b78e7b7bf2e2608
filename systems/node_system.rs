//! What a node system is: what a system does to nodes, row by row, in passes that it shares with its neighbours in the
//! step.

use super::registry::HostSystem;
use crate::backend::cpu::{Cpu, NodeColumns};
use crate::components::*;
use crate::math::SimdScalar;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::IntoSystem;
use bevy_ecs::world::FilteredEntityRef;
use bumpalo::Bump;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use std::collections::BTreeMap;
use std::mem::needs_drop;

/// What a system does to the nodes of a body, row by row. Its component calls for it: each entity that has one and
/// [`OfBody`] acts on that body, and a body that has one itself is acted on.
///
/// Neighbours of a step share a pass: a task takes some rows through all of them, one after the other. So a system sees
/// no rows but its own there; what it needs of others it finds out beforehand, in [`prepare`](Self::prepare).
pub trait NodeSystem: Component {
    /// The node columns that it reads (`&Mass`) and writes (`&mut ExternalForce`), as a bevy query names them.
    type Columns: QueryData + 'static;
    /// What a step needs beside the component.
    type Prepared: Send + Sync;
    /// Whether it sums the forces of elements and clears the loads of the last step: for nodes inside a patch, that has
    /// done so.
    const SUMS_FORCES: bool = false;
    /// Whether it uses these sums up, by moving the nodes.
    const MOVES_NODES: bool = false;

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

    /// Does it to some rows of the body, which no other task has.
    fn act<T: SimdScalar>(&self, prepared: &Self::Prepared, cpu: &Cpu, nodes: &mut NodeColumns<'_, T>);
}

/// A body before a pass begins, and the step that it is in.
#[derive(Clone, Copy, Debug)]
pub struct Before<'a> {
    /// The clock, at the beginning of the step.
    pub clock: &'a Clock,
    /// Values of loads and motions in this step.
    pub signals: &'a Signals,
    /// Where nodes are at rest (m).
    pub rest: &'a RestPosition,
    /// Displacements at the beginning of the step (m).
    pub displacement: &'a Displacement,
}

/// The nodes of a body, for what forces on them do to the stable step.
#[derive(Clone, Copy, Debug)]
pub struct NodesAtRest<'a> {
    /// Where they are at rest (m).
    pub rest: &'a RestPosition,
    /// Their masses (kg); 0: inactive.
    pub mass: &'a Mass,
    /// Which axes are held, as bits.
    pub axes: Option<&'a ConstrainedAxes>,
    /// Inputs that programs set, where the scene has any.
    pub signals: Option<&'a Signals>,
    /// What the scene lasts (s).
    pub duration: f64,
}

impl NodesAtRest<'_> {
    /// Whether the node of a row can be pushed anywhere.
    pub fn moves(&self, row: usize) -> bool {
        self.mass.get(row) > 0.0 && self.axes.is_none_or(|axes| axes[row] & 7 != 7)
    }
}

/// Norms of −∂f/∂u and −∂f/∂v of forces on nodes, over the nodes' masses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ForceSlopes {
    /// κ (1/s²).
    pub stiffness: f64,
    /// γ (1/s).
    pub damping: f64,
}

impl ForceSlopes {
    /// Of forces that are the same wherever nodes are and however they move.
    pub const NONE: Self = Self { stiffness: 0.0, damping: 0.0 };

    /// The larger of both, each by itself.
    pub fn larger(self, other: Self) -> Self {
        Self { stiffness: self.stiffness.max(other.stiffness), damping: self.damping.max(other.damping) }
    }

    /// Those of forces that act together.
    pub fn and(self, other: Self) -> Self {
        Self { stiffness: self.stiffness + other.stiffness, damping: self.damping + other.damping }
    }
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
}

impl<S: NodeSystem> OnRows for Bound<'_, S> {
    fn single(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f32>) {
        self.system.act(&self.prepared, cpu, nodes);
    }
    fn double(&self, cpu: &Cpu, nodes: &mut NodeColumns<'_, f64>) {
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
    slopes: fn(Option<OfSystem>, f64, &mut World) -> ForceSlopes,
    /// Only what is for this one of several systems calls for it.
    of: Option<OfSystem>,
    /// See [`NodeSystem::SUMS_FORCES`].
    pub sums_forces: bool,
    /// See [`NodeSystem::MOVES_NODES`].
    pub moves_nodes: bool,
}

impl NodeRows {
    /// That of a system.
    pub fn of<S: NodeSystem>() -> Self {
        Self {
            callers: |query| {
                query.data::<(Option<&S>, Option<&OfBody>, Option<&OfSystem>)>();
            },
            with_callers: |query| {
                query.with::<S>();
            },
            bind: bind::<S>,
            touches: || {
                let nothing = |_: Query<S::Columns>, _: CallersOf<S>, _: Res<Clock>, _: Res<Signals>| Ok(());
                Box::new(IntoSystem::into_system(nothing))
            },
            slopes: slopes::<S>,
            of: None,
            sums_forces: S::SUMS_FORCES,
            moves_nodes: S::MOVES_NODES,
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

    /// How fast the forces that it adds grow, in a scene that lasts so long (s): see [`NodeSystem::slopes`].
    pub(crate) fn slopes(&self, duration: f64, world: &mut World) -> ForceSlopes {
        (self.slopes)(self.of, duration, world)
    }

    /// A system that does nothing and touches what this one does: for the order in which systems may run.
    pub(crate) fn touches(&self) -> HostSystem {
        (self.touches)()
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
            let bound = Bound { system, prepared: system.prepare(before) };
            all.push(match needs_drop::<S::Prepared>() {
                true => BoundSystem::Own(Box::new(bound)),
                false => BoundSystem::Lent(arena.alloc(bound)),
            });
        }
    }
}

/// Of all that calls for a system: together on one body, the largest of all bodies.
fn slopes<S: NodeSystem>(of_system: Option<OfSystem>, duration: f64, world: &mut World) -> ForceSlopes {
    let mut bodies: BTreeMap<Entity, ForceSlopes> = BTreeMap::new();
    let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>)>();
    for (entity, system, of, _) in callers.iter(world).filter(|caller| caller.3.copied() == of_system) {
        let body = of.map_or(entity, |of| of.0);
        if let (Some(rest), Some(mass)) = (world.get::<RestPosition>(body), world.get::<Mass>(body)) {
            let (axes, signals) = (world.get::<ConstrainedAxes>(body), world.get_resource::<Signals>());
            let nodes = NodesAtRest { rest, mass, axes, signals, duration };
            let sum = bodies.entry(body).or_default();
            // a negative norm would take from the others; what is no number is the guards' business
            *sum = sum.and(system.slopes(&nodes).larger(ForceSlopes::default()));
        }
    }
    bodies.into_values().fold(ForceSlopes::default(), ForceSlopes::larger)
}
