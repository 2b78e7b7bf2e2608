//! Sinew inside a program of one's own: stepped from a loop of sixty frames a second, the surface read for drawing.
//!
//! `cargo run --release --example embed`

use sinew::glam::DVec3;
use sinew::{Error, Options, SceneFile, Simulation};
use std::path::Path;
use std::time::Instant;

/// A scene need not be a file.
const SCENE: &str = r#"(
    duration: 1,
    bodies: { "jelly": (mesh: Cylinder(radius: 0.04, height: 0.06, across: 10, along: 10, elements: Hex8), material: "gel") },
    materials: { "gel": (density: 1000, neo_hookean: Young(young: 5000, poisson: 0.45), damping: 4) },
    constraints: [Prescribed(on: Plane(normal: (0, 0, 1), at: 0), displacement: (0.01, 0, 0),
        curve: Table([(0, 0), (0.1, 1), (0.2, 0), (0.3, -1), (0.4, 0)]))],
    loads: [Gravity(acceleration: (0, 0, -9.81))],
)"#;

/// Simulated time a frame (s).
const FRAME: f64 = 1.0 / 60.0;

#[allow(missing_docs)]
pub fn main() -> Result<(), Error> {
    let scene = SceneFile::from_text("jelly", SCENE, Path::new("."), &[])?;
    let mut simulation = Simulation::new(&scene, &Options::default())?;
    let rest = simulation.rest_positions("jelly")?;
    // the same until elements are removed
    let triangles = simulation.surface_triangles("jelly")?;
    println!("{} points, {} triangles, step {:.2e} s", rest.len(), triangles.len(), simulation.time_step());

    let mut slowest = 0.0_f64;
    for frame in 1..=60 {
        let started = Instant::now();
        simulation.advance_to(f64::from(frame) * FRAME)?;
        let moved = simulation.displacements("jelly")?;
        let positions: Vec<DVec3> = rest.iter().zip(&moved).map(|(x, u)| *x + *u).collect();
        slowest = slowest.max(started.elapsed().as_secs_f64());
        draw(frame, &positions, &triangles);
    }
    println!("the slowest frame took {:.1} ms of {:.1} ms", 1e3 * slowest, 1e3 * FRAME);
    Ok(())
}

/// Stands for what a program does with a surface: here it tells its area and how far the top leans.
fn draw(frame: u32, positions: &[DVec3], triangles: &[[u32; 3]]) {
    if !frame.is_multiple_of(6) {
        return;
    }
    let corner = |place: u32| positions[place as usize];
    let area = |[a, b, c]: &[u32; 3]| (corner(*b) - corner(*a)).cross(corner(*c) - corner(*a)).length() / 2.0;
    let area: f64 = triangles.iter().map(area).sum();
    let top = positions.iter().copied().reduce(|a, b| if b.z > a.z { b } else { a }).unwrap_or_default();
    println!(
        "frame {frame:2}: area {:.1} cm², top at ({:+.1}, {:+.1}, {:.1}) mm",
        1e4 * area,
        1e3 * top.x,
        1e3 * top.y,
        1e3 * top.z
    );
}
