//! Parameters of a scene that change while it runs: those of materials, and the amplitudes of loads.
//!
//! What elements remember stays what it was: viscous stress is that of the past, and what elements hold more or less
//! with their new parameters is the program's, not motion's.

use super::Simulation;
use super::step_change::add_to_memory_by;
use super::stiffness::{StabilitySample, StiffnessTracker};
use crate::assembly::renew_materials;
use crate::backend::block_kernel::{law_numbers, law_uniforms};
use crate::backend::cpu::BlockLaw;
use crate::backend::device::{Device, bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::materials::PronyTerm;
use crate::observation::held_for_long;
use crate::scene::schema::{Scene, WhenUnstable};
use crate::scene::{SceneFile, other_than_parameters, validate};
use bevy_ecs::prelude::*;

/// What is changed on the host.
fn is_written(column: &ColumnAccess) -> bool {
    matches!(column.subject, Subject::Shape | Subject::Memory)
}

/// What is read there: the same, and what it follows from.
fn is_read(column: &ColumnAccess) -> bool {
    is_written(column) || column.subject == Subject::Motion
}

impl Simulation {
    /// Changes parameters from the next step on, by their places in the scene and in the words of `--set`:
    /// `"materials.liver.neo_hookean=Young(young: 5e3, poisson: 0.45)"`, `"loads[0].acceleration=(0, 0, -3.7)"`. They
    /// are those of elastic laws, `fibres` and `exponential_fibres` (not their directions), `per_copy` of bodies of the
    /// same, and what loads are: all in the scene's units. All of it is read and checked as the scene was, and the
    /// stable step is found anew where materials change, for some tens of steps' time.
    ///
    /// Snapshots hold what was changed, and going back takes it back. Nodes stay where they are: a load that changes
    /// acts in full from the next step on, and what elements hold more or less afterwards counts as if they had begun
    /// so.
    ///
    /// # Errors
    /// What is wrong with the scene as it would be; anything else that would change, effects and loads among it that
    /// had no weight when the simulation was made, and values that a program put into the scene beside its text; a
    /// material too stiff for a step that stays; a static analysis: then nothing has changed. What the GPU says.
    pub fn change(&mut self, sets: &[String]) -> Result<(), Error> {
        if self.scene.is_static() {
            return Err(Error::Options("a static analysis takes its materials and loads from the scene".into()));
        }
        self.settle()?;
        let changed = self.read_changed(self.changed.as_deref().unwrap_or(self.file.text()), sets)?;
        if changed.scene == self.scene {
            return Ok(());
        }
        self.keep_start();
        let per_copy = |scene: &Scene| scene.bodies.values().map(|body| body.per_copy.clone()).collect::<Vec<_>>();
        let differs = per_copy(&changed.scene) != per_copy(&self.scene);
        if differs || changed.scene.materials != self.scene.materials {
            self.change_materials(&changed.scene)?;
        }
        if changed.scene.loads != self.scene.loads {
            self.world.resource_mut::<Signals>().renew_loads(&changed.scene.loads);
            let step = self.step_count();
            if let Some(follower) = self.solver.follower_mut() {
                follower.note_change(step, true);
            }
        }
        self.lineage.note(self.step_count(), changed.text());
        self.changed = Some(changed.text().into());
        self.scene = changed.scene;
        Ok(())
    }

    /// The scene from a text with values put in, if this one can become it.
    fn read_changed(&self, text: &str, sets: &[String]) -> Result<SceneFile, Error> {
        let changed = self.file.again(text, sets)?;
        let mut diagnostics = changed.diagnostics();
        validate(&changed, &mut diagnostics);
        if let Some(place) = other_than_parameters(&self.file.scene, &changed.scene) {
            diagnostics.error_at(place, "this cannot change while the scene runs").note(
                "parameters of elastic laws and fibres can, and amplitudes of loads, where they had a weight at first",
            );
        }
        if diagnostics.has_errors() { Err(diagnostics.into()) } else { Ok(changed) }
    }

    /// The text of the scene where it has been changed, for snapshots.
    pub(super) fn changed_text(&self) -> Option<String> {
        self.changed.clone()
    }

    /// Whether this scene can become that of a snapshot.
    pub(super) fn check_changed(&self, text: Option<&str>) -> Result<(), Error> {
        text.map_or(Ok(()), |text| self.read_changed(text, &[]).map(drop))
    }

    /// Goes on with the parameters of a snapshot, which have been checked and whose state is in the world.
    pub(super) fn take_up_changed(&mut self, text: Option<String>) -> Result<(), Error> {
        if text == self.changed {
            return Ok(());
        }
        let scene = match &text {
            Some(text) => self.read_changed(text, &[])?.scene,
            None => self.file.scene.clone(),
        };
        bring_to_host(&mut self.world, |_, name| column_is(name, is_read))?;
        self.renew(&scene)?;
        self.world.resource_mut::<Signals>().renew_loads(&scene.loads);
        (self.scene, self.changed) = (scene, text);
        send_to_device(&mut self.world, |_, name| column_is(name, is_written))
    }

    fn change_materials(&mut self, scene: &Scene) -> Result<(), Error> {
        let before = held_for_long(&mut self.world)?;
        bring_to_host(&mut self.world, |_, name| column_is(name, is_read))?;
        let changed = self.renew(scene)?;
        if let Err(refused) = self.find_stable_step() {
            let scene = self.scene.clone();
            self.renew(&scene)?;
            return Err(refused);
        }
        for (entity, law) in changed {
            remember_as_before(&mut self.world, entity, &law);
        }
        send_to_device(&mut self.world, |_, name| column_is(name, is_written))?;
        let more = held_for_long(&mut self.world)? - before;
        self.world.resource_mut::<GuardMemory>().at_start += more;
        if let Some(follower) = self.solver.follower_mut() {
            follower.check_soon();
        }
        Ok(())
    }

    /// Gives blocks the laws of a scene's materials, here and on a device. Those that have others now, with the laws
    /// before.
    fn renew(&mut self, scene: &Scene) -> Result<Vec<(Entity, BlockLaw<f64>)>, Error> {
        let changed = renew_materials(&self.file.scene, scene, &mut self.world);
        for (entity, _) in &changed {
            let entity = self.world.entity(*entity);
            let (Some(law), Some(label)) = (entity.get::<BlockLaw<f32>>(), entity.get::<Label>()) else { continue };
            let uniforms = law_uniforms(law, &label.0).into_iter().flatten().chain(law_numbers(law, &label.0));
            if let Some(mut device) = self.world.get_resource_mut::<Device>() {
                for (label, bytes) in uniforms {
                    device.rewrite(&label, &bytes)?;
                }
            }
        }
        Ok(changed)
    }

    /// Finds the stable step anew, of elements that are others now.
    ///
    /// # Errors
    /// That a step that stays is beyond it: then what is known is what it was. What the GPU says.
    fn find_stable_step(&mut self) -> Result<(), Error> {
        let Some(mut follower) = self.solver.lend_follower() else { return Ok(()) };
        let (found, shape) = (follower.found.clone(), follower.shape.take());
        let trackers = std::mem::replace(&mut follower.trackers, StiffnessTracker::all(&mut self.world));
        let mut seen = follower
            .trackers
            .iter_mut()
            .fold(StabilitySample::NOTHING, |seen, block| seen.and(block.sample(&self.world)));
        seen.square = seen.of_elements;
        let known = match follower.policy {
            WhenUnstable::Adapt | WhenUnstable::Watch => self.estimate(&mut follower, &mut seen),
            _ => self.find(&mut follower, &mut seen),
        };
        if let Ok(false) = known {
            follower.found.take(&seen);
        }
        follower.found.latest = seen.square;
        let loads = follower.loads();
        self.solver.take_back(follower);
        let fits = known.and_then(|_| {
            self.fits_the_step(&loads).map_err(|limit| {
                let step = self.time_step();
                Error::Options(format!(
                    "with so stiff a material the stable step is {limit:.3e} s, and the step is {step:.3e} s: let the step \
                     follow (when_unstable: Adapt)"
                ))
            })
        });
        if let (Err(_), Some(follower)) = (&fits, self.solver.follower_mut()) {
            (follower.found, follower.shape, follower.trackers) = (found, shape, trackers);
        }
        fits
    }
}

/// Viscous memories hold so many times the stress of the last step: what they stand for beside it stays, as the stress
/// becomes that of the present law.
fn remember_as_before(world: &mut World, entity: Entity, before: &BlockLaw<f64>) {
    let Some(now) = world.get::<BlockLaw<f64>>(entity).cloned() else { return };
    // what each term remembers is the same for both
    let times = |law: &BlockLaw<f64>, sign: f64| law.with_terms(|_, _, term| PronyTerm::adding(sign * term.aim));
    add_to_memory_by(world, entity, times(before, -1.0));
    add_to_memory_by(world, entity, times(&now, 1.0));
}
