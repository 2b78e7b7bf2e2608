//! Studies with sinew: what accuracy costs in time ([`accuracy`]), cases that are hard to keep stable ([`hard`]), what
//! steps and loads cost ([`bench`]), and many variants of a scene ([`sweep`]).

pub mod accuracy;
pub mod bench;
pub mod hard;
pub mod sweep;
