//! The Rust of docs/laws.md.

use sinew::systems::Registry;
use sinew::{Error, Options, SceneFile, Simulation};

#[path = "../extend/gent.rs"]
mod gent;
use gent::Gent;

fn with_a_law(scene: SceneFile, options: Options) -> Result<(), Error> {
    let registry = Registry::default().with_law::<Gent<f64>>("gent");
    let mut simulation = Simulation::with_systems(&scene, &options, &registry)?;
    Ok(())
}
