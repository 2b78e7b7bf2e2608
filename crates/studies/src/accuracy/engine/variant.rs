//! From a configuration to the scene that it means.

use super::effects::switch_off;
use super::ladder::climb;
use crate::accuracy::configuration::{Configuration, Digits, Factor, Processor};
use crate::accuracy::method::Method;
use sinew::mesh::{CellKind, ElementKind};
use sinew::scene::SceneFile;
use sinew::scene::schema::{Analysis, Axis, Constraint, InitialState, MeshSource, Probe, Quantity, Scene, Select};

/// The residual that searches for equilibrium in f64 end with.
const TOLERANCE: f64 = 1e-8;

/// How the mesh of a body is made finer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finer {
    /// By other numbers of cells: round shapes stay round.
    Cells,
    /// By cutting its elements: files, and bodies of which something is named by number.
    Cut,
}

/// How the meshes of a scene can be made finer: all bodies in one way, so that one factor means the same everywhere.
pub fn finer(scene: &Scene) -> Finer {
    let files = scene.bodies.values().any(|body| matches!(body.mesh, MeshSource::File { .. }));
    if files || scene.selections().any(|select| by_number(select, true)) { Finer::Cut } else { Finer::Cells }
}

/// Whether elements are named by number: another kind of them has other numbers.
pub fn names_elements(scene: &Scene) -> bool {
    scene.selections().any(|select| by_number(select, false))
}

fn by_number(select: &Select, or_nodes: bool) -> bool {
    match select {
        Select::Elements(_) => true,
        Select::Nodes(_) => or_nodes,
        Select::And(all) | Select::Or(all) => all.iter().any(|one| by_number(one, or_nodes)),
        Select::Not(one) => by_number(one, or_nodes),
        _ => false,
    }
}

/// The cells of a generated mesh along its directions.
pub fn cells(mesh: &MeshSource) -> Vec<u32> {
    match mesh {
        MeshSource::File { .. } => Vec::new(),
        MeshSource::Box { cells, .. } | MeshSource::Hexahedron { cells, .. } | MeshSource::Tube { cells, .. } => {
            vec![cells.0, cells.1, cells.2]
        }
        MeshSource::Cylinder { across, along, .. } => vec![*across, *along],
        MeshSource::Ellipsoid { across, .. } => vec![*across],
        MeshSource::Lens { across, through, .. } => vec![*across, *through],
    }
}

/// Whether a generated mesh can have so many times its cells and keep its shape: a lens of an odd number of cells
/// through has no sharp rim.
pub fn divides(mesh: &MeshSource, factor: Factor) -> bool {
    let whole = cells(mesh).into_iter().all(|count| factor.times(count).is_some());
    let rim = match mesh {
        MeshSource::Lens { through, .. } => factor.times(*through).is_some_and(|new| new % 2 == *through % 2),
        _ => true,
    };
    whole && (rim || factor > Factor::ONE)
}

/// Gives a scene other meshes. Factors have been chosen so that cells stay whole.
fn remesh(scene: &mut Scene, factor: Factor, element: Option<ElementKind>) {
    let way = finer(scene);
    for body in scene.bodies.values_mut() {
        if way == Finer::Cut {
            body.refine += factor.up.max(1).ilog2();
        }
        let times = |count: &mut u32| {
            *count = if way == Finer::Cells { factor.times(*count).unwrap_or(*count) } else { *count };
        };
        let elements = match &mut body.mesh {
            MeshSource::File { tets, hexes, .. } => match element.map(|kind| kind.cell()) {
                Some(CellKind::Tet4) => tets,
                Some(CellKind::Hex8) => hexes,
                // nothing to choose
                _ => continue,
            },
            MeshSource::Box { cells, elements, .. }
            | MeshSource::Hexahedron { cells, elements, .. }
            | MeshSource::Tube { cells, elements, .. } => {
                [&mut cells.0, &mut cells.1, &mut cells.2].into_iter().for_each(times);
                elements
            }
            MeshSource::Cylinder { across, along, elements, .. } => {
                [across, along].into_iter().for_each(times);
                elements
            }
            MeshSource::Ellipsoid { across, elements, .. } => {
                times(across);
                elements
            }
            MeshSource::Lens { across, through, elements, .. } => {
                [across, through].into_iter().for_each(times);
                elements
            }
        };
        *elements = element.unwrap_or(*elements);
    }
}

