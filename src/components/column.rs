//! Columns of numbers in the precision that a run has.

pub use super::column_bytes::AsBytes;
use super::column_layout::{Increments, Rows, Subject};
use crate::math::Scalar;
use bevy_ecs::component::{ComponentId, Mutable};
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// The number type of a run.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, PartialEq, Eq)]
pub enum Precision {
    /// 32 bits: fast, and the only one on the GPU.
    #[default]
    F32,
    /// 64 bits: the reference, CPU only.
    F64,
}

/// A column of real numbers in the run's precision. Vectors are three numbers side by side.
#[derive(Clone, Debug, PartialEq)]
pub enum Reals {
    /// 32-bit numbers; the same bytes on host and device.
    F32(Vec<f32>),
    /// 64-bit numbers.
    F64(Vec<f64>),
}

/// Runs the same expression on the slice of either precision.
macro_rules! either {
    ($reals:expr, $values:ident => $body:expr) => {
        match $reals {
            $crate::components::Reals::F32($values) => $body,
            $crate::components::Reals::F64($values) => $body,
        }
    };
}
pub(super) use either;

impl Reals {
    /// `length` zeros.
    pub fn zeros(precision: Precision, length: usize) -> Self {
        match precision {
            Precision::F32 => Reals::F32(vec![0.0; length]),
            Precision::F64 => Reals::F64(vec![0.0; length]),
        }
    }

    /// Numbers rounded to a precision.
    pub fn from_f64(precision: Precision, values: impl Iterator<Item = f64>) -> Self {
        match precision {
            Precision::F32 => Reals::F32(values.map(|v| v as f32).collect()),
            Precision::F64 => Reals::F64(values.collect()),
        }
    }

    /// The number type.
    pub fn precision(&self) -> Precision {
        match self {
            Reals::F32(_) => Precision::F32,
            Reals::F64(_) => Precision::F64,
        }
    }

    /// How many numbers.
    pub fn len(&self) -> usize {
        either!(self, v => v.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One number, widened.
    #[inline]
    pub fn get(&self, index: usize) -> f64 {
        either!(self, v => v[index].to_f64())
    }

    /// Writes one number, rounded.
    #[inline]
    pub fn set(&mut self, index: usize, value: f64) {
        either!(self, v => v[index] = Scalar::from_f64(value));
    }

    /// The numbers, widened, into so many others.
    pub fn read(&self, into: &mut [f64]) {
        match self {
            Reals::F32(values) => into.iter_mut().zip(values).for_each(|(into, &value)| *into = f64::from(value)),
            Reals::F64(values) => into.copy_from_slice(values),
        }
    }

    /// Takes so many numbers, rounded.
    pub fn write(&mut self, from: &[f64]) {
        match self {
            Reals::F32(values) => values.iter_mut().zip(from).for_each(|(value, &from)| *value = from as f32),
            Reals::F64(values) => values.copy_from_slice(from),
        }
    }

    /// The sum of all numbers, in their order.
    pub fn sum(&self) -> f64 {
        either!(self, v => v.iter().map(|number| number.to_f64()).sum())
    }

    /// Row `row` of a column of vectors.
    #[inline]
    pub fn vector(&self, row: usize) -> DVec3 {
        self.vector_at(3 * row)
    }

    /// The vector that begins with a number.
    #[inline]
    pub fn vector_at(&self, index: usize) -> DVec3 {
        either!(self, v => DVec3::new(v[index].to_f64(), v[index + 1].to_f64(), v[index + 2].to_f64()))
    }

    /// Writes row `row` of a column of vectors, rounded.
    #[inline]
    pub fn set_vector(&mut self, row: usize, value: DVec3) {
        self.set_vector_at(3 * row, value);
    }

    /// Writes the vector that begins with a number, rounded.
    #[inline]
    pub fn set_vector_at(&mut self, index: usize, value: DVec3) {
        either!(self, v => {
            for (place, x) in v[index..index + 3].iter_mut().zip(value.to_array()) {
                *place = Scalar::from_f64(x);
            }
        });
    }

    /// All rows of a column of vectors.
    pub fn vectors(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..self.len() / 3).map(|row| self.vector(row))
    }

    /// Whether `T` is the number type.
    fn is_of<T>(&self) -> bool {
        either!(self, v => size_of_val(v.as_slice()) == v.len() * size_of::<T>())
    }

    /// The numbers as `T`, which must be the run's own number type.
    pub fn slice<T: Scalar>(&self) -> &[T] {
        debug_assert!(self.is_of::<T>(), "a column of {:?} is taken for one of another precision", self.precision());
        either!(self, v => bytemuck::try_cast_slice(v).unwrap_or(&[]))
    }

    /// The same, to write.
    pub fn slice_mut<T: Scalar>(&mut self) -> &mut [T] {
        debug_assert!(self.is_of::<T>(), "a column of {:?} is taken for one of another precision", self.precision());
        either!(self, v => bytemuck::try_cast_slice_mut(v).unwrap_or(&mut []))
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        either!(self, v => bytemuck::cast_slice(v))
    }

    /// The bytes, to write.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        either!(self, v => bytemuck::cast_slice_mut(v))
    }
}

