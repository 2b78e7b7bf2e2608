//! Input that cannot be.

use super::super::Trial;
use bevy_ecs::prelude::*;
use glam::DVec3;
use sinew::Error;
use sinew::components::{Authoring, Clock, ExternalForce};
use sinew::systems::{Phase, Registry, System};

/// H28.
pub fn bad_numbers(trial: &mut Trial<'_>) -> Result<(), Error> {
    let of_steps = [
        ("an implicit step of 0", "solver=Implicit(step: 0)", ["step", "above 0"]),
        ("an implicit step below 0", "solver=Implicit(step: -1)", ["step", "above 0"]),
        ("an implicit step that is no number", "solver=Implicit(step: NaN)", ["step", "NaN"]),
        ("no iteration of Newton's", "solver=Implicit(newton: 0)", ["newton", "at least 1"]),
        ("a tolerance of 1", "solver=Implicit(tolerance: 1)", ["tolerance", "below 1"]),
        ("no pass in a step", "solver=Implicit(budget: 0)", ["budget", "at least 3"]),
        ("a share above 1", "solver=Implicit(scheme: GeneralizedAlpha(high_frequencies: 2))", ["from 0 to 1", "2"]),
    ];
    let of_steps = if trial.is_implicit() { &of_steps[..] } else { &[] };
    for &(what, set, words) in of_steps {
        let made = trial.start(&[set.to_string()]);
        trial.refused(what, made, &words);
    }
    for (what, set, words) in [
        ("no density", "materials.tissue.density=0", ["density", "above 0"]),
        ("a density below 0", "materials.tissue.density=-1", ["density", "above 0"]),
        ("a shear modulus below 0", "materials.tissue.neo_hookean=Moduli(shear: -1, bulk: 1)", ["shear", "above 0"]),
        ("Poisson's ratio of a half", "materials.tissue.neo_hookean=Young(young: 1, poisson: 0.5)", ["poisson", "0.5"]),
        ("a step of 0", "integration.step=0", ["step", "above 0"]),
        ("a step below 0", "integration.step=-1", ["step", "above 0"]),
        ("a mesh of no cells", "bodies.body.mesh.cells=(0, 1, 1)", ["cells", "0"]),
        ("no duration", "duration=0", ["duration", "above 0"]),
        ("a density that is no number", "materials.tissue.density=NaN", ["density", "NaN"]),
        ("an infinite modulus", "materials.tissue.neo_hookean=Moduli(shear: inf, bulk: 1)", ["shear", "inf"]),
    ] {
        // which implicit steps do without
        if trial.is_implicit() && set.starts_with("integration") {
            continue;
        }
        let made = trial.start(&[set.to_string()]);
        trial.refused(what, made, &words);
    }
    Ok(())
}

/// Writes what is no number on one node, in the third step.
fn poison(clock: Res<Clock>, mut bodies: Query<(&Authoring, &mut ExternalForce)>) {
    for (authoring, mut force) in &mut bodies {
        if clock.step == 3 {
            force.set_vector(authoring.node_rows[POISONED] as usize, DVec3::splat(f64::NAN));
        }
    }
}

/// The node, in the author's order.
const POISONED: usize = 21;

/// H27.
pub fn not_a_number(trial: &mut Trial<'_>) -> Result<(), Error> {
    let made = trial.start(&["materials.tissue.neo_hookean=Young(young: NaN, poisson: 0.45)".into()]);
    trial.refused("a modulus that is no number", made, &["young", "NaN"]);
    let mesh = "# vtk DataFile Version 3.0\na tetrahedron\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0\n1 0 0\n0 nan 0\n0 0 1\n\
                CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
    let made = trial.start_beside("bad.vtk", mesh, &["bodies.body.mesh=File(path: \"bad.vtk\")".into()]);
    trial.refused("a coordinate that is no number", made, &["bad.vtk", "NaN"]);

    let registry = Registry::default().with(System::custom("poison", Phase::Loads, "writes no number", poison));
    let mut simulation = trial.start_with(&[], &registry)?;
    let ended = simulation.finish();
    trial.stops("a custom system's write", ended, &["not finite", &format!("node {POISONED}")]);
    let late = simulation.step_count();
    trial.most("steps until it is found", late as f64, 3.0 + sinew::observation::HOST_GUARD_STEPS as f64);
    Ok(())
}
