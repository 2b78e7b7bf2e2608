//! The elastic law of a material: exactly one, with moduli that make sense.

use super::Validator;
use crate::materials::complaints::Complaint;
use crate::scene::limits::FORMULA_BYTES;
use crate::scene::schema::{ELASTIC_LAWS, Material, OwnLaw, laws_for_large_strains};
use crate::scene::syntax::Path;

/// What a law could be.
const FOR_INSTANCE: &str =
    "for instance energy: \"mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2\", parameters: {\"mu\": 1000, \"kappa\": 1e4}";

pub(super) fn validate(validator: &mut Validator, path: &Path, name: &str, material: &Material) {
    match material.elastic_laws()[..] {
        [] => {
            validator
                .out
                .error_at(path.name("neo_hookean"), format!("the material `{name}` has no elastic law"))
                .note("add for instance neo_hookean: Young(young: 3000, poisson: 0.45)")
                .note(format!("elastic laws: {}", ELASTIC_LAWS.join(", ")));
        }
        [_] => {}
        [first, ref others @ ..] => {
            for law in others {
                validator
                    .out
                    .error_at(path.name(*law), format!("the material `{name}` has two elastic laws, {first} and {law}"))
                    .note("a material has exactly one: leave the others out");
            }
        }
    }
    for (word, complaints) in material.check_elastic_laws() {
        complaints.list.into_iter().for_each(|complaint| tell(validator, &path.name(word), complaint));
    }
    if let Some(law) = &material.law {
        own_law(validator, &path.name("law"), law);
    }
    let large = laws_for_large_strains();
    let by_frame = if material.by_frame().is_some() { " with `rotation: Frame`" } else { "" };
    if let [word] = material.elastic_laws()[..]
        && (!large.contains(&word) || !by_frame.is_empty())
    {
        let fibres =
            [("fibres", material.fibres.is_some()), ("exponential_fibres", material.exponential_fibres.is_some())];
        for (effect, _) in fibres.into_iter().filter(|(_, there)| *there) {
            validator
                .out
                .error_at(
                    path.name(effect),
                    format!("`{effect}` need an elastic law for large strains, not `{word}`{by_frame}"),
                )
                .note(format!("elastic laws: {}", large.join(", ")));
        }
    }
}

fn tell(validator: &mut Validator, law: &Path, complaint: Complaint) {
    let at = format!("{law}.{}", complaint.at);
    let told = match complaint.is_error {
        true => validator.out.error_at(at, complaint.message),
        false => validator.out.warn_at(at, complaint.message),
    };
    for note in complaint.notes {
        told.note(note);
    }
}

fn own_law(validator: &mut Validator, path: &Path, law: &OwnLaw) {
    let ways = [("energy", law.energy.is_some()), ("file", !law.file.is_empty()), ("rust", law.rust.is_some())];
    let mut ways = ways.into_iter().filter_map(|(way, is_there)| is_there.then_some(way));
    match (ways.next(), ways.next()) {
        (Some(first), Some(second)) => {
            validator
                .out
                .error_at(path.name(second), format!("the law has both `{first}` and `{second}`"))
                .note("a law is a formula of its energy, a file of WGSL, or one in Rust: leave the other out");
            return;
        }
        (Some("rust"), None) => return,
        _ => {}
    }
    match &law.energy {
        Some(energy) if energy.trim().is_empty() => {
            validator.out.error_at(path.name("energy"), "the formula is empty").note(FOR_INSTANCE);
        }
        Some(energy) if energy.len() > FORMULA_BYTES => {
            let message = format!("a formula has at most {FORMULA_BYTES} bytes, found {}", energy.len());
            validator.out.error_at(path.name("energy"), message).note("a file of WGSL may be longer");
        }
        None if law.file.is_empty() => {
            validator
                .out
                .error_at(path.name("file"), "the law has neither `energy` nor `file` nor `rust`")
                .note(FOR_INSTANCE)
                .note("or file: \"law.wgsl\", a law in WGSL");
        }
        _ => {}
    }
}
