//! Stiffness of forces on nodes, whoever brings them, counts for the stable step: of a program's own systems, and of
//! loads in WGSL that an input makes stiffer while they act.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu, near, scene_of};
use sinew::backend::cpu::{Cpu, NodeColumns};
use sinew::components::*;
use sinew::glam::DVec3;
use sinew::math::SimdScalar;
use sinew::systems::{Before, ForceSlopes, NodeSystem, NodesAtRest, Phase, Registry, System};
use sinew::{BackendChoice, Error, Options, Simulation};
use std::path::Path;

/// f = −κ m u on every node, and says so.
#[derive(bevy_ecs::prelude::Component, Clone, serde::Deserialize)]
struct Spring {
    over_mass: f64,
    /// What it says κ is, where that is not it.
    #[serde(default)]
    says: f64,
}

impl NodeSystem for Spring {
    type Columns = (&'static Displacement, &'static Mass, &'static mut ExternalForce);
    type Prepared = ();

    fn prepare(&self, _: &Before<'_>) {}

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: if self.says == 0.0 { self.over_mass } else { self.says }, damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            let stiffness = self.over_mass * nodes.mass()[row].to_f64();
            nodes.add_load(row, -stiffness * nodes.displacement(row));
        }
    }
}

fn registry() -> Registry {
    let spring = System::of_nodes::<Spring>("spring", Phase::Loads, "pulls nodes back").on_each_body::<Spring>();
    Registry::default().with(spring)
}

