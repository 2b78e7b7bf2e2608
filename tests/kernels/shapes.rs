//! Distances to tools: Rust in f64 against WGSL.

use super::pair::UNIT;
use glam::DVec3;
use sinew::backend::gpu::{BufferKind, Gpu, gpu_or_reason};
use sinew::backend::kernel::{Fragment, Kernel};
use sinew::mesh::Triangles;
use sinew::shader;
use sinew::tools::{DistanceGrid, Shape, Solid};

const MAIN: &str = "@group(0) @binding(0) var<uniform> tool: ToolShape;
@group(0) @binding(1) var<storage, read> places: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> found: array<vec4<f32>>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&places) { found[id.x] = tool_distance(tool, places[id.x].xyz); }
}
";

/// Runs a kernel over places; what it found at each: a gradient and a distance.
fn found(gpu: &mut Gpu, kernel: Kernel, places: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let read = gpu.create_with("places", places, BufferKind::Storage).unwrap();
    let written = gpu.create("found", 16 * places.len() as u64, BufferKind::Storage).unwrap();
    let kernel = kernel.bind("places", read).bind("found", written).threads(places.len() as u32);
    let kernel = gpu.prepare(&kernel).unwrap_or_else(|error| panic!("{error}"));
    gpu.run_once(&[kernel]).unwrap();
    gpu.download_rows(written).unwrap()
}

fn shapes() -> Vec<Shape> {
    let tube = |bevel| Shape::Tube { length: 0.15, inner: 0.8e-3, outer: 1.1e-3, bevel };
    vec![
        Shape::Plane {},
        Shape::Sphere { radius: 3e-3 },
        Shape::Box { size: DVec3::new(4e-3, 20e-3, 1e-3) },
        Shape::Capsule { length: 40e-3, radius: 1.5e-3 },
        Shape::Cylinder { length: 5e-3, radius: 4e-3 },
        Shape::Cone { length: 30e-3, tip: 0.3e-3, base: 5e-3 },
        Shape::Cone { length: 3e-3, tip: 4e-3, base: 0.0 },
        Shape::Cone { length: 20e-3, tip: 0.0, base: 1e-3 },
        tube(0.0),
        tube(45.0),
    ]
}

#[test]
fn distances_to_tools_are_those_of_the_host() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let mut dice = fastrand::Rng::with_seed(5);
    for (shape, rounding) in shapes().into_iter().flat_map(|shape| [(shape.clone(), 0.0), (shape, 0.1e-3)]) {
        let solid = Solid::new(shape, rounding).unwrap();
        let (center, radius) = solid.bounding_sphere().unwrap_or((DVec3::ZERO, 10e-3));
        let places: Vec<[f32; 4]> = (0..5000)
            .map(|i| {
                // about the tip, about the whole, on the axis, at the surface
                let half = if i % 2 == 0 { 5e-3 } else { 1.5 * radius };
                let mut way = || (2.0 * dice.f64() - 1.0) * half;
                let mut y = DVec3::new(way(), way(), way()) + if i % 2 == 0 { DVec3::ZERO } else { center };
                match i % 5 {
                    3 => y = DVec3::new(0.0, 0.0, y.z),
                    4 => {
                        let (distance, gradient) = solid.distance(y);
                        y -= distance * gradient;
                    }
                    _ => {}
                }
                let [x, y, z] = y.as_vec3().to_array();
                [x, y, z, 0.0]
            })
            .collect();
        let uniform = gpu.create_with("tool", &solid.packed(), BufferKind::Uniform).unwrap();
        let main = Fragment::new("main.wgsl", MAIN);
        let kernel = Kernel::new("tool", "main").fragment(main).fragment(shader!("tool_shape")).bind("tool", uniform);
        let got = found(&mut gpu, kernel, &places);
        let (mut worst, mut turned, mut directions) = (0.0_f64, 0.0_f64, 0);
        for (&[x, y, z, _], got) in places.iter().zip(got) {
            let y = DVec3::new(x.into(), y.into(), z.into());
            let (distance, gradient) = solid.distance(y);
            let device = DVec3::new(got[0].into(), got[1].into(), got[2].into());
            assert!((device.length() - 1.0).abs() < 8.0 * UNIT, "{solid:?} at {y}: {device}");
            // rounding of places and sizes, which are no larger than that
            let size = y.length() + 2.0 * radius;
            worst = worst.max((f64::from(got[3]) - distance).abs() / size);
            // near an edge, an axis or a ridge the direction is that of few digits, or another of the same right
            let near = DVec3::AXES.map(|axis| [1e-6, -1e-6].map(|h| solid.distance(y + h * size * axis).1));
            let spread = near.iter().flatten().map(|other| other.distance(gradient)).fold(0.0, f64::max);
            if spread < 1e-3 {
                directions += 1;
                turned = turned.max(device.distance(gradient));
            }
        }
        assert!(worst < 16.0 * UNIT, "{solid:?}: {worst:e}");
        assert!(turned < 2e-4 && directions > 1500, "{solid:?}: {turned:e} of {directions}");
    }
}

