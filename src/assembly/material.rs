//! Materials: entities with a component for every effect.

use super::user_laws;
use crate::backend::cpu::LawParameters;
use crate::components::{Damping, Density, ExponentialFibres, Label, Prony, StiffnessDamping};
use crate::materials::{ElasticLaw, ExponentialFibre, Fibres, each_elastic_law};
use crate::scene::CopiedMaterial;
use crate::scene::schema::{self, Material};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// The materials of a scene, by name.
pub(super) fn spawn(
    scene: &schema::Scene,
    laws: &mut BTreeMap<String, user_laws::Read>,
    world: &mut World,
) -> BTreeMap<String, Entity> {
    let mut spawned = BTreeMap::new();
    for (name, material) in &scene.materials {
        let material = &called_for(material);
        let mut entity = world.spawn((Label(name.clone()), Density(material.density)));
        if let Some(law) = material.elastic_law() {
            insert(&mut entity, law);
        }
        if let Some(user_laws::Read { law, built_in, own_kernels, findings, .. }) = laws.remove(name) {
            entity.insert(findings);
            if let Some(kernels) = own_kernels {
                entity.insert(kernels);
            }
            insert(&mut entity, built_in.unwrap_or(ElasticLaw::UserLaw(law)));
        }
        if let Some(fibres) = &material.fibres {
            entity.insert(fibres_of(fibres));
        }
        if let Some(families) = &material.exponential_fibres {
            entity.insert(ExponentialFibres(families.iter().map(family_of).collect()));
        }
        if let Some(prony) = &material.prony {
            let terms = |terms: &[schema::PronyTerm]| terms.iter().map(|term| (term.alpha, term.tau)).collect();
            entity.insert(Prony {
                terms: terms(&prony.terms),
                volumetric: terms(&prony.volumetric),
                integrator: prony.integrator,
                reproject: prony.reproject,
            });
        }
        if let Some(rate) = material.damping {
            entity.insert(Damping(rate));
        }
        if let Some(time) = material.stiffness_damping {
            entity.insert(StiffnessDamping(time));
        }
        spawned.insert(name.clone(), entity.id());
    }
    spawned
}

/// Parameters of a body's material in each of its copies, of the effects that it was made with: `made` and `now` are
/// scenes. `None` where all have the same.
pub(super) fn parameters_of_copies(
    made: &schema::Scene,
    now: &schema::Scene,
    body: &str,
    material: &str,
) -> Option<Vec<LawParameters<f64>>> {
    let (body, made, now) = (now.bodies.get(body)?, made.materials.get(material)?, now.materials.get(material)?);
    let copied = CopiedMaterial::of(body, material, now)?;
    let of_copy = |copy: usize| {
        let of_copy = copied.of_copy(copy)?;
        let fibres = made.fibres.as_ref().filter(|fibres| fibres.eta != 0.0);
        let families = made.exponential_fibres.iter().flatten().zip(of_copy.exponential_fibres.iter().flatten());
        Some(LawParameters {
            elastic: of_copy.elastic_law()?,
            fibres: fibres.and(of_copy.fibres.as_ref()).map(fibres_of),
            exponential: families.filter(|(made, _)| made.k1 != 0.0).map(|(_, family)| family_of(family)).collect(),
        })
    };
    (0..body.copies as usize).map(of_copy).collect()
}

/// Takes the parameters that a material has now, of the effects that it was made with.
pub(super) fn renew(entity: &mut EntityWorldMut<'_>, made: &Material, now: &Material) {
    if let Some(law) = now.elastic_law() {
        insert(entity, law);
    }
    if let (Some(_), Some(fibres)) = (entity.get::<Fibres<f64>>(), &now.fibres) {
        entity.insert(fibres_of(fibres));
    }
    if let (Some(made), Some(now)) = (&made.exponential_fibres, &now.exponential_fibres) {
        let weighty = made.iter().zip(now).filter(|(made, _)| made.k1 != 0.0);
        let families: Vec<ExponentialFibre<f64>> = weighty.map(|(_, now)| family_of(now)).collect();
        if entity.contains::<ExponentialFibres>() {
            entity.insert(ExponentialFibres(families));
        }
    }
}

fn fibres_of(fibres: &schema::Fibres) -> Fibres<f64> {
    Fibres { eta: fibres.eta, tension_only: number(fibres.tension_only) }
}

fn family_of(family: &schema::ExponentialFibres) -> ExponentialFibre<f64> {
    ExponentialFibre {
        k1: family.k1,
        k2: family.k2,
        dispersion: family.dispersion,
        tension_only: number(family.tension_only),
    }
}

/// A material without the effects that have no weight: they cost nothing, and change nothing to the last bit.
pub(super) fn called_for(material: &Material) -> Material {
    let mut material = material.clone();
    material.fibres = material.fibres.filter(|fibres| fibres.eta != 0.0);
    if let Some(families) = &mut material.exponential_fibres {
        families.retain(|family| family.k1 != 0.0);
    }
    material.exponential_fibres = material.exponential_fibres.filter(|families| !families.is_empty());
    if let Some(prony) = &mut material.prony {
        prony.terms.retain(|term| term.alpha != 0.0);
        prony.volumetric.retain(|term| term.alpha != 0.0);
    }
    material.prony = material.prony.filter(|prony| !(prony.terms.is_empty() && prony.volumetric.is_empty()));
    material.damping = material.damping.filter(|&rate| rate != 0.0);
    material.stiffness_damping = material.stiffness_damping.filter(|&time| time != 0.0);
    material
}

fn number(yes: bool) -> f64 {
    if yes { 1.0 } else { 0.0 }
}

macro_rules! insert_any {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        /// A law as the component of its type.
        fn insert(entity: &mut EntityWorldMut<'_>, law: ElasticLaw<f64>) {
            match law {
                $(ElasticLaw::$law(law) => entity.insert(law),)*
            };
        }
    };
}
each_elastic_law!(insert_any corotational_frame: CorotationalFrame; law: UserLaw;);

/// Directions of all families of fibres, with the fields they stand in: `fibres` first, then `exponential_fibres`.
pub(super) fn directions(material: &Material) -> Vec<(String, &schema::Direction)> {
    let fibres = material.fibres.iter().map(|fibres| ("fibres".to_string(), &fibres.direction));
    let families = material.exponential_fibres.iter().flatten().enumerate();
    let families = families.map(|(i, family)| (format!("exponential_fibres[{i}]"), &family.direction));
    fibres.chain(families).collect()
}
