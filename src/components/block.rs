//! Element blocks: one element type, one material, one body. Columns hold groups of [`LANES`](crate::math::LANES)
//! elements: number `k` of element `e` stands at (e / LANES · numbers + k) · LANES + e mod LANES. The last group is
//! filled up with elements of no volume. Elements stand patch by patch, neighbours together.

use super::Reals;
use super::column::columns;
use crate::elements::elements_a_patch;
use crate::scene::schema::{ElementKind, Inversion};
use bevy_ecs::prelude::*;

/// What a block is.
#[derive(Component, Clone, Debug)]
pub struct Block {
    /// The body.
    pub body: Entity,
    /// The material.
    pub material: Entity,
    /// The element type.
    pub kind: ElementKind,
    /// How many elements, without those that fill up the last group.
    pub count: usize,
    /// Where the block's part of the body's [`ElementForce`](super::ElementForce) begins.
    pub force_offset: usize,
    /// How many numbers it has there.
    pub force_length: usize,
    /// Whether the element type is that for [specialised](crate::elements::Element::Specialisation) shapes.
    pub simple: bool,
    /// Of each family of fibres its direction: first that of `fibres`, then those of `exponential_fibres`.
    pub fibre_directions: Vec<FamilyDirection<f64>>,
}

/// What becomes of a block's elements that are turned inside out; where it is missing, the run stops.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnInversion(pub Inversion);

/// Where a family of fibres has its direction from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FamilyDirection<T> {
    /// The same unit vector in all elements.
    Uniform([T; 3]),
    /// One an element: which of the directions in [`FibreDirection`].
    Varying(usize),
}

columns! {
    /// Rows of the body's node columns, by corner.
    Connectivity(Vec<u32>) = "connectivity", Structure of Mesh, Elements;
    /// What the element type knows of the rest shape: see [`Element`](crate::elements::Element).
    RestShape(Reals) = "rest_shape", Given of Shape, Elements;
    /// Unit vectors along the fibres at rest, of the families where they differ from element to element.
    FibreDirection(Reals) = "fibre_direction", Given of Mesh, Elements;
    /// Viscous history q: six numbers a point and Prony term, then one a term of the pressure.
    ViscousMemory(Reals) = "viscous_memory", State of Memory, Elements;
    /// The same as it was before the last step. Implicit steps have carried their memories on when somebody looks at
    /// stress, which is that at their end. Exists with [`ViscousMemory`] where steps are implicit.
    MemoryBefore(Reals) = "memory_before", State of Scheme, Elements;
    /// 1 until the element is removed, then 0. Exists when elements can be removed.
    Alive(Vec<u32>) = "alive", State of Removal, Elements;
    /// The step before which the element goes at the latest; `u32::MAX`: never. Exists with [`Alive`].
    RemovalStep(Vec<u32>) = "removal_step", State of Removal, Elements;
    /// Elastic, hourglass and kinetic energy (J) that each element held when it was removed. Exists with [`Alive`].
    RemovedEnergy(Reals) = "removed_energy", State of Account, Elements;
    /// The part of [`RemovedEnergy`] that is kinetic along constrained axes (J): what constraints had given the mass
    /// that went, and is their work still. Exists with [`Alive`].
    RemovedWork(Reals) = "removed_work", State of Account, Elements, in "removed_motion_books";
    /// Momentum (kg m/s) that each element had when it was removed, three numbers each. Exists with [`Alive`].
    RemovedMomentum(Reals) = "removed_momentum", State of Account, Elements, in "removed_motion_books";
    /// Volume at rest (m³) of each element that is there, and that times θ, by which its law measures the change of
    /// volume. Exists with [`NodalVolumeChange`].
    ElementVolume(Reals) = "element_volume", Scratch of Mean, Elements;
    /// θ of each node of the body: the mean over the block's elements around it, by rest volume. Exists for elements
    /// with averaged nodal pressure.
    NodalVolumeChange(Reals) = "nodal_volume_change", Scratch of Mean, Nodes(1);
    /// What each 64 elements come to, four words each: bits of the elastic and the hourglass energy (J) and of the
    /// smallest J, and its row. For the guards on a GPU.
    ElementSums(Vec<u32>) = "element_sums", Scratch of Guard, Other;
    /// Two numbers: the lowest row of an element found with J < 0, by the kernel itself in every step, and the step in
    /// which it was: the first in which there was one; `u32::MAX`: none. Elements that are removed for it
    /// ([`OnInversion`]) are not noted here.
    FirstInverted(Vec<u32>) = "first_inverted", State of Inversion, Other;
    /// Mass that was added to each element so that the step may be as large as it is (kg), in f64 whatever the run's
    /// precision. Exists where the scene has mass scaled.
    AddedMass(Vec<f64>) = "added_mass", State of Mass, Elements;
}

/// Groups of elements of each of a block's patches but the last.
pub const fn patch_groups(kind: ElementKind) -> usize {
    elements_a_patch(kind) / crate::math::LANES
}

/// Elements of each of a block's patches but the last, which may have less.
pub const fn patch_length(kind: ElementKind) -> usize {
    patch_groups(kind) * crate::math::LANES
}

/// When each element goes at the latest (s); infinite: never by time. Exists with [`RemovalStep`] where elements go by
/// time.
#[derive(Component, Clone, Debug)]
pub struct RemovalTime(pub Vec<f64>);

/// Which elements of a block meet in a node: `elements[starts[i]..starts[i + 1]]` are rows of elements around node row
/// `i`, ascending. Exists with [`NodalVolumeChange`].
#[derive(Component, Clone, Debug)]
pub struct BlockCorners {
    /// Where each node's elements begin; one number more than nodes.
    pub starts: Vec<u32>,
    /// Rows of elements.
    pub elements: Vec<u32>,
}
