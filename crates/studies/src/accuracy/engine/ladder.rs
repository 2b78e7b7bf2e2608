//! The ladder of elastic laws: the same tissue at small strains, under another law at large ones.

use sinew::scene::schema::{Material, Scene, comparable_laws};

/// Laws that a scene's materials can have instead of theirs, from the simplest on: those that not all of them have,
/// where all have one of these.
pub fn laws(scene: &Scene) -> Vec<String> {
    let known = comparable_laws();
    let own = |material: &Material| material.elastic_laws().first().copied().filter(|word| known.contains(word));
    let words: Vec<Option<&str>> = scene.materials.values().map(own).collect();
    if words.contains(&None) {
        return Vec::new();
    }
    let others = known.iter().filter(|word| words.iter().any(|own| own.as_ref() != Some(word)));
    others.map(|word| word.to_string()).collect()
}

/// Gives all materials of a scene another law of the same moduli at small strains.
pub fn climb(scene: &mut Scene, word: &str) {
    scene.materials.values_mut().for_each(|material| material.take_law(word));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;
    use sinew::materials::Elastic;
    use sinew::scene::SceneFile;

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
            assert_eq!(material.elastic_laws(), [word.as_str()]);
            let [shear, bulk] = material.elastic_law().unwrap().small_strain_moduli();
            assert!((shear - 700.0).abs() < 1e-9 && bulk == 5000.0, "{word}: {shear} {bulk}");
        }
    }
}
