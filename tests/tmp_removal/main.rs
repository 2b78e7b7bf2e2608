#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, dead_code)]
#[path = "../physics/configurations.rs"]
mod configurations;
#[path = "../physics/islands.rs"]
mod islands;
#[path = "../physics/suction.rs"]
mod suction;
#[path = "../physics/tool_removal.rs"]
mod tool_removal;
