//! The ladder of elastic laws: the same tissue at small strains, under another law at large ones.

use crate::materials::{self, Elastic};
use crate::scene::schema::{ArrudaBoyce, Elasticity, Material, MooneyRivlin, Ogden, OgdenTerm, Scene};

/// The laws by their words in scenes, from the simplest on.
const LAWS: [&str; 6] = ["linear", "st_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "ogden", "arruda_boyce"];
/// The exponent of the one term that an Ogden law on the ladder has: 2 would be neo-Hookean.
const OGDEN_ALPHA: f64 = 4.0;
/// The locking stretch of the chains of an Arruda-Boyce law on the ladder.
const LOCKING_STRETCH: f64 = 2.0;

/// Laws that a scene's materials can have instead of theirs: those that not all of them have, where all have one of the
/// list.
pub fn laws(scene: &Scene) -> Vec<String> {
    if scene.materials.values().any(|material| small_strain_moduli(material).is_none()) {
        return Vec::new();
    }
    let others = LAWS.iter().filter(|word| scene.materials.values().any(|material| word_of(material) != Some(word)));
    others.map(|word| word.to_string()).collect()
}

fn word_of(material: &Material) -> Option<&'static str> {
    let has = [
        material.linear.is_some(),
        material.st_venant_kirchhoff.is_some(),
        material.neo_hookean.is_some(),
        material.mooney_rivlin.is_some(),
        material.ogden.is_some(),
        material.arruda_boyce.is_some(),
    ];
    has.iter().position(|has| *has).map(|place| LAWS[place])
}

/// Shear and bulk modulus (Pa) of the law at small strains.
fn small_strain_moduli(material: &Material) -> Option<(f64, f64)> {
    let elasticity = [&material.linear, &material.st_venant_kirchhoff, &material.neo_hookean];
    let of_elasticity = elasticity.into_iter().flatten().map(|law| law.moduli()).next();
    let mooney_rivlin = material.mooney_rivlin.map(|law| (2.0 * (law.c10 + law.c01), law.bulk));
    let ogden = || {
        let law = material.ogden.as_ref()?;
        Some((law.terms.iter().map(|term| 0.5 * term.mu * term.alpha).sum(), law.bulk))
    };
    let arruda_boyce = || {
        let law = material.arruda_boyce?;
        Some((law.shear * chain_factor(law.locking_stretch), law.bulk))
    };
    of_elasticity.or(mooney_rivlin).or_else(ogden).or_else(arruda_boyce)
}

/// Shear modulus at small strains over the parameter μ of an Arruda-Boyce law.
fn chain_factor(locking_stretch: f64) -> f64 {
    materials::ArrudaBoyce { shear: 1.0, locking_stretch, bulk: 1.0 }.small_strain_moduli()[0]
}

/// Gives all materials of a scene another law of the same moduli at small strains. A Mooney-Rivlin law gets equal
/// constants.
pub fn climb(scene: &mut Scene, word: &str) {
    for material in scene.materials.values_mut() {
        let Some((shear, bulk)) = small_strain_moduli(material) else { continue };
        (material.linear, material.st_venant_kirchhoff, material.neo_hookean) = (None, None, None);
        (material.mooney_rivlin, material.ogden, material.arruda_boyce) = (None, None, None);
        let moduli = Some(Elasticity::Moduli { shear, bulk });
        match word {
            "linear" => material.linear = moduli,
            "st_venant_kirchhoff" => material.st_venant_kirchhoff = moduli,
            "mooney_rivlin" => {
                material.mooney_rivlin = Some(MooneyRivlin { c10: 0.25 * shear, c01: 0.25 * shear, bulk });
            }
            "ogden" => {
                let term = OgdenTerm { mu: 2.0 * shear / OGDEN_ALPHA, alpha: OGDEN_ALPHA };
                material.ogden = Some(Ogden { terms: vec![term], bulk });
            }
            "arruda_boyce" => {
                let (locking_stretch, shear) = (LOCKING_STRETCH, shear / chain_factor(LOCKING_STRETCH));
                material.arruda_boyce = Some(ArrudaBoyce { shear, locking_stretch, bulk });
            }
            _ => material.neo_hookean = moduli,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;
    use crate::scene::SceneFile;

    #[test]
    fn every_law_of_the_ladder_has_the_moduli_of_the_scene_at_small_strains() {
        let text = r#"(duration: 1, bodies: {"a": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: "m")},
            materials: {"m": (density: 1, neo_hookean: Moduli(shear: 700, bulk: 5000))})"#;
        let file = SceneFile::from_text("a.ron", text, "".as_ref(), &[]).unwrap();
        let words = laws(&file.scene);
        assert_eq!(words, ["linear", "st_venant_kirchhoff", "mooney_rivlin", "ogden", "arruda_boyce"]);
        for word in words {
            let mut scene = file.scene.clone();
            climb(&mut scene, &word);
            let material = &scene.materials["m"];
            assert_eq!(word_of(material), Some(word.as_str()));
            let (shear, bulk) = small_strain_moduli(material).unwrap();
            assert!((shear - 700.0).abs() < 1e-9 && bulk == 5000.0, "{word}: {shear} {bulk}");
        }
    }
}
