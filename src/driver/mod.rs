//! A simulation that somebody watches and drives: commands in, its newest state out, without a word of windows.
//!
//! A [`Session`] is that without a thread, for hosts that step it once a frame; a [`FrameDriver`] does so by the clock,
//! where there are no threads: in a page. A `Driver` has one on a thread of its own, which the host never waits for:
//!
//! ```no_run
//! use sinew::driver::{Command, Driver};
//! # fn main() -> Result<(), sinew::Error> {
//! let scene = sinew::SceneFile::load("scenes/cube_under_gravity.ron", &[])?;
//! let driver = Driver::start(sinew::Options::default(), || ());
//! driver.send(Command::Load(Box::new(scene)));
//! driver.send(Command::Run);
//! let state = driver.state(); // at any time, once a frame for instance
//! println!("{} s, {} bodies", state.time, state.bodies.len());
//! # Ok(())
//! # }
//! ```
//!
//! Nothing that is sent can bring it down: what is refused is a text in the state, with the old scene going on, and a
//! simulation that broke down stays as it was then, until it is reset, rewound or replaced.

mod command;
mod frames;
mod grabs;
mod look;
mod pace;
mod session;
mod state;
// a page has no threads
#[cfg(not(target_arch = "wasm32"))]
mod thread;

pub use command::Command;
pub use frames::FrameDriver;
pub use session::Session;
pub use state::{Body, BodyState, HeldState, Loaded, Picked, Refusal, State, ToolState};
#[cfg(not(target_arch = "wasm32"))]
pub use thread::Driver;
