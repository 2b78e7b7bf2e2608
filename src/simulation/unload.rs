//! The unloaded shape of bodies whose meshes show them loaded, as scans do: X such that the equilibrium under the loads
//! stands where the mesh has its nodes.
//!
//! The fixed-point iteration X ← X − (x(X) − x̄) of Sellier 2011, x̄ the loaded shape and x(X) the equilibrium of a
//! body with the rest shape X, made faster by least squares over what the last iterations did (Anderson 1965; for blood
//! vessels Bols et al. 2013). Of one iteration back that is Aitken's rule, with which Rausch, Genet & Humphrey 2017 do
//! it; five take a third of the iterations.

use super::preload::at_rest;
use super::{Options, Simulation};
use crate::error::{Error, NotUnloaded};
use crate::scene::schema::{Analysis, EquilibriumSearch, InitialState, Load};
use crate::scene::{Diagnostics, SceneFile};
use glam::DVec3;
use std::collections::BTreeMap;

/// How many iterations are looked back at.
const BACK: usize = 5;
/// How often in a row a rest shape that no equilibrium is found of is moved half of the way back.
const MOST_HALVINGS: usize = 5;
/// Iterations in which the largest distance must become less.
const PATIENCE: usize = 8;

/// How an unloaded shape is sought.
#[derive(Clone, Copy, Debug)]
pub struct Unloading {
    /// How far loaded nodes may be from where they should be at most, as a share of the bodies' size (the diagonal of
    /// the box around them).
    pub tolerance: f64,
    /// Static analyses at most.
    pub most: usize,
}

impl Default for Unloading {
    fn default() -> Self {
        Self { tolerance: 1e-4, most: 40 }
    }
}

/// One iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnloadingStep {
    /// Its number, from 1.
    pub number: usize,
    /// The largest distance of a loaded node from where it should be (m).
    pub largest: f64,
    /// The root mean square of all distances (m).
    pub mean_square: f64,
    /// Pseudo-steps of the static analysis.
    pub steps: u64,
}

/// An unloaded shape.
#[derive(Clone, Debug)]
pub struct Unloaded {
    /// Where the nodes of each body are at rest (m), in the author's order.
    pub rest: BTreeMap<String, Vec<DVec3>>,
    /// All iterations; the last is that of `rest`.
    pub iterations: Vec<UnloadingStep>,
    /// How far nodes may be from where they should be (m).
    pub allowed: f64,
}

/// Positions of all bodies' nodes, one after the other.
type Shape = Vec<DVec3>;

/// Finds the unloaded shape of all bodies of a scene whose meshes show them loaded: by what acts at t = 0, or where the
/// scene is a static analysis at its time. `tell` is called after each iteration.
///
/// # Errors
/// What is wrong with the scene, also that no load acts then; that none was found, with the distance that was reached;
/// what the GPU says.
pub fn unload(
    scene: &SceneFile,
    options: &Options,
    how: &Unloading,
    mut tell: impl FnMut(&UnloadingStep),
) -> Result<Unloaded, Error> {
    let mut file = scene.clone();
    if file.scene.start == InitialState::Undeformed {
        file.scene.start = InitialState::Equilibrium(EquilibriumSearch::default());
    }
    file.scene = at_rest(&file.scene).unwrap_or(file.scene);
    file.scene.bodies.values_mut().for_each(|body| body.rest_shape = None);
    file.rest_shapes.clear();
    let mut search = Search::of(file, options, how)?;
    let mut iterations: Vec<UnloadingStep> = Vec::new();
    while iterations.len() < how.most {
        let Some(step) = search.evaluate(&iterations)? else { continue };
        tell(&step);
        iterations.push(step);
        if step.largest <= search.allowed {
            if iterations.len() == 1
                && let Some(idle) = no_load(&search.file)
            {
                return Err(idle.into());
            }
            return Ok(Unloaded { rest: search.by_body(), iterations, allowed: search.allowed });
        }
        search.improve();
        let best = |steps: &[UnloadingStep]| steps.iter().map(|step| step.largest).fold(f64::INFINITY, f64::min);
        if let Some(before) = iterations.len().checked_sub(PATIENCE).filter(|&before| before > 0)
            && best(&iterations[before..]) >= best(&iterations[..before])
        {
            let why = "it has not become less for a while: the loaded shape may be one that no rest shape has an equilibrium in";
            return Err(search.given_up(&iterations, why.into()));
        }
    }
    Err(search.given_up(&iterations, "it may become less with more iterations".into()))
}

