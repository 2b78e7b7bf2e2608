//! Neighbouring systems of a step that work node by node, in one pass over the nodes: what one writes the next finds in
//! the core's cache. On a GPU the same is one kernel (src/backend/node_stage.rs).

use super::node_system::{BoundSystem, BoundSystems, Callers, NodeRows, OfRun};
use super::node_views::Before;
use super::runs_on::HostSystem;
use crate::backend::cpu::{Cpu, Declared, Met, NodeColumns, OwnRows, ROWS_A_TASK, Touches, Undeclared};
use crate::backend::step::step_number;
use crate::components::*;
use crate::error::Error;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::{ParamBuilder, QueryParamBuilder, SystemParam, SystemParamBuilder};
use bevy_ecs::world::FilteredEntityRef;
use bumpalo::Bump;
use std::sync::atomic::AtomicU32;

/// What nodes have.
#[derive(QueryData)]
#[query_data(mutable)]
pub(super) struct BodyColumns {
    pub(super) body: Entity,
    rest: &'static RestPosition,
    mass: &'static Mass,
    inertial: Option<&'static InertialMass>,
    internal: &'static mut InternalForce,
    external: Option<&'static mut ExternalForce>,
    axes: &'static ConstrainedAxes,
    damping: Option<&'static DampingCoefficient>,
    pub(super) u: &'static mut Displacement,
    step: &'static mut DisplacementIncrement,
    compensation: Option<&'static mut DisplacementCompensation>,
    work: Option<&'static mut Work>,
    first_non_finite: &'static mut FirstNonFinite,
    internal_work: Option<&'static mut InternalWork>,
    previous_prescribed: Option<&'static mut PreviousPrescribedIncrement>,
    contacts: Option<&'static ToolContacts>,
    touch: Option<&'static mut ToolTouch>,
    grasps: Option<&'static Grasps>,
    hold: Option<&'static mut ToolHold>,
    met: Option<(&'static ContactForce, &'static mut SurfaceTouch)>,
    own: Option<&'static mut OwnNumbers>,
    chosen: Option<&'static ChosenBy>,
}

impl BodyColumnsItem<'_, '_> {
    /// All rows, in the run's precision.
    pub(super) fn columns<'a, T: OfRun>(
        &'a mut self,
        element_force: &'a [T],
        non_finite: &'a AtomicU32,
        undeclared: &'a Undeclared,
    ) -> NodeColumns<'a, T> {
        let nodes = self.axes.len();
        NodeColumns {
            first: 0,
            rest: &self.rest.0,
            element_force,
            non_finite,
            undeclared,
            declared: Declared::default(),
            mass: self.mass.slice(),
            inertia: self.inertial.map_or(self.mass.slice(), |inertial| inertial.slice()),
            internal: self.internal.slice_mut(),
            external: self.external.as_mut().map(|e| e.slice_mut()),
            axes: self.axes,
            damping: self.damping.map(|d| d.slice()),
            u: self.u.slice_mut(),
            step: self.step.slice_mut(),
            compensation: self.compensation.as_mut().map(|c| c.slice_mut().split_at_mut(3 * nodes).into()),
            work: self.work.as_mut().map(|w| w.slice_mut()),
            internal_work: self.internal_work.as_mut().map_or(&mut [], |work| work.as_mut_slice()),
            previous_prescribed: self.previous_prescribed.as_mut().map_or(&mut [], |step| step.as_mut_slice()),
            touches: self.contacts.zip(self.touch.as_mut()).map(|(contacts, touch)| Touches {
                rows: &contacts.rows,
                values: touch.slice_mut(),
                numbers: contacts.numbers(),
            }),
            holds: self.grasps.zip(self.hold.as_mut()).map(|(grasps, hold)| Touches {
                rows: &grasps.rows,
                values: hold.slice_mut(),
                numbers: grasps.numbers(),
            }),
            met: self.met.as_mut().map(|(force, touch)| Met {
                force: force.slice(),
                // what contact goes on from stays as it is
                touch: touch.bypass_change_detection().slice_mut(),
            }),
            own: OwnRows::of(
                self.own.as_mut().map_or(&mut [], |own| own.slice_mut()),
                self.chosen.map_or(&[], |chosen| chosen),
                nodes,
            ),
        }
    }

    /// Notes the lowest row of a node whose displacement is no longer finite; `u32::MAX`: none.
    pub(super) fn note_non_finite(&mut self, row: AtomicU32, clock: &Clock) {
        let row = row.into_inner();
        if row != u32::MAX && self.first_non_finite[0] == u32::MAX {
            self.first_non_finite.copy_from_slice(&[row, step_number(clock)]);
        }
    }
}

