//! Laws of the user's own, read from the files that materials name.

pub(super) use crate::backend::user_law::Read;

use super::own_texts;
use crate::backend::user_law::read as read_law;
use crate::scene::SceneFile;
use crate::scene::diagnostic::Diagnostics;
use crate::scene::schema::OwnLaw;
use crate::scene::syntax::Path;
use std::collections::BTreeMap;

/// The laws of all materials that have one, by the material's name. Complaints go to `diagnostics`.
pub(super) fn read(scene: &SceneFile, diagnostics: &mut Diagnostics) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    for (name, material) in &scene.scene.materials {
        let Some(law) = &material.law else { continue };
        let place = Path::default().name("materials").name(name).name("law");
        if diagnostics.has_error_in(place.clone()) {
            continue;
        }
        if let Some(read) = one(scene, law, &place, diagnostics) {
            found.insert(name.clone(), read);
        }
    }
    found
}

fn one(scene: &SceneFile, law: &OwnLaw, place: &Path, diagnostics: &mut Diagnostics) -> Option<Read> {
    let file = own_texts::read(scene, &law.file, place, diagnostics)?;
    let (read, complaints) = match read_law(&law.file, &file.text, &law.parameters) {
        Ok(mut read) => {
            let warnings = std::mem::take(&mut read.warnings);
            (Some(read), warnings)
        }
        Err(complaints) => (None, complaints),
    };
    for complaint in complaints {
        own_texts::tell(complaint, &file, place, diagnostics);
    }
    read
}
