//! The elastic law of a material: exactly one, with moduli that make sense.

use super::{Judge, show};
use crate::scene::limits::FORMULA_BYTES;
use crate::scene::schema::{ArrudaBoyce, Elasticity, Material, MooneyRivlin, Ogden, OwnLaw};
use crate::scene::syntax::Path;

/// What a law could be.
const FOR_INSTANCE: &str =
    "for instance energy: \"mu/2*I1bar_minus_3 + kappa/2*J_minus_1^2\", parameters: {\"mu\": 1000, \"kappa\": 1e4}";

/// Terms that an Ogden law can have.
const OGDEN_TERMS: usize = 4;

/// Names of the elastic laws that a material has, and of all there are.
fn laws(material: &Material) -> (Vec<&'static str>, [&'static str; 8]) {
    let all = [
        ("linear", material.linear.is_some()),
        ("st_venant_kirchhoff", material.st_venant_kirchhoff.is_some()),
        ("neo_hookean", material.neo_hookean.is_some()),
        ("stable_neo_hookean", material.stable_neo_hookean.is_some()),
        ("mooney_rivlin", material.mooney_rivlin.is_some()),
        ("ogden", material.ogden.is_some()),
        ("arruda_boyce", material.arruda_boyce.is_some()),
        ("law", material.law.is_some()),
    ];
    (all.iter().filter(|(_, there)| *there).map(|(name, _)| *name).collect(), all.map(|(name, _)| name))
}

pub(super) fn validate(judge: &mut Judge, path: &Path, name: &str, material: &Material) {
    let (found, all) = laws(material);
    match found[..] {
        [] => {
            judge
                .out
                .error_at(path.name("neo_hookean"), format!("the material `{name}` has no elastic law"))
                .note("add for instance neo_hookean: Young(young: 3000, poisson: 0.45)")
                .note(format!("elastic laws: {}", all.join(", ")));
        }
        [_] => {}
        [first, ref others @ ..] => {
            for law in others {
                judge
                    .out
                    .error_at(path.name(*law), format!("the material `{name}` has two elastic laws, {first} and {law}"))
                    .note("a material has exactly one: leave the others out");
            }
        }
    }
    for (word, law) in [
        ("linear", material.linear),
        ("st_venant_kirchhoff", material.st_venant_kirchhoff),
        ("neo_hookean", material.neo_hookean),
        ("stable_neo_hookean", material.stable_neo_hookean),
    ] {
        if let Some(law) = law {
            elasticity(judge, &path.name(word), law);
        }
    }
    if let Some(law) = &material.law {
        own_law(judge, &path.name("law"), law);
    }
    if let Some(law) = &material.mooney_rivlin {
        mooney_rivlin(judge, &path.name("mooney_rivlin"), law);
    }
    if let Some(law) = &material.ogden {
        ogden(judge, &path.name("ogden"), law);
    }
    if let Some(law) = &material.arruda_boyce {
        arruda_boyce(judge, &path.name("arruda_boyce"), law);
    }
    if material.linear.is_some() {
        let fibres =
            [("fibres", material.fibres.is_some()), ("exponential_fibres", material.exponential_fibres.is_some())];
        for (word, _) in fibres.into_iter().filter(|(_, there)| *there) {
            judge
                .out
                .error_at(path.name(word), format!("`{word}` need an elastic law for large strains, not `linear`"))
                .note(format!("elastic laws: {}", all[1..].join(", ")));
        }
    }
}

fn own_law(judge: &mut Judge, path: &Path, law: &OwnLaw) {
    match &law.energy {
        Some(_) if !law.file.is_empty() => {
            judge
                .out
                .error_at(path.name("file"), "the law has both `energy` and `file`")
                .note("a law is a formula of its energy, or a file of WGSL: leave the other out");
        }
        Some(energy) if energy.trim().is_empty() => {
            judge.out.error_at(path.name("energy"), "the formula is empty").note(FOR_INSTANCE);
        }
        Some(energy) if energy.len() > FORMULA_BYTES => {
            let message = format!("a formula has at most {FORMULA_BYTES} bytes, found {}", energy.len());
            judge.out.error_at(path.name("energy"), message).note("a file of WGSL may be longer");
        }
        None if law.file.is_empty() => {
            judge
                .out
                .error_at(path.name("file"), "the law has neither `energy` nor `file`")
                .note(FOR_INSTANCE)
                .note("or file: \"law.wgsl\", a law in WGSL");
        }
        _ => {}
    }
}

