//! `sinew check` says whether implicit steps would pay.

use super::sinew::Workspace;

/// Of a slow load implicit steps are advised, with the passes that they take and about the error that they have; of one
/// that is there at once, and of what a program moves, they are not.
#[test]
fn check_advises_implicit_steps_where_they_pay() {
    let place = Workspace::new();
    std::fs::write(
        place.path("slow.ron"),
        "(duration: 0.4,
        bodies: {\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45))},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))],
        loads: [Pressure(on: Plane(normal: (0, 0, 1), at: 0.02), pressure: 300, curve: Smooth(end: 0.4))],
        probes: {\"top\": (what: Displacement, on: Plane(normal: (0, 0, 1), at: 0.02), every: 0.04)})",
    )
    .unwrap();
    let advice = |set: &[&str]| -> serde_json::Value {
        let facts = place.done(&[&["check", "slow.ron", "--json"], set].concat());
        serde_json::from_str::<serde_json::Value>(&facts).unwrap()["implicit_steps"].clone()
    };
    let advised = advice(&[]);
    let number = |name: &str| advised[name].as_f64().unwrap_or_else(|| panic!("no {name}: {advised}"));
    let step = format!("solver=Implicit(step: {})", number("step"));
    assert!(place.done(&["check", "slow.ron"]).contains(&format!("try --set '{step}'")), "{advised}");

    let way = |set: &[&str], out: &str| -> Vec<f64> {
        place.done(&[&["run", "slow.ron", "--backend", "cpu", "--precision", "f64", "--out", out], set].concat());
        place.table(&format!("{out}/probe_top.csv")).iter().map(|row| *row.last().unwrap()).collect()
    };
    let (explicit, implicit) = (way(&[], "explicit"), way(&["--set", &step], "implicit"));
    assert_eq!(explicit.len(), implicit.len());
    let largest = explicit.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
    let square: f64 = explicit.iter().zip(&implicit).map(|(a, b)| (a - b).powi(2)).sum();
    let error = (square / explicit.len() as f64).sqrt() / largest;
    assert!(largest > 1e-6 && error < 3.0 * number("error").max(1e-3), "{error}: {advised}");
    let passes = place.json("implicit/summary.json")["implicit"]["passes"].as_f64().unwrap();
    assert!((passes / number("passes") - 1.0).abs() < 0.5, "{passes}: {advised}");

    assert!(advice(&["--set", "loads[0].curve=Step()"]).is_null());
    assert!(advice(&["--set", "loads[0].curve=Input(name: \"hand\")"]).is_null());
    assert!(advice(&["--set", &step]).is_null(), "they are taken");
}

/// What is carried goes far and is hardly strained, and so does what swings about an edge: Rayleigh's quotient had them
/// swing at 5e-7 and .08 Hz, and steps were praised for errors under 1 % that had the force on the tool 42 % off. A
/// block that is held by all of a face is advised of.
#[test]
fn check_advises_no_implicit_steps_for_what_goes_as_a_whole() {
    let place = Workspace::new();
    let advice = |name: &str, text: &str| -> serde_json::Value {
        std::fs::write(place.path(name), text).unwrap();
        let facts = place.done(&["check", name, "--json"]);
        serde_json::from_str::<serde_json::Value>(&facts).unwrap()["implicit_steps"].clone()
    };
    let carried = |more: &str| {
        format!(
            "(duration: 3, bodies: {{\"a\": (material: \"t\",
                mesh: Box(size: (0.01, 0.01, 0.01), cells: (4, 4, 4), elements: Hex8MeanDilatation))}},
            materials: {{\"t\": (density: 1000, neo_hookean: Young(young: 1e5, poisson: 0.3),
                stiffness_damping: 1e-4)}}, {more})"
        )
    };
    let grasped = carried(
        "tools: {\"g\": (shape: Sphere(radius: 2e-3), at: (0.015, 0.005, 0.005),
            moves: [(displacement: (0.1, 0, 0.05), curve: Smooth(end: 0.06))])},
        attachments: [Grasp(tool: \"g\", body: \"a\", on: Set(\"x1\"), closed: Step())]",
    );
    assert!(advice("carried.ron", &grasped).is_null());
    let led = "constraints: [Prescribed(on: Set(\"x0\"), displacement: (0.1, 0, 0), curve: Smooth(end: 3))]";
    assert!(advice("led.ron", &carried(led)).is_null());

    let hinge = |on: &str| {
        format!(
            "(duration: 2, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (4, 4, 4)), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e5, poisson: 0.45))}},
            constraints: [Fixed(on: {on})],
            loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 2))])"
        )
    };
    let edge = hinge("And([Set(\"x0\"), Set(\"z0\")])");
    assert!(advice("hinge.ron", &edge).is_null());
    // soft and for long: it swings twice and more, by what the quotient says
    let long = edge.replace("duration: 2,", "duration: 10,").replace("end: 2)", "end: 6.67)").replace("3e5", "3e4");
    assert!(long.contains("duration: 10") && long.contains("6.67") && long.contains("3e4"), "{long}");
    assert!(advice("long.ron", &long).is_null());
    let planes = ["x", "y", "z"].map(|axis| format!("Fixed(on: Set(\"{axis}0\"), axes: [{}])", axis.to_uppercase()));
    let planes = edge.replace("Fixed(on: And([Set(\"x0\"), Set(\"z0\")]))", &planes.join(", "));
    assert!(planes.contains("axes: [Z]") && advice("planes.ron", &planes).is_object(), "{planes}");
    assert!(advice("held.ron", &hinge("Set(\"x0\")")).is_object());
}
