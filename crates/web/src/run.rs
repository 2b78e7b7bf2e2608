//! Scenes run without the viewer: what a step takes in a page, and whether it comes to what it comes to elsewhere.

use serde_json::json;
use sinew::{BackendChoice, Error, Options, SceneFile, Simulation};
use wasm_bindgen::prelude::*;
use web_time::Instant;

/// Runs the text of a scene for so many steps. Gives an object in JSON: elements, steps, seconds that the steps took,
/// simulated time (s), and of each body where its nodes are by then (m), in the author's order.
///
/// # Errors
/// What is wrong with the scene, or how it broke down, in words.
#[wasm_bindgen]
pub fn run_steps(text: &str, steps: u32) -> Result<String, JsValue> {
    run(text, u64::from(steps)).map_err(|error| JsValue::from_str(&error.to_string()))
}

fn run(text: &str, steps: u64) -> Result<String, Error> {
    let files = super::scenes::bundle().files;
    let scene = SceneFile::from_memory("scene.ron", text, files, &[]).map_err(|wrong| Error::Scene(Box::new(wrong)))?;
    let options = Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() };
    let mut simulation = Simulation::new(&scene, &options)?;
    let started = Instant::now();
    simulation.advance(steps)?;
    let seconds = started.elapsed().as_secs_f64();
    let mut bodies = serde_json::Map::new();
    let mut elements = 0;
    for name in scene.scene.bodies.keys() {
        let positions: Vec<[f64; 3]> = simulation.positions(name)?.iter().map(|place| place.to_array()).collect();
        elements += simulation.elements_left(name)?;
        bodies.insert(name.clone(), json!(positions));
    }
    let (steps, time) = (simulation.step_count(), simulation.time());
    Ok(json!({ "elements": elements, "steps": steps, "seconds": seconds, "time": time, "bodies": bodies }).to_string())
}
