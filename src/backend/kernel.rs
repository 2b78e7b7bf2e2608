//! Kernels as data: what a system wants to run on a GPU, said without a word of any GPU interface.
//!
//! A [`Kernel`] is a list of WGSL [`Fragment`]s, an entry point, buffers by the name of the WGSL variable they belong
//! to, and the number of invocations. What several authors have written stands in [`Unit`]s, which do not see each
//! other's names. A [`Composer`] puts it together as a module of naga's, checks it and tells what it declares; it needs
//! no GPU.

mod compose;
mod diagnose;
mod link;
mod reflect;
#[cfg(test)]
mod tests;
mod unit;

use bevy_ecs::prelude::Entity;
use std::borrow::Cow;

pub(crate) use crate::uniform::uniform;
pub use crate::uniform::{Layout, Uniform};
pub use compose::{Composed, Composer, EntryPoint, compose};
pub use diagnose::{KernelError, NameMismatch};
pub use reflect::{Binding, BindingKind, Member};
pub use unit::{Link, Unit, UnitId};

/// Name of the uniform variable that holds the step's record; the GPU layer binds it, a kernel must not.
pub const STEP_VARIABLE: &str = "step";

/// Name of the storage variable that holds the records of all steps of a submission: a kernel that declares it is
/// dispatched once a submission. It is a struct of their number, padding up to 16 bytes, and the records, of whole
/// sixteens of bytes. The GPU layer binds it, a kernel must not.
pub const STEP_RECORDS_VARIABLE: &str = "step_records";

/// How many buffers a kernel may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MostBuffers {
    /// Storage buffers.
    pub storage: usize,
    /// Uniform buffers.
    pub uniform: usize,
    /// Of both kinds together.
    pub together: usize,
}

impl MostBuffers {
    /// On every WebGPU device (`maxStorageBuffersPerShaderStage`, `maxUniformBuffersPerShaderStage`).
    pub const WEBGPU: Self = Self::new(8, 12);
    /// On every desktop GPU: what is assumed where kernels are described without one.
    pub const DESKTOP: Self = Self::new(16, 12);

    /// So many of each kind, and of both together no fewer.
    pub const fn new(storage: usize, uniform: usize) -> Self {
        Self { storage, uniform, together: storage + uniform }
    }

    /// Why a kernel with so many buffers cannot be, if so.
    pub fn exceeded_by(self, storage: usize, uniform: usize) -> Option<String> {
        let counts = [
            (storage, "storage buffers", self.storage),
            (uniform, "uniform buffers", self.uniform),
            (storage + uniform, "buffers", self.together),
        ];
        let (needed, of, most) = counts.into_iter().find(|(needed, _, most)| needed > most)?;
        Some(format!("it would need {needed} {of}, and {most} may be"))
    }
}

/// Invocations that a workgroup may have on every desktop GPU: what is assumed where kernels are described without one.
pub const DESKTOP_WORKGROUP: usize = 1024;

/// A piece of WGSL: one file, or text generated under a file's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fragment {
    /// Path shown in errors, relative to the crate or the scene, for example `shaders/tet4.wgsl`.
    pub path: String,
    /// The WGSL text.
    pub text: Cow<'static, str>,
    /// Uniforms that it declares and that each invocation has for itself in this kernel.
    private: Vec<&'static str>,
}

impl Fragment {
    /// A fragment from its path and text.
    pub fn new(path: impl Into<String>, text: impl Into<Cow<'static, str>>) -> Self {
        Self { path: path.into(), text: text.into(), private: Vec::new() }
    }

    /// The same with a variable of each invocation's own in place of its uniform of that name.
    pub(crate) fn with_private(mut self, uniform: &'static str) -> Self {
        self.private.push(uniform);
        self
    }
}

