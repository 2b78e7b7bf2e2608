//! Which search for equilibrium a study goes by: the one that takes fewer passes over all forces.

use super::Engine;
use super::calibration::MORE_PASSES;
use super::march::{self, refusal};
use super::variant::variant;
use crate::accuracy::configuration::{Configuration, Factor};
use crate::accuracy::method::Method;
use crate::accuracy::solver::Refusal;
use glam::DVec3;
use sinew::Simulation;
use sinew::scene::schema::{Analysis, SearchMethod};

/// The share of the time left that each of the two searches may take.
const SHARE: f64 = 0.04;
/// Pseudo-steps between two looks at the clock.
const STEPS: u64 = 40;
/// Equilibria that are farther apart than this, as a share of the largest displacement, are two.
const SAME: f64 = 1e-2;

/// The search that a study goes by.
#[derive(Clone, Debug, Default)]
pub(super) struct Rest {
    /// In place of the scene's own.
    pub by: Option<SearchMethod>,
    /// The other one, where that was gone through, too.
    pub beside: Option<SearchMethod>,
    /// Why, in a sentence.
    pub note: Option<String>,
}

/// A search that came to its end.
struct Searched {
    passes: f64,
    displacements: Vec<Vec<DVec3>>,
}

impl Engine<'_> {
    /// Goes through both searches on the coarsest mesh that stands for the others, and counts. Where one does not end,
    /// or ends elsewhere, the scene's own remains.
    pub(super) fn choose_rest(&mut self, own: &Configuration) -> Result<Rest, Refusal> {
        let Analysis::Static(search) = &self.file.scene.analysis else { return Ok(Rest::default()) };
        if search.arc.is_some() {
            return Ok(Rest::default());
        }
        let single = self.single_layers();
        let mesh = self.sound_meshes()?.into_iter().find(|mesh| !single.contains(mesh)).unwrap_or(Factor::ONE);
        let other = match search.method {
            SearchMethod::Relaxation => SearchMethod::Newton,
            SearchMethod::Newton => SearchMethod::Relaxation,
        };
        let Some(first) = self.searched(own, mesh, search.method)? else { return Ok(Rest::default()) };
        let Some(second) = self.searched(own, mesh, other)? else { return Ok(Rest::default()) };
        let at = match mesh == Factor::ONE {
            true => String::new(),
            false => format!(" (counted with {mesh} the cells)"),
        };
        let [name, other_name] = [search.method, other].map(|method| Method::Rest(method).to_string());
        let apart = apart(&first.displacements, &second.displacements);
        if apart.is_nan() || apart > SAME {
            let note = format!(
                "{other_name} ends {:.1} % from where {name} does: rest is as the scene has it{at}",
                100.0 * apart
            );
            return Ok(Rest { note: Some(note), ..Rest::default() });
        }
        let [of_own, of_other] =
            [(search.method, &first), (other, &second)].map(|(method, found)| found.passes * growth(method, mesh));
        let cheaper = of_other < of_own;
        let (by, fewer, than, more) =
            if cheaper { (&other_name, of_other, &name, of_own) } else { (&name, of_own, &other_name, of_other) };
        let note = format!("rest by {by}: {fewer:.0} passes over all forces, {than} takes {more:.0}{at}");
        let (by, beside) = if cheaper { (Some(other), search.method) } else { (None, other) };
        Ok(Rest { by, beside: Some(beside), note: Some(note) })
    }

    /// A search on a mesh, if it comes to its end in its share of the time.
    fn searched(&self, own: &Configuration, mesh: Factor, method: SearchMethod) -> Result<Option<Searched>, Refusal> {
        let share = SHARE * self.time_left();
        let configuration = Configuration { mesh, method: Method::Rest(method), ..own.clone() };
        let scene = variant(self.file, &configuration, None);
        let Ok(mut simulation) = Simulation::new(&scene, &self.options(&configuration)) else { return Ok(None) };
        let (most, mut taken) = (simulation.planned_steps(), 0.0);
        while !simulation.is_finished() && simulation.step_count() < most {
            self.check_time()?;
            match march::timed(&mut simulation, STEPS) {
                Ok(seconds) => taken += seconds,
                Err(Refusal::Interrupted) => return Err(Refusal::Interrupted),
                Err(_) => return Ok(None),
            }
            if taken > share {
                return Ok(None);
            }
        }
        if !simulation.equilibrium().is_some_and(|found| found.reached) {
            return Ok(None);
        }
        let passes = simulation.step_count() + simulation.implicit_steps().map_or(0, |took| took.passes);
        let bodies: Vec<String> = scene.scene.bodies.keys().cloned().collect();
        let displacements = bodies.iter().map(|body| simulation.displacements(body));
        let displacements = displacements.collect::<Result<_, _>>().map_err(refusal)?;
        Ok(Some(Searched { passes: passes as f64, displacements }))
    }
}

/// How many times as many passes a search takes on the scene's own mesh as on one of a factor: waves of relaxation take
/// a step a cell.
fn growth(method: SearchMethod, mesh: Factor) -> f64 {
    let finer = 1.0 / mesh.value();
    match method {
        SearchMethod::Relaxation => finer,
        SearchMethod::Newton => finer.powf(MORE_PASSES),
    }
}

/// The largest distance of two fields, as a share of the largest displacement.
fn apart(one: &[Vec<DVec3>], other: &[Vec<DVec3>]) -> f64 {
    let (mut apart, mut largest) = (0.0_f64, 0.0_f64);
    for (a, b) in one.iter().flatten().zip(other.iter().flatten()) {
        if !(a.is_finite() && b.is_finite()) {
            return f64::NAN;
        }
        (apart, largest) = (apart.max(a.distance(*b)), largest.max(a.length()));
    }
    if largest > 0.0 { apart / largest } else { apart }
}
