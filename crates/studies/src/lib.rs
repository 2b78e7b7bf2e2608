//! Studies with sinew: what accuracy costs in time ([`accuracy`]), cases that are hard to keep stable ([`hard`]), and
//! what steps and loads cost ([`bench`]).

pub mod accuracy;
pub mod bench;
pub mod hard;
