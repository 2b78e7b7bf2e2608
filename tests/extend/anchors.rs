//! Springs from some nodes to where each of them should be: a list of rows, and a list of numbers beside it, which the
//! twin on a GPU reads as those of the engine's own loads do.

use sinew::gpu_or_reason;
use sinew::prelude::*;
use sinew::systems::{Rows, Stage};
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Anchors {
    /// Over the mass of a node (1/s²).
    stiffness: f64,
    /// Rows of the body, ascending.
    #[serde(skip_serializing)]
    rows: Vec<u32>,
    /// The displacement to which each is pulled (m).
    #[serde(skip_serializing)]
    goals: Vec<DVec3>,
}

fn system() -> System {
    System::of_nodes::<Anchors>("anchors", Phase::Loads, "pulls some nodes to where they should be")
        .on_each_body::<Anchors>()
        .with_shader::<Anchors>("tests/extend/anchors.wgsl", include_str!("anchors.wgsl"))
}

impl NodeSystem for Anchors {
    type Columns = (&'static Displacement, &'static Mass, &'static mut ExternalForce);
    type Prepared = ();

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn stages(&self, _: Entity, _: &World) -> Vec<Stage> {
        let goals: Vec<f32> = self.goals.iter().flat_map(|goal| goal.as_vec3().to_array()).collect();
        let along = Stage::of(self.rows()).reals("goals", &goals).integers("axes", &[0, 1, 2]);
        vec![along.text("where goals stand", "fn goal_at(i: u32, axis: u32) -> f32 { return goals[3u * i + axis]; }")]
    }

    fn prepare(&self, _: &Before<'_>) {}

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: self.stiffness, damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        let here = nodes.first..nodes.first + nodes.rows();
        for (&row, goal) in self.rows.iter().zip(&self.goals).filter(|(row, _)| here.contains(&(**row as usize))) {
            let row = row as usize - here.start;
            let pull = nodes.mass()[row].to_f64() * self.stiffness * (*goal - nodes.displacement(row));
            nodes.add_load(row, pull);
        }
    }
}

fn begun(backend: BackendChoice, rows: &str) -> Result<Simulation, Error> {
    let text = format!(
        r#"(
    duration: 0.3,
    bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3)), material: "tissue")}},
    materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3), damping: 60)}},
    parameters: {{"anchors": (
        rows: {rows}, goals: [(0, 0, 0.002), (0.001, 0, 0.004), (0, 0, -0.003)], stiffness: 4e7,
    )}},
)"#
    );
    let scene = SceneFile::from_text("anchors.ron", &text, Path::new("."), &[]).unwrap();
    Simulation::with_systems(&scene, &Options { backend, ..Options::default() }, &Registry::default().with(system()))
}

#[test]
fn a_list_of_rows_with_a_list_of_numbers_is_the_same_on_both_backends() {
    let mut host = begun(BackendChoice::Cpu, "[3, 17, 40]").unwrap();
    host.finish().unwrap();
    let of_host = host.displacements("cube").unwrap();
    // far stiffer than the cube: each has a node where it should be
    for goal in [DVec3::new(0.0, 0.0, 0.002), DVec3::new(0.001, 0.0, 0.004), DVec3::new(0.0, 0.0, -0.003)] {
        let nearest = of_host.iter().map(|u| u.distance(goal)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.01 * goal.length(), "{nearest} m from {goal}");
    }
    if gpu_or_reason().is_none() {
        return;
    }
    let mut device = begun(BackendChoice::Gpu, "[3, 17, 40]").unwrap();
    let told = device.explain(&Registry::default().with(system())).unwrap();
    assert!(told.kernels.iter().any(|kernel| kernel.system.contains("anchors") && kernel.systems.len() > 2));
    device.finish().unwrap();
    let of_device = device.displacements("cube").unwrap();
    let off = of_host.iter().zip(&of_device).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // f32 on both
    assert!(off < 1e-4 * 0.004, "{off} m");
}

#[test]
fn rows_that_do_not_ascend_are_refused_where_a_shader_has_them() {
    for rows in ["[17, 3, 40]", "[3, 3, 40]"] {
        let wrong = begun(BackendChoice::Cpu, rows).err().unwrap().to_string();
        assert!(wrong.contains("do not ascend") && wrong.contains("anchors.ron"), "{rows}: {wrong}");
    }
}
