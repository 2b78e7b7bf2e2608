//! Parameters that change while a simulation runs: materials and loads give what they give in a scene that has them
//! from the start, in the same bits; the step follows; snapshots and going back know of them.

use crate::configurations::{Configuration, ELEMENTS, configurations, cpu_and_long_gpu, scene_of};
use sinew::glam::DVec3;
use sinew::{Error, Simulation};
use std::path::Path;

/// Materials and loads as they are at first, and as they become: places in the scene, both values.
const CHANGES: [(&str, &str, &str); 8] = [
    ("materials.a.neo_hookean", "Young(young: 3e4, poisson: 0.3)", "Moduli(shear: 3e4, bulk: 5e4)"),
    ("materials.a.fibres.eta", "2e4", "5e3"),
    ("materials.a.exponential_fibres[1].k1", "4e3", "9e3"),
    ("materials.b.ogden.terms[0].mu", "4e3", "7e3"),
    ("loads[0].acceleration", "(0, 2, -9.81)", "(1, 0, -20)"),
    ("loads[1].force", "(0.4, 0, 0)", "(0, 0.7, 0)"),
    ("loads[2].pressure", "60", "-200"),
    ("loads[3].traction", "(0, 30, 0)", "(50, 0, 9)"),
];

/// A block of two viscous materials that is loaded in every way, with the first values or with the others.
fn block(elements: &str, changed: bool, further: &str) -> String {
    let [neo, eta, k1, mu, gravity, force, pressure, traction] =
        CHANGES.map(|(_, first, then)| if changed { then } else { first });
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.2), cells: (2, 2, 4), elements: {elements}), material: \"a\",
            regions: [(on: Box(min: (-1, -1, 0.09), max: (1, 1, 1)), material: \"b\")])}},
        materials: {{
            \"a\": (density: 1000, damping: 2, stiffness_damping: 1e-5, neo_hookean: {neo},
                fibres: (eta: {eta}, direction: Along(0, 0, 1)),
                exponential_fibres: [(k1: 0, k2: 1, direction: Along(1, 0, 0)), (k1: {k1}, k2: 2, direction: Along(0, 1, 1))],
                prony: (terms: [(alpha: 0.3, tau: 0.01)], volumetric: [(alpha: 0.1, tau: 0.02)])),
            \"b\": (density: 1100, ogden: (terms: [(mu: {mu}, alpha: 3), (mu: -1e3, alpha: -2)], bulk: 8e4))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Gravity(acceleration: {gravity}), NodalForce(on: Plane(normal: (0, 0, 1), at: 0.2), force: {force}, share: Total),
            Pressure(on: Surface(normal: (0, 0, 1)), pressure: {pressure}),
            Traction(on: Surface(normal: (1, 0, 0)), traction: {traction})],
        {further})"
    )
}

fn to_others() -> Vec<String> {
    CHANGES.iter().map(|(place, _, then)| format!("{place}={then}")).collect()
}

fn moved(simulation: &mut Simulation, steps: u64) -> Vec<DVec3> {
    simulation.advance(steps).unwrap_or_else(|error| panic!("{error}"));
    simulation.displacements("b").unwrap()
}

#[test]
#[ignore = "long"]
fn what_is_changed_before_the_first_step_is_as_if_the_scene_had_been_so() {
    const OWN: &str = "integration: (step: 5e-5, bound: Elements)";
    for run in configurations() {
        for elements in ELEMENTS {
            let mut simulation = run.start(&block(elements, false, OWN));
            let first = moved(&mut run.start(&block(elements, false, OWN)), 150);
            simulation.change(&to_others()).unwrap();
            let mut made_so = run.start(&block(elements, true, OWN));
            let (found, expected) = (moved(&mut simulation, 150), moved(&mut made_so, 150));
            assert!(found == expected && found != first, "{} {elements}", run.name);
            // and back again
            simulation.reset().unwrap();
            assert!(moved(&mut simulation, 150) == first, "{} {elements}: reset", run.name);
        }
    }
}

#[test]
#[ignore = "long"]
fn what_goes_on_from_a_snapshot_has_what_was_changed_and_going_back_takes_it_back() {
    // elements that could go have their rest shapes in snapshots
    for further in ["", "removal: [(body: \"b\", on: All, when: VolumeRatioBelow(0.01))]"] {
        for run in configurations() {
            let text = block("Hex8", false, further);
            let mut simulation = run.start(&text);
            let first = moved(&mut simulation, 120);
            simulation.reset().unwrap();
            simulation.keep_history(1e-9, 1 << 30).unwrap();
            moved(&mut simulation, 50);
            simulation.change(&to_others()).unwrap();
            let changed = moved(&mut simulation, 30);
            let kept = simulation.snapshot().unwrap();
            let end = moved(&mut simulation, 200);
            let mut other = run.start(&text);
            other.restore(&kept).unwrap();
            assert!(other.displacements("b").unwrap() == changed && moved(&mut other, 200) == end, "{}", run.name);
            // twice the same way
            other.restore(&kept).unwrap();
            assert!(moved(&mut other, 200) == end, "{}: again", run.name);
            // to before it was changed
            let before = simulation.history()[20];
            simulation.rewind(before).unwrap();
            let left = 120 - simulation.step_count();
            assert!(moved(&mut simulation, left) == first, "{}: not taken back", run.name);
        }
    }
}