#[test]
fn special_places_have_a_distance_and_a_direction_on_a_gpu_too() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    for (shape, rounding) in shapes().into_iter().flat_map(|shape| [(shape.clone(), 0.0), (shape, 0.1e-3)]) {
        let solid = Solid::new(shape, rounding).unwrap();
        let (points, _) = solid.surface(8, 1.0);
        let on_axis = [-1.0, 0.0, 1e-4, 1e-3, 1.5e-3, 2.5e-3, 3e-3, 5e-3, 30e-3].map(|z| DVec3::new(0.0, 0.0, z));
        let far = [1e-38, 1e-30, 1e-19, 1e9, 1e30].map(DVec3::splat);
        let all = points.into_iter().chain(on_axis).chain(far).flat_map(|y| [y, -y, y.with_x(0.0), y.with_z(-0.0)]);
        let places: Vec<[f32; 4]> = all.map(|y| y.as_vec3().extend(0.0).to_array()).collect();
        let uniform = gpu.create_with("tool", &solid.packed(), BufferKind::Uniform).unwrap();
        let main = Fragment::new("main.wgsl", MAIN);
        let kernel = Kernel::new("tool", "main").fragment(main).fragment(shader!("tool_shape")).bind("tool", uniform);
        for (place, [x, y, z, distance]) in places.iter().zip(found(&mut gpu, kernel, &places)) {
            let length = DVec3::new(x.into(), y.into(), z.into()).length();
            let is_sound = distance.is_finite() && (length - 1.0).abs() < 8.0 * UNIT;
            assert!(is_sound, "{solid:?} at {place:?}: {distance} {x} {y} {z}");
        }
    }
}

#[test]
fn distances_on_grids_are_those_of_the_host() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let of_shape = |shape: Shape| {
        let (points, triangles) = Solid::new(shape, 0.2e-3).unwrap().surface(24, 0.0);
        let surface = Triangles { points, triangles, ..Triangles::default() };
        DistanceGrid::new(&surface, 0.7 * DistanceGrid::usual_spacing(&surface)).unwrap()
    };
    let grids = [
        of_shape(Shape::Box { size: DVec3::new(4e-3, 9e-3, 2e-3) }),
        of_shape(Shape::Tube { length: 12e-3, inner: 2e-3, outer: 3e-3, bevel: 30.0 }),
    ];
    // both in one buffer
    let values: Vec<f32> = grids.iter().flat_map(|grid| grid.values()).copied().collect();
    let buffer = gpu.create_with("values", &values, BufferKind::Storage).unwrap();
    let main = MAIN.replace("ToolShape", "ToolGrid").replace("tool_distance", "tool_grid_distance");
    let mut dice = fastrand::Rng::with_seed(6);
    let mut first = 0;
    for grid in &grids {
        let (center, radius) = grid.bounding_sphere();
        let places: Vec<[f32; 4]> = (0..8000)
            .map(|i| {
                let half = [1.0, 3.0, 40.0, 1e20][if i < 8 { 3 } else { i % 8 / 3 }] * radius;
                let mut way = || (2.0 * dice.f64() - 1.0) * half;
                let mut y = center + DVec3::new(way(), way(), way());
                if i % 4 == 0 {
                    let (distance, gradient) = grid.distance(y);
                    y -= distance * gradient;
                }
                y.as_vec3().extend(0.0).to_array()
            })
            .collect();
        let uniform = gpu.create_with("tool", &grid.packed(first), BufferKind::Uniform).unwrap();
        first += grid.values().len() as u32;
        let kernel = Kernel::new("tool", "main").fragment(Fragment::new("main.wgsl", main.clone()));
        let kernel = kernel.fragment(shader!("tool_grid")).bind("tool", uniform).bind("tool_grid_values", buffer);
        let (mut worst, mut turned, mut directions) = (0.0_f64, 0.0_f64, 0);
        for (&[x, y, z, _], got) in places.iter().zip(found(&mut gpu, kernel, &places)) {
            let y = DVec3::new(x.into(), y.into(), z.into());
            let (distance, gradient) = grid.distance(y);
            let device = DVec3::new(got[0].into(), got[1].into(), got[2].into());
            assert!((device.length() - 1.0).abs() < 8.0 * UNIT, "at {y}: {device}");
            if y.length() > 1e15 {
                assert!(got[3] > 1e14);
                continue;
            }
            let size = y.length() + 2.0 * radius;
            worst = worst.max((f64::from(got[3]) - distance).abs() / size);
            // from cell to cell the direction jumps
            let near = DVec3::AXES.map(|axis| [1e-6, -1e-6].map(|h| grid.distance(y + h * size * axis).1));
            let spread = near.iter().flatten().map(|other| other.distance(gradient)).fold(0.0, f64::max);
            if spread < 1e-3 {
                directions += 1;
                turned = turned.max(device.distance(gradient));
            }
        }
        assert!(worst < 16.0 * UNIT, "{worst:e}");
        assert!(turned < 1e-3 && directions > 4000, "{turned:e} of {directions}");
    }
}
