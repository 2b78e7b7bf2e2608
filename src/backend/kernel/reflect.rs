//! What WGSL declares: buffers by name and the layout of structs.

use naga::proc::Layouter;
use naga::{AddressSpace, ArraySize, GlobalVariable, Handle, Module, ScalarKind, StorageAccess, Type, TypeInner};

/// How a kernel sees a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// `var<uniform>`
    Uniform,
    /// `var<storage, read>`
    Read,
    /// `var<storage, read_write>`
    ReadWrite,
}

/// A buffer variable that the fragments declare.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Name of the WGSL variable.
    pub name: String,
    /// How the kernel sees it.
    pub kind: BindingKind,
    /// WGSL type, for example `array<vec4<f32>>` or `NeoHookean`.
    pub type_name: String,
    /// Bytes the buffer needs at least (of a run-time sized array: those of one row).
    pub size: u32,
    /// Bytes from row to row, for arrays.
    pub stride: Option<u32>,
    /// Binding number on the device. The numbers in the fragments only make each file valid on its own.
    pub index: u32,
}

/// A member of a WGSL struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name of the member.
    pub name: String,
    /// WGSL type, for example `vec3<f32>`.
    pub type_name: String,
    /// Bytes from the start of the struct.
    pub offset: u32,
    /// Bytes of the member, without the padding behind it.
    pub size: u32,
}

/// The binding a global variable is, or None where it is not a buffer.
pub(super) fn binding(module: &Module, layouts: &Layouter, variable: &GlobalVariable, index: u32) -> Option<Binding> {
    let kind = match variable.space {
        AddressSpace::Uniform => BindingKind::Uniform,
        AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => BindingKind::ReadWrite,
        AddressSpace::Storage { .. } => BindingKind::Read,
        _ => return None,
    };
    let stride = match module.types[variable.ty].inner {
        TypeInner::Array { stride, .. } => Some(stride),
        _ => None,
    };
    Some(Binding {
        name: variable.name.clone().unwrap_or_default(),
        kind,
        type_name: type_name(module, variable.ty),
        size: layouts[variable.ty].size,
        stride,
        index,
    })
}

/// Members of a struct, or None where the type is no struct.
pub(super) fn members(module: &Module, layouts: &Layouter, inner: &TypeInner) -> Option<Vec<Member>> {
    let TypeInner::Struct { members, .. } = inner else { return None };
    let member = |m: &naga::StructMember| Member {
        name: m.name.clone().unwrap_or_default(),
        type_name: type_name(module, m.ty),
        offset: m.offset,
        size: layouts[m.ty].size,
    };
    Some(members.iter().map(member).collect())
}

/// A type as WGSL writes it.
pub(super) fn type_name(module: &Module, handle: Handle<Type>) -> String {
    let ty = &module.types[handle];
    if let Some(name) = &ty.name {
        return name.clone();
    }
    match &ty.inner {
        TypeInner::Scalar(s) => scalar_name(*s),
        TypeInner::Atomic(s) => format!("atomic<{}>", scalar_name(*s)),
        TypeInner::Vector { size, scalar } => format!("vec{}<{}>", *size as u8, scalar_name(*scalar)),
        TypeInner::Matrix { columns, rows, scalar } => {
            format!("mat{}x{}<{}>", *columns as u8, *rows as u8, scalar_name(*scalar))
        }
        TypeInner::Array { base, size: ArraySize::Constant(n), .. } => {
            format!("array<{}, {n}>", type_name(module, *base))
        }
        TypeInner::Array { base, .. } => format!("array<{}>", type_name(module, *base)),
        _ => "opaque".to_owned(),
    }
}

fn scalar_name(scalar: naga::Scalar) -> String {
    let letter = match scalar.kind {
        ScalarKind::Float | ScalarKind::AbstractFloat => "f",
        ScalarKind::Uint => "u",
        ScalarKind::Sint | ScalarKind::AbstractInt => "i",
        ScalarKind::Bool => return "bool".to_owned(),
    };
    format!("{letter}{}", u32::from(scalar.width) * 8)
}
