//! Rust structs that kernels see as uniforms, and how they lie in memory.

/// How a struct lies in memory: to be compared with its WGSL twin, found by reflection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Name of the struct, the same in Rust and WGSL.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// Name, first byte and bytes of each member.
    pub members: &'static [(&'static str, usize, usize)],
}

/// A struct with a WGSL twin.
pub trait Uniform {
    /// How it lies in memory.
    const LAYOUT: Layout;
    /// Its bytes.
    fn bytes(&self) -> Vec<u8>;
}

/// Says for a `#[repr(C)]` struct of plain numbers that it has a WGSL twin of the same name and members. A member left
/// out does not compile.
macro_rules! uniform {
    ($name:ident $(<$number:ty>)? { $($member:ident),* }) => {
        impl $crate::uniform::Uniform for $name $(<$number>)? {
            const LAYOUT: $crate::uniform::Layout = $crate::uniform::Layout {
                name: stringify!($name),
                size: size_of::<Self>(),
                members: &[$((
                    stringify!($member),
                    std::mem::offset_of!(Self, $member),
                    // every member is one 32-bit number
                    4,
                )),*],
            };
            fn bytes(&self) -> Vec<u8> {
                let Self { $($member),* } = self;
                [$(bytemuck::bytes_of::<_>($crate::uniform::word($member))),*].concat()
            }
        }
    };
}
pub(crate) use uniform;

/// The only members that a uniform struct may have: for them Rust and WGSL agree on place and size.
pub trait Word: bytemuck::Pod {}
impl Word for f32 {}
impl Word for u32 {}

/// Takes 32-bit numbers only.
pub fn word<W: Word>(value: &W) -> &W {
    value
}
