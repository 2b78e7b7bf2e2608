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
        let mut simulation = start(0, thin, "").unwrap();
        let summary = simulation.summary("").unwrap();
        let worst = &summary.stability.bound.worst;
        assert_eq!((worst[0].body.as_str(), worst[0].element), ("b", 12));
        // ω is about c/height where that is small beside all else
        assert!(worst[0].cost > 0.3 / thin && worst[0].cost < 3.0 / thin, "{worst:?}");
        near("gain without it", worst[0].gain, worst[1].bound / worst[0].bound, worst[0].gain, 1e-12);
        assert_eq!(worst.len(), 3);
        let warnings = simulation.warnings().render(false);
        assert!(warnings.contains("element 12 of b makes the step") && warnings.contains("ScaleMass"), "{warnings}");
    }
    let even = start(0, 1.0, "").unwrap();
    assert!(even.warnings().is_empty());
}

#[test]
fn added_mass_makes_the_step_larger_and_does_not_weigh() {
    for run in 0..configurations().len() {
        let plain = start(run, 0.05, "").unwrap();
        let mut scaled = start(run, 0.05, "integration: (when_unstable: ScaleMass(most: 0.04))").unwrap();
        let history = *scaled.step_history().unwrap();
        near("share", history.added_share, 0.04, 0.04, 1e-4);
        assert!(scaled.time_step() > 1.2 * plain.time_step(), "{} {}", scaled.time_step(), plain.time_step());
        assert!(scaled.time_step() < scaled.stable_limit().unwrap().unwrap());
        let mass: f64 = scaled.masses("b").unwrap().iter().sum();
        near("mass that is told", mass, 1000.0 * 4e-4 * 0.041, mass, 1e-6);
        assert!(scaled.warnings().list().iter().all(|w| !w.message.contains("are added")));
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
fn much_added_mass_is_warned_of() {
    let step = 0.9 * start(0, 0.05, "").unwrap().summary("").unwrap().stability.bound.usual;
    let more = format!("integration: (step: {step:?}, when_unstable: ScaleMass())");
    let scaled = start(0, 0.05, &more).unwrap();
    let history = scaled.step_history().unwrap();
    assert!(history.added_share > 0.05, "{history:?}");
    let told = scaled.warnings().render(false);
    assert!(told.contains("kg are added") && told.contains("of all mass"), "{told}");
    assert_eq!(scaled.time_step(), step);
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
