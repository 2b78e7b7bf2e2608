//! A reference from finer and finer meshes: each of twice the cells of the one before, as fine as time allows.

use super::configuration::{Configuration, Digits, Factor, Processor};
use super::estimate::Refined;
use super::plan::{Fate, Planned, Varied};
use super::reference::Reference;
use super::solver::{Choices, Refusal, Solution, Solver};
use super::study::Row;
use sinew::mesh::ElementKind;

/// How many meshes are extrapolated.
const ENOUGH: usize = 3;

/// How the scene is solved on the meshes of a reference: its own way, so that these runs are rows of the study too,
/// with two exceptions. Tetrahedra that lock get a pressure at their nodes. Searches for rest are made in f64, where
/// what the search leaves undone cannot be taken for an error of the mesh.
pub fn way(choices: &Choices, mesh: Factor) -> Configuration {
    let base = &choices.base;
    let pressure = Some(ElementKind::Tet4NodalPressure).filter(|kind| choices.elements.contains(kind));
    let element = pressure.filter(|_| base.element == Some(ElementKind::Tet4)).or(base.element);
    let mut configuration = Configuration { element, mesh, ..base.clone() };
    if choices.steps.is_empty() {
        (configuration.digits, configuration.place) = (Digits::Double, Processor::Cpu);
    }
    configuration
}

/// Adds the meshes that a reference can be made of to `rows`, where they are not there yet.
///
/// # Errors
/// That somebody wants the study to end.
pub fn add(solver: &mut dyn Solver, choices: &Choices, rows: &mut Vec<Planned>) -> Result<(), Refusal> {
    for mesh in choices.meshes.iter().copied().filter(|&mesh| is_doubling(mesh)) {
        let configuration = way(choices, mesh);
        if rows.iter().all(|row| row.configuration != configuration) {
            rows.push(Planned::of(solver, Varied::Refinement, configuration, &choices.base)?);
        }
    }
    Ok(())
}

fn is_doubling(mesh: Factor) -> bool {
    mesh.up.is_power_of_two() && mesh.down.is_power_of_two()
}

/// The rows of a plan that a reference is made of, from the coarsest on, as fine as fits into `share` (s): three meshes
/// that end with the scene's own or a finer one; else two such; else three or two coarser ones.
pub fn choose(choices: &Choices, rows: &[Planned], share: f64) -> Result<Vec<usize>, String> {
    let all = places(choices, rows.iter().map(|row| &row.configuration));
    let cost = |place: usize| match rows[place].fate {
        Fate::Run(cost) | Fate::LeftOut(cost) => cost.seconds,
        Fate::Refused(_) => f64::INFINITY,
    };
    let layers = |place: &usize| !choices.single_layers.contains(&rows[*place].configuration.mesh);
    let thick: Vec<usize> = all.iter().copied().filter(layers).collect();
    let written = |set: &[usize]| set.last().is_some_and(|&last| rows[last].configuration.mesh >= Factor::ONE);
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for (list, many) in [(&thick, ENOUGH), (&all, 2)] {
        let finest_first = list.windows(many).rev().map(<[usize]>::to_vec);
        sets.extend(finest_first.filter(|set| doublings(set.iter().map(|&place| rows[place].configuration.mesh))));
    }
    // of equal keys the order stays: three before two, finer before coarser
    sets.sort_by_key(|set| !written(set));
    let price = |set: &[usize]| set.iter().map(|&place| cost(place)).sum::<f64>();
    let least = sets.iter().map(|set| price(set)).fold(f64::INFINITY, f64::min);
    let found = sets.into_iter().find(|set| price(set) <= share);
    found.ok_or_else(|| match least.is_finite() {
        true => format!("the two coarsest meshes take {least:.1} s"),
        false => "the meshes of the scene come in one size only".into(),
    })
}

/// The mesh of twice the cells of that at `place`, in the way of a reference.
pub fn finer(choices: &Choices, rows: &[Planned], place: usize) -> Option<usize> {
    let wanted = way(choices, rows[place].configuration.mesh.times_two());
    rows.iter().position(|row| row.configuration == wanted)
}

