//! Implicit steps: what they solve, and what with.

mod preconditioner;