/// What a pass asks of the step that it is in.
#[derive(SystemParam)]
pub(super) struct InStep<'w> {
    pub(super) cpu: Res<'w, Cpu>,
    pub(super) clock: Res<'w, Clock>,
    signals: Res<'w, Signals>,
    observed: Res<'w, Observed>,
    surfaces: Option<Res<'w, SurfaceSleep>>,
}

impl InStep<'_> {
    /// Whether somebody may look at what is made and used in a pass after it.
    pub(super) fn is_observed(&self) -> bool {
        self.observed.0
    }

    /// Whether all sleep that act on surfaces.
    pub(super) fn surfaces_sleep(&self) -> bool {
        self.surfaces.as_ref().is_some_and(|surfaces| surfaces.asleep)
    }

    /// Whether somebody may look at the forces of a pass after it.
    pub(super) fn observes(&self, pass: &NodePass) -> bool {
        self.observed.0 || !pass.has_forces_of_its_own()
    }
}

/// The node systems of a pass, in their order.
#[derive(Clone, Default)]
pub(crate) struct NodePass {
    systems: Vec<NodeRows>,
    /// What they have declared, each with its place among all that the pass goes through, and their names by places.
    declared: Vec<Declared>,
    names: Vec<String>,
}

impl NodePass {
    /// Of systems that follow one another in a step, by their names.
    pub(crate) fn new<'a>(systems: impl IntoIterator<Item = (&'a str, NodeRows)>, world: &mut World) -> Self {
        let mut pass = Self::default();
        for (place, (name, system)) in systems.into_iter().enumerate() {
            pass.declared.push(system.declared(world).at(place));
            pass.names.push(name.to_owned());
            pass.systems.push(system);
        }
        pass
    }

    /// The same where others go before it: notes name systems of both.
    pub(super) fn after(mut self, other: &Self) -> Self {
        self.names.splice(..0, other.names.iter().cloned());
        let first = other.systems.len();
        (first..).zip(&mut self.declared).for_each(|(place, declared)| *declared = declared.at(place));
        self
    }

    /// Ends a run in which a system asked for what it has not declared.
    pub(super) fn refuse(&self, undeclared: &Undeclared) -> Result<(), Error> {
        let Some((place, told)) = undeclared.told() else { return Ok(()) };
        let name = self.names.get(place).map_or("a system", String::as_str);
        Err(Error::Options(format!("`{name}` {told}: what shares a pass with it is planned by these")))
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.systems.is_empty()
    }

    /// Whether forces are made in it, used, and not needed any more.
    fn has_forces_of_its_own(&self) -> bool {
        self.systems.iter().any(|system| system.sums_forces) && self.systems.iter().any(|system| system.moves_nodes)
    }

    /// Has a query look at what calls for its systems, and for those of another pass.
    pub(super) fn callers(&self, other: &Self, query: &mut QueryBuilder<FilteredEntityRef<'static, 'static>>) {
        let all: Vec<&NodeRows> = self.systems.iter().chain(&other.systems).collect();
        NodeRows::callers_of(&all, query);
    }

    /// Binds all that calls for its systems on a body to a step.
    pub(super) fn bind<'a>(
        &self,
        callers: &'a Callers<'_, '_>,
        step: &InStep<'_>,
        body: &BodyColumnsItem<'_, '_>,
        arena: &'a Bump,
    ) -> BoundSystems<'a> {
        let before = Before {
            clock: &step.clock,
            signals: &step.signals,
            rest: body.rest,
            displacement: &body.u,
            mass: body.mass,
            chosen: body.chosen.map_or(&[], |chosen| chosen),
            bit: 0,
            declared: Declared::default(),
        };
        let mut all = BoundSystems::new();
        for (system, &declared) in self.systems.iter().zip(&self.declared) {
            system.bind(callers, body.body, &Before { declared, ..before }, arena, &mut all);
        }
        all
    }
}