fn elasticity(judge: &mut Judge, path: &Path, law: Elasticity) {
    match law {
        Elasticity::Young { young, poisson } => {
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
        Elasticity::Moduli { shear, bulk } => {
            judge.above_zero(&path.name("shear"), shear, "Pa");
            bulk_modulus(judge, path, bulk, shear, "`shear`");
        }
    }
}

/// A bulk modulus, with a warning where it is small against the shear modulus.
fn bulk_modulus(judge: &mut Judge, path: &Path, bulk: f64, shear: f64, called: &str) {
    judge.above_zero(&path.name("bulk"), bulk, "Pa");
    let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
    if shear > 0.0 && bulk > 0.0 && poisson < 0.0 {
        judge.out.warn_at(path.name("bulk"), format!("`bulk` is small: Poisson's ratio is {poisson:.3}")).note(
            format!("Poisson's ratio is above 0 when `bulk` is above 2/3 {called}, here {}", show(shear * 2.0 / 3.0)),
        );
    }
}

fn mooney_rivlin(judge: &mut Judge, path: &Path, law: &MooneyRivlin) {
    let sum = law.c10 + law.c01;
    if sum <= 0.0 {
        judge
            .out
            .error_at(path.name("c10"), format!("`c10` + `c01` must be above 0, found {} Pa", show(sum)))
            .note("twice their sum is the shear modulus of small strains");
    } else if law.c10 < 0.0 || law.c01 < 0.0 {
        let word = if law.c10 < 0.0 { "c10" } else { "c01" };
        judge
            .out
            .warn_at(path.name(word), format!("`{word}` is below 0: at some large stretch the law loses its stiffness"))
            .note("it is safe at every stretch when both are 0 or above");
    }
    bulk_modulus(judge, path, law.bulk, 2.0 * sum, "of 2 (`c10` + `c01`)");
}

fn ogden(judge: &mut Judge, path: &Path, law: &Ogden) {
    let terms = path.name("terms");
    let count = law.terms.len();
    if count == 0 || count > OGDEN_TERMS {
        judge
            .out
            .error_at(&terms, format!("`ogden` must have 1 to {OGDEN_TERMS} terms, found {count}"))
            .note("a term is (mu: 1000, alpha: 2)");
    }
    for (i, term) in law.terms.iter().enumerate() {
        if term.alpha == 0.0 {
            judge.out.error_at(terms.index(i).name("alpha"), "`alpha` must not be 0: such a term has no energy");
        } else if term.mu * term.alpha < 0.0 {
            judge
                .out
                .warn_at(
                    terms.index(i).name("mu"),
                    "`mu` and `alpha` are of different sign: at some large stretch the law loses its stiffness",
                )
                .note("it is safe at every stretch when `mu` times `alpha` is above 0 in each term");
        }
    }
    let shear = 0.5 * law.terms.iter().map(|term| term.mu * term.alpha).sum::<f64>();
    if count > 0 && shear <= 0.0 {
        judge
            .out
            .error_at(
                &terms,
                format!("the sum of all `mu` times `alpha` must be above 0, found {} Pa", show(2.0 * shear)),
            )
            .note("half of it is the shear modulus of small strains");
    }
    bulk_modulus(judge, path, law.bulk, shear, "of half the sum of all `mu` times `alpha`");
}

fn arruda_boyce(judge: &mut Judge, path: &Path, law: &ArrudaBoyce) {
    judge.above_zero(&path.name("shear"), law.shear, "Pa");
    if law.locking_stretch <= 1.0 {
        judge
            .must(&path.name("locking_stretch"), "above 1", show(law.locking_stretch))
            .note("chains at rest are stretched to 1 already; a large value gives the neo-Hookean law");
    }
    bulk_modulus(judge, path, law.bulk, law.shear, "`shear`");
}