/// What is wrong where no load acts at the time that is looked at: the mesh would be at rest as it is.
fn no_load(file: &SceneFile) -> Option<Diagnostics> {
    let scene = &file.scene;
    let Analysis::Static(EquilibriumSearch { at, .. }) = scene.analysis else { return None };
    let time = at.unwrap_or(scene.duration);
    let begins_later = |load: &Load| load.curve().value(time) == 0.0;
    if !scene.loads.iter().all(begins_later) {
        return None;
    }
    let (path, note) = match scene.loads.is_empty() {
        true => ("loads", "name what acted while the mesh was measured, such as its weight"),
        false => (
            "loads[0].curve",
            "by their curves loads are 0 then: leave `curve` out of what acted while the mesh was measured",
        ),
    };
    let mut diagnostics = file.diagnostics();
    let message = format!("no load acts at t = {time} s: the unloaded shape is the mesh as it is");
    diagnostics.error_at(path, message).note(note);
    Some(diagnostics)
}

/// The search at work.
struct Search<'a> {
    file: SceneFile,
    options: &'a Options,
    /// How many nodes each body has, by name.
    nodes: BTreeMap<String, usize>,
    loaded: Shape,
    rest: Shape,
    /// The last rest shapes and their x(X) − x̄, the present one last.
    tried: Vec<(Shape, Shape)>,
    halvings: usize,
    allowed: f64,
}

impl<'a> Search<'a> {
    fn of(file: SceneFile, options: &'a Options, how: &Unloading) -> Result<Self, Error> {
        let mut simulation = Simulation::new(&file, options)?;
        let (mut loaded, mut nodes) = (Shape::new(), BTreeMap::new());
        for name in file.scene.bodies.keys() {
            let points = simulation.rest_positions(name)?;
            nodes.insert(name.clone(), points.len());
            loaded.extend(points);
        }
        let (low, high) = crate::mesh::extent(loaded.iter().copied());
        let allowed = how.tolerance * (high - low).length();
        let rest = loaded.clone();
        Ok(Self { file, options, nodes, loaded, rest, tried: Vec::new(), halvings: 0, allowed })
    }

    fn by_body(&self) -> BTreeMap<String, Vec<DVec3>> {
        let mut left = self.rest.as_slice();
        let mut take = |count: usize| {
            let (own, others) = left.split_at(count.min(left.len()));
            left = others;
            own.to_vec()
        };
        self.nodes.iter().map(|(name, &count)| (name.clone(), take(count))).collect()
    }

    /// Finds how far the equilibrium of the present rest shape is from the loaded one; `None` where there is none and
    /// the shape has been moved half of the way back.
    fn evaluate(&mut self, iterations: &[UnloadingStep]) -> Result<Option<UnloadingStep>, Error> {
        let (placed, steps) = match self.equilibrium() {
            Ok(found) => found,
            Err(error @ (Error::Scene(_) | Error::NotConverged(_) | Error::Unstable(_))) => {
                let Some((before, _)) = self.tried.last().filter(|_| self.halvings < MOST_HALVINGS) else {
                    return Err(
                        self.given_up(iterations, format!("a rest shape on the way has no equilibrium: {error}"))
                    );
                };
                self.rest.iter_mut().zip(before).for_each(|(x, before)| *x = 0.5 * (*x + *before));
                self.halvings += 1;
                return Ok(None);
            }
            Err(other) => return Err(other),
        };
        if self.halvings > 0 {
            // what led non_finite is no guide
            self.tried.clear();
            self.halvings = 0;
        }
        let distances: Shape = placed.iter().zip(&self.loaded).map(|(x, loaded)| *x - *loaded).collect();
        let lengths = || distances.iter().map(|d| d.length());
        let largest = lengths().fold(0.0, |most: f64, length| if length <= most { most } else { length });
        let square = lengths().map(|length| length * length).sum::<f64>() / distances.len().max(1) as f64;
        if !largest.is_finite() {
            return Err(self.given_up(iterations, "nodes went to no finite place".into()));
        }
        self.tried.push((self.rest.clone(), distances));
        if self.tried.len() > BACK + 1 {
            self.tried.remove(0);
        }
        let number = iterations.len() + 1;
        Ok(Some(UnloadingStep { number, largest, mean_square: square.sqrt(), steps }))
    }