/// What a column is to the state of a simulation. Every column names its role where it is declared, so that snapshots
/// cannot forget one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Carried on from step to step: part of every snapshot.
    State,
    /// What the scene says; part of a snapshot where a system of one's own writes it.
    Given,
    /// The shape of the mesh; never changes.
    Structure,
    /// Made afresh in every step before it is read.
    Scratch,
}

/// A component that is a column of plain numbers and can live on a device: the same bytes here and there.
pub trait Column: Component<Mutability = Mutable> {
    /// Its name in shaders and reports.
    const NAME: &'static str;
    /// What it is to the state.
    const ROLE: Role;
    /// What it is about.
    const SUBJECT: Subject;
    /// The buffer on a device in which it lies: of its own name, or one that an entity's columns share, one after the
    /// other as they are declared; kernels may have few buffers.
    const BUFFER: &'static str;
    /// What its numbers are in shaders: `f32` or `u32`.
    const WORD: &'static str;
    /// What its rows belong to.
    const ROWS: Rows;
    /// Which of its numbers are changes in a step.
    const INCREMENTS: Increments;
    /// The bytes.
    fn bytes(&self) -> &[u8];
    /// The bytes, to write.
    fn bytes_mut(&mut self) -> &mut [u8];
    /// Multiplies those that are changes in a step.
    fn scale_increments(&mut self, factor: f64);
}

/// Access to one kind of column without its type.
#[derive(Clone, Copy)]
pub struct ColumnAccess {
    /// The column's name.
    pub name: &'static str,
    /// What it is to the state.
    pub role: Role,
    /// What it is about.
    pub subject: Subject,
    /// The buffer on a device in which it lies.
    pub buffer: &'static str,
    /// What its numbers are in shaders.
    pub word: &'static str,
    /// Its bytes on the host.
    pub bytes: fn(&World, Entity) -> Option<&[u8]>,
    /// Writes its bytes on the host.
    pub write: fn(&mut World, Entity, &[u8]),
    /// Its component.
    pub id: fn(&World) -> Option<ComponentId>,
    /// Which of its numbers are changes in a step.
    pub increments: Increments,
    /// Multiplies these on the host.
    pub scale_increments: fn(&mut World, Entity, f64),
}

impl ColumnAccess {
    /// Access to a kind of column.
    pub fn of<C: Column>() -> Self {
        Self {
            name: C::NAME,
            role: C::ROLE,
            subject: C::SUBJECT,
            buffer: C::BUFFER,
            word: C::WORD,
            bytes: |world, entity| world.get::<C>(entity).map(|column| column.bytes()),
            write: |world, entity, bytes| {
                if let Some(mut column) = world.get_mut::<C>(entity) {
                    column.bytes_mut().copy_from_slice(bytes);
                }
            },
            id: |world| world.component_id::<C>(),
            increments: C::INCREMENTS,
            scale_increments: |world, entity, factor| {
                if let Some(mut column) = world.get_mut::<C>(entity) {
                    column.scale_increments(factor);
                }
            },
        }
    }
}

/// The columns of one buffer in the order in which they lie there.
pub fn columns_in(buffer: &str) -> impl Iterator<Item = ColumnAccess> {
    all_columns().iter().copied().filter(move |column| column.buffer == buffer)
}

