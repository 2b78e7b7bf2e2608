//! What a material brings to the kernels of its blocks: WGSL twins of its laws, and their parameters.

use super::kernel::{Fragment, Layout, Uniform, uniform};
use crate::components::FamilyDirection;
use crate::materials::{
    ArrudaBoyce, ElasticLaw, ExponentialFibre, Fibres, Linear, MooneyRivlin, NeoHookean, Ogden, PronyTerm,
    StVenantKirchhoff, StableNeoHookean, each_elastic_law,
};
use crate::shader;

uniform!(Linear<f32> { shear, bulk });
uniform!(StVenantKirchhoff<f32> { shear, bulk });
uniform!(NeoHookean<f32> { shear, bulk });
uniform!(StableNeoHookean<f32> { shear, bulk });
uniform!(MooneyRivlin<f32> { c10, c01, bulk });
uniform!(ArrudaBoyce<f32> { shear, locking_stretch, bulk });
uniform!(Fibres<f32> { eta, tension_only });
uniform!(PronyTerm<f32> { stress, memory, rate, aim });

impl Uniform for Ogden<f32> {
    // WGSL has vec4 for four numbers, and rounds the struct up to whole ones
    const LAYOUT: Layout = Layout {
        name: "Ogden",
        size: 48,
        members: &[("mu", 0, 16), ("alpha", 16, 16), ("bulk", 32, 4), ("terms", 36, 4)],
    };
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = bytemuck::cast_slice(&[self.mu, self.alpha]).to_vec();
        bytes.extend(self.bulk.to_ne_bytes());
        bytes.extend(self.terms.to_ne_bytes());
        bytes.resize(Self::LAYOUT.size, 0);
        bytes
    }
}

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

/// An elastic law's WGSL twin, its parameters, and how they are laid out.
pub(super) struct ElasticPart {
    pub fragment: Fragment,
    /// Empty for a law without parameters.
    pub bytes: Vec<u8>,
    /// None where the bytes were laid out by reflection.
    pub layout: Option<Layout>,
}

macro_rules! elastic_parts {
    ($($law:ident = $stem:literal;)*) => {
        impl ElasticPart {
            pub fn of(law: &ElasticLaw<f32>) -> Self {
                match law {
                    $(ElasticLaw::$law(law) => Self {
                        fragment: shader!($stem),
                        bytes: law.bytes(),
                        layout: Some(<$law<f32> as Uniform>::LAYOUT),
                    },)*
                    ElasticLaw::UserLaw(law) => Self {
                        fragment: Fragment::new(law.parts().path.as_str(), law.parts().text.as_str()),
                        bytes: law.parts().uniform.clone(),
                        layout: None,
                    },
                }
            }
        }
    };
}
each_elastic_law!(elastic_parts);

/// Fragments that a law's twin stands on: what it has no functions of its own for.
pub(super) fn ground(law: &ElasticLaw<f32>) -> Vec<Fragment> {
    match law {
        ElasticLaw::Linear(_) => vec![],
        ElasticLaw::StVenantKirchhoff(_) => vec![shader!("finite_strain")],
        ElasticLaw::StableNeoHookean(_) => vec![shader!("elementary")],
        ElasticLaw::Ogden(_) => {
            vec![shader!("finite_strain"), shader!("volume_ratio"), shader!("eigen"), shader!("elementary")]
        }
        // may call what all of these call
        ElasticLaw::UserLaw(_) => vec![
            shader!("finite_strain"),
            shader!("volume_ratio"),
            shader!("eigen"),
            shader!("elementary"),
            shader!("invariants"),
        ],
        _ => vec![shader!("finite_strain"), shader!("volume_ratio")],
    }
}
