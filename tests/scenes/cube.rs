//! The sagging cube.

use super::{near, run};

fn sag(cells: u32) -> f64 {
    let mut simulation = run("cube_under_gravity", &[&format!("bodies.cube.mesh.cells=({cells}, {cells}, {cells})")]);
    -simulation.probe("top").unwrap()[2]
}

/// Mean sag of the top in small strain: ρgL²/2M when the sides are held (M = κ + 4μ/3), ρgL²/2E when they are free. The
/// cube, held below only, lies between.
#[test]
fn the_cube_sags_between_the_two_columns_that_bound_it() {
    let (held, free) = (9810.0 * 0.01 / (2.0 * 11379.31), 9810.0 * 0.01 / (2.0 * 3000.0));
    let sag = sag(10);
    assert!(held < sag && sag < free, "{held} < {sag} < {free} m");
}

#[test]
fn the_shipped_mesh_is_within_two_percent_of_a_finer_one() {
    let (shipped, fine) = (sag(10), sag(16));
    assert!(near(shipped, fine, 0.02), "{shipped} m with 10 cells, {fine} m with 16");
}

#[test]
fn the_ground_bears_the_weight() {
    let mut simulation = run("cube_under_gravity", &[]);
    let reaction = simulation.probe("ground").unwrap();
    assert!(near(reaction[2], 9.81, 1e-3), "{} N", reaction[2]);
    assert!(reaction[0].abs() < 1e-6 && reaction[1].abs() < 1e-6, "{reaction:?} N");
}

#[test]
fn little_of_the_energy_is_in_hourglass_control() {
    let energies = run("cube_under_gravity", &[]).energies().unwrap();
    assert!(energies.hourglass < 0.03 * energies.strain, "{energies:?}");
}
