//! Pictures of a run, drawn on the CPU.