/// The scene that a configuration means, with nothing observed on the way; `step` is the time step (s), `None` to have
/// it found.
pub fn variant(file: &SceneFile, configuration: &Configuration, step: Option<f64>) -> SceneFile {
    let mut file = file.clone();
    let scene = &mut file.scene;
    remesh(scene, configuration.mesh, configuration.element);
    for body in scene.bodies.values_mut() {
        body.hourglass *= configuration.hourglass;
    }
    if let Some(viscous) = configuration.viscous {
        scene.materials.values_mut().filter_map(|m| m.prony.as_mut()).for_each(|prony| prony.integrator = viscous);
    }
    if let Some(law) = &configuration.law {
        climb(scene, law);
    }
    scene.integration.compensated = configuration.digits == Digits::Compensated;
    configuration.method.apply(scene, step);
    if let Some(effect) = &configuration.without {
        switch_off(scene, effect);
    }
    // what is left of the way to rest must not be taken for an error of the mesh
    let sharpen = |tolerance: &mut Option<f64>| {
        if configuration.digits == Digits::Double {
            *tolerance = Some(tolerance.map_or(TOLERANCE, |asked| asked.min(TOLERANCE)));
        }
    };
    if let Analysis::Static(search) = &mut scene.analysis {
        sharpen(&mut search.tolerance);
    }
    if let InitialState::Equilibrium(search) = &mut scene.start {
        sharpen(&mut search.tolerance);
    }
    scene.output.fields_every = Some(scene.duration);
    scene.output.energies_every = None;
    for (name, probe, _) in reactions(scene) {
        scene.probes.insert(name, probe);
    }
    for probe in scene.probes.values_mut() {
        probe.every = Some(scene.duration);
    }
    file
}

/// Probes for the reactions of constraints that no probe of the scene observes: name, probe, and the axes that are
/// held.
pub fn reactions(scene: &Scene) -> Vec<(String, Probe, Vec<Axis>)> {
    let mut found = Vec::new();
    let many = scene.constraints.len() > 1;
    for (number, constraint) in scene.constraints.iter().enumerate() {
        let (Constraint::Fixed { body, on, axes } | Constraint::Prescribed { body, on, axes, .. }) = constraint;
        let same =
            |probe: &Probe| probe.what == Quantity::Reaction && probe.on.as_ref() == Some(on) && probe.body == *body;
        let name = if many { format!("reaction{number}") } else { "reaction".into() };
        if !scene.probes.values().any(same) && !scene.probes.contains_key(&name) {
            let probe =
                Probe { body: body.clone(), what: Quantity::Reaction, on: Some(on.clone()), every: None, peak: false };
            found.push((name, probe, axes.clone()));
        }
    }
    found
}

/// The scene as it is written, as a configuration; `element` is the kind of all its elements, if they are of one.
pub fn written(scene: &Scene, element: Option<ElementKind>, double: bool, place: Processor) -> Configuration {
    let digits = match (double, scene.integration.compensated) {
        (true, _) => Digits::Double,
        (false, true) => Digits::Compensated,
        (false, false) => Digits::Plain,
    };
    let mut viscous: Vec<_> = scene.materials.values().filter_map(|m| Some(m.prony.as_ref()?.integrator)).collect();
    viscous.dedup();
    Configuration {
        element,
        mesh: Factor::ONE,
        step: 1,
        method: Method::of(scene),
        digits,
        hourglass: 1.0,
        viscous: if let [one] = viscous[..] { Some(one) } else { None },
        law: None,
        place,
        without: None,
    }
}
