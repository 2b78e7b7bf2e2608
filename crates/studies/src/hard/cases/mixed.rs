//! Tetrahedra and hexahedra in one body.

use super::super::Trial;
use super::cells::vtk;
use glam::{DMat3, DVec3};
use sinew::Error;

const CELLS: usize = 3;

/// H31.
pub fn mixed_patch(trial: &mut Trial<'_>) -> Result<(), Error> {
    let own = trial.configuration.elements_name();
    let (tets, hexes) = if trial.configuration.is_tets() { (own, "Hex8") } else { ("Tet4", own) };
    let set = format!("bodies.body.mesh=File(path: \"mixed.vtk\", tets: {tets}, hexes: {hexes})");
    let mut simulation = trial.start_beside("mixed.vtk", &mesh(), &[set])?;
    simulation.finish()?;
    let gradient =
        DMat3::from_cols(DVec3::new(0.1, -0.02, 0.0), DVec3::new(0.05, -0.1, 0.03), DVec3::new(0.0, 0.04, 0.2));
    let (rest, u) = (simulation.rest_positions("body")?, simulation.displacements("body")?);
    let off = rest.iter().zip(&u).fold(0.0_f64, |worst, (x, u)| worst.max((*u - gradient * *x).length()));
    let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.length()));
    trial.most("nodes off the common gradient", off / largest, trial.bound(1e-6, 1e-4));
    Ok(())
}

/// Two layers of hexahedra below two of tetrahedra, their inner nodes moved but for those where they meet: there faces
/// of four corners lie against pairs of triangles, and share their forces only where all lie in one plane, in rows.
fn mesh() -> String {
    let place = |at: [usize; 3]| {
        let [x, y, z] = at;
        let inside = [x, y].iter().all(|&i| i > 0 && i < CELLS) && (z == 1 || z == 3);
        let moved =
            |i: usize| if inside { 0.2 * ((7 * x + 5 * y + 3 * z + 11 * i) % 5) as f64 / 5.0 - 0.1 } else { 0.0 };
        [0, 1, 2].map(|i| 0.01 * (at[i] as f64 + moved(i)))
    };
    vtk([CELLS, CELLS, 4], place, |[_, _, z]| z < 2)
}
