//! What an elastic law is, and the list of those there are.

use super::{Kinematics, NeoHookean};
use crate::math::{Mat3, Real, Scalar, Sym3};

/// An isotropic elastic law over the numbers `R`: Ψ = Ψ_iso + U(θ), so that S = S_iso + U'(θ) ∂θ/∂E.
///
/// θ measures the change of volume; it is J − 1 unless the law says otherwise. Elements that do not lock take the pressure
/// U'(θ) from means of θ. The WGSL twin of a law has functions of the same names with `elastic_` before them; those that
/// have a default here have it in `shaders/finite_strain.wgsl` and `shaders/volume_ratio.wgsl`.
pub trait Elastic<R: Real>: Copy + Send + Sync {
    /// The same law over other numbers.
    type Of<Q: Real>: Elastic<Q>;

    /// Its parameters as other numbers.
    fn map<Q: Real>(&self, number: impl Fn(R) -> Q) -> Self::Of<Q>;

    /// Strain measures of a displacement gradient.
    #[inline(always)]
    fn kinematics(gradient: &Mat3<R>) -> Kinematics<R> {
        Kinematics::new(gradient)
    }

    /// First Piola-Kirchhoff stress (Pa) from the second: F S.
    #[inline(always)]
    fn first_stress(gradient: &Mat3<R>, stress: &Sym3<R>) -> Mat3<R> {
        gradient.plus_identity_times(stress)
    }

    /// S_iso (Pa): all of the second Piola-Kirchhoff stress that the pressure does not give.
    fn isochoric(&self, k: &Kinematics<R>) -> Sym3<R>;

    /// θ.
    #[inline(always)]
    fn volume_measure(k: &Kinematics<R>) -> R {
        k.volume_change
    }

    /// Second Piola-Kirchhoff stress (Pa) of a pressure (Pa): p ∂θ/∂E, with J C⁻¹ for ∂θ/∂E.
    #[inline(always)]
    fn volumetric(k: &Kinematics<R>, pressure: R) -> Sym3<R> {
        k.adjugate_c.scaled(pressure / k.j)
    }

    /// U'(θ) (Pa), positive when the volume has grown.
    fn pressure(&self, theta: R) -> R;

    /// Ψ_iso (J/m³).
    fn isochoric_energy(&self, k: &Kinematics<R>) -> R;

    /// U(θ) (J/m³).
    fn volumetric_energy(&self, theta: R) -> R;

    /// Shear and bulk modulus (Pa) at small strains.
    fn small_strain_moduli(&self) -> [R; 2];
}

/// All elastic laws: type and name. One line here makes a law known to both backends.
macro_rules! each_elastic_law {
    ($then:ident) => {
        $then! {
            NeoHookean = "neo_hookean";
        }
    };
}
pub(crate) use each_elastic_law;

/// What is done with a law whatever its type.
pub trait WithElastic<T: Scalar> {
    /// What comes of it.
    type Output;
    /// Does it.
    fn with<L: Elastic<T>>(self, law: &L) -> Self::Output;
}

macro_rules! elastic_laws {
    ($($law:ident = $name:literal;)*) => {
        /// Any elastic law.
        #[derive(Clone, Copy, Debug)]
        #[allow(missing_docs)]
        pub enum ElasticLaw<T: Scalar> {
            $($law($law<T>),)*
        }

        impl ElasticLaw<f64> {
            /// The law that an entity has as a component.
            pub fn of(material: bevy_ecs::world::EntityRef<'_>) -> Option<Self> {
                $(if let Some(&law) = material.get::<$law<f64>>() {
                    return Some(ElasticLaw::$law(law));
                })*
                None
            }
        }

        impl<T: Scalar> ElasticLaw<T> {
            /// Its name in scenes, and the stem of its WGSL twin.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$law(_) => $name,)*
                }
            }

            /// In another precision.
            pub fn rounded<Q: Scalar>(&self) -> ElasticLaw<Q> {
                match self {
                    $(Self::$law(law) => ElasticLaw::$law(law.map(|x| Q::from_f64(x.to_f64()))),)*
                }
            }

            /// Does something with the law as what it is.
            #[inline(always)]
            pub fn with<W: WithElastic<T>>(&self, what: W) -> W::Output {
                match self {
                    $(Self::$law(law) => what.with(law),)*
                }
            }

            /// As [`Elastic::kinematics`].
            pub fn kinematics(&self, gradient: &Mat3<T>) -> Kinematics<T> {
                match self {
                    $(Self::$law(_) => <$law<T>>::kinematics(gradient),)*
                }
            }

            /// As [`Elastic::first_stress`].
            pub fn first_stress(&self, gradient: &Mat3<T>, stress: &Sym3<T>) -> Mat3<T> {
                match self {
                    $(Self::$law(_) => <$law<T>>::first_stress(gradient, stress),)*
                }
            }

            /// As [`Elastic::isochoric`].
            pub fn isochoric(&self, k: &Kinematics<T>) -> Sym3<T> {
                match self {
                    $(Self::$law(law) => law.isochoric(k),)*
                }
            }

            /// As [`Elastic::volume_measure`].
            pub fn volume_measure(&self, k: &Kinematics<T>) -> T {
                match self {
                    $(Self::$law(_) => <$law<T>>::volume_measure(k),)*
                }
            }

            /// As [`Elastic::volumetric`].
            pub fn volumetric(&self, k: &Kinematics<T>, pressure: T) -> Sym3<T> {
                match self {
                    $(Self::$law(_) => <$law<T>>::volumetric(k, pressure),)*
                }
            }

            /// As [`Elastic::pressure`].
            pub fn pressure(&self, theta: T) -> T {
                match self {
                    $(Self::$law(law) => law.pressure(theta),)*
                }
            }

            /// As [`Elastic::isochoric_energy`].
            pub fn isochoric_energy(&self, k: &Kinematics<T>) -> T {
                match self {
                    $(Self::$law(law) => law.isochoric_energy(k),)*
                }
            }

            /// As [`Elastic::volumetric_energy`].
            pub fn volumetric_energy(&self, theta: T) -> T {
                match self {
                    $(Self::$law(law) => law.volumetric_energy(theta),)*
                }
            }

            /// As [`Elastic::small_strain_moduli`].
            pub fn small_strain_moduli(&self) -> [T; 2] {
                match self {
                    $(Self::$law(law) => law.small_strain_moduli(),)*
                }
            }
        }
    };
}
each_elastic_law!(elastic_laws);
