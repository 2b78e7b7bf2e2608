//! Materials: entities with a component for every effect.

use super::user_laws;
use crate::backend::cpu::LawParameters;
use crate::components::{
    Damping, Density, ElementMemory, ExponentialFibres, Label, PerCopyInertia, PerCopyMemory, Prony, StiffnessDamping,
};
use crate::materials::{ElasticLaw, ExponentialFibre, Fibres, each_elastic_law};

use crate::scene::schema::{self, Material};
use crate::scene::{CopiedMaterial, Part};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

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
            entity.insert(prony_of(prony));
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

/// A body's material in each of its copies.
pub(super) struct OfCopies {
    copied: CopiedMaterial,
    /// Of each, without the effects that have no weight in the material that it was made with.
    materials: Vec<Material>,
}

impl OfCopies {
    /// Of a material of a body, of the effects that it was made with: `made` and `now` are scenes. `None` where all
    /// copies have the same.
    pub fn of(made: &schema::Scene, now: &schema::Scene, body: &str, material: &str) -> Option<Self> {
        let (body, made, now) = (now.bodies.get(body)?, made.materials.get(material)?, now.materials.get(material)?);
        let copied = CopiedMaterial::of(body, material, now)?;
        let of_copy = |copy: usize| Some(called_for_in(made, copied.of_copy(copy)?));
        let materials = (0..body.copies as usize).map(of_copy).collect::<Option<_>>()?;
        Some(Self { copied, materials })
    }

    /// Parameters of the law of each, where these or what elements remember differ.
    pub fn laws(&self) -> Option<Vec<LawParameters<f64>>> {
        let of_copy = |material: &Material| {
            Some(LawParameters {
                elastic: material.elastic_law()?,
                fibres: material.fibres.as_ref().map(fibres_of),
                exponential: material.exponential_fibres.iter().flatten().map(family_of).collect(),
                terms: Vec::new(),
            })
        };
        let differs = self.copied.differs_in(Part::Law) || self.copied.differs_in(Part::Memory);
        self.materials.iter().map(of_copy).collect::<Option<_>>().filter(|_| differs)
    }

    /// What elements of each remember, where it differs.
    pub fn memories(&self) -> Option<PerCopyMemory> {
        let of_copy = |material: &Material| ElementMemory {
            prony: material.prony.as_ref().map(prony_of),
            damping: material.stiffness_damping.map(StiffnessDamping),
        };
        let differs = self.copied.differs_in(Part::Memory);
        differs.then(|| PerCopyMemory(self.materials.iter().map(of_copy).collect()))
    }

    /// What elements of each weigh by, where it differs.
    pub fn inertia(&self, copies: &Arc<[u32]>) -> Option<PerCopyInertia> {
        let of_copy = |material: &Material| [material.density, material.damping.unwrap_or(0.0)];
        let of_copy = self.materials.iter().map(of_copy).collect();
        self.copied.differs_in(Part::Inertia).then(|| PerCopyInertia { copies: Arc::clone(copies), of_copy })
    }

    /// Where fibres of the families of each run, in the order of [`directions`], where that differs.
    pub fn directions(&self) -> Option<Vec<Vec<&schema::Direction>>> {
        let of_copy = |material| directions(material).into_iter().map(|(_, direction)| direction).collect();
        self.copied.differs_in(Part::Direction).then(|| self.materials.iter().map(of_copy).collect())
    }
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

fn prony_of(prony: &schema::Prony) -> Prony {
    let terms = |terms: &[schema::PronyTerm]| terms.iter().map(|term| (term.alpha, term.tau)).collect();
    Prony {
        terms: terms(&prony.terms),
        volumetric: terms(&prony.volumetric),
        integrator: prony.integrator,
        reproject: prony.reproject,
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
    called_for_in(material, material.clone())
}

/// A material with the effects that have a weight in another one, which differs from it in numbers only.
fn called_for_in(made: &Material, mut material: Material) -> Material {
    fn keep<T, M>(list: &mut Vec<T>, made: &[M], has_weight: impl Fn(&M) -> bool) {
        let mut weights = made.iter().map(has_weight);
        list.retain(|_| weights.next().unwrap_or(false));
    }
    material.fibres = material.fibres.filter(|_| made.fibres.as_ref().is_some_and(|fibres| fibres.eta != 0.0));
    if let (Some(families), Some(made)) = (&mut material.exponential_fibres, &made.exponential_fibres) {
        keep(families, made, |family| family.k1 != 0.0);
    }
    material.exponential_fibres = material.exponential_fibres.filter(|families| !families.is_empty());
    if let (Some(prony), Some(made)) = (&mut material.prony, &made.prony) {
        keep(&mut prony.terms, &made.terms, |term| term.alpha != 0.0);
        keep(&mut prony.volumetric, &made.volumetric, |term| term.alpha != 0.0);
    }
    material.prony = material.prony.filter(|prony| !(prony.terms.is_empty() && prony.volumetric.is_empty()));
    let has_weight = |made: Option<f64>| made.is_some_and(|number| number != 0.0);
    material.damping = material.damping.filter(|_| has_weight(made.damping));
    material.stiffness_damping = material.stiffness_damping.filter(|_| has_weight(made.stiffness_damping));
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
