//! The same scene gives the same bits (gate G6), any numbering the same motion, f32 the motion of f64.
//!
//! Bounds: a shuffled mesh sums the same forces in another order: eps a step, 60 steps, moduli 1e4: 1e-12 of the
//! displacement in f64, 1e-4 in f32; f32 against f64 likewise 1e-4.

use crate::configurations::{Configuration, configurations, cpu_and_long_gpu};
use crate::grids::{Grid, bits, grid};
use crate::random::Random;
use glam::DVec3;
use sinew::backend::cpu::{Cpu, Instructions};
use sinew::components::{Patches, Precision, Scheme};
use sinew::mesh::ElementKind;
use sinew::{BackendChoice, Options, Simulation};
use std::path::Path;

/// Both kinds, more elements than one thread would take alone: 512 hexahedra below, 1536 tetrahedra above.
fn mesh(cells: usize) -> Grid {
    let kind = move |layer: usize| if layer < cells { ElementKind::Hex8 } else { ElementKind::Tet4 };
    grid([cells, cells, cells + cells / 2], kind).moved(|x| x / cells as f64)
}

/// What a scene has besides elasticity.
#[derive(Clone, Copy, PartialEq)]
enum Effects {
    /// Fibres, viscosity, damping.
    Laws,
    /// And removal.
    All,
    /// The same, with pressures from means.
    Means,
}

fn scene(effects: Effects) -> String {
    let laws = "fibres: (eta: 2000, direction: Around(center: (0.5, -0.3, 0), axis: (0, 0, 1))),
        prony: (terms: [(alpha: 0.5, tau: 0.1)]), damping: 0.1,";
    let removal = "removal: [(when: StretchAbove(1.1)), (on: Sphere(center: (0.5, 0.5, 1), radius: 0.3),
        when: During(start: 0.01, end: 0.3))],";
    let removal = if effects == Effects::Laws { "" } else { removal };
    let kinds = if effects == Effects::Means { "tets: Tet4NodalPressure, hexes: Hex8MeanDilatation" } else { "" };
    format!(
        "(duration: 100, bodies: {{\"b\": (mesh: File(path: \"mesh.vtk\", {kinds}), material: \"m\", spin: (1, 2, 3))}},
        materials: {{\"m\": (density: 1000, {laws} neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {removal}
        loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(on: Surface(normal: (0, 0, 1)), pressure: 400),
            Traction(on: Surface(normal: (1, 0, 0)), traction: (0, 100, 0))],
        integration: (step: 0.004), output: (energies_every: 0.1))"
    )
}

fn start(mesh: &Grid, run: &Configuration, effects: Effects, folder: &Path) -> Simulation {
    mesh.write(&folder.join("mesh.vtk"));
    run.start_in(&scene(effects), folder)
}

#[test]
fn bits_are_the_same_from_run_to_run_and_for_any_number_of_threads() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(8));
    let both = |precision| [Effects::All, Effects::Means].map(|effects| (precision, effects));
    for (precision, effects) in [Precision::F64, Precision::F32].into_iter().flat_map(both) {
        let of = |threads: usize| {
            let options = Options { backend: BackendChoice::Cpu, precision, threads, ..Options::default() };
            let run = Configuration { name: "CPU", options };
            let mut simulation = start(&mesh, &run, effects, folder.path());
            simulation.advance(60).unwrap();
            let energies = format!("{:?}", simulation.energies().unwrap());
            let removed = simulation.summary("").unwrap().removed_elements;
            (bits(&mut simulation, "b"), energies, removed)
        };
        let one = of(1);
        assert!(one.2 > 10, "elements must be removed for this to say something: {}", one.2);
        for threads in [1, 3, 16] {
            let other = of(threads);
            assert!(one == other, "{precision:?}, {threads} threads: not the same bits; {} and {}", one.1, other.1);
        }
    }
}

#[test]
fn gpu_gives_the_same_bits_from_run_to_run() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(8));
    for run in configurations().iter().filter(|run| run.options.backend == BackendChoice::Gpu) {
        for effects in [Effects::All, Effects::Means] {
            let of = || {
                let mut simulation = start(&mesh, run, effects, folder.path());
                simulation.advance(40).unwrap();
                bits(&mut simulation, "b")
            };
            assert!(of() == of(), "not the same bits");
        }
    }
}

fn largest_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    let largest = a.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    a.iter().zip(b).fold(0.0_f64, |worst, (a, b)| worst.max((*a - *b).length())) / largest
}

/// Also those that this machine would not choose.
#[test]
fn all_vector_registers_give_the_same_motion() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(6));
    for (precision, bound) in [(Precision::F64, 1e-12), (Precision::F32, 1e-4)] {
        let [widest, others @ ..] =
            [Instructions::Widest, Instructions::Avx2, Instructions::Portable].map(|instructions| {
                let options = Options { backend: BackendChoice::Cpu, precision, instructions, ..Options::default() };
                let run = Configuration { name: "CPU", options };
                let mut simulation = start(&mesh, &run, Effects::Laws, folder.path());
                simulation.advance(60).unwrap();
                (simulation.displacements("b").unwrap(), simulation.world().resource::<Cpu>().describe())
            });
        assert!(others[1].1.contains("scalar"), "{}", others[1].1);
        for (other, backend) in others {
            let off = largest_difference(&widest.0, &other);
            assert!(off <= bound, "{backend}: {off:e}");
        }
    }
}

