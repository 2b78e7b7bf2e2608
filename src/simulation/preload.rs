//! `start: Equilibrium()`: bodies are at rest under what acts at t = 0 before the first step is taken.
//!
//! A static analysis of the same scene at t = 0, with the same precision on the same backend, finds where they stand.
//! It is made with the simulation and runs when the first state is asked for, so that nothing is sought where a
//! snapshot is gone on from.

use super::step_change::relax_fully;
use super::{Equilibrium, Options, Simulation};
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::contact::face_points;
use crate::error::{Error, NotConverged};
use crate::mesh::SurfaceFace;
use crate::scene::SceneFile;
use crate::scene::schema::{
    Analysis, ContactLaw, EquilibriumSearch, InitialState, Integration, Inversion, Output, Scene,
};
use crate::systems::Registry;
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::Serialize;
use std::ops::ControlFlow;
use std::time::Duration;
use web_time::Instant;

/// Pseudo-steps after which it is told how far the search for rest is, at most.
const TOLD: u64 = 400;
/// The time in which that is told, as well as it can be: who is told may want an end.
const WAITED: Duration = Duration::from_millis(50);
/// How often rest is sought anew because the step of the motion has become another.
const RENEWALS: u32 = 4;

/// What bringing the bodies to rest before the first step took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Preload {
    /// The equilibrium from which the motion begins.
    pub equilibrium: Equilibrium,
    /// Pseudo-steps that led there.
    pub steps: u64,
    /// How long that took (s).
    pub seconds: f64,
}

/// Whether a column is taken over from the static analysis node by node: where nodes are, and forces for those who
/// observe the start.
fn is_taken(column: &ColumnAccess) -> bool {
    let subject = matches!(column.subject, Subject::Motion | Subject::Force);
    subject && column.role == Role::State && column.increments != Increments::All
}

/// The same where bodies rest on springs: who touches, how deep, and what friction holds.
fn is_touch(column: &ColumnAccess) -> bool {
    column.subject == Subject::Touch && column.role == Role::State
}

/// The static analysis that is to bring a scene's bodies to rest, where it wants that.
///
/// # Errors
/// As [`Simulation::new`].
pub(super) fn settling(scene: &SceneFile, options: &Options, clock: &Clock) -> Result<Option<Box<Simulation>>, Error> {
    let Some(at_rest) = at_rest(&scene.scene) else { return Ok(None) };
    // springs bear what the first step finds
    let springs = has_springs(&at_rest).then(|| {
        let of_steps = SolvedSprings { step: clock.time_step, shared: true, forces: SpringForces::Stepped };
        clock.springs.map_or(of_steps, |springs| SolvedSprings { forces: SpringForces::Stepped, ..springs })
    });
    let mut file = scene.clone();
    file.scene = at_rest;
    Ok(Some(Box::new(Simulation::on_springs(&file, options, &Registry::default(), springs)?)))
}

fn has_springs(scene: &Scene) -> bool {
    scene.contacts.iter().any(|contact| contact.law() != ContactLaw::Kinematic)
}

/// The scene whose equilibrium is sought; `None` where none is. What belongs to the motion only is left out: systems of
/// one's own take part from the first step on.
pub(super) fn at_rest(scene: &Scene) -> Option<Scene> {
    let InitialState::Equilibrium(search) = scene.start else { return None };
    if scene.is_static() {
        return None;
    }
    let Integration { safety, bound, compensated, .. } = scene.integration;
    let mut scene = Scene {
        analysis: Analysis::Static(EquilibriumSearch { at: Some(0.0), ..search }),
        start: InitialState::Undeformed,
        removal: Vec::new(),
        suction: Vec::new(),
        probes: Default::default(),
        integration: Integration { safety, bound, compensated, ..Integration::default() },
        schedule: None,
        parameters: Default::default(),
        output: Output::default(),
        ..scene.clone()
    };
    for body in scene.bodies.values_mut() {
        (body.velocity, body.spin, body.start) = (DVec3::ZERO, DVec3::ZERO, None);
    }
    for material in scene.materials.values_mut() {
        material.inversion = material.inversion.filter(|policy| *policy != Inversion::Remove);
    }
    Some(scene)
}

impl Simulation {
    /// Brings the bodies to rest where the scene says `start: Equilibrium()` and no step has been taken; else does
    /// nothing. Who steps, observes or asks for a state need not call it: that does.
    ///
    /// # Errors
    /// That there is no equilibrium, or none was found; what the GPU says. Then no step is taken.
    pub fn settle(&mut self) -> Result<(), Error> {
        self.settle_telling(|_, _| ControlFlow::Continue(())).map(|_| ())
    }

