//! Looking into a simulation from a program.

use super::Simulation;
use crate::components::*;
use crate::error::{Criterion, Error};
use crate::observation::Observer;
use crate::observation::{AttachmentReading, ContactReading, ToolReading};
use crate::output::{Folder, Node, nodes};
use crate::scene::Diagnostics;
use crate::scene::schema::Scene;
use crate::{SceneFile, systems::Registry};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use web_time::Instant;

impl Simulation {
    /// The world. On the GPU its columns may be older than the device's: the functions below bring what they return.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to change. On the GPU changes to columns do not reach the device; custom systems' do.
    pub fn world_mut(&mut self) -> &mut World {
        // what is written now is newer than what was seen before
        self.world.increment_change_tick();
        &mut self.world
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Steps taken.
    pub fn step_count(&self) -> u64 {
        self.world.resource::<Clock>().step
    }

    /// Steps that the scene lasts, with the step as it is now: their number changes when the step follows what is
    /// stable ([`Simulation::finish`] goes to the end whatever happens to it).
    pub fn planned_steps(&self) -> u64 {
        self.facts.steps
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.world.resource::<Clock>().time()
    }

    /// Δt (s).
    pub fn time_step(&self) -> f64 {
        self.world.resource::<Clock>().time_step
    }

    /// The elements that set the stable step at the start, the smallest first: at most ten.
    #[doc(hidden)]
    pub fn critical_elements(&self) -> &[crate::assembly::CriticalElement] {
        &self.facts.stability.bound.worst
    }

    /// What is not wrong with the scene but should be known.
    pub fn warnings(&self) -> &Diagnostics {
        &self.facts.warnings
    }

    /// The body of a name.
    ///
    /// # Errors
    /// That there is none, with the names there are.
    pub fn body(&mut self, name: &str) -> Result<Entity, Error> {
        let bodies: Vec<(Entity, String)> = self
            .world
            .query_filtered::<(Entity, &Label), With<Authoring>>()
            .iter(&self.world)
            .map(|(entity, label)| (entity, label.0.clone()))
            .collect();
        let found = bodies.iter().find(|(_, label)| label == name).map(|(entity, _)| *entity);
        let names: Vec<&str> = bodies.iter().map(|(_, label)| label.as_str()).collect();
        found.ok_or_else(|| Error::Options(format!("there is no body named {name:?}; there is {}", names.join(", "))))
    }

    /// Displacements of a body's nodes (m), in the author's order.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn displacements(&mut self, body: &str) -> Result<Vec<DVec3>, Error> {
        self.settle()?;
        let body = self.body(body)?;
        crate::backend::device::bring_to_host(&mut self.world, |entity, name| {
            entity == body && name == Displacement::NAME
        })?;
        let (Some(authoring), Some(u)) = (self.world.get::<Authoring>(body), self.world.get::<Displacement>(body))
        else {
            return Ok(Vec::new());
        };
        Ok(authoring.node_rows.iter().map(|&row| u.vector(row as usize)).collect())
    }

    /// Rest positions of a body's nodes (m), in the author's order.
    ///
    /// # Errors
    /// No such body.
    pub fn rest_positions(&mut self, body: &str) -> Result<Vec<DVec3>, Error> {
        let body = self.body(body)?;
        let (Some(authoring), Some(rest)) = (self.world.get::<Authoring>(body), self.world.get::<RestPosition>(body))
        else {
            return Ok(Vec::new());
        };
        Ok(authoring.node_rows.iter().map(|&row| rest.0[row as usize]).collect())
    }