/// Where an entity's column begins in its buffer on a device, in words of four bytes.
pub fn place_in_buffer<C: Column>(entity: Entity, world: &World) -> usize {
    let before = columns_in(C::BUFFER).take_while(|column| column.name != C::NAME);
    before.filter_map(|column| (column.bytes)(world, entity)).map(<[u8]>::len).sum::<usize>() / 4
}

/// Whether something holds of the column of a name.
pub fn column_is(name: &str, which: impl Fn(&ColumnAccess) -> bool) -> bool {
    all_columns().iter().any(|column| column.name == name && which(column))
}

/// Whether any entity has a component. A query for it would ask for memory.
pub(crate) fn is_anywhere<C: Component>(world: &World) -> bool {
    let Some(component) = world.component_id::<C>() else { return false };
    world.archetypes().iter().any(|archetype| !archetype.is_empty() && archetype.contains(component))
}

/// Every kind of column there is, as the modules declare them.
pub fn all_columns() -> &'static [ColumnAccess] {
    static ALL: LazyLock<Vec<ColumnAccess>> = LazyLock::new(|| {
        let of_tools = [super::tool::accesses(), super::tool_removal::accesses(), super::suction::accesses()].concat();
        let attached = [super::grasp::accesses(), super::suture::accesses(), super::glue::accesses()].concat();
        [super::nodes::accesses(), super::block::accesses(), super::contact::accesses(), of_tools, attached].concat()
    });
    &ALL
}

/// Declares components that are columns, each with its name, its [`Role`] and [`Subject`], what its [`Rows`] belong to
/// and, where they are not none and its own, its [`Increments`] and its buffer; and a function `accesses` that lists
/// them.
macro_rules! columns {
    (@buffer $word:literal) => { $word };
    (@buffer $word:literal $buffer:literal) => { $buffer };
    (@increments) => { $crate::components::Increments::None };
    (@increments $which:ident) => { $crate::components::Increments::$which };
    (@increments $which:ident $numbers:expr) => { $crate::components::Increments::$which($numbers) };
    (@rows $rows:ident) => { $crate::components::Rows::$rows };
    (@rows $rows:ident $numbers:expr) => { $crate::components::Rows::$rows($numbers) };
    ($(
        $(#[$doc:meta])*
        $name:ident($type:ty) = $word:literal, $role:ident of $subject:ident, $rows:ident$(($numbers:expr))?
            $(, increments: $which:ident$(($of:expr))?)? $(, in $buffer:literal)?;
    )*) => {
        $(
            $(#[$doc])*
            #[derive(bevy_ecs::prelude::Component, Clone, Debug)]
            pub struct $name(pub $type);

            impl $crate::components::Column for $name {
                const NAME: &'static str = $word;
                const ROLE: $crate::components::Role = $crate::components::Role::$role;
                const SUBJECT: $crate::components::Subject = $crate::components::Subject::$subject;
                const BUFFER: &'static str = $crate::components::column::columns!(@buffer $word $($buffer)?);
                const WORD: &'static str = <$type as $crate::components::column::AsBytes>::WORD;
                const ROWS: $crate::components::Rows = $crate::components::column::columns!(@rows $rows $($numbers)?);
                const INCREMENTS: $crate::components::Increments =
                    $crate::components::column::columns!(@increments $($which $($of)?)?);
                fn bytes(&self) -> &[u8] {
                    $crate::components::column::AsBytes::as_bytes(&self.0)
                }
                fn bytes_mut(&mut self) -> &mut [u8] {
                    $crate::components::column::AsBytes::as_bytes_mut(&mut self.0)
                }
                fn scale_increments(&mut self, factor: f64) {
                    let is_one = |place, length| Self::INCREMENTS.is_one(place, length);
                    $crate::components::column::AsBytes::scale(&mut self.0, &is_one, factor);
                }
            }

            impl std::ops::Deref for $name {
                type Target = $type;
                fn deref(&self) -> &$type {
                    &self.0
                }
            }

            impl std::ops::DerefMut for $name {
                fn deref_mut(&mut self) -> &mut $type {
                    &mut self.0
                }
            }
        )*

        /// The columns declared here.
        pub(super) fn accesses() -> Vec<$crate::components::ColumnAccess> {
            vec![$($crate::components::ColumnAccess::of::<$name>()),*]
        }
    };
}
pub(crate) use columns;
