//! What a column is about, what its rows belong to, and which of its numbers follow the length of steps.

/// What a column is about: what becomes of it where a step is tried and taken back, where its length changes, and where
/// a motion begins at rest follows from that. Who declares a column says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Where nodes are and how they move. A step that is not found leaves it as it was; a motion from rest begins
    /// there.
    Motion,
    /// Forces on nodes: likewise, for who looks at them then.
    Force,
    /// What the material remembers: likewise, and it follows the length of a step; at rest it has come to its end.
    Memory,
    /// What tools hold of nodes: a step that is not found leaves it as it was.
    Grip,
    /// Who touches, how deep, and what friction, ties and sutures hold: what a search for rest carries on between
    /// loads, and what a motion from rest takes over.
    Touch,
    /// Shapes at rest, which laws and removal change.
    Shape,
    /// Masses and what goes with them, which removal changes.
    Mass,
    /// What of the mesh stays.
    Mesh,
    /// What does not move freely.
    Constraint,
    /// Which elements are there, and in which step they go.
    Removal,
    /// Which elements are turned inside out: what is only tried notes none.
    Inversion,
    /// Means that elements take pressures from.
    Mean,
    /// What the formula of implicit steps has beside.
    Scheme,
    /// What is sucked.
    Suction,
    /// Work, energies and momenta since the start.
    Account,
    /// What guards look at.
    Guard,
    /// What node systems have for themselves.
    Own,
}

/// What a row of a column belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// A node of a body, so many numbers each, side by side.
    Nodes(usize),
    /// An element of a block, in groups of [`LANES`](crate::math::LANES).
    Elements,
    /// Something else: sums over several, what is found first, forces by corner.
    Other,
}

/// Which numbers of a column are changes in a step, and follow when steps become longer or shorter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Increments {
    /// None.
    None,
    /// All.
    All,
    /// Those of the second half.
    SecondHalf,
    /// The last three of so many numbers a row.
    LastThreeOf(usize),
}

impl Increments {
    /// Whether that of a place in a column of some length is one.
    pub(super) fn is_one(self, place: usize, length: usize) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::SecondHalf => place >= length / 2,
            Self::LastThreeOf(numbers) => place % numbers >= numbers - 3,
        }
    }
}
