//! Free bodies on tissue that is moved as told, or by forceps: who moves it does the work.

use crate::configurations::{configurations, near};

/// A block of 2 × 2 × 1 cm with all of its nodes lifted by 1 cm within .3 s, and a box of 10 g that stands on it.
fn lifted(told: bool) -> String {
    let way = "displacement: (0, 0, 0.01), curve: Smooth(end: 0.3)";
    let (told, grasped) = match told {
        true => (format!("Prescribed(on: All, {way})"), String::new()),
        false => (String::new(), "attachments: [Grasp(tool: \"forceps\", on: All, closed: Step())],".to_string()),
    };
    format!(
        "(duration: 0.3, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 20)}},
        constraints: [{told}], {grasped} loads: [Gravity(acceleration: (0, 0, -9.81))], integration: (step: 2.5e-4),
        tools: {{\"box\": (shape: Box(size: (0.015, 0.015, 0.01)), at: (0.01, 0.01, 0.015), free: (mass: 0.01)),
            \"forceps\": (shape: Sphere(radius: 0.01), at: (0.01, 0.01, 0.005), moves: [({way})])}},
        contacts: [Tool(tool: \"box\")], output: (energies_every: 0.05))"
    )
}

#[test]
fn a_free_box_that_is_lifted_takes_its_work_from_who_lifts() {
    let work = 0.01 * 9.81 * 0.01;
    for run in configurations() {
        let found = [true, false].map(|told| {
            let mut simulation = run.start(&lifted(told));
            simulation.advance_to(0.15).unwrap();
            let half = simulation.tool("box").unwrap();
            simulation.advance_to(0.3).unwrap();
            let what = format!("{}, {}", run.name, if told { "told" } else { "by forceps" });
            let (tool, e) = (simulation.tool("box").unwrap(), simulation.energies().unwrap());
            println!(
                "{what}: {:e} m, {:e} J done on it, {:e} J lost; {e:?}",
                tool.place.z,
                -tool.work.unwrap(),
                e.contact_loss.unwrap()
            );
            // it stands on the block all the way: .01 m and half of its own height above
            near(&format!("{what}: half way"), half.place.z, 0.02, 0.01, 1e-3);
            near(&format!("{what}: at the end"), tool.place.z, 0.025, 0.01, 1e-5);
            near(&format!("{what}: weight"), -tool.force.z, -0.01 * 9.81, 0.01 * 9.81, 2e-3);
            near(&format!("{what}: work on it"), -tool.work.unwrap(), work, work, 2e-3);
            near(&format!("{what}: lost"), e.contact_loss.unwrap(), 0.0, work, 2e-3);
            [half.place, tool.place]
        });
        let [[told_half, told], [grasped_half, grasped]] = found;
        let off = (told.z - grasped.z).abs().max((told_half.z - grasped_half.z).abs());
        near(&format!("{}: by forceps and as told", run.name), off, 0.0, 0.01, run.bound(1e-12, 1e-6));
    }
}
