//! What a node system may ask of its body's columns: what it has declared, and nothing else.

use super::node_columns::NodeColumns;
use crate::components::*;
use bevy_ecs::component::ComponentId;
use bevy_ecs::prelude::World;
use bevy_ecs::system::SystemAccess;
use std::sync::atomic::{AtomicU32, Ordering};

/// What component something is in a world.
type ComponentOf = fn(&World) -> Option<ComponentId>;

macro_rules! asked {
    ($($column:ident),*) => {
        /// Columns that node systems ask for, by the places of their bits: two of each, to read and to write.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Asked {
            $($column),*
        }

        /// In that order their names, and their components.
        const COLUMNS: &[(&str, ComponentOf)] = &[$((stringify!($column), |world| world.component_id::<$column>())),*];
    };
}
asked!(
    Mass,
    InertialMass,
    InternalForce,
    ExternalForce,
    ConstrainedAxes,
    DampingCoefficient,
    Displacement,
    DisplacementIncrement
);

/// Places of systems that a note has room for, and of bits.
const BITS: u32 = 2 * COLUMNS.len() as u32;

/// What the system whose turn it is has declared, and which of its pass it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Declared {
    bits: u32,
    system: u32,
}

/// All: what is no system asks for what it likes.
impl Default for Declared {
    fn default() -> Self {
        Self { bits: u32::MAX, system: 0 }
    }
}

impl Declared {
    /// What the access of a system says.
    pub(crate) fn of(access: &SystemAccess, world: &World) -> Self {
        let touched = Touched(access);
        let of_column = |(place, (_, id)): (usize, &(&str, ComponentOf))| {
            let Some(id) = id(world) else { return 0 };
            u32::from(touched.reads(id)) << (2 * place) | u32::from(touched.writes(id)) << (2 * place + 1)
        };
        Self { bits: COLUMNS.iter().enumerate().map(of_column).fold(0, |all, bits| all | bits), system: 0 }
    }

    /// The same of the system of a place in its pass.
    pub(crate) fn at(self, place: usize) -> Self {
        Self { system: place as u32, ..self }
    }
}

/// The first system of a pass that asked for what it has not declared, by its place, and what that was.
#[derive(Debug)]
pub struct Undeclared(AtomicU32);

impl Default for Undeclared {
    fn default() -> Self {
        Self(AtomicU32::new(u32::MAX))
    }
}

impl Undeclared {
    #[cold]
    fn note(&self, system: u32, bit: u32) {
        self.0.fetch_min(system * BITS + bit, Ordering::Relaxed);
    }

    /// What is wrong with which system, by its place; `None` where nothing is.
    pub(crate) fn told(&self) -> Option<(usize, String)> {
        let note = Some(self.0.load(Ordering::Relaxed)).filter(|note| *note != u32::MAX)?;
        let (name, _) = COLUMNS[(note % BITS / 2) as usize];
        let (does, as_column) = if note % 2 == 0 { ("reads", "&") } else { ("writes", "&mut ") };
        Some(((note / BITS) as usize, format!("{does} `{name}`, and has no `{as_column}{name}` among its `Columns`")))
    }
}

impl<'a, T> NodeColumns<'a, T> {
    /// The system whose turn it is reads a column.
    #[inline(always)]
    pub(crate) fn reads(&self, column: Asked) {
        self.asks(2 * column as u32);
    }

    /// It writes one.
    #[inline(always)]
    pub(crate) fn writes(&self, column: Asked) {
        self.asks(2 * column as u32 + 1);
    }

    #[inline(always)]
    fn asks(&self, bit: u32) {
        if self.declared.bits >> bit & 1 == 0 {
            self.undeclared.note(self.declared.system, bit);
        }
    }

    fn may_write(&self, column: Asked) -> bool {
        self.declared.bits >> (2 * column as u32 + 1) & 1 == 1
    }

    /// Masses that weigh (kg), a number a node.
    #[inline(always)]
    pub fn mass(&self) -> &'a [T] {
        self.reads(Asked::Mass);
        self.mass
    }

    /// Masses that are slow to move (kg), a number a node: the others, where there is no `InertialMass`.
    #[inline(always)]
    pub fn inertia(&self) -> &'a [T] {
        self.reads(Asked::InertialMass);
        self.inertia
    }

    /// Which axes are constrained, as bits 0, 1, 2 of a number a node.
    #[inline(always)]
    pub fn axes(&self) -> &'a [u32] {
        self.reads(Asked::ConstrainedAxes);
        self.axes
    }

    /// Damping coefficients (kg/s), a number a node, where a material is damped.
    #[inline(always)]
    pub fn damping(&self) -> Option<&'a [T]> {
        self.reads(Asked::DampingCoefficient);
        self.damping
    }

    /// Forces of elements (N), three numbers a node.
    #[inline(always)]
    pub fn internal_force(&self) -> &[T] {
        self.reads(Asked::InternalForce);
        self.internal
    }

    /// Loads so far (N), three numbers a node; `None` where nothing adds any.
    #[inline(always)]
    pub fn external_force(&self) -> Option<&[T]> {
        self.reads(Asked::ExternalForce);
        self.external.as_deref()
    }

    /// The same, to add to.
    #[inline(always)]
    pub fn external_force_mut(&mut self) -> Option<&mut [T]> {
        self.writes(Asked::ExternalForce);
        debug_assert!(
            self.external.is_some() || !self.may_write(Asked::ExternalForce),
            "nobody has made room for loads"
        );
        self.external.as_deref_mut()
    }

    /// Displacements (m), three numbers a node.
    #[inline(always)]
    pub fn displacements(&self) -> &[T] {
        self.reads(Asked::Displacement);
        self.u
    }

    /// The same, to write.
    #[inline(always)]
    pub fn displacements_mut(&mut self) -> &mut [T] {
        self.writes(Asked::Displacement);
        self.u
    }

    /// Displacements of the last step (m), three numbers a node.
    #[inline(always)]
    pub fn increments(&self) -> &[T] {
        self.reads(Asked::DisplacementIncrement);
        self.step
    }

    /// The same, to write.
    #[inline(always)]
    pub fn increments_mut(&mut self) -> &mut [T] {
        self.writes(Asked::DisplacementIncrement);
        self.step
    }
}