/// Does what bound systems do to some rows, one after the other: each is `NodeSystem::act` in its file.
pub(super) fn act<T: OfRun>(systems: &[BoundSystem<'_>], cpu: &Cpu, nodes: &mut NodeColumns<'_, T>) {
    for system in systems {
        T::act(system.on_rows(), cpu, nodes);
    }
}

/// Node systems as one pass over all nodes, in their order.
pub(crate) fn node_pass(pass: NodePass, world: &mut World) -> HostSystem {
    pass_over(pass, |_| None, world)
}

/// The same over those nodes that have waited: those of surfaces.
pub(crate) fn shared_pass(pass: NodePass, world: &mut World) -> HostSystem {
    pass_over(pass, |corners| corners, world)
}

/// Node systems as one pass over all nodes, or over those that have waited. Bodies do not wait for each other.
fn pass_over(pass: NodePass, moved: fn(Option<&Corners>) -> Option<&Corners>, world: &mut World) -> HostSystem {
    type Bodies<'w, 's> = Query<'w, 's, (BodyColumns, Option<&'static ElementForce>, Option<&'static Corners>)>;
    let parameters = (
        QueryParamBuilder::new(|query| pass.callers(&NodePass::default(), query)),
        ParamBuilder::of::<InStep>(),
        ParamBuilder::query::<(BodyColumns, Option<&'static ElementForce>, Option<&'static Corners>)>(),
    );
    let state = parameters.build_state(world);
    let mut system =
        state.build_system(move |callers: Callers, step: InStep, mut bodies: Bodies| -> Result<(), Error> {
            let (cpu, observed, undeclared) = (&*step.cpu, step.observes(&pass), Undeclared::default());
            cpu.for_each(bodies.iter_mut(), |(mut body, force, corners)| {
                cpu.with_arena(|arena| {
                    let systems = pass.bind(&callers, &step, &body, arena);
                    // where nothing is fixed but for good, `boundary` has nothing to do
                    if systems.is_empty() {
                        return;
                    }
                    let of_step = (&step, arena, observed, &undeclared);
                    let moved = moved(corners);
                    match body.u.precision() {
                        Precision::F32 => move_others::<f32>(of_step, &mut body, (force, moved), &systems),
                        Precision::F64 => move_others::<f64>(of_step, &mut body, (force, moved), &systems),
                    }
                });
            });
            pass.refuse(&undeclared)
        });
    system.initialize(world);
    Box::new(system)
}

/// Takes all nodes of a body through systems but those that have `moved` with their patch. Tasks are of the same rows
/// as where all nodes inside patches do, so that sums over them are the same.
fn move_others<T: OfRun>(
    (step, arena, observed, undeclared): (&InStep<'_>, &Bump, bool, &Undeclared),
    body: &mut BodyColumnsItem<'_, '_>,
    (force, moved): (Option<&ElementForce>, Option<&Corners>),
    systems: &[BoundSystem<'_>],
) {
    let non_finite = AtomicU32::new(u32::MAX);
    let mut columns = body.columns::<T>(force.map_or(&[], |force| force.slice()), &non_finite, undeclared);
    let deferred = moved.map_or(&[][..], |moved| &moved.deferred[..]);
    let deferred = arena.alloc_slice_fill_iter(deferred.iter().map(|rows| {
        columns.take(rows.start - columns.first);
        columns.take(rows.len())
    }));
    if let Some(moved) = moved {
        columns.take(moved.first_waiting - columns.first);
    }
    let deferred = deferred.iter_mut().map(|rows| rows.take(rows.rows()));
    move_rows(&step.cpu, observed, deferred.chain(columns.tasks(ROWS_A_TASK)), &[systems]);
    body.note_non_finite(non_finite, &step.clock);
}

/// Takes nodes through systems, `gather` first, a task's rows at a time; without `observed` their forces go nowhere
/// else.
pub(super) fn move_rows<'a, T: OfRun>(
    cpu: &Cpu,
    observed: bool,
    tasks: impl Iterator<Item = NodeColumns<'a, T>>,
    systems: &[&[BoundSystem<'_>]],
) {
    cpu.for_each(tasks, |mut rows| {
        rows.with_forces(observed, |rows| systems.iter().for_each(|systems| act(systems, cpu, rows)));
    });
}
