//! Numbers a thousand times off tissue: most come from another unit (mm for m, g/cm³ for kg/m³, kPa for Pa). A line
//! each; nothing is refused, for there are steel balls and whales.

use crate::assembly::Assembly;
use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::materials::Elastic;
use crate::scene::Diagnostics;
use crate::scene::schema::Scene;
use crate::scene::syntax::Path;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Longest sides of bodies (m): cells of tissue to elephants.
const SIZES: RangeInclusive<f64> = 2e-5..=5.0;
/// Densities (kg/m³): foam to heavy metal.
const DENSITIES: RangeInclusive<f64> = 10.0..=30_000.0;
/// Young's moduli at rest (Pa): a gel that hardly holds itself, to steel.
const MODULI: RangeInclusive<f64> = 5.0..=1e12;

/// Warns of what is far from tissue, and of bodies under load that nothing holds.
pub(super) fn check(assembly: &Assembly<'_>, may_hold: bool, world: &mut World, diagnostics: &mut Diagnostics) {
    let scene = &assembly.scene.scene;
    sizes(assembly, diagnostics);
    materials(scene, world, diagnostics);
    for (number, load) in scene.loads.iter().enumerate() {
        let parts = load.parts();
        if let Some(usual) = parts.usual.filter(|_| parts.amplitude != glam::DVec3::ZERO) {
            let (field, unit) = parts.field;
            let path = Path::default().name("loads").index(number).name(field);
            unusual(parts.amplitude.length(), &usual.range, unit, parts.name, usual.hint, path, diagnostics);
        }
    }
    unheld(assembly, may_hold, world, diagnostics);
}

fn unusual(
    value: f64,
    usual: &RangeInclusive<f64>,
    unit: &str,
    what: &str,
    hint: &str,
    path: Path,
    diagnostics: &mut Diagnostics,
) {
    if !usual.contains(&value) {
        let message = format!("{what} of {value:.3e} {unit}: far from tissue; {hint}");
        diagnostics.warn_at(path, message);
    }
}

fn sizes(assembly: &Assembly<'_>, diagnostics: &mut Diagnostics) {
    for (name, body) in &assembly.bodies {
        let Some(described) = assembly.scene.scene.bodies.get(name) else { continue };
        // copies may stand far apart
        let points = body.placed.mesh.points.len() / described.copies.max(1) as usize;
        let (low, high) = crate::mesh::extent(body.placed.mesh.points.iter().take(points).copied());
        let path = Path::default().name("bodies").name(name).name("mesh");
        let hint = "lengths are metres: a mesh in mm needs scale: 0.001 (`sinew mesh` shows it)";
        let what = format!("{name} has a length");
        unusual((high - low).max_element(), &SIZES, "m", &what, hint, path, diagnostics);
    }
}

fn materials(scene: &Scene, world: &mut World, diagnostics: &mut Diagnostics) {
    let mut moduli: BTreeMap<String, f64> = BTreeMap::new();
    for (block, law) in world.query::<(&Block, &BlockLaw<f64>)>().iter(world) {
        let Some(label) = world.get::<Label>(block.material) else { continue };
        let [shear, bulk] = law.elastic.small_strain_moduli();
        moduli.insert(label.0.clone(), 9.0 * bulk * shear / (3.0 * bulk + shear));
    }
    for (name, material) in &scene.materials {
        let path = Path::default().name("materials").name(name);
        let hint = "water has 1000 kg/m³; 1 would be in g/cm³";
        let density = path.name("density");
        unusual(material.density, &DENSITIES, "kg/m³", "a density", hint, density, diagnostics);
        if let Some(young) = moduli.get(name) {
            let hint = "moduli are in Pa: liver has some thousand, cartilage some million; 3 would be kPa";
            unusual(*young, &MODULI, "Pa", "Young's modulus at rest", hint, path, diagnostics);
        }
    }
}

/// Bodies that loads act on and nothing holds fly away: seldom meant, and never by who forgot a constraint.
fn unheld(assembly: &Assembly<'_>, may_hold: bool, world: &mut World, diagnostics: &mut Diagnostics) {
    // a constraint that is wrong was meant to hold
    if may_hold || diagnostics.has_error_in("constraints") {
        return;
    }
    let held: Vec<Entity> =
        world.query_filtered::<&OfBody, Or<(With<Fixed>, With<Prescribed>)>>().iter(world).map(|of| of.0).collect();
    type Loads = Or<(With<SceneLoad>, With<OwnLoad>)>;
    let loaded: Vec<Entity> = world.query_filtered::<&OfBody, Loads>().iter(world).map(|of| of.0).collect();
    let moves = |name: &str| {
        let body = &assembly.scene.scene.bodies[name];
        body.velocity != glam::DVec3::ZERO || body.spin != glam::DVec3::ZERO
    };
    for (name, body) in &assembly.bodies {
        let touched = assembly.scene.scene.attachments.iter().any(|attachment| attachment.holds(name))
            || world.get::<ToolContacts>(body.entity).is_some()
            || world.get::<ContactForce>(body.entity).is_some()
            || world.get_resource::<FreeTools>().is_some_and(|free| free.meet(body.entity));
        if loaded.contains(&body.entity) && !touched && !held.contains(&body.entity) && !moves(name) {
            let path = Path::default().name("bodies").name(name);
            let message = format!("nothing holds {name}, and loads act on it: it flies off as a whole");
            diagnostics.warn_at(path, message).note("constraints: [Fixed(on: ...)] holds nodes");
        }
    }
}
