//! Fields of VTU files: each once, and such as the scene has.

use super::{Validator, scene};
use crate::scene::schema::{Field, Material, OutputField, Scene};

pub(super) fn validate(scene_: &Scene, validator: &mut Validator) {
    let path = scene("output").name("fields");
    let Some(fields) = &scene_.output.fields else { return };
    for (i, field) in fields.iter().enumerate() {
        if fields[..i].contains(field) {
            validator.out.error_at(path.index(i), format!("`{field:?}` is there twice")).note("name each field once");
        }
        if *field == OutputField::FibreStretch && !scene_.materials.values().any(has_fibres) {
            validator
                .out
                .error_at(path.index(i), "no material has fibres whose stretch could be written")
                .note("add `fibres` or `exponential_fibres` to a material, or leave `FibreStretch` out");
        }
    }
    let drawn = match scene_.picture.field {
        Field::Displacement => OutputField::Displacement,
        Field::Speed => OutputField::Velocity,
        Field::VonMises => OutputField::VonMises,
        Field::Pressure => OutputField::Pressure,
        Field::VolumeRatio => OutputField::VolumeRatio,
    };
    let missing: Vec<OutputField> =
        [OutputField::Displacement, drawn].into_iter().filter(|field| !fields.contains(field)).collect();
    if let Some(field) = missing.last() {
        let what = match field {
            OutputField::Displacement => "`sinew render` would draw the shape at rest".to_string(),
            _ => format!("`sinew render` would not find the scene's `picture: (field: {:?})`", scene_.picture.field),
        };
        validator
            .out
            .warn_at(path, format!("{what}: `{field:?}` is not among `fields`"))
            .note("add it, if you want pictures");
    }
}

fn has_fibres(material: &Material) -> bool {
    material.fibres.is_some() || material.exponential_fibres.as_ref().is_some_and(|families| !families.is_empty())
}
