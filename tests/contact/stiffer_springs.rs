//! Springs whose stiffness goes with the step become stiffer where other bodies shorten it, and that is told.

use crate::configurations::configurations;

/// A plate that is pressed onto a plane, and a block far away that is crushed or not.
fn warns(crushed: f64, law: &str) -> Vec<String> {
    let mut simulation = configurations()[0].start(&format!(
        "(duration: 0.4, bodies: {{
            \"plate\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2)), material: \"m\", translate: (0.1, 0, 0)),
            \"far\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2)), material: \"m\", translate: (-0.1, 0, 0.05))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.3), damping: 20)}},
        constraints: [Fixed(body: \"far\", on: Set(\"z0\")),
            Prescribed(body: \"far\", on: Set(\"z1\"), displacement: (0, 0, {crushed}), curve: Smooth(start: 0.25, end: 0.35))],
        tools: {{\"t\": (shape: Plane())}}, contacts: [Tool(tool: \"t\", body: \"plate\"{law})],
        loads: [Pressure(body: \"plate\", on: Set(\"z1\"), pressure: 500, curve: Smooth(end: 0.1))])"
    ));
    simulation.finish().unwrap();
    simulation
        .summary("")
        .unwrap()
        .guards
        .warnings
        .iter()
        .map(|notice| format!("{}: {}", notice.criterion, notice.message))
        .collect()
}

#[test]
fn springs_that_stiffen_are_told_of() {
    let told = warns(-6e-3, ", law: Penalty(share: 0.5)");
    let of_springs = told.iter().find(|told| told.starts_with("contact_stiffness")).unwrap();
    assert!(
        of_springs.contains("times as stiff as they were") && of_springs.contains("law: Kinematic"),
        "{of_springs}"
    );
    for (crushed, law) in [(-6e-3, ""), (0.0, ", law: Penalty(share: 0.5)")] {
        let told = warns(crushed, law);
        assert!(!told.iter().any(|told| told.starts_with("contact_stiffness")), "{crushed}, {law}: {told:?}");
    }
}
