//! Materials: densities, fibres, viscosity; elastic laws have a file of their own.

use super::{Judge, elastic_law, scene, show};
use crate::scene::schema::{Direction, ExponentialFibres, Inversion, Material, MeshSource, Prony, PronyTerm, Scene};
use crate::scene::syntax::Path;
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, judge: &mut Judge) {
    for (name, material) in &scene_.materials {
        let path = scene("materials").name(name);
        validate_material(judge, &path, name, material);
        let fibres = material.fibres.iter().map(|fibres| (path.name("fibres"), &fibres.direction));
        let families = material.exponential_fibres.iter().flatten().enumerate();
        let families = families.map(|(i, family)| (path.name("exponential_fibres").index(i), &family.direction));
        for (place, direction) in fibres.chain(families) {
            let Direction::Field(field) = direction else { continue };
            for (body, found) in &scene_.bodies {
                let uses = found.material == *name || found.regions.iter().any(|region| region.material == *name);
                if uses && !matches!(found.mesh, MeshSource::File { .. }) {
                    let message = format!("the mesh of `{body}` has no cell data `{field}`: it is generated");
                    judge
                        .out
                        .error_at(place.name("direction"), message)
                        .note("allowed for generated meshes: Along(x, y, z), Around(center: ..., axis: ...)");
                }
            }
        }
    }
}

fn validate_material(judge: &mut Judge, path: &Path, name: &str, material: &Material) {
    judge.above_zero(&path.name("density"), material.density, "kg/m³");
    elastic_law::validate(judge, path, name, material);
    if let Some(fibres) = &material.fibres {
        let path = path.name("fibres");
        judge.not_negative(&path.name("eta"), fibres.eta, "Pa");
        direction(judge, &path.name("direction"), &fibres.direction);
    }
    if let Some(families) = &material.exponential_fibres {
        let path = path.name("exponential_fibres");
        if families.is_empty() {
            judge
                .out
                .error_at(&path, "`exponential_fibres` has no families")
                .note("add (k1: ..., k2: ..., direction: ...), or leave `exponential_fibres` out");
        }
        for (i, family) in families.iter().enumerate() {
            exponential(judge, &path.index(i), family);
        }
    }
    if let Some(prony) = &material.prony {
        viscous(judge, &path.name("prony"), prony);
    }
    if let Some(damping) = material.damping {
        judge.not_negative(&path.name("damping"), damping, "s⁻¹");
    }
    if let Some(time) = material.stiffness_damping {
        judge.not_negative(&path.name("stiffness_damping"), time, "s");
    }
    if let (Some(Inversion::Recover), Some(because)) = (material.inversion, material.cannot_recover_because_of()) {
        let message = format!("the material `{name}` cannot recover from inversion: it has {because}");
        judge
            .out
            .error_at(path.name("inversion"), message)
            .note("can recover: stable_neo_hookean without fibres, exponential_fibres, stiffness_damping and terms of prony")
            .note("allowed for all others: Stop, Remove");
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

fn exponential(judge: &mut Judge, path: &Path, family: &ExponentialFibres) {
    judge.not_negative(&path.name("k1"), family.k1, "Pa");
    judge.not_negative(&path.name("k2"), family.k2, "");
    if !(0.0..=1.0 / 3.0).contains(&family.dispersion) {
        judge
            .must(&path.name("dispersion"), "between 0 and 1/3", show(family.dispersion))
            .note("0: all fibres along the direction; 1/3: as many in every direction");
    }
    direction(judge, &path.name("direction"), &family.direction);
}

fn viscous(judge: &mut Judge, path: &Path, prony: &Prony) {
    if prony.terms.is_empty() && prony.volumetric.is_empty() {
        judge
            .out
            .error_at(path.name("terms"), "`prony` has no terms")
            .note("add (alpha: ..., tau: ...), or leave `prony` out");
    }
    relaxation(judge, &path.name("terms"), &prony.terms);
    relaxation(judge, &path.name("volumetric"), &prony.volumetric);
}

fn relaxation(judge: &mut Judge, path: &Path, terms: &[PronyTerm]) {
    for (i, term) in terms.iter().enumerate() {
        judge.not_negative(&path.index(i).name("alpha"), term.alpha, "");
        judge.above_zero(&path.index(i).name("tau"), term.tau, "s");
    }
    let sum: f64 = terms.iter().map(|term| term.alpha).sum();
    if sum >= 1.0 {
        judge
            .out
            .error_at(path, format!("the `alpha` of all terms must be below 1 together, found {}", show(sum)))
            .note("1 minus their sum is the share of the stress that remains for ever");
    }
}