    /// Moves the rest shape by its distances, less what the changes before show to be undone by that: those weights of
    /// changes that leave the least of the distances.
    fn improve(&mut self) {
        let Some(((rest, distances), earlier)) = self.tried.split_last() else { return };
        let changes: Vec<(Shape, Shape)> = earlier
            .iter()
            .zip(&self.tried[1..])
            .map(|(a, b)| (difference(&b.0, &a.0), difference(&b.1, &a.1)))
            .collect();
        let products = changes.iter().map(|(_, a)| changes.iter().map(|(_, b)| dot(a, b)).collect()).collect();
        let weights = solve(products, changes.iter().map(|(_, change)| dot(change, distances)).collect());
        let mut next: Shape = rest.iter().zip(distances).map(|(x, distance)| *x - *distance).collect();
        for (weight, (moved, change)) in weights.into_iter().zip(&changes) {
            next.iter_mut().zip(moved).zip(change).for_each(|((x, moved), change)| *x -= weight * (*moved - *change));
        }
        self.rest = next;
    }

    /// Where the nodes of the present rest shape are in equilibrium (m), and how many pseudo-steps led there.
    fn equilibrium(&mut self) -> Result<(Shape, u64), Error> {
        self.file.rest_shapes = self.by_body();
        let mut simulation = Simulation::new(&self.file, self.options)?;
        simulation.finish()?;
        let mut placed = Shape::new();
        for name in self.nodes.keys() {
            let (rest, moved) = (simulation.rest_positions(name)?, simulation.displacements(name)?);
            placed.extend(rest.iter().zip(&moved).map(|(x, u)| *x + *u));
        }
        Ok((placed, simulation.step_count()))
    }

    fn given_up(&self, iterations: &[UnloadingStep], why: String) -> Error {
        let largest = iterations.iter().map(|step| step.largest).fold(f64::INFINITY, f64::min);
        Error::NotUnloaded(Box::new(NotUnloaded { iterations: iterations.len(), largest, allowed: self.allowed, why }))
    }
}

fn difference(a: &[DVec3], b: &[DVec3]) -> Shape {
    a.iter().zip(b).map(|(a, b)| *a - *b).collect()
}

fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// Solves a small symmetric system by elimination with pivots; unknowns that it says nothing of are 0.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    let largest = matrix.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut solved = vec![0.0; size];
    let mut left: Vec<usize> = (0..size).collect();
    let mut order = Vec::new();
    // the diagonal holds the largest of what is left of such a matrix
    while let Some(pivot) = left.iter().copied().max_by(|&a, &b| matrix[a][a].total_cmp(&matrix[b][b])) {
        left.retain(|&row| row != pivot);
        if matrix[pivot][pivot] <= 1e-12 * largest {
            continue;
        }
        for &row in &left {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            (0..size).for_each(|column| matrix[row][column] -= factor * matrix[pivot][column]);
            right[row] -= factor * right[pivot];
        }
        order.push(pivot);
    }
    for &row in order.iter().rev() {
        let known: f64 =
            (0..size).filter(|&column| column != row).map(|column| matrix[row][column] * solved[column]).sum();
        solved[row] = (right[row] - known) / matrix[row][row];
    }
    solved
}

#[cfg(test)]
mod tests;
