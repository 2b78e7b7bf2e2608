//! Materials: densities, moduli, fibres, viscosity.

use super::{Judge, scene, show};
use crate::scene::schema::{Direction, Fibres, Material, MeshSource, NeoHookean, Prony, Scene};
use crate::scene::syntax::Path;
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, judge: &mut Judge) {
    for (name, material) in &scene_.materials {
        let path = scene("materials").name(name);
        validate_material(judge, &path, name, material);
        if let Some(Fibres { direction: Direction::Field(field), .. }) = &material.fibres {
            let place = path.name("fibres").name("direction");
            for (body, found) in &scene_.bodies {
                let uses = found.material == *name || found.regions.iter().any(|region| region.material == *name);
                if uses && !matches!(found.mesh, MeshSource::File { .. }) {
                    judge
                        .out
                        .error_at(&place, format!("the mesh of `{body}` has no cell data `{field}`: it is generated"))
                        .note("allowed for generated meshes: Along(x, y, z), Around(center: ..., axis: ...)");
                }
            }
        }
    }
}

fn validate_material(judge: &mut Judge, path: &Path, name: &str, material: &Material) {
    judge.above_zero(&path.name("density"), material.density, "kg/m³");
    match &material.neo_hookean {
        Some(law) => elastic(judge, &path.name("neo_hookean"), *law),
        None if material.law.is_some() => {}
        None => {
            judge
                .out
                .error_at(path.name("neo_hookean"), format!("the material `{name}` has no elastic law"))
                .note("add for instance neo_hookean: Young(young: 3000, poisson: 0.45)");
        }
    }
    if let Some(law) = &material.law {
        let path = path.name("law");
        if material.neo_hookean.is_some() {
            let message = format!("the material `{name}` has two elastic laws: `law` and `neo_hookean`");
            judge.out.error_at(&path, message).note("leave one of them out");
        }
        if law.file.is_empty() {
            judge.out.error_at(path.name("file"), "the path of the law is empty");
        }
    }
    if let Some(fibres) = &material.fibres {
        let path = path.name("fibres");
        judge.not_negative(&path.name("eta"), fibres.eta, "Pa");
        direction(judge, &path.name("direction"), &fibres.direction);
    }
    if let Some(prony) = &material.prony {
        viscous(judge, &path.name("prony").name("terms"), prony);
    }
    if let Some(damping) = material.damping {
        judge.not_negative(&path.name("damping"), damping, "s⁻¹");
    }
}

fn elastic(judge: &mut Judge, path: &Path, law: NeoHookean) {
    match law {
        NeoHookean::Young { young, poisson } => {
            judge.above_zero(&path.name("young"), young, "Pa");
            let path = path.name("poisson");
            if poisson >= 0.5 {
                judge
                    .must(&path, "between -1 and 0.5", show(poisson))
                    .note("0.5 means no change of volume at all: an infinite bulk modulus, and a stable step of 0")
                    .note("soft tissue is usually given 0.45 to 0.499");
            } else if poisson <= -1.0 {
                judge
                    .must(&path, "between -1 and 0.5", show(poisson))
                    .note("at -1 and below the bulk modulus is infinite or negative");
            }
        }
        NeoHookean::Moduli { shear, bulk } => {
            judge.above_zero(&path.name("shear"), shear, "Pa");
            judge.above_zero(&path.name("bulk"), bulk, "Pa");
            let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
            if shear > 0.0 && bulk > 0.0 && poisson < 0.0 {
                judge.out.warn_at(path.name("bulk"), format!("`bulk` is small: Poisson's ratio is {poisson:.3}")).note(
                    format!(
                        "Poisson's ratio is above 0 when `bulk` is above 2/3 `shear`, here {}",
                        show(shear * 2.0 / 3.0)
                    ),
                );
            }
        }
    }
}

fn direction(judge: &mut Judge, path: &Path, direction: &Direction) {
    match direction {
        Direction::Along(x, y, z) => {
            if DVec3::new(*x, *y, *z).try_normalize().is_none() {
                judge.out.error_at(path, "fibres along (0, 0, 0) have no direction");
            }
        }
        Direction::Around { axis, .. } => judge.has_direction(&path.name("axis"), *axis),
        Direction::Field(name) => {
            if name.is_empty() {
                judge.out.error_at(path, "the name of the cell data is empty");
            }
        }
    }
}

fn viscous(judge: &mut Judge, path: &Path, prony: &Prony) {
    if prony.terms.is_empty() {
        judge.out.error_at(path, "`prony` has no terms").note("add (alpha: ..., tau: ...), or leave `prony` out");
    }
    for (i, term) in prony.terms.iter().enumerate() {
        judge.not_negative(&path.index(i).name("alpha"), term.alpha, "");
        judge.above_zero(&path.index(i).name("tau"), term.tau, "s");
    }
    let sum: f64 = prony.terms.iter().map(|term| term.alpha).sum();
    if sum >= 1.0 {
        judge
            .out
            .error_at(path, format!("the `alpha` of all terms must be below 1 together, found {}", show(sum)))
            .note("1 minus their sum is the share of the stress that remains for ever");
    }
}
