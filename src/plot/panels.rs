//! Small multiples.
