//! What accuracy costs in time: a scene is solved in many ways, each is timed and measured against a reference.
//!
//! ```text
//! configuration  one way to solve a scene            solver    what a study needs of whoever solves it
//! plan           what is varied, what fits            study     runs the plan
//! method         how it is stepped in time
//! refinement     which meshes a reference is made of  work      the runs and their time
//! reference      what errors are measured against     quantities, oscillation, field, points: what is compared
//! richardson     the limit of small cells             findings  orders, parts of the error, verdict
//! estimate       how far the scene as written is off  outlook   what a larger budget would add
//! pareto         who is worth the price               advice    what to do, in sentences
//! engine         the solver that this crate is        tables, plot: what is written
//! ```

pub mod advice;
pub mod configuration;
pub mod engine;
pub mod estimate;
pub mod field;
pub mod files;
pub mod findings;
pub mod method;
pub mod oscillation;
mod outlook;
pub mod pareto;
pub mod plan;
pub mod plot;
pub mod points;
pub mod quantities;
pub mod reference;
pub mod refinement;
pub mod richardson;
pub mod solver;
pub mod study;
pub mod tables;
mod work;

pub use configuration::{Configuration, Digits, Factor, Processor};
pub use engine::Engine;
pub use estimate::Estimate;
pub use findings::{Findings, TargetVerdict};
pub use method::Method;
pub use plan::{Fate, Plan, Varied};
pub use reference::Reference;
pub use solver::{Choices, Cost, Refusal, Solution, Solver};
pub use study::{Outcome, Row, Settings, Study, StudyObserver, study};
