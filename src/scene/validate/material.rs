//! Materials: densities, fibres, viscosity; elastic laws have a file of their own.

use super::{Validator, elastic_law, scene, show};
use crate::scene::schema::{
    Direction, ExponentialFibres, Inversion, Material, MeshSource, Prony, PronyTerm, Scene, laws_that_recover,
};
use crate::scene::syntax::Path;
use glam::DVec3;

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    for (name, material) in &scene_.materials {
        let path = scene("materials").name(name);
        validate_material(validator, &path, name, material);
        let fibres = material.fibres.iter().map(|fibres| (path.name("fibres"), &fibres.direction));
        let families = material.exponential_fibres.iter().flatten().enumerate();
        let families = families.map(|(i, family)| (path.name("exponential_fibres").index(i), &family.direction));
        for (place, direction) in fibres.chain(families) {
            let Direction::Field(field) = direction else { continue };
            for (body, found) in &scene_.bodies {
                let uses = found.material == *name || found.regions.iter().any(|region| region.material == *name);
                if uses && !matches!(found.mesh, MeshSource::File { .. }) {
                    let message = format!("the mesh of `{body}` has no cell data `{field}`: it is generated");
                    validator
                        .out
                        .error_at(place.name("direction"), message)
                        .note("allowed for generated meshes: Along(x, y, z), Around(center: ..., axis: ...)");
                }
            }
        }
    }
}

pub(super) fn validate_material(validator: &mut Validator, path: &Path, name: &str, material: &Material) {
    validator.above_zero(&path.name("density"), material.density, "kg/m³");
    elastic_law::validate(validator, path, name, material);
    if let Some(fibres) = &material.fibres {
        let path = path.name("fibres");
        validator.not_negative(&path.name("eta"), fibres.eta, "Pa");
        direction(validator, &path.name("direction"), &fibres.direction);
    }
    if let Some(families) = &material.exponential_fibres {
        let path = path.name("exponential_fibres");
        if families.is_empty() {
            validator
                .out
                .error_at(&path, "`exponential_fibres` has no families")
                .note("add (k1: ..., k2: ..., direction: ...), or leave `exponential_fibres` out");
        }
        for (i, family) in families.iter().enumerate() {
            exponential(validator, &path.index(i), family);
        }
    }
    if let Some(prony) = &material.prony {
        viscous(validator, &path.name("prony"), prony);
    }
    if let Some(damping) = material.damping {
        validator.not_negative(&path.name("damping"), damping, "s⁻¹");
    }
    if let Some(time) = material.stiffness_damping {
        validator.not_negative(&path.name("stiffness_damping"), time, "s");
    }
    if let (Some(Inversion::Recover), Some(because)) = (material.inversion, material.cannot_recover_because_of()) {
        let message = format!("the material `{name}` cannot recover from inversion: it has {because}");
        validator
            .out
            .error_at(path.name("inversion"), message)
            .note(format!(
                "can recover: {} without fibres, exponential_fibres, stiffness_damping and terms of prony",
                laws_that_recover().join(", ")
            ))
            .note("allowed for all others: Stop, Remove");
    }
}

fn direction(validator: &mut Validator, path: &Path, direction: &Direction) {
    match direction {
        Direction::Along(x, y, z) => {
            if DVec3::new(*x, *y, *z).try_normalize().is_none() {
                validator.out.error_at(path, "fibres along (0, 0, 0) have no direction");
            }
        }
        Direction::Around { axis, .. } => validator.has_direction(&path.name("axis"), *axis),
        Direction::Field(name) => {
            if name.is_empty() {
                validator.out.error_at(path, "the name of the cell data is empty");
            }
        }
    }
}

fn exponential(validator: &mut Validator, path: &Path, family: &ExponentialFibres) {
    validator.not_negative(&path.name("k1"), family.k1, "Pa");
    validator.not_negative(&path.name("k2"), family.k2, "");
    if !(0.0..=1.0 / 3.0).contains(&family.dispersion) {
        validator
            .must(&path.name("dispersion"), "between 0 and 1/3", show(family.dispersion))
            .note("0: all fibres along the direction; 1/3: as many in every direction");
    }
    direction(validator, &path.name("direction"), &family.direction);
}

fn viscous(validator: &mut Validator, path: &Path, prony: &Prony) {
    if prony.terms.is_empty() && prony.volumetric.is_empty() {
        validator
            .out
            .error_at(path.name("terms"), "`prony` has no terms")
            .note("add (alpha: ..., tau: ...), or leave `prony` out");
    }
    relaxation(validator, &path.name("terms"), &prony.terms);
    relaxation(validator, &path.name("volumetric"), &prony.volumetric);
}

fn relaxation(validator: &mut Validator, path: &Path, terms: &[PronyTerm]) {
    for (i, term) in terms.iter().enumerate() {
        validator.not_negative(&path.index(i).name("alpha"), term.alpha, "");
        validator.above_zero(&path.index(i).name("tau"), term.tau, "s");
    }
    let sum: f64 = terms.iter().map(|term| term.alpha).sum();
    if sum >= 1.0 {
        validator
            .out
            .error_at(path, format!("the `alpha` of all terms must be below 1 together, found {}", show(sum)))
            .note("1 minus their sum is the share of the stress that remains for ever");
    }
}
