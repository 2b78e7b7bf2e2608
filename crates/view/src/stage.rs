//! From what is drawn of a state to the picture of it: the window, films and measurements do the same.

use crate::scene3d::{Look, Scene, Scene3d, Tissue};
use crate::settings::Settings;
use crate::surfaces::Drawn;
use glam::Vec3;
use sinew::driver::State;
use sinew_pictures::render::{Camera, Extent, View};

/// Draws; `scale`: pixels a point of the screen.
pub fn paint(
    scene3d: &mut Scene3d,
    drawn: &Drawn<'_>,
    camera: &Camera,
    (state, settings, tissues): (&State, &Settings, &[Tissue]),
    scale: f32,
) {
    let surfaces = drawn.surfaces(camera);
    let table = drawn.has_table(&surfaces);
    let up = state.loaded.as_ref().map_or(Vec3::Z, |loaded| View::from(&loaded.scene.scene.picture).up);
    let up = up.normalize_or(Vec3::Z);
    let ground = (up, lowest(&drawn.bodies, up));
    let look = Look {
        wet: settings.wet,
        shadows: settings.shadows,
        ground: !table && camera.eye().dot(up) > ground.1,
        dark: settings.dark,
        scale,
        tissues: tissues.to_vec(),
    };
    let (scale, plane, bodies) = (drawn.scale, drawn.plane, drawn.bodies);
    scene3d.draw(&Scene { surfaces: &surfaces, key: drawn.key, scale, plane, bodies, ground, look }, camera);
}

/// Where the lowest corner of an extent is along a direction (m).
fn lowest(extent: &Extent, up: Vec3) -> f32 {
    if extent.is_nothing() {
        return 0.0;
    }
    let corner = Vec3::select(up.cmpgt(Vec3::ZERO), extent.low, extent.high);
    corner.dot(up)
}
