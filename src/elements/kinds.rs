//! From an element's kind to its type, and what a kind alone tells.

use super::{Element, MOST_NODES, MOST_POINTS, MOST_ROWS, PressureFrom};
use crate::mesh::ElementKind;

macro_rules! make_with_element {
    ($dollar:tt $($(#[$about:meta])* $file:ident: $kind:ident of $cell:ident, $shader:literal;)*) => {
        /// Runs an expression with `$element` standing for the type of an [`ElementKind`].
        macro_rules! with_element {
            ($dollar of:expr, $dollar element:ident => $dollar body:expr) => {
                match $dollar of {
                    $(crate::mesh::ElementKind::$kind => {
                        type $dollar element = crate::elements::$kind;
                        $dollar body
                    })*
                }
            };
        }
    };
}
crate::mesh::each_element_kind! { $ make_with_element }
pub(crate) use with_element;

/// The same for a block, or whatever has a `kind` and is `simple` as one: where it is, with the type for
/// [specialised](Element::Specialisation) shapes.
macro_rules! with_element_of {
    ($block:expr, $element:ident => $body:expr) => {
        if $block.simple {
            $crate::elements::with_element!($block.kind, General => {
                type $element = <General as $crate::elements::Element>::Specialisation;
                $body
            })
        } else {
            $crate::elements::with_element!($block.kind, $element => $body)
        }
    };
}
pub(crate) use with_element_of;

/// Something to be done with the type of an [`ElementKind`].
pub trait ElementTask {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<E: Element>(self) -> Self::Output;
}

/// Does something with the type of an element kind: how other crates come from the one to the other.
pub fn run_with_element<T: ElementTask>(kind: ElementKind, task: T) -> T::Output {
    with_element!(kind, E => task.run::<E>())
}

/// How many nodes an element of a kind has.
pub const fn node_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::NODES)
}

/// What share of an element's mass each of its nodes has, 1 together: the one rule by which masses go to nodes.
pub const fn mass_shares(kind: ElementKind) -> &'static [f64] {
    with_element!(kind, E => E::CELL.shares())
}

// what the list of kinds says of their cells is what the elements say, and kernels have room for them
const _: () = {
    let (mut place, mut nodes, mut rows, mut points) = (0, 0, 0, 0);
    const fn larger(a: usize, b: usize) -> usize {
        if a > b { a } else { b }
    }
    while place < ElementKind::ALL.len() {
        let kind = ElementKind::ALL[place];
        with_element!(kind, E => {
            assert!(E::CELL as usize == kind.cell() as usize && E::CELL.shares().len() == E::NODES);
            // energies, viscous memory and nodal means know one pressure an element
            assert!(E::POINTS == 1 || matches!(E::PRESSURE, PressureFrom::MeanOverPoints));
            nodes = larger(nodes, E::NODES);
            rows = larger(rows, E::ROWS);
            points = larger(points, E::POINTS);
        });
        place += 1;
    }
    assert!(nodes == MOST_NODES && rows == MOST_ROWS && points == MOST_POINTS);
};

/// How many integration points an element of a kind has.
pub const fn point_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::POINTS)
}

/// How much rounding leaves of a residual: see [`Element::ROUNDING`].
pub const fn rounding(kind: ElementKind) -> f64 {
    with_element!(kind, E => E::ROUNDING)
}

/// Whether elements of a kind take their pressure from nodal means.
pub fn averages(kind: ElementKind) -> bool {
    with_element!(kind, E => E::PRESSURE == PressureFrom::Nodes)
}

/// How many elements of a kind a patch has.
pub const fn elements_a_patch(kind: ElementKind) -> usize {
    with_element!(kind, E => E::ELEMENTS_A_PATCH)
}
