//! What a material brings to the kernels of its blocks: WGSL twins of its laws, and their parameters.

use super::cpu::BlockLaw;
use super::kernel::{Fragment, Layout, Uniform, uniform};
use crate::components::FamilyDirection;
use crate::materials::{self, ElasticLaw, ExponentialFibre, Fibres, Law, Prerequisite, PronyTerm, each_elastic_law};
use crate::shader;

uniform!(Fibres<f32> { eta, tension_only });
uniform!(PronyTerm<f32> { stress, memory, rate, aim });

/// A family of fibres as kernels see it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct ExponentialFamily {
    k1: f32,
    k2: f32,
    dispersion: f32,
    tension_only: f32,
    x: f32,
    y: f32,
    z: f32,
    unused: f32,
}
uniform!(ExponentialFamily { k1, k2, dispersion, tension_only, x, y, z, unused });

impl ExponentialFamily {
    pub fn new((family, direction): &(ExponentialFibre<f32>, FamilyDirection<f32>)) -> Self {
        let [x, y, z] = match direction {
            FamilyDirection::Uniform(direction) => *direction,
            FamilyDirection::Varying(_) => [0.0; 3],
        };
        let ExponentialFibre { k1, k2, dispersion, tension_only } = *family;
        Self { k1, k2, dispersion, tension_only, x, y, z, unused: 0.0 }
    }
}

/// The direction of each family, as WGSL.
pub(super) fn family_directions(families: &[(ExponentialFibre<f32>, FamilyDirection<f32>)]) -> String {
    let mut text = format!("const FAMILIES: u32 = {}u;\n", families.len());
    text += "fn family_direction(element: u32, family: u32) -> vec3<f32> {\n";
    for (number, (_, direction)) in families.iter().enumerate() {
        if let FamilyDirection::Varying(place) = direction {
            text += &format!(
                "    if family == {number}u {{\n        return varying_direction(element, {place}u);\n    }}\n"
            );
        }
    }
    text += "    let f = exponential_fibres[family];\n    return vec3<f32>(f.x, f.y, f.z);\n}\n";
    text
}

/// WGSL that gives an invocation the law of its element, where the parameters in
/// [`LawParameters::numbers`](super::cpu::LawParameters::numbers) differ from copy to copy; terms of what it
/// `remembers` are known only to kernels that carry that on.
pub(super) fn law_of_element(law: &BlockLaw<f32>, remembers: bool) -> String {
    let (rows, of_law) = law.copies.as_ref().map_or((0, 0), |copies| (copies.rows, copies.of_law));
    let families = &law.exponential;
    let fibres = law.fibres.as_ref().map(|(fibres, _)| fibres);
    let of_elastic = of_law - 2 * families.len() - usize::from(fibres.is_some());
    let mut text = format!(
        "@group(0) @binding(0) var<storage, read> law_numbers: array<f32>;\n\
         fn law_number(element: u32, k: u32) -> f32 {{\n    return law_numbers[place(element, {rows}u, k)];\n}}\n\
         fn take_law(element: u32) {{\n"
    );
    let part = ElasticPart::of(&law.elastic);
    let mut k = 0;
    for (name, offset, bytes) in part.layout.iter().flat_map(|layout| layout.members) {
        match bytes / 4 {
            1 if k < of_elastic => {
                text += &format!("    elastic.{name} = law_number(element, {k}u);\n");
                k += 1;
            }
            // what is no parameter is the same in all copies: how many terms there are
            1 => {
                let word = part.bytes.get(*offset..offset + 4).and_then(|bytes| bytes.try_into().ok());
                text += &format!("    elastic.{name} = {}u;\n", word.map_or(0, u32::from_ne_bytes));
            }
            numbers => {
                for i in 0..numbers {
                    text += &format!("    elastic.{name}[{i}] = law_number(element, {}u);\n", k + i);
                }
                k += numbers;
            }
        }
    }
    if let Some(fibres) = fibres {
        text += &format!("    fibres = Fibres(law_number(element, {k}u), {:?});\n", fibres.tension_only);
        k += 1;
    }
    for (number, family) in families.iter().enumerate() {
        let ExponentialFamily { dispersion, tension_only, x, y, z, .. } = ExponentialFamily::new(family);
        text += &format!(
            "    exponential_fibres[{number}] = ExponentialFamily(law_number(element, {k}u), law_number(element, {}u), \
             {dispersion:?}, {tension_only:?}, {x:?}, {y:?}, {z:?}, 0.0);\n",
            k + 1
        );
        k += 2;
    }
    for (number, k) in (of_law..rows).step_by(4).enumerate().filter(|_| remembers) {
        let numbers: Vec<String> = (k..k + 4).map(|k| format!("law_number(element, {k}u)")).collect();
        text += &format!("    prony[{number}] = PronyTerm({});\n", numbers.join(", "));
    }
    text + "}\n"
}

/// An elastic law's WGSL twin, its parameters, and how they are laid out.
pub(super) struct ElasticPart {
    /// None of a law of the user's own, which is a unit.
    pub fragment: Option<Fragment>,
    /// Empty for a law without parameters.
    pub bytes: Vec<u8>,
    /// None where the bytes were laid out by reflection.
    pub layout: Option<Layout>,
}

/// A law whose numbers are all of each element; in the order in which it has them.
const OF_FRAME: Layout = Layout {
    name: "CorotationalFrame",
    size: 48,
    members: &[("shear", 0, 4), ("bulk", 4, 4), ("along", 16, 12), ("across", 32, 12)],
};

macro_rules! elastic_parts {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        impl ElasticPart {
            pub fn of(law: &ElasticLaw<f32>) -> Self {
                match law {
                    $(ElasticLaw::$law(law) => Self {
                        fragment: Some(shader!($word)),
                        bytes: law.bytes(),
                        layout: Some(<materials::$law<f32> as Uniform>::LAYOUT),
                    },)*
                    ElasticLaw::CorotationalFrame(_) => Self {
                        fragment: Some(shader!("corotational_frame")),
                        bytes: Vec::new(),
                        layout: Some(OF_FRAME),
                    },
                    ElasticLaw::UserLaw(law) => Self {
                        fragment: None,
                        bytes: law.parts().uniform.clone(),
                        layout: None,
                    },
                }
            }
        }

        /// Fragments that a law's twin stands on.
        pub(super) fn prerequisites(law: &ElasticLaw<f32>) -> Vec<Fragment> {
            let files = match law {
                $(ElasticLaw::$law(_) => <materials::$law<f64> as Law>::PREREQUISITES,)*
                ElasticLaw::CorotationalFrame(_) => &[Prerequisite::Hooke],
                ElasticLaw::UserLaw(_) => &[Prerequisite::FiniteStrain, Prerequisite::VolumeRatio],
            };
            files.iter().copied().map(fragment).collect()
        }
    };
}
each_elastic_law!(elastic_parts);

fn fragment(support: Prerequisite) -> Fragment {
    match support {
        Prerequisite::FiniteStrain => shader!("finite_strain"),
        Prerequisite::VolumeRatio => shader!("volume_ratio"),
        Prerequisite::Hooke => shader!("hooke"),
        Prerequisite::Eigen => shader!("eigen"),
        Prerequisite::Elementary => shader!("elementary"),
        Prerequisite::Invariants => shader!("invariants"),
    }
}
