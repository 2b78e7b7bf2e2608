//! Looking at a simulation: what its state has in it.

use super::grabs::Hands;
use super::state::{Body, BodyState, Loaded, State, ToolState};
use crate::components::{
    Alive, Authoring, Block, Column, ConstrainedAxes, Displacement, Energies, Label, RestPosition,
};
use crate::error::Error;
use crate::math::turned;
use crate::observation::{ToolReading, field_of, header, way_of};
use crate::scene::schema::OutputField;
use crate::{SceneFile, Simulation};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Energies, probes and what tools feel are taken in one of so many states of a simulation that runs.
const MEASURED: u64 = 4;

/// Who looks, and what it remembers between two looks.
#[derive(Default)]
pub struct Look {
    /// The field that states have values of.
    pub field: Option<OutputField>,
    /// The field that states have vectors of.
    pub arrows: Option<OutputField>,
    /// Whether positions are drawn from where they are on a GPU.
    pub lends: bool,
    /// The last ones that were brought from there, by bodies.
    brought: Vec<BodyState>,
    loaded: Option<Arc<Loaded>>,
    /// Scenes so far, and states of the present one.
    scenes: u64,
    states: u64,
    topology: u64,
    /// Of each body which elements are there, and since when.
    alive: Vec<(Arc<Vec<u8>>, u64)>,
    measured: Measured,
}

/// What is not taken for every state.
#[derive(Clone, Default)]
struct Measured {
    /// Step and time (s).
    at: Option<(u64, f64)>,
    energies: Energies,
    probes: Vec<Vec<f64>>,
    tools: BTreeMap<String, ToolReading>,
}

impl Look {
    /// The scene that is looked at.
    pub fn scene(&self) -> Option<SceneFile> {
        self.loaded.as_ref().map(|loaded| loaded.scene.clone())
    }

    /// Begins to look at a scene.
    pub fn begin(&mut self, scene: &SceneFile, simulation: &mut Simulation) -> Result<(), Error> {
        let bodies = scene.scene.bodies.keys().map(|name| body(name, simulation)).collect::<Result<_, _>>()?;
        let columns = |what| header(what).into_iter().skip(1).map(|column| column.to_string()).collect();
        let loaded = Loaded {
            number: self.scenes,
            scene: scene.clone(),
            backend: simulation.backend().into(),
            bodies,
            probes: scene.scene.probes.iter().map(|(name, probe)| (name.clone(), columns(&probe.what))).collect(),
            critical: simulation.critical_elements().to_vec(),
            warnings: simulation.warnings().lines(),
        };
        (self.loaded, self.states) = (Some(Arc::new(loaded)), 0);
        self.scenes += 1;
        (self.alive, self.measured) = (Vec::new(), Measured::default());
        self.brought.clear();
        Ok(())
    }

    /// Forgets what was measured: the state has become another one, perhaps at the same step.
    pub fn measure_anew(&mut self) {
        self.measured.at = None;
    }

    /// Puts what is seen into a state.
    pub fn at(
        &mut self,
        simulation: &mut Simulation,
        hands: &Hands,
        running: bool,
        state: &mut State,
    ) -> Result<(), Error> {
        let Some(loaded) = self.loaded.clone() else { return Ok(()) };
        state.time = simulation.time();
        state.time_step = simulation.time_step();
        state.step = simulation.step_count();
        state.finished = simulation.is_finished();
        state.history = simulation.history();
        state.inputs = simulation.inputs();
        state.breakdown = simulation.failure().cloned().map(Box::new);
        (state.field, state.arrows) = (self.field, self.arrows);
        let lent = self.lends && running && !self.states.is_multiple_of(MEASURED);
        for (number, body) in loaded.bodies.iter().enumerate() {
            let last = self.brought.get(number).filter(|_| lent && body.on_gpu.is_some());
            let now = match last {
                Some(last) => last.clone(),
                None => self.body(number, &body.name, simulation)?,
            };
            state.bodies.push(now);
        }
        if self.lends && !lent {
            self.brought.clone_from(&state.bodies);
        }
        state.held = hands.states(simulation, |name, node| {
            let number = loaded.bodies.iter().position(|body| body.name == name);
            let position = number.and_then(|number| state.bodies.get(number)?.positions.get(node as usize));
            position.map_or(DVec3::NAN, |position| DVec3::from(position.map(f64::from)))
        })?;
        // numbers of a state that is no longer physical are of no use, and some cannot be had
        if state.breakdown.is_none() {
            self.measure(&loaded, simulation, running)?;
        }
        state.measured = self.measured.at.map_or(state.time, |(_, time)| time);
        (state.energies, state.probes) = (self.measured.energies, self.measured.probes.clone());
        state.tools = loaded.scene.scene.tools.keys().map(|name| self.tool(name, simulation)).collect();
        state.loaded = Some(loaded);
        self.states += 1;
        Ok(())
    }

