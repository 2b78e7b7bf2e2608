//! What a program gets wrong about a system of its own is an error that says so, and nothing else.

use sinew::bevy_ecs::query::QueryData;
use sinew::components::Precision;
use sinew::gpu_or_reason;
use sinew::prelude::*;
use sinew::systems::{Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, Rows, SimdScalar};
use std::marker::PhantomData;
use std::path::Path;

/// What the scene says under `parameters`.
#[derive(Component, Clone, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Hold {
    /// Rows that it is for.
    rows: Vec<u32>,
}

impl NodeSystem for Hold {
    type Columns = &'static mut ExternalForce;
    type Prepared = ();

    fn rows(&self) -> Rows<'_> {
        Rows::List(&self.rows)
    }

    fn prepare(&self, _: &Before<'_>) {}

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes { stiffness: 1.0, damping: 0.0 }
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, _: &mut NodeColumns<'_, T>) {}
}

fn begun(system: System, rows: &str) -> Result<Simulation, String> {
    begun_on(BackendChoice::Cpu, system, rows)
}

fn begun_on(backend: BackendChoice, system: System, rows: &str) -> Result<Simulation, String> {
    let text = format!(
        r#"(
    duration: 1,
    bodies: {{"cube": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (2, 2, 2)), material: "tissue")}},
    materials: {{"tissue": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
    parameters: {{{rows}}},
)"#
    );
    let scene = SceneFile::from_text("hold.ron", &text, Path::new("."), &[]).unwrap();
    let precision = if backend == BackendChoice::Gpu { Precision::F32 } else { Precision::F64 };
    let options = Options { backend, precision, ..Options::default() };
    Simulation::with_systems(&scene, &options, &Registry::default().with(system)).map_err(|wrong| wrong.to_string())
}

fn hold() -> System {
    System::of_nodes::<Hold>("hold", Phase::Loads, "does nothing to some nodes").on_each_body::<Hold>()
}

#[test]
fn rows_that_are_none() {
    begun(hold(), r#""hold": (rows: [0, 26])"#).unwrap();
    for row in [27, u32::MAX] {
        let wrong = begun(hold(), &format!(r#""hold": (rows: [0, {row}])"#)).err().unwrap();
        assert_eq!(wrong, format!("`hold` is for the node of row {row}, and the body has 27 rows, from 0"));
    }
}

#[test]
fn parameters_that_a_shader_cannot_have() {
    let system = hold().with_shader::<Hold>("hold.wgsl", "fn hold(node: u32) {}");
    let wrong = begun(system, r#""hold": (rows: [0])"#).err().unwrap();
    let said = "the parameters of `hold` do not fit: `rows`: a list of any length is nothing that a shader can have";
    assert!(wrong.contains(said), "{wrong}");
    assert!(wrong.contains("hold.ron:5"), "{wrong}");
}

#[test]
fn a_system_that_runs_every_no_steps_runs_in_each() {
    let count = |mut counted: ResMut<Counted>| counted.0 += 1;
    let mut system = System::custom("hold", Phase::Loads, "counts", count);
    system.every = 0;
    let mut simulation = begun(system, "").unwrap();
    simulation.world_mut().insert_resource(Counted(0));
    simulation.advance(3).unwrap();
    assert_eq!(simulation.world().resource::<Counted>().0, 3);
}

/// Writes loads and reads masses, whatever it declares.
#[derive(Component, serde::Deserialize, serde::Serialize)]
#[serde(crate = "sinew::serde", deny_unknown_fields)]
struct Push<C: 'static> {
    /// Force on each node (N).
    force: f64,
    #[serde(skip)]
    declares: PhantomData<fn() -> C>,
}

impl<C> Clone for Push<C> {
    fn clone(&self) -> Self {
        Self { force: self.force, declares: PhantomData }
    }
}

impl<C: QueryData + Send + Sync + 'static> NodeSystem for Push<C> {
    type Columns = C;
    type Prepared = ();

    fn prepare(&self, _: &Before<'_>) {}

    fn slopes(&self, _: &NodesAtRest<'_>) -> ForceSlopes {
        ForceSlopes::NONE
    }

    fn act<T: SimdScalar>(&self, (): &(), _: &Cpu, nodes: &mut NodeColumns<'_, T>) {
        for row in 0..nodes.rows() {
            if nodes.mass()[row] > T::default() {
                nodes.add_load(row, self.force * DVec3::Z);
            }
        }
    }
}

fn pushed<C: QueryData + Send + Sync + 'static>() -> Result<(), String> {
    let system = System::of_nodes::<Push<C>>("hold", Phase::Loads, "pushes").on_each_body::<Push<C>>();
    let mut simulation = begun(system, r#""hold": (force: 1)"#)?;
    simulation.advance(2).map_err(|wrong| wrong.to_string())
}

/// Not in debug builds alone: who shares a pass with whom is planned by what is declared.
#[test]
fn columns_that_are_not_declared() {
    pushed::<(&'static Mass, &'static mut ExternalForce)>().unwrap();
    let told = |does: &str, column: &str, wanted: &str| {
        format!(
            "`hold` {does} `{column}`, and has no `{wanted}{column}` among its `Columns`: what shares a pass with it is \
             planned by these"
        )
    };
    assert_eq!(pushed::<&'static mut ExternalForce>(), Err(told("reads", "Mass", "&")));
    assert_eq!(pushed::<&'static Mass>(), Err(told("writes", "ExternalForce", "&mut ")));
    assert_eq!(pushed::<(&'static Mass, &'static ExternalForce)>(), Err(told("writes", "ExternalForce", "&mut ")));
}

/// On a GPU a text knows no other names, which is told when the simulation is made.
#[test]
fn columns_that_a_shader_has_not_declared() {
    if gpu_or_reason().is_none() {
        return;
    }
    fn on_a_gpu<C: QueryData + Send + Sync + 'static>() -> Result<(), String> {
        let text = "fn hold(node: u32) {\n    add_load(node, vec3<f32>(0.0, 0.0, parameters.force * mass[node]));\n}\n";
        let system = System::of_nodes::<Push<C>>("hold", Phase::Loads, "pushes").on_each_body::<Push<C>>();
        let system = system.with_shader::<Push<C>>("hold.wgsl", text);
        begun_on(BackendChoice::Gpu, system, r#""hold": (force: 1)"#)?.advance(2).map_err(|wrong| wrong.to_string())
    }
    on_a_gpu::<(&'static Mass, &'static mut ExternalForce)>().unwrap();
    let wrong = on_a_gpu::<&'static mut ExternalForce>().err().unwrap();
    assert!(wrong.contains("hold.wgsl") && wrong.contains("mass"), "{wrong}");
}

/// How often it was run.
#[derive(Resource)]
struct Counted(u32);