/// Nodes whose work is counted are moved one after the other, others a register full at a time.
#[test]
fn booking_work_changes_no_bit() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(6));
    mesh.write(&folder.path().join("mesh.vtk"));
    for precision in [Precision::F64, Precision::F32] {
        let [counted, plain] = [true, false].map(|counted| {
            let text = scene(Effects::Laws);
            let text = if counted { text } else { text.replace("output: (energies_every: 0.1)", "output: ()") };
            let options = Options { backend: BackendChoice::Cpu, precision, ..Options::default() };
            let mut simulation = Configuration { name: "CPU", options }.start_in(&text, folder.path());
            simulation.advance(60).unwrap();
            let known = simulation.energies().unwrap().internal_work.is_some();
            assert_eq!(known, counted, "work must be counted in one of them only");
            bits(&mut simulation, "b")
        });
        assert!(counted == plain, "{precision:?}");
    }
}

/// Sums patch by patch and over all corners differ in their order only; bounds as for a shuffled mesh.
#[test]
#[ignore = "long"]
fn both_schemes_move_alike() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(8));
    for run in configurations() {
        for effects in [Effects::Laws, Effects::All, Effects::Means] {
            let [patches, two_pass] = [Scheme::Patches, Scheme::TwoPass].map(|scheme| {
                let options = Options { scheme: Some(scheme), ..run.options.clone() };
                let mut simulation = start(&mesh, &Configuration { options, ..run }, effects, folder.path());
                simulation.advance(60).unwrap();
                simulation.displacements("b").unwrap()
            });
            let error = largest_difference(&patches, &two_pass);
            println!("{}: {error:.1e}", run.name);
            assert!(error < run.bound(1e-12, 1e-4) && patches != two_pass, "{}: {error:e}", run.name);
        }
    }
}

/// Tetrahedra that share no node: more nodes than a workgroup has room for. The others move by patches.
#[test]
fn patches_of_too_many_nodes_are_summed_in_two_passes_on_a_gpu() {
    let (folder, whole) = (tempfile::tempdir().unwrap(), grid([3, 3, 6], |_| ElementKind::Tet4));
    let mut apart = Grid { points: Vec::new(), elements: Vec::new(), interior: Vec::new() };
    for element in &whole.elements {
        let first = apart.points.len();
        apart.points.extend(element.iter().map(|&node| whole.points[node]));
        apart.elements.push((first..first + 4).collect());
    }
    apart.write(&folder.path().join("mesh.vtk"));
    let scene = "(duration: 1, materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        bodies: {\"apart\": (mesh: File(path: \"mesh.vtk\"), material: \"m\", spin: (1, 2, 3)),
            \"b\": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: \"m\", spin: (3, 2, 1))},
        integration: (step: 0.004))";
    let ends: Vec<[Vec<DVec3>; 2]> = configurations()
        .iter()
        .map(|run| {
            let mut simulation = run.start_in(scene, folder.path());
            let why = simulation.summary("").unwrap().backend_because;
            let gpu = run.options.backend == BackendChoice::Gpu;
            let said = "forces of `apart` are summed in two passes: a patch has 1296 nodes, and 640 fit";
            assert!(why.contains(said) == gpu && !why.contains("`b`"), "{why}");
            simulation.advance(40).unwrap();
            ["apart", "b"].map(|body| simulation.displacements(body).unwrap())
        })
        .collect();
    for end in &ends[1..] {
        for (body, exact) in end.iter().zip(&ends[0]) {
            let error = largest_difference(exact, body);
            assert!(error < 1e-4, "{error:e}");
        }
    }
}

#[test]
fn f32_moves_as_f64_does() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(4));
    for effects in [Effects::All, Effects::Means] {
        let of = |run: &Configuration| {
            let mut simulation = start(&mesh, run, effects, folder.path());
            simulation.advance(60).unwrap();
            (run.name, simulation.displacements("b").unwrap())
        };
        let all: Vec<(&str, Vec<DVec3>)> = cpu_and_long_gpu().iter().map(of).collect();
        for (name, displacements) in &all[1..] {
            let error = largest_difference(&all[0].1, displacements);
            println!("{name}: {error:.1e}");
            assert!(error < 1e-4, "{name}: {error:e}");
        }
    }
}

#[test]
fn numbering_does_not_matter() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), mesh(4));
    let mut random = Random(61);
    let (points, elements) = (random.permutation(mesh.points.len()), random.permutation(mesh.elements.len()));
    let shuffled = mesh.shuffled(&points, &elements);
    for run in &configurations() {
        // without removal: of elements equally far from the middle the author's first goes first
        let of = |mesh: &Grid| {
            let mut simulation = start(mesh, run, Effects::Laws, folder.path());
            simulation.advance(60).unwrap();
            simulation.displacements("b").unwrap()
        };
        let (plain, moved) = (of(&mesh), of(&shuffled));
        let back: Vec<DVec3> = points.iter().map(|&to| moved[to]).collect();
        let error = largest_difference(&plain, &back);
        println!("{}: {error:.1e}", run.name);
        assert!(error < run.bound(1e-11, 1e-4), "{}: {error:e}", run.name);
    }
}