#[test]
#[ignore = "long"]
fn the_step_follows_a_material_that_becomes_stiffer_and_softer() {
    for run in configurations() {
        let mut simulation = run.start(&block("Tet4", false, ""));
        simulation.advance(30).unwrap();
        let step = simulation.time_step();
        let set = |simulation: &mut Simulation, shear: f64| {
            simulation.change(&[format!("materials.a.neo_hookean=Moduli(shear: {shear:e}, bulk: {shear:e})")]).unwrap();
        };
        set(&mut simulation, 3e6);
        simulation.advance(1).unwrap();
        let limit = simulation.stable_limit().unwrap().unwrap();
        let stiff = simulation.time_step();
        assert!(stiff <= 0.95 * limit && stiff < 0.3 * step, "{}: {stiff} s of {limit} s, {step} s before", run.name);
        simulation.advance(2000).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        // made by nothing but the loads
        assert!(simulation.guards().imbalance < 0.01, "{}: {}", run.name, simulation.guards().imbalance);
        set(&mut simulation, 1e4);
        simulation.advance(2000).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        assert!(simulation.time_step() > 2.0 * stiff, "{}: {} s", run.name, simulation.time_step());
    }
}

/// Held at both ends, stretched by a quarter, without viscosity.
const HELD: &str = "(duration: 2, bodies: {\"b\": (mesh: Box(size: (0.1, 0.1, 0.2), cells: (2, 2, 4), elements: Hex8), material: \"a\")},
    materials: {\"a\": (density: 1000, damping: 100, neo_hookean: Young(young: 3e4, poisson: 0.3))},
    constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
        Prescribed(on: Plane(normal: (0, 0, 1), at: 0.2), displacement: (0, 0, 0.05), curve: Smooth(end: 0.2))],
    guards: (every: 16))";

#[test]
fn what_elements_hold_more_afterwards_is_no_energy_from_nothing() {
    for run in configurations() {
        let mut simulation = run.start(HELD);
        simulation.advance_to(0.4).unwrap();
        for young in ["3e5", "1e3"] {
            simulation.change(&[format!("materials.a.neo_hookean=Young(young: {young}, poisson: 0.3)")]).unwrap();
            simulation.advance_to(simulation.time() + 0.1).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        }
        let guards = simulation.guards();
        assert!(guards.imbalance.abs() < 0.01 && guards.warnings.is_empty(), "{}: {guards:?}", run.name);
    }
}

#[test]
fn a_load_that_changes_acts_in_full_from_the_next_step_on() {
    let falls = "(duration: 1, bodies: {\"b\": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: \"a\")},
        materials: {\"a\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))},
        loads: [Gravity(acceleration: (0, 0, -10))], integration: (step: 1e-3))";
    for run in configurations() {
        let mut simulation = run.start(falls);
        simulation.advance(20).unwrap();
        let speed = |simulation: &mut Simulation| simulation.fields("b").unwrap().velocity[0].z;
        let before = speed(&mut simulation);
        simulation.change(&["loads[0].acceleration=(0, 0, 30)".to_string()]).unwrap();
        simulation.advance(20).unwrap();
        let gained = speed(&mut simulation) - before;
        assert!((gained - 0.6).abs() < run.bound(1e-9, 1e-4), "{}: {gained} m/s", run.name);
    }
}

fn refused(simulation: &mut Simulation, set: &str, words: &str) {
    let error: Error = simulation.change(&["loads[0].acceleration=(9, 9, 9)".into(), set.into()]).unwrap_err();
    let told = match error {
        Error::Scene(wrong) => wrong.render(false),
        other => other.to_string(),
    };
    assert!(told.contains(words), "{set}: {told}");
}

#[test]
fn what_cannot_change_is_refused_and_nothing_has_changed() {
    let further = "integration: (when_unstable: Watch)";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(&block("Hex8", false, further));
        simulation.advance(20).unwrap();
        for (set, words) in [
            ("materials.a.density=2000", "cannot change while the scene runs"),
            ("materials.a.prony.terms[0].alpha=0.2", "cannot change while the scene runs"),
            ("materials.a.exponential_fibres[0].k1=10", "cannot change while the scene runs"),
            ("materials.a.fibres.direction=Along(1, 0, 0)", "cannot change while the scene runs"),
            ("loads[1].share=Each", "cannot change while the scene runs"),
            ("duration=3", "cannot change while the scene runs"),
            ("materials.b.ogden.bulk=-1", "`bulk` must be above 0"),
            ("materials.c.density=1", "materials"),
            ("loads[1].force=sideways", "force"),
            ("materials.b.ogden.bulk=1e12", "with so stiff a material the stable step is"),
        ] {
            refused(&mut simulation, set, words);
        }
        let mut untouched: Simulation = start_untouched(&run, further);
        assert!(moved(&mut simulation, 100) == moved(&mut untouched, 120), "{}", run.name);
        let mut rests = run.start(&block("Hex8", false, "analysis: Static()"));
        let told = rests.change(&to_others()).unwrap_err().to_string();
        assert!(told.contains("a static analysis"), "{told}");
    }
}

fn start_untouched(run: &Configuration, further: &str) -> Simulation {
    let scene = scene_of(&block("Hex8", false, further), Path::new("."));
    Simulation::new(&scene, &run.options).unwrap()
}
