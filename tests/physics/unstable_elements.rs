//! Elements that need a smaller step than the others: named (H03, H04), made heavier (H32), or removed.

use crate::configurations::{configurations, near, scene_of};
use sinew::{Error, Simulation};
use std::path::Path;

/// A column whose middle layer of cells is thinner than the others by a factor.
fn column(thin: f64, more: &str) -> String {
    let h = 0.02;
    let mut mesh = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n16\n");
    for (layer, z) in [0.0, h, h * (1.0 + thin), h * (2.0 + thin)].iter().enumerate() {
        for (corner, (x, y)) in [(0.0, 0.0), (h, 0.0), (h, h), (0.0, h)].iter().enumerate() {
            mesh += &format!("{} {x} {y} {z}\n", 4 * layer + corner + 1);
        }
    }
    mesh += "$EndNodes\n$Elements\n3\n";
    for layer in 0..3 {
        let nodes: Vec<String> = (1..=8).map(|node| (4 * layer + node).to_string()).collect();
        mesh += &format!("{} 5 2 0 0 {}\n", 11 + layer, nodes.join(" "));
    }
    mesh += "$EndElements\n";
    let folder = std::env::temp_dir().join(format!("sinew-thin-{thin}"));
    std::fs::create_dir_all(&folder).unwrap();
    // tests that run beside each other write the same file: nobody may read half of it
    let own = folder.join(format!("{:?}", std::thread::current().id()));
    std::fs::write(&own, mesh).unwrap();
    std::fs::rename(own, folder.join("thin.msh")).unwrap();
    format!(
        r#"(duration: 0.2, bodies: {{"b": (mesh: File(path: "thin.msh"), material: "m")}},
        materials: {{"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
        loads: [Gravity(acceleration: (0, 0, -2))], output: (energies_every: 0.2), {more})"#
    )
}

fn start(run: usize, thin: f64, more: &str) -> Result<Simulation, Error> {
    let folder = std::env::temp_dir().join(format!("sinew-thin-{thin}"));
    let text = column(thin, more);
    Simulation::new(&scene_of(&text, &folder), &configurations()[run].options)
}

#[test]
fn thin_element_is_named_with_what_it_costs() {
    for thin in [1e-3, 1e-6] {
        let mut simulation = start(0, thin, "integration: (bound: Auto)").unwrap();
        let summary = simulation.summary("").unwrap();
        let worst = &summary.stability.bound.worst;
        assert_eq!((worst[0].body.as_str(), worst[0].element), ("b", 12));
        // ω is about c/height where that is small beside all else
        assert!(worst[0].cost > 0.3 / thin && worst[0].cost < 3.0 / thin, "{worst:?}");
        near("gain without it", worst[0].gain, worst[1].bound / worst[0].bound, worst[0].gain, 1e-12);
        assert_eq!(worst.len(), 3);
        let warnings = simulation.warnings().render(false);
        assert!(warnings.contains("element 12 of b makes the step"), "{warnings}");
        // beside elements of usual size it weighs so little that added mass would help less than what all elements
        // allow together
        assert!(!warnings.contains("ScaleMass"), "{warnings}");
        let alone = start(0, thin, "integration: (bound: Elements)").unwrap();
        let warnings = alone.warnings().render(false);
        assert!(warnings.contains("`bound: Iterated` takes that"), "{warnings}");
    }
    let even = start(0, 1.0, "").unwrap();
    assert!(!even.warnings().render(false).contains("makes the step"));
}

#[test]
fn added_mass_makes_the_step_larger_and_does_not_weigh() {
    for run in 0..configurations().len() {
        let plain = start(run, 0.05, "integration: (bound: Elements)").unwrap();
        let mut scaled = start(run, 0.05, "integration: (when_unstable: ScaleMass(most: 0.04))").unwrap();
        let history = *scaled.step_history().unwrap();
        near("share", history.added_share, 0.04, 0.04, 1e-4);
        assert!(scaled.time_step() > 1.2 * plain.time_step(), "{} {}", scaled.time_step(), plain.time_step());
        assert!(scaled.time_step() < scaled.stable_limit().unwrap().unwrap());
        let mass: f64 = scaled.masses("b").unwrap().iter().sum();
        near("mass that is told", mass, 1000.0 * 4e-4 * 0.041, mass, 1e-6);
        assert!(scaled.warnings().list().iter().all(|w| !w.message.contains("kg added")));
        scaled.finish().unwrap();
        // the weight is that of the real mass, what falls is heavier: the centre of all mass falls by less than ½ g t²
        let energies = scaled.energies().unwrap();
        let (load, held) = (energies.load_work.unwrap(), energies.kinetic + energies.strain + energies.hourglass);
        near("energy", held, load, load, 5e-3);
        let expected = 0.5 * mass * 4.0 * 0.04 / 1.04;
        near("kinetic energy", energies.kinetic, expected, expected, 0.02);
    }
}

#[test]
fn much_added_mass_is_warned_of_and_more_than_is_allowed_is_an_error() {
    let step = 0.25 * start(0, 0.05, "").unwrap().summary("").unwrap().stability.bound.usual;
    let scene = |most: f64| format!("integration: (step: {step:?}, when_unstable: ScaleMass(most: {most}))");
    let scaled = start(0, 0.05, &scene(1.0)).unwrap();
    let history = scaled.step_history().unwrap();
    assert!(history.added_share > 0.05, "{history:?}");
    let told = scaled.warnings().render(false);
    assert!(told.contains("kg added") && told.contains("of all mass") && told.contains("element 12 of b"), "{told}");
    assert_eq!(scaled.time_step(), step);
    match start(0, 0.05, &scene(0.99 * history.added_share)) {
        Err(Error::Scene(wrong)) => {
            let text = wrong.render(false);
            assert!(text.contains("`most` allows") && text.contains("element 12 of b"), "{text}");
        }
        other => panic!("{:?}", other.map(|s| s.step_count())),
    }
    assert!(start(0, 0.05, &scene(1.01 * history.added_share)).is_ok());
}

#[test]
fn the_same_mass_is_added_in_any_precision() {
    for more in [
        "integration: (when_unstable: ScaleMass(most: 0.3))",
        "integration: (step: 1.2e-3, when_unstable: ScaleMass(most: 1))",
    ] {
        let added = |run: usize| start(run, 0.07, more).unwrap().step_history().unwrap().added_mass;
        assert!(added(0) > 0.0 && added(0) == added(1), "{more}: {} {}", added(0), added(1));
    }
}

/// A block that is squeezed by so much (m) while its step stays: mass is added during the run.
fn squeezed_at_one_step(by: f64, most: f64) -> String {
    format!(
        r#"(duration: 0.2, bodies: {{"b": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: "t")}},
        materials: {{"t": (density: 1000, neo_hookean: Young(young: 3000, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(on: Plane(normal: (0, 0, 1), at: 0.1), displacement: (0, 0, {}), curve: Smooth(end: 0.1))],
        integration: (step: 0.004, when_unstable: ScaleMass(most: {most})))"#,
        -by
    )
}

#[test]
fn mass_that_is_added_during_the_run_is_warned_of_and_ends_it_where_it_is_too_much() {
    let mut shares = Vec::new();
    for run in configurations() {
        let mut simulation = run.start(&squeezed_at_one_step(0.057, 1.0));
        simulation.finish().unwrap();
        let history = *simulation.step_history().unwrap();
        println!("{}: {history:?}", run.name);
        assert!(history.added_share > 0.05 && history.added_share.is_finite(), "{}: {history:?}", run.name);
        let warnings = simulation.guards().warnings;
        let told = warnings.iter().find(|notice| notice.criterion == "added_mass").unwrap();
        assert!(told.message.contains("of all mass was added") && told.value > 0.05, "{told:?}");
        shares.push(history.added_share);
        let most = 0.9 * history.added_share;
        let mut too_much = run.start(&squeezed_at_one_step(0.057, most));
        match too_much.finish() {
            Err(Error::Unstable(found)) => {
                assert_eq!((found.criterion.name, found.criterion.limit), ("added_mass", Some(most)), "{found}");
                assert!(found.criterion.value.unwrap() > most && found.what.contains("element"), "{found}");
                assert!(too_much.step_history().unwrap().added_share <= most);
            }
            other => panic!("{}: {other:?}", run.name),
        }
    }
    // what the same motion needs, as far as displacements are the same
    shares.iter().for_each(|&share| near("share", share, shares[0], shares[0], 1e-4));
}

/// What is squeezed flat would need mass without end.
#[test]
fn mass_without_end_is_not_added() {
    for run in configurations() {
        let mut simulation = run.start(&squeezed_at_one_step(0.07, 0.5));
        let ended = simulation.finish();
        assert!(
            matches!(&ended, Err(Error::Unstable(found)) if found.criterion.element.is_some()),
            "{}: {ended:?}",
            run.name
        );
        let history = simulation.step_history().unwrap();
        assert!(history.added_mass.is_finite() && history.added_share <= 0.5, "{}: {history:?}", run.name);
    }
}

#[test]
fn elements_that_need_a_smaller_step_are_removed() {
    for run in 0..configurations().len() {
        let step = 0.5 * start(run, 0.05, "").unwrap().summary("").unwrap().stability.bound.usual;
        let more = format!("integration: (step: {step:?}, when_unstable: Remove)");
        let mut simulation = start(run, 0.05, &more).unwrap();
        simulation.finish().unwrap();
        let summary = simulation.summary("finished").unwrap();
        assert_eq!(
            (summary.removed_elements, summary.step_history.unwrap().removed),
            (1, 1),
            "{}",
            configurations()[run].name
        );
        assert_eq!(simulation.time_step(), step);
        // the two that are left fall on
        near("mass", summary.mass - summary.removed_mass, 1000.0 * 4e-4 * 0.04, 0.016, 1e-6);
    }
}

#[test]
fn unknown_policies_are_told_with_what_is_allowed() {
    let wrong =
        sinew::SceneFile::from_text("test", &column(1.0, "integration: (when_unstable: Hope)"), Path::new("."), &[]);
    let text = wrong.unwrap_err().render(false);
    assert!(text.contains("Adapt") && text.contains("ScaleMass") && text.contains("Watch"), "{text}");
}

#[test]
fn step_grows_again_when_the_element_that_sets_it_is_gone() {
    for run in 0..configurations().len() {
        let more = "removal: [(on: Elements([12]), when: At(0.01))]";
        let mut simulation = start(run, 0.01, more).unwrap();
        let first = simulation.time_step();
        simulation.finish().unwrap();
        let history = simulation.step_history().unwrap();
        assert!(history.changes >= 1 && history.largest > 20.0 * first, "{history:?}");
        near("the end", simulation.time(), 0.2, 0.2, 1e-12);
    }
}