/// Of rows that ran, those that a reference can be made of: the three finest of which each has twice the cells of the
/// one before, or two.
fn finished(choices: &Choices, rows: &[&Row]) -> Vec<usize> {
    let all = places(choices, rows.iter().map(|row| &row.configuration));
    let done: Vec<usize> = all.into_iter().filter(|&place| rows[place].measured().is_some()).collect();
    let mesh = |place: &usize| rows[*place].configuration.mesh;
    let thick: Vec<usize> =
        done.iter().copied().filter(|place| !choices.single_layers.contains(&mesh(place))).collect();
    let best = |list: &[usize], many: usize| {
        let mut sets = list.windows(many).rev();
        sets.find(|set| doublings(set.iter().map(mesh))).map(<[usize]>::to_vec)
    };
    let (three, two) = (best(&thick, ENOUGH), best(&done, 2));
    let finest = |set: &Option<Vec<usize>>| set.as_ref().and_then(|set| set.last().map(mesh));
    // two meshes of which the finer is the scene's own say more of it than three coarser ones
    let coarse = finest(&three) < finest(&two).filter(|&mesh| mesh <= Factor::ONE);
    if coarse { two } else { three.or(two) }.unwrap_or_default()
}

/// The runs that a reference is made of, if one is wanted.
pub fn refined(choices: &Choices, rows: &[Row], solutions: &[Option<Solution>], wanted: bool) -> Refined {
    let all: Vec<&Row> = rows.iter().collect();
    let places = if wanted { finished(choices, &all) } else { Vec::new() };
    let meshes = places.iter().map(|&place| rows[place].configuration.mesh).collect();
    let own = places.iter().filter_map(|&place| solutions[place].clone()).collect();
    Refined { places, meshes, solutions: own }
}

/// A reference from runs on finer and finer meshes. What they all have in common is no part of what they differ by:
/// rounding, and a step that does not become smaller with the cells, are added to its uncertainty.
pub fn made(refined: &Refined, choices: &Choices, rows: &[Row], solutions: &[Option<Solution>]) -> Option<Reference> {
    let sizes: Vec<f64> = refined.meshes.iter().map(|mesh| 1.0 / mesh.value()).collect();
    let list: Vec<&Solution> = refined.solutions.iter().collect();
    let way = rows.get(*refined.places.first()?).map(|row| &row.configuration)?;
    let meshes: Vec<String> = refined.meshes.iter().map(ToString::to_string).collect();
    let (element, digits) = (way.element_name(), way.digits);
    let told =
        format!("made here: meshes {} of {element}, {digits}, extrapolated to cells of no size", meshes.join(", "));
    let mut reference = Reference::of_meshes(&sizes, &list, told)?;
    if choices.touches {
        reference = reference.of_contact(&sizes, &list);
    }
    let solution = |is: &dyn Fn(&Row) -> bool| {
        rows.iter().zip(solutions).find(|(row, _)| is(row)).and_then(|(_, solution)| solution.as_ref())
    };
    let Some(written) = solution(&|row| row.varied == Varied::Nothing) else { return Some(reference) };
    let double = solution(&|row| row.varied == Varied::Digits && row.configuration.digits == Digits::Double);
    if let Some(double) = double.filter(|_| way.digits != Digits::Double) {
        reference = reference.blurred_by(written, double, 1.0);
    }
    let quarter = solution(&|row| row.varied == Varied::Step && row.configuration.step == 4);
    if let Some(quarter) = quarter.filter(|_| choices.step_is_fixed) {
        // of second order, a quarter of the step leaves a sixteenth of its error; of first order a quarter
        let times = 4f64.powi(way.method.order());
        reference = reference.blurred_by(written, quarter, times / (times - 1.0));
    }
    Some(reference)
}

/// Places of the configurations that a reference can be made of, by mesh.
fn places<'a>(choices: &Choices, all: impl Iterator<Item = &'a Configuration>) -> Vec<usize> {
    let fits = |one: &Configuration| is_doubling(one.mesh) && *one == way(choices, one.mesh);
    let mut found: Vec<(Factor, usize)> =
        all.enumerate().filter(|(_, one)| fits(one)).map(|(place, one)| (one.mesh, place)).collect();
    found.sort();
    found.into_iter().map(|(_, place)| place).collect()
}

/// Whether each mesh has twice the cells of the one before.
fn doublings(meshes: impl Iterator<Item = Factor>) -> bool {
    let list: Vec<Factor> = meshes.collect();
    list.windows(2).all(|pair| pair[0].times_two() == pair[1])
}