    fn body(&mut self, number: usize, name: &str, simulation: &mut Simulation) -> Result<BodyState, Error> {
        let entity = simulation.body(name)?;
        let moved = simulation.displacements(name)?;
        let world = simulation.world_mut();
        let (values, components) = match self.field {
            Some(field) => field_of(field, entity, world)?,
            None => (Vec::new(), 0),
        };
        let arrows = match self.arrows {
            Some(field) => field_of(field, entity, world)?.0,
            None => Vec::new(),
        };
        let arrows = arrows.as_chunks().0.to_vec();
        crate::backend::device::bring_to_host(world, |_, name| name == Alive::NAME)?;
        let mut alive = Vec::new();
        let mut positions = Vec::new();
        if let (Some(authoring), Some(rest)) = (world.get::<Authoring>(entity), world.get::<RestPosition>(entity)) {
            let blocks: Vec<Option<&Alive>> = authoring.blocks.iter().map(|&block| world.get::<Alive>(block)).collect();
            let there =
                |&(block, row): &(u32, u32)| blocks[block as usize].is_none_or(|alive| alive[row as usize] != 0);
            alive.extend(authoring.element_rows.iter().map(|place| u8::from(there(place))));
            let place = |(row, moved): (&u32, &DVec3)| (rest.0[*row as usize] + *moved).as_vec3().to_array();
            positions.extend(authoring.node_rows.iter().zip(&moved).map(place));
        }
        if self.alive.get(number).is_none_or(|(before, _)| **before != alive) {
            self.topology += 1;
            self.alive.truncate(number);
            self.alive.push((Arc::new(alive), self.topology));
        }
        let skinned = simulation.scene().bodies.get(name).is_some_and(|body| body.skin.is_some());
        let skin = if skinned { Some(simulation.skin(name)?) } else { None };
        let (alive, topology) = self.alive[number].clone();
        Ok(BodyState { positions, alive, topology, values, components, arrows, skin })
    }

    /// Takes energies, probes and what tools feel where that is due.
    fn measure(&mut self, loaded: &Loaded, simulation: &mut Simulation, running: bool) -> Result<(), Error> {
        let now = (simulation.step_count(), simulation.time());
        let due = self.measured.at.is_none() || !running || self.states.is_multiple_of(MEASURED);
        if !due || self.measured.at == Some(now) {
            return Ok(());
        }
        self.measured.at = Some(now);
        self.measured.energies = simulation.energies()?;
        self.measured.probes =
            loaded.probes.iter().map(|(name, _)| simulation.probe(name)).collect::<Result<_, _>>()?;
        for name in loaded.scene.scene.tools.keys() {
            self.measured.tools.insert(name.clone(), simulation.tool(name)?);
        }
        Ok(())
    }

    fn tool(&self, name: &str, simulation: &mut Simulation) -> ToolState {
        let [place, turn] = way_of(simulation.world_mut(), name, false);
        let rotation = turned(turn);
        let felt = self.measured.tools.get(name).cloned().unwrap_or_default();
        ToolState { name: name.into(), place, rotation, felt }
    }
}

fn body(name: &str, simulation: &mut Simulation) -> Result<Body, Error> {
    let entity = simulation.body(name)?;
    let rest = simulation.rest_positions(name)?;
    let on_gpu = simulation.gpu_column::<Displacement>(name)?;
    let world = simulation.world();
    let authoring =
        world.get::<Authoring>(entity).cloned().ok_or_else(|| crate::error::missing("a body's numbering"))?;
    let axes = world.get::<ConstrainedAxes>(entity);
    let constrained = |row: &u32| axes.map_or(0, |axes| axes[*row as usize]);
    let label = |block: &Entity| world.get::<Label>(world.get::<Block>(*block)?.material);
    let of_block = |block: &Entity| label(block).map(|label| label.0.clone()).unwrap_or_default();
    let of_blocks: Vec<String> = authoring.blocks.iter().map(of_block).collect();
    let mut materials = of_blocks.clone();
    materials.sort_unstable();
    materials.dedup();
    let place = |(block, _): &(u32, u32)| materials.binary_search(&of_blocks[*block as usize]).unwrap_or(0) as u32;
    let element_materials = authoring.element_rows.iter().map(place).collect();
    Ok(Body {
        element_materials,
        materials,
        on_gpu,
        sets: authoring.sets,
        name: name.into(),
        rest: rest.into_iter().map(|place| place.as_vec3().to_array()).collect(),
        constrained: authoring.node_rows.iter().map(constrained).collect(),
        cells: authoring.cells,
        nodes: authoring.node_ids,
        elements: authoring.element_ids,
    })
}

#[cfg(test)]
mod tests;