/// A file of the crate's `shaders/` folder as a [`Fragment`], built into the program: `shader!("row")`.
#[doc(hidden)]
#[macro_export]
macro_rules! shader {
    ($stem:ident) => {
        $crate::backend::kernel::Fragment::new(
            concat!("shaders/", stringify!($stem), ".wgsl"),
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", stringify!($stem), ".wgsl")),
        )
    };
    ($stem:literal) => {
        $crate::backend::kernel::Fragment::new(
            concat!("shaders/", $stem, ".wgsl"),
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $stem, ".wgsl")),
        )
    };
}

/// A buffer of the GPU layer; only valid for the `Gpu` that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferId(pub(crate) u32);

impl BufferId {
    /// No buffer: stands in where kernels are only described, and where making one failed until that is told.
    pub const NONE: BufferId = BufferId(u32::MAX);
}

/// A kernel made ready by the GPU layer; only valid for the `Gpu` that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KernelId(pub(crate) u32);

/// One dispatch of a step, as data.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Name in errors, reports and GPU debuggers, for example `element_forces of liver`.
    pub label: String,
    /// Name of the `@compute` function.
    pub entry: &'static str,
    /// The element block that it works on, if it is one.
    pub block: Option<Entity>,
    /// Whether it is of what its system repeats in a step, as the plan says.
    pub repeated: bool,
    /// Systems that it is put together from, where it is.
    pub systems: Vec<Cow<'static, str>>,
    /// The WGSL, in any order: WGSL declarations are order-free.
    pub fragments: Vec<Fragment>,
    /// More of it, which units have too: what these pieces declare is there once.
    pub common: Vec<Fragment>,
    /// WGSL that is read apart from that.
    pub units: Vec<Unit>,
    /// Functions of `fragments` that call those of units.
    pub links: Vec<Link>,
    /// (WGSL variable, buffer). Every variable the entry point uses needs one, [`STEP_VARIABLE`] excepted.
    pub bindings: Vec<(Cow<'static, str>, BufferId)>,
    /// Structs of its uniforms as Rust sees them, by WGSL variable: what tests compare with the WGSL.
    pub layouts: Vec<(Cow<'static, str>, Layout)>,
    /// Invocations wanted; rounded up to whole workgroups, so that the kernel checks its bound. 0 dispatches nothing.
    pub threads: u32,
}

impl Kernel {
    /// A kernel without fragments, buffers or threads yet.
    pub fn new(label: impl Into<String>, entry: &'static str) -> Self {
        Self {
            label: label.into(),
            entry,
            block: None,
            repeated: false,
            systems: Vec::new(),
            fragments: Vec::new(),
            common: Vec::new(),
            units: Vec::new(),
            links: Vec::new(),
            bindings: Vec::new(),
            layouts: Vec::new(),
            threads: 0,
        }
    }

    /// Adds a piece of WGSL.
    pub fn fragment(mut self, fragment: Fragment) -> Self {
        self.fragments.push(fragment);
        self
    }

    /// Gives a WGSL variable its buffer.
    pub fn bind(mut self, variable: impl Into<Cow<'static, str>>, buffer: BufferId) -> Self {
        self.bindings.push((variable.into(), buffer));
        self
    }

    /// Gives a `var<uniform>` the buffer that holds a struct, or several.
    pub fn bind_uniform<U: Uniform>(mut self, variable: &'static str, buffer: BufferId) -> Self {
        self.layouts.push((variable.into(), U::LAYOUT));
        self.bind(variable, buffer)
    }

    /// Sets the number of invocations.
    pub fn threads(mut self, threads: u32) -> Self {
        self.threads = threads;
        self
    }

    /// Says that it is of what its system repeats.
    pub fn repeated(self) -> Self {
        Self { repeated: true, ..self }
    }

    /// The paths of the fragments, for messages: `shaders/tet4.wgsl + shaders/row.wgsl`.
    pub fn paths(&self) -> String {
        self.all_fragments().iter().map(|f| f.path.as_str()).collect::<Vec<_>>().join(" + ")
    }
}
