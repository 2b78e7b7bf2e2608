//! What the rows of a column belong to, and which of its numbers follow the length of steps.

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