/// A cube whose nodes are pulled back to where they were; `spring`: what the parameters say.
fn cube(spring: &str, further: &str) -> String {
    format!(
        "(duration: 1, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: \"m\", velocity: (0, 0, 0.1))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.3))}},
        schedule: [\"element_forces\", \"gather\", \"spring\", \"integrate\", \"observe\"],
        parameters: {{\"spring\": ({spring})}}, {further})"
    )
}

fn start(run: &Configuration, text: &str) -> Result<Simulation, Error> {
    Simulation::with_systems(&scene_of(text, Path::new(".")), &run.options, &registry())
}

fn farthest(simulation: &mut Simulation) -> f64 {
    simulation.displacements("b").unwrap().iter().fold(0.0_f64, |far, u| far.max(u.length()))
}

#[test]
fn a_system_of_the_programs_own_that_says_how_stiff_it_is_gets_the_step_that_it_needs() {
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Cpu) {
        let mut bodies = start(run, &cube("over_mass: 0", "integration: (bound: Elements)")).unwrap();
        let bodies = bodies.summary("").unwrap().stability.stable_step;
        let over_mass = 12.0 / (bodies * bodies);
        let spring = format!("over_mass: {over_mass:e}");
        // with every policy, not only where the step follows
        for policy in ["Adapt", "Watch"] {
            let text = cube(&spring, &format!("integration: (bound: Elements, when_unstable: {policy})"));
            let mut simulation = start(run, &text).unwrap();
            let stability = simulation.summary("").unwrap().stability;
            near(policy, stability.stable_step, 0.5 * bodies, bodies, 1e-9);
            assert!(stability.because.contains("forces on nodes make"), "{}", stability.because);
            assert!(simulation.time_step() <= 0.9 * 0.5 * bodies);
            simulation.advance(400).unwrap_or_else(|error| panic!("{policy}, {}: {error}", run.name));
            // as far as its speed takes it against the spring, and somewhat more within the body
            let far = farthest(&mut simulation);
            assert!(far < 3.0 * 0.1 / over_mass.sqrt(), "{policy}: {far} m");
        }
        // a step of the scene's own beyond that is an error
        let own = |further: &str| cube(&spring, &format!("integration: (step: {:e}{further})", 0.8 * bodies));
        let refused = start(run, &own("")).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains("is beyond the stable one of"), "{refused}");
        assert!(start(run, &own(", beyond_stable_step: true")).is_ok());
        // a negative norm takes nothing from others
        let wrong = cube("over_mass: 0, says: -1e30", "integration: (bound: Elements)");
        let mut wrong = start(run, &wrong).unwrap();
        let wrong = wrong.summary("").unwrap().stability.stable_step;
        assert_eq!(wrong, bodies);
    }
}

/// A spring in WGSL whose stiffness is an input.
fn scene_in_wgsl(further: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let text = "fn pull(node: Node) -> vec3f { return -2e4 * node.curve * node.mass * (node.displacement - vec3f(0, 0, 1e-3)); }";
    std::fs::write(folder.path().join("pull.wgsl"), text).unwrap();
    let scene = format!(
        "(duration: 2, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 50)}},
        systems: {{\"pull\": (file: \"pull.wgsl\", curve: Input(name: \"k\", rate: 1e5))}}, {further})"
    );
    (folder, scene)
}

#[test]
fn an_input_that_makes_a_load_stiffer_makes_the_step_smaller() {
    let (folder, scene) = scene_in_wgsl("");
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start_in(&scene, folder.path());
        simulation.advance(40).unwrap();
        let first = simulation.time_step();
        simulation.set_input("k", 1000.0).unwrap();
        simulation.advance(10).unwrap();
        let after = simulation.time_step();
        // κ is 2e7/s²: ω of the load alone allows 2/√(√3·2e7)
        let bound = 2.0 / (3.0_f64.sqrt() * 2e7).sqrt();
        assert!(after < bound && first > 1.5 * bound, "{}: {first} s, {after} s, {bound} s", run.name);
        let kept = simulation.snapshot().unwrap();
        simulation.advance(2000).unwrap_or_else(|error| panic!("{}: {error}", run.name));
        let end = simulation.displacements("b").unwrap();
        let off = end.iter().fold(0.0_f64, |most, u| most.max(u.distance(DVec3::new(0.0, 0.0, 1e-3))));
        assert!(off < 2e-4, "{}: {off} m off", run.name);
        // and who goes on from there takes the same steps
        let mut other = run.start_in(&scene, folder.path());
        other.restore(&kept).unwrap();
        other.advance(2000).unwrap();
        assert!(other.displacements("b").unwrap() == end, "{}: other bits", run.name);
        // from the start on it is what it was
        simulation.reset().unwrap();
        simulation.advance(40).unwrap();
        assert_eq!(simulation.time_step(), first);
    }
}

/// What two loads in WGSL that are `[one, other]` as stiff leave of the step, each on some nodes.
fn step_under([one, other]: [f64; 2], on: [&str; 2], elements: &str) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    for (name, stiffness) in [("one", one), ("other", other)] {
        let text = format!(
            "fn {name}(node: Node) -> vec3f {{ return vec3f(-{stiffness:e} * node.mass * node.displacement.x, 0, 0); }}"
        );
        std::fs::write(folder.path().join(format!("{name}.wgsl")), text).unwrap();
    }
    let scene = format!(
        r#"(duration: 1, bodies: {{"b": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: {elements}), material: "m")}},
        materials: {{"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
        systems: {{"one": (file: "one.wgsl", on: {}), "other": (file: "other.wgsl", on: {})}}, integration: (bound: Elements))"#,
        on[0], on[1]
    );
    let mut simulation = Simulation::new(
        &scene_of(&scene, folder.path()),
        &Options { backend: BackendChoice::Cpu, ..Options::default() },
    )
    .unwrap();
    simulation.summary("").unwrap().stability.stable_step
}

/// 1/Δt² is (ω² + κ)/4, with κ summed over the loads of one node, and the largest of all nodes.
#[test]
fn loads_at_different_nodes_do_not_make_the_step_smaller_together() {
    let [left, right] = ["Plane(normal: (1, 0, 0), at: 0)", "Plane(normal: (1, 0, 0), at: 0.1)"];
    for elements in ["Hex8", "Tet4"] {
        let square = |stiffness: [f64; 2], on: [&str; 2]| step_under(stiffness, on, elements).powi(-2);
        let bodies = square([0.0; 2], [left, right]);
        let [one, other] = [6.0 * bodies, 10.0 * bodies];
        let apart = square([one, other], [left, right]);
        near("of the stiffer one alone", apart, bodies + 0.25 * other, bodies, 1e-4);
        assert_eq!(apart, square([0.0, other], [left, right]));
        near(
            "of both at the same nodes",
            square([one, other], [left, left]),
            bodies + 0.25 * (one + other),
            bodies,
            1e-4,
        );
    }
}

#[test]
fn an_input_that_makes_a_load_too_stiff_is_refused_where_the_step_stays() {
    let (folder, scene) = scene_in_wgsl("integration: (when_unstable: Watch)");
    for run in configurations() {
        let mut simulation = run.start_in(&scene, folder.path());
        simulation.set_input("k", 1.5).unwrap();
        simulation.advance(5).unwrap();
        let refused = simulation.set_input("k", 1e6).unwrap_err().to_string();
        assert!(refused.contains("so stiff that the stable step is"), "{refused}");
        assert_eq!(simulation.inputs()[0].target, 1.5);
        simulation.advance(50).unwrap();
        let file = scene_of(&scene.replace("Watch", "Adapt"), folder.path());
        let mut follows = Simulation::new(&file, &Options { ..run.options.clone() }).unwrap();
        follows.set_input("k", 1e6).unwrap();
    }
}
