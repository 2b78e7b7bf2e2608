//! A system on the host that says how stiff its forces are and what energy they hold: the stable step counts them as
//! those of a node system.

use sinew::prelude::*;
use sinew::scene::SceneFile;
use sinew::systems::ForceSlopes;
use std::path::Path;

/// A cube that hangs by the nodes of its upper side, on springs far stiffer than it.
const SCENE: &str = r#"(
    duration: 0.5,
    bodies: {"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: "tissue")},
    materials: {"tissue": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 60)},
    loads: [Gravity(acceleration: (0, 0, -9.81))],
    parameters: {"hanger": (height: 0.0999, stiffness: 1e8)},
    output: (energies_every: 0.1),
)"#;

/// Of the springs, over the mass (1/s²).
const STIFFNESS: f64 = 1e8;

#[derive(Resource, serde::Deserialize)]
#[serde(crate = "sinew::serde")]
struct Hanger {
    height: f64,
    stiffness: f64,
}

type Nodes<'w, 's, F> = Query<'w, 's, (&'static RestPosition, &'static Displacement, &'static Mass, F)>;

fn pull(hanger: Res<Hanger>, mut bodies: Nodes<&'static mut ExternalForce>) {
    for (rest, displacement, mass, mut force) in &mut bodies {
        for row in (0..rest.0.len()).filter(|&row| rest.0[row].z > hanger.height) {
            let sum = force.vector(row) - hanger.stiffness * mass.get(row) * displacement.vector(row);
            force.set_vector(row, sum);
        }
    }
}

fn slopes(hanger: Res<Hanger>) -> ForceSlopes {
    ForceSlopes { stiffness: hanger.stiffness, damping: 0.0 }
}

fn energy(hanger: Res<Hanger>, clock: Res<Clock>, bodies: Nodes<&'static DisplacementIncrement>) -> f64 {
    let of_body = |(rest, u, mass, step): (&RestPosition, &Displacement, &Mass, &DisplacementIncrement)| {
        let held = (0..rest.0.len()).filter(|&row| rest.0[row].z > hanger.height);
        let middle = |row: usize| u.vector(row) - clock.back_to_middle() * step.vector(row);
        held.map(|row| 0.5 * hanger.stiffness * mass.get(row) * middle(row).length_squared()).sum::<f64>()
    };
    bodies.iter().map(of_body).sum()
}

fn silent() -> System {
    System::custom("hanger", Phase::Loads, "holds what is high", pull).with_parameters::<Hanger>()
}

fn begun(hanger: System) -> Result<Simulation, Error> {
    let scene = SceneFile::from_text("hanger.ron", SCENE, Path::new("."), &[])
        .unwrap_or_else(|wrong| panic!("{}", wrong.render(false)));
    let options = Options { backend: BackendChoice::Cpu, ..Options::default() };
    Simulation::with_systems(&scene, &options, &Registry::default().with(hanger))
}

#[test]
fn a_stiff_spring_of_the_host_needs_no_step_of_the_scenes_own() {
    let mut simulation = begun(silent().with_slopes(slopes).with_energy(energy)).unwrap();
    // central differences of a spring alone are stable up to 2/√κ
    assert!(simulation.time_step() < 2.0 / STIFFNESS.sqrt(), "{}", simulation.time_step());
    simulation.finish().unwrap();
    let rest = simulation.rest_positions("cube").unwrap();
    let mass = simulation.masses("cube").unwrap();
    let moved = simulation.displacements("cube").unwrap();
    let upper = || (0..rest.len()).filter(|&node| rest[node].z > 0.0999);
    // κ m/8 δ = m g: an eighth of the mass is that of the upper side
    let hangs = 8.0 * 9.81 / STIFFNESS;
    let down = upper().map(|node| -mass[node] * moved[node].z).sum::<f64>() / upper().map(|n| mass[n]).sum::<f64>();
    assert!((down / hangs - 1.0).abs() < 0.01, "{down} of {hangs}");
    // at rest the middle of the step is where its end is
    let springs: f64 = upper().map(|node| 0.5 * STIFFNESS * mass[node] * moved[node].length_squared()).sum();
    let held = simulation.energies().unwrap().held.unwrap();
    assert!((held / springs - 1.0).abs() < 0.01, "{held} of {springs}");
}

#[test]
fn without_its_slopes_it_breaks_down() {
    let mut simulation = begun(silent()).unwrap();
    assert!(simulation.time_step() > 2.0 / STIFFNESS.sqrt(), "{}", simulation.time_step());
    assert!(matches!(simulation.finish(), Err(Error::Unstable(_))));
}

#[test]
fn slopes_that_are_no_slopes_are_refused() {
    for wrong in [-1.0, f64::INFINITY, f64::NAN] {
        let slopes = move || ForceSlopes { stiffness: wrong, damping: 0.0 };
        let refused = begun(silent().with_slopes(slopes)).err().map(|error| error.to_string());
        assert!(refused.as_ref().is_some_and(|text| text.contains("`hanger`")), "{wrong}: {refused:?}");
    }
    fn of_nothing(_: Res<Nothing>) -> ForceSlopes {
        ForceSlopes::NONE
    }
    let refused = begun(silent().with_slopes(of_nothing)).err().map(|error| error.to_string());
    assert!(refused.as_ref().is_some_and(|text| text.contains("slopes of the system `hanger`")), "{refused:?}");
}

#[derive(Resource)]
struct Nothing;
