//! What an elastic law is, and the list of those there are.

use super::{Fibres, Kinematics};
use crate::math::{Mat3, Real, Sym3, dot_plus};

/// An isotropic elastic law over the numbers `R`: Ψ = Ψ_iso + U(θ), so that S = S_iso + U'(θ) ∂θ/∂E.
///
/// θ measures the change of volume; it is J − 1 unless the law says otherwise. Elements that do not lock take the
/// pressure U'(θ) from means of θ. The WGSL twin of a law has functions of the same names with `elastic_` before them;
/// those that have a default here have it in `shaders/finite_strain.wgsl` and `shaders/volume_ratio.wgsl`.
pub trait Elastic<R: Real>: Copy + Send + Sync {
    /// The same law over other numbers.
    type Of<Q: Real>: Elastic<Q>;

    /// Its parameters as other numbers.
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Self::Of<Q>;

    /// Strain measures of a displacement gradient.
    #[inline(always)]
    fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::new(gradient)
    }

    /// First Piola-Kirchhoff stress (Pa): F S of S_iso, to which effects may have been added, and of a pressure (Pa).
    #[inline(always)]
    fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
        gradient.plus_identity_times(&isochoric.plus(&self.volumetric(k, pressure)))
    }

    /// First Piola-Kirchhoff stress (Pa) and J where nothing but this law and one family of fibres acts, along
    /// `fibres.1` at rest; with its own pressure, or one that the element gives (Pa). A law that knows a shorter way
    /// than by S takes it.
    #[inline(always)]
    fn direct_stress(
        &self,
        gradient: &Mat3<R>,
        pressure: Option<R>,
        fibres: Option<(Fibres<R>, [R; 3])>,
    ) -> (Mat3<R>, R) {
        self.stress_relaxed(
            gradient,
            pressure,
            fibres.map(
                #[inline(always)]
                |(fibres, direction)| (fibres, Sym3::square_of(direction)),
            ),
            #[inline(always)]
            |isochoric, volumetric| isochoric.plus(&volumetric),
        )
    }

    /// The same where something becomes of S_iso (Pa), fibres and all: `relax` says what, and adds the second stress it
    /// gets (Pa), that of the pressure. Fibres come with a⊗a of their direction.
    #[inline(always)]
    fn stress_relaxed(
        &self,
        gradient: &Mat3<R>,
        pressure: Option<R>,
        fibres: Option<(Fibres<R>, Sym3<R>)>,
        relax: impl FnOnce(Sym3<R>, Sym3<R>) -> Sym3<R>,
    ) -> (Mat3<R>, R) {
        let k = self.kinematics(gradient);
        let pressure = match pressure {
            Some(pressure) => pressure,
            None => self.pressure(self.volume_measure(&k)),
        };
        let mut isochoric = self.isochoric(&k);
        if let Some((fibres, along_squared)) = fibres {
            isochoric = isochoric.plus(&fibres.isochoric_along(&k, &along_squared));
        }
        let zero = pressure.constant(0.0);
        let rest = relax(isochoric, Sym3([zero; 6]));
        (self.first_stress(gradient, &k, &rest, pressure), k.true_j)
    }

    /// The first Piola-Kirchhoff stress (Pa) and J of a law that is all there is at a point, with its own pressure,
    /// where the law has a way that is much shorter than by S.
    #[inline(always)]
    fn alone(&self, _gradient: &Mat3<R>) -> Option<(Mat3<R>, R)> {
        None
    }

    /// S_iso (Pa): all of the second Piola-Kirchhoff stress that the pressure does not give.
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R>;

    /// θ.
    #[inline(always)]
    fn volume_measure(&self, k: &Kinematics<R>) -> R {
        k.volume_change
    }

    /// Second Piola-Kirchhoff stress (Pa) of a pressure (Pa): p ∂θ/∂E, with J C⁻¹ for ∂θ/∂E.
    #[inline(always)]
    fn volumetric(&self, k: &Kinematics<R>, pressure: R) -> Sym3<R> {
        k.adjugate_c.scaled(pressure / k.j)
    }

    /// What a stress (Pa) is without its part that acts on θ and so is a pressure: s − (s:C)/3 C⁻¹ where θ is J − 1.
    #[inline(always)]
    fn without_pressure(&self, k: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
        k.without_pressure(&stress)
    }

    /// Cauchy stress (Pa) from the first Piola-Kirchhoff stress and J: P Fᵀ/J.
    fn cauchy(&self, gradient: &Mat3<R>, j: R, first: &Mat3<R>) -> Sym3<R> {
        let (h, p) = (&gradient.0, &first.0);
        let entry = |i: usize, k: usize| dot_plus(p[i], h[k], p[i][k]) / j;
        Sym3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)])
    }

    /// U'(θ) (Pa), positive when the volume has grown.
    fn pressure(&self, theta: R) -> R;

    /// Ψ_iso (J/m³).
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R;

    /// U(θ) (J/m³).
    fn volumetric_energy(&self, theta: R) -> R;

    /// Shear and bulk modulus (Pa) at small strains.
    fn small_strain_moduli(&self) -> [R; 2];

    /// Whether it ends at J = 0, and pushes without bound before: else it has a stress, and a tangent stiffness, also
    /// of what is flat or inside out.
    fn ends_at_no_volume(&self) -> bool {
        true
    }
}