    /// Where a body's nodes are now (m), in the author's order: at rest, and moved by their displacements.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn positions(&mut self, body: &str) -> Result<Vec<DVec3>, Error> {
        let (rest, displacements) = (self.rest_positions(body)?, self.displacements(body)?);
        Ok(rest.into_iter().zip(displacements).map(|(rest, displacement)| rest + displacement).collect())
    }

    /// All fields of a body at the present step, in the author's order.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn fields(&mut self, body: &str) -> Result<crate::observation::BodyFields, Error> {
        self.settle()?;
        let body = self.body(body)?;
        crate::observation::body_fields(&mut self.world, body)
    }

    /// Internal forces of a body's nodes at the present displacements (N), in the author's order.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn internal_forces(&mut self, body: &str) -> Result<Vec<DVec3>, Error> {
        self.settle()?;
        let body = self.body(body)?;
        crate::observation::internal_forces(&mut self.world, body)
    }

    /// Lumped masses of a body's nodes (kg), in the author's order; 0 for those whose elements are all removed.
    ///
    /// # Errors
    /// No such body; what the GPU says.
    pub fn masses(&mut self, body: &str) -> Result<Vec<f64>, Error> {
        let body = self.body(body)?;
        crate::backend::device::bring_to_host(&mut self.world, |entity, name| entity == body && name == Mass::NAME)?;
        let (Some(authoring), Some(mass)) = (self.world.get::<Authoring>(body), self.world.get::<Mass>(body)) else {
            return Ok(Vec::new());
        };
        Ok(authoring.node_rows.iter().map(|&row| mass.get(row as usize)).collect())
    }

    /// Where steps are taken, in words: the processor or the GPU, the number type, threads.
    pub fn backend(&self) -> &str {
        &self.facts.backend
    }

    /// Whether steps are taken on a GPU.
    pub fn is_on_gpu(&self) -> bool {
        self.facts.on_gpu
    }

    /// Energies of all bodies at the present step.
    ///
    /// # Errors
    /// What the GPU says.
    pub fn energies(&mut self) -> Result<Energies, Error> {
        self.settle()?;
        crate::observation::energies(&mut self.world)
    }

    /// What a probe sees at the present step; of one that holds peaks the values of the largest size of all
    /// observations so far and of the present step, which does not count as one.
    ///
    /// # Errors
    /// No such probe; what the GPU says.
    pub fn probe(&mut self, name: &str) -> Result<Vec<f64>, Error> {
        self.settle()?;
        let probes: Vec<(Entity, String)> = self
            .world
            .query_filtered::<(Entity, &Label), With<Probe>>()
            .iter(&self.world)
            .map(|(entity, label)| (entity, label.0.clone()))
            .collect();
        match probes.iter().find(|(_, label)| label == name) {
            Some((probe, _)) => {
                let seen = crate::observation::observe_probe(&mut self.world, *probe)?;
                Ok(crate::observation::with_peaks(&self.world, *probe, seen))
            }
            None => {
                let names: Vec<&str> = probes.iter().map(|(_, label)| label.as_str()).collect();
                Err(Error::Options(format!("there is no probe named {name:?}; there is {}", names.join(", "))))
            }
        }
    }

    /// What a body feels where it touches others or itself.
    ///
    /// # Errors
    /// No such body, or none that may touch another or itself; what the GPU says.
    pub fn contact(&mut self, body: &str) -> Result<ContactReading, Error> {
        self.settle()?;
        let entity = self.body(body)?;
        let reading = crate::observation::read_contact(&mut self.world, entity)?;
        reading.ok_or_else(|| Error::Options(format!("nothing under `contacts` lets {body:?} touch a body")))
    }

    /// What a suture, a tie or glue bears, by its name, or as a text by its place among the attachments, counted from
    /// 0.
    ///
    /// # Errors
    /// No such attachment; what the GPU says.
    pub fn attachment(&mut self, name: &str) -> Result<AttachmentReading, Error> {
        let mut all = self.attachments()?;
        all.remove(name).ok_or_else(|| {
            let names: Vec<&str> = all.keys().map(String::as_str).collect();
            let there = if names.is_empty() { "none in this scene".into() } else { names.join(", ") };
            Error::Options(format!("there is no suture, tie or glue named {name:?}; there is {there}"))
        })
    }

    /// What all sutures, ties and glue bear.
    pub(super) fn attachments(&mut self) -> Result<BTreeMap<String, AttachmentReading>, Error> {
        self.settle()?;
        let mut all = BTreeMap::new();
        for (number, attachment) in self.scene.attachments.iter().enumerate() {
            let Some(name) = attachment.name(number) else { continue };
            all.extend(crate::observation::read_attachment(&mut self.world, number)?.map(|reading| (name, reading)));
        }
        Ok(all)
    }

    /// What a tool of the scene feels.
    ///
    /// # Errors
    /// No such tool; what the GPU says.
    pub fn tool(&mut self, name: &str) -> Result<ToolReading, Error> {
        self.settle()?;
        if !self.scene.tools.contains_key(name) {
            let names: Vec<&str> = self.scene.tools.keys().map(String::as_str).collect();
            return Err(Error::Options(format!("there is no tool named {name:?}; there is {}", names.join(", "))));
        }
        crate::observation::read_tool(&mut self.world, name)
    }

    /// Writes all that is observed from now on into a folder.
    ///
    /// # Errors
    /// Files that cannot be created.
    pub fn write_into(&mut self, folder: &mut Folder) -> Result<(), Error> {
        self.world.resource_scope(|world, mut observer: Mut<Observer>| observer.write_into(folder, world))?;
        Ok(())
    }

    /// Writes `nodes.csv` (of several bodies `nodes_NAME.csv` each): the present state in the author's numbering.
    ///
    /// # Errors
    /// That a node is nowhere, or the force on it no number; files that cannot be written; what the GPU says.
    pub fn write_nodes(&mut self, folder: &mut Folder) -> Result<(), Error> {
        let started = Instant::now();
        let written = self.write_all_nodes(folder);
        self.elapsed += started.elapsed();
        self.world.resource_mut::<Observer>().writing += started.elapsed();
        written.map_err(|error| self.note(error))
    }

    fn write_all_nodes(&mut self, folder: &mut Folder) -> Result<(), Error> {
        let names: Vec<String> = self.scene.bodies.keys().cloned().collect();
        for name in &names {
            let (rest, displacements) = (self.rest_positions(name)?, self.displacements(name)?);
            let forces = self.internal_forces(name)?;
            crate::observation::mass(&mut self.world)?;
            let body = self.body(name)?;
            let path = folder.claim(&nodes::file_name(name, names.len()))?;
            let (Some(authoring), Some(mass)) = (self.world.get::<Authoring>(body), self.world.get::<Mass>(body))
            else {
                continue;
            };
            let node = |(place, &row): (usize, &u32)| Node {
                id: authoring.node_ids.of(place),
                position: rest[place],
                displacement: displacements[place],
                force: forces[place],
                mass: mass.get(row as usize),
            };
            if let Some(place) = (0..rest.len()).find(|&i| !displacements[i].is_finite() || !forces[i].is_finite()) {
                let node = authoring.node_ids.of(place);
                let found = format!("the place of node {node}, or the force on it, is no finite number");
                let criterion = Criterion { node: Some(node), ..Criterion::of("result") };
                return Err(self.world.resource::<Observer>().refused(&self.world, name, found, criterion));
            }
            nodes::write(&path, authoring.node_rows.iter().enumerate().map(node))?;
        }
        Ok(())
    }

    /// Everything that is wrong with a scene, as far as can be known without running it.
    pub fn check(scene: &SceneFile, registry: &Registry) -> Diagnostics {
        super::prepare::check(scene, registry)
    }
}