    /// The same, and tells again and again how far it is: the pseudo-steps so far, and what they have come to, whose
    /// residual is infinite until it is first looked at. Who is told may break it off: then no step is taken, and the
    /// search goes on when a state is asked for.
    ///
    /// # Errors
    /// As [`Simulation::settle`].
    #[doc(hidden)]
    pub fn settle_telling(
        &mut self,
        mut tell: impl FnMut(u64, &Equilibrium) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Error> {
        let Some(mut analysis) = self.settling.take() else { return Ok(ControlFlow::Continue(())) };
        let started = Instant::now();
        for turn in 0..=RENEWALS {
            let found = analysis.find_equilibrium(&mut tell);
            if !matches!(found, Ok(ControlFlow::Continue(()))) {
                // who asks again gets no motion from elsewhere
                self.settling = Some(analysis);
                return found.map_err(at_start);
            }
            self.stand_as(&mut analysis.world)?;
            let Some(step) = self.other_step(&analysis)?.filter(|_| turn < RENEWALS) else { break };
            analysis.rest_again(step);
        }
        let equilibrium = analysis.equilibrium().cloned().unwrap_or_default();
        let steps = analysis.step_count();
        self.preload = Some(Preload { equilibrium, steps, seconds: started.elapsed().as_secs_f64() });
        Ok(ControlFlow::Continue(()))
    }

    /// What settling took; `None` where it was not asked for or has not been done yet.
    pub fn preload(&self) -> Option<&Preload> {
        self.preload.as_ref()
    }

    /// The step of the motion (s), where springs bear bodies at rest as those of another one would: of bodies as they
    /// stand another may be stable, which is looked at now.
    fn other_step(&mut self, analysis: &Self) -> Result<Option<f64>, Error> {
        let springs = analysis.world.resource::<Clock>().springs.filter(|springs| springs.shared);
        let Some(springs) = springs else { return Ok(None) };
        self.on_threads(Self::follow)?;
        let step = self.world.resource::<Clock>().time_step;
        Ok((step != springs.step).then_some(step))
    }

    fn find_equilibrium(
        &mut self,
        tell: &mut impl FnMut(u64, &Equilibrium) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Error> {
        let mut count = 1;
        while !self.is_finished() && self.step_count() < self.planned_steps() {
            let started = Instant::now();
            self.advance_towards_end(count)?;
            count = if started.elapsed() < WAITED { TOLD.min(2 * count) } else { (count / 2).max(1) };
            if let Some(found) = self.equilibrium()
                && tell(self.step_count(), found).is_break()
            {
                return Ok(ControlFlow::Break(()));
            }
        }
        match self.equilibrium() {
            Some(found) if !found.reached => Err(Error::NotConverged(Box::new(NotConverged {
                steps: self.step_count(),
                stalled_at: None,
                equilibrium: found.clone(),
                at_start: true,
            }))),
            _ => Ok(ControlFlow::Continue(())),
        }
    }

    /// Bodies stand where they do in another world, at rest and relaxed; guards and the stable step begin with that.
    fn stand_as(&mut self, other: &mut World) -> Result<(), Error> {
        let taken = |name| column_is(name, |column| is_taken(column) || is_touch(column));
        bring_to_host(other, |_, name| taken(name))?;
        let bodies: Vec<(Entity, Label)> = bodies(&mut self.world);
        let others = self::bodies(other);
        for (body, label) in bodies {
            let Some(&(from, _)) = others.iter().find(|(_, other)| *other == label) else { continue };
            take(&mut self.world, body, other, from);
            take_touch(&mut self.world, body, other, from);
            if let Some(mut lost) = self.world.get_mut::<DisplacementCompensation>(body) {
                // at rest the step is exact
                (lost.len() / 2..lost.len()).for_each(|i| lost.set(i, 0.0));
            }
        }
        relax_fully(&mut self.world);
        let remembered = |name| column_is(name, |column| column.subject == Subject::Memory);
        send_to_device(&mut self.world, |_, name| taken(name) || remembered(name))?;
        crate::observation::begin_to_guard(&mut self.world)?;
        if let Some(follower) = self.solver.follower_mut() {
            // the step was found for bodies that are not deformed
            follower.found.next = 0;
        }
        Ok(())
    }
}

fn bodies(world: &mut World) -> Vec<(Entity, Label)> {
    let mut query = world.query_filtered::<(Entity, &Label), With<Authoring>>();
    query.iter(world).map(|(entity, label)| (entity, label.clone())).collect()
}

/// Takes over how a body touches tools at rest and what threads and ties bear, and if that is by springs how it touches
/// others: the kinematic law between bodies begins anew, and so does what closed tools hold. Where the motion may lose
/// elements and the search for rest may not, rows have another order, and there is room for what may come to the
/// surface.
fn take_touch(world: &mut World, body: Entity, other: &World, from: Entity) {
    let rows = |world: &World, entity| Some(world.get::<Authoring>(entity)?.node_rows.clone());
    let (Some(to_rows), Some(from_rows)) = (rows(world, body), rows(other, from)) else { return };
    let springs = other.resource::<Clock>().springs.is_some();
    let number = world.get::<Displacement>(body).map_or(0, |u| u.bytes().len() / u.len().max(1));
    let kinematic = [ToolTouch::NAME, SutureState::NAME, TieState::NAME];
    let is_wanted = |column: &&ColumnAccess| is_touch(column) && (springs || kinematic.contains(&column.name));
    for column in all_columns().iter().filter(is_wanted) {
        let (Some(source), Some(target)) = ((column.bytes)(other, from), (column.bytes)(world, body)) else { continue };
        let mut taken = target.to_vec();
        let places = match column.name {
            SurfaceTouch::NAME => {
                let same = to_rows.iter().zip(&from_rows).map(|(to, from)| [to, from].map(|&row| row as usize));
                same.map(|[to, from]| Same { numbers: MEETING_NUMBERS, places: [to, from], count: 1 }).collect()
            }
            ToolTouch::NAME => tool_places([(world, body), (other, from)]),
            FaceTouch::NAME => face_places([(world, body), (other, from)]),
            // tension, length and energy, and the force; what became of them begins with the motion
            SutureState::NAME if !springs => some_of_each(target.len() / number.max(1), SUTURE_NUMBERS, [2, 3]),
            TieState::NAME if !springs => some_of_each(target.len() / number.max(1), TIE_NUMBERS, [2, 3]),
            // one of each after the other
            _ => vec![Same { numbers: 1, places: [0, 0], count: target.len() / number.max(1) }],
        };
        for Same { numbers, places, count } in places {
            let [to, from] = places.map(|place| number * numbers * place..number * numbers * (place + count));
            if let (Some(taken), Some(source)) = (taken.get_mut(to), source.get(from)) {
                taken.copy_from_slice(source);
            }
        }
        (column.write)(world, body, &taken);
    }
}

/// Places in a column of two worlds that are of the same things: so many numbers each, the first two, and how many.
struct Same {
    numbers: usize,
    places: [usize; 2],
    count: usize,
}

/// Of a column with so many numbers in all and for each thing, those from a place on, so many.
fn some_of_each(all: usize, each: usize, [first, count]: [usize; 2]) -> Vec<Same> {
    (0..all / each).map(|thing| Same { numbers: 1, places: [each * thing + first; 2], count }).collect()
}

/// What [`ToolTouch`] has of the same node in both worlds.
fn tool_places(both: [(&World, Entity); 2]) -> Vec<Same> {
    let tools = both.map(|(world, body)| Some((world.get::<ToolContacts>(body)?, world.get::<Authoring>(body)?)));
    let [Some((to, to_rows)), Some((from, from_rows))] = tools else { return Vec::new() };
    let place = |tools: &ToolContacts, row: u32| tools.rows.binary_search(&row).ok();
    let same = |(&to_row, &from_row): (&u32, &u32)| {
        let places = [place(to, to_row)?, place(from, from_row)?];
        Some(Same { numbers: to.numbers(), places, count: 1 })
    };
    to_rows.node_rows.iter().zip(&from_rows.node_rows).filter_map(same).collect()
}

/// What [`FaceTouch`] has of the same facet in both worlds.
fn face_places(both: [(&World, Entity); 2]) -> Vec<Same> {
    let Some(authoring) = both[0].0.get::<Authoring>(both[0].1) else { return Vec::new() };
    let surface = authoring.surface(|_, _| true);
    let facets = || surface.iter().flat_map(SurfaceFace::facets).map(|facet| (facet, face_points(facet).len()));
    let [to, from] = both.map(|(world, body)| FacePlaces::firsts(world.get::<FacePlaces>(body), facets()));
    let same = to.into_iter().zip(from).zip(facets());
    same.map(|((to, from), (_, count))| Same { numbers: MEETING_NUMBERS, places: [to, from], count }).collect()
}

/// Takes over columns of vectors, of which a node may have several, node by node.
fn take(world: &mut World, body: Entity, other: &World, from: Entity) {
    let rows = |world: &World, entity| world.get::<Authoring>(entity).map(|authoring| authoring.node_rows.clone());
    let (Some(to_rows), Some(from_rows)) = (rows(world, body), rows(other, from)) else { return };
    let vectors = world.get::<Displacement>(body).map_or(0, |u| u.len() / 3);
    let vector = world.get::<Displacement>(body).map_or(0, |u| u.bytes().len()) / vectors.max(1);
    for column in all_columns().iter().filter(|column| is_taken(column)) {
        let (Some(source), Some(target)) = ((column.bytes)(other, from), (column.bytes)(world, body)) else { continue };
        let mut taken = target.to_vec();
        let of_part = vector * to_rows.len();
        for (target, source) in taken.chunks_exact_mut(of_part.max(1)).zip(source.chunks_exact(of_part.max(1))) {
            for (&to, &from) in to_rows.iter().zip(&from_rows) {
                let [to, from] = [to, from].map(|row| vector * row as usize);
                target[to..to + vector].copy_from_slice(&source[from..from + vector]);
            }
        }
        (column.write)(world, body, &taken);
    }
}

/// The same error, which says that it is of the start.
fn at_start(error: Error) -> Error {
    match error {
        Error::NotConverged(mut found) => {
            found.at_start = true;
            Error::NotConverged(found)
        }
        Error::Unstable(mut broken) => {
            broken.what = format!("on the way to the equilibrium of the start, {}", broken.what);
            Error::Unstable(broken)
        }
        other => other,
    }
}