/// All elastic laws with a WGSL file of ours: word and type. One line here makes a law known to scenes and to both
/// backends, and to the studies that compare laws in this order.
macro_rules! each_elastic_law {
    ($then:ident $($more:tt)*) => {
        $then! {
            /// Hooke's law for small strains and rotations.
            linear: Linear;
            /// Hooke's law in Green's strain: large rotations, small strains.
            st_venant_kirchhoff: StVenantKirchhoff;
            /// Hooke's law in the frame that turns with the material: large rotations, moderate strains.
            corotational: Corotational;
            /// The neo-Hookean law, for large strains.
            neo_hookean: NeoHookean;
            /// The stable neo-Hookean law, defined for every deformation, also of tissue that is turned inside out.
            stable_neo_hookean: StableNeoHookean;
            /// The Mooney-Rivlin law, for large strains.
            mooney_rivlin: MooneyRivlin;
            /// Ogden's law in principal stretches, for large strains.
            ogden: Ogden;
            /// The eight-chain law of Arruda and Boyce, which stiffens towards a locking stretch.
            arruda_boyce: ArrudaBoyce;
            $($more)*
        }
    };
}
pub(crate) use each_elastic_law;

macro_rules! elastic_laws {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        /// Any elastic law. It is a law itself: one that asks at each point which it is.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)]
        pub enum ElasticLaw<R: Real> {
            $($law(super::$law<R>),)*
        }

        impl ElasticLaw<f64> {
            /// The law that an entity has as a component.
            pub fn of(material: bevy_ecs::world::EntityRef<'_>) -> Option<Self> {
                $(if let Some(&law) = material.get::<super::$law<f64>>() {
                    return Some(ElasticLaw::$law(law));
                })*
                None
            }
        }

        impl<R: Real> ElasticLaw<R> {
            /// Its name in scenes, and the stem of its WGSL twin.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$law(_) => stringify!($word),)*
                }
            }
        }

        impl<R: Real> Elastic<R> for ElasticLaw<R> {
            type Of<Q: Real> = ElasticLaw<Q>;

            #[inline(always)]
            fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> ElasticLaw<Q> {
                match self {
                    $(Self::$law(law) => ElasticLaw::$law(law.map(number)),)*
                }
            }
            #[inline(always)]
            fn kinematics(&self, gradient: &Mat3<R>) -> Kinematics<R> {
                match self {
                    $(Self::$law(law) => law.kinematics(gradient),)*
                }
            }
            #[inline(always)]
            fn first_stress(&self, gradient: &Mat3<R>, k: &Kinematics<R>, isochoric: &Sym3<R>, pressure: R) -> Mat3<R> {
                match self {
                    $(Self::$law(law) => law.first_stress(gradient, k, isochoric, pressure),)*
                }
            }
            #[inline(always)]
            fn alone(&self, gradient: &Mat3<R>) -> Option<(Mat3<R>, R)> {
                match self {
                    $(Self::$law(law) => law.alone(gradient),)*
                }
            }
            #[inline(always)]
            fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R> {
                match self {
                    $(Self::$law(law) => law.isochoric(k),)*
                }
            }
            #[inline(always)]
            fn volume_measure(&self, k: &Kinematics<R>) -> R {
                match self {
                    $(Self::$law(law) => law.volume_measure(k),)*
                }
            }
            #[inline(always)]
            fn volumetric(&self, k: &Kinematics<R>, pressure: R) -> Sym3<R> {
                match self {
                    $(Self::$law(law) => law.volumetric(k, pressure),)*
                }
            }
            #[inline(always)]
            fn without_pressure(&self, k: &Kinematics<R>, stress: Sym3<R>) -> Sym3<R> {
                match self {
                    $(Self::$law(law) => law.without_pressure(k, stress),)*
                }
            }
            fn cauchy(&self, gradient: &Mat3<R>, j: R, first: &Mat3<R>) -> Sym3<R> {
                match self {
                    $(Self::$law(law) => law.cauchy(gradient, j, first),)*
                }
            }
            #[inline(always)]
            fn pressure(&self, theta: R) -> R {
                match self {
                    $(Self::$law(law) => law.pressure(theta),)*
                }
            }
            fn isochoric_energy(&self, k: &Kinematics<R>) -> R {
                match self {
                    $(Self::$law(law) => law.isochoric_energy(k),)*
                }
            }
            fn volumetric_energy(&self, theta: R) -> R {
                match self {
                    $(Self::$law(law) => law.volumetric_energy(theta),)*
                }
            }
            fn small_strain_moduli(&self) -> [R; 2] {
                match self {
                    $(Self::$law(law) => law.small_strain_moduli(),)*
                }
            }
            fn ends_at_no_volume(&self) -> bool {
                match self {
                    $(Self::$law(law) => law.ends_at_no_volume(),)*
                }
            }
        }
    };
}
each_elastic_law!(elastic_laws corotational_frame: CorotationalFrame; law: UserLaw;);

macro_rules! texts {
    ($($(#[$doc:meta])* $word:ident: $law:ident;)*) => {
        /// The texts of the files of laws: what their parameters mean is told in the words they are documented with.
        pub const TEXTS: &[&str] = &[
            include_str!("elasticity.rs"),
            $(include_str!(concat!(stringify!($word), ".rs")),)*
        ];
    };
}
each_elastic_law!(texts);
