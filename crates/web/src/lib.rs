//! Sinew and its viewer in a page. On anything but WebAssembly there is nothing here: `src/main.rs` makes the page.
#![cfg(target_arch = "wasm32")]

mod run;
mod scenes;

use eframe::{WebOptions, WebRunner};
use serde_json::json;
use sinew::driver::State;
use sinew::{BackendChoice, Options};
use sinew_view::{App, FIELDS, Settings, Start};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

/// The page: a viewer on a canvas.
#[wasm_bindgen]
pub struct Page {
    runner: WebRunner,
}

#[wasm_bindgen]
#[allow(clippy::new_without_default, reason = "JavaScript knows constructors only")]
impl Page {
    /// Nothing yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self { runner: WebRunner::new() }
    }

    /// Begins with the shipped scene of a name, or with a text if one is given, in the colours of a field.
    ///
    /// # Errors
    /// That nothing can be drawn: there is neither WebGPU nor WebGL.
    pub async fn start(
        &self,
        canvas: HtmlCanvasElement,
        scene: String,
        text: Option<String>,
        run: bool,
        field: Option<String>,
    ) -> Result<(), JsValue> {
        let mut bundle = scenes::bundle();
        if let Some(text) = text {
            bundle.scenes.insert(0, (scene.clone(), text));
        }
        let field = field.and_then(|name| FIELDS.into_iter().find(|field| field.array() == name));
        let start = Start {
            scene: Some(scene.into()),
            options: Options { backend: BackendChoice::Cpu, threads: 1, ..Options::default() },
            run,
            settings: Settings { field, ..Settings::default() },
            bundle: Some(bundle),
            ..Start::default()
        };
        let app: eframe::AppCreator<'static> = Box::new(move |context| Ok(Box::new(App::on_screen(context, start))));
        self.runner.start(canvas, WebOptions::default(), app).await
    }

    /// What is seen, for who tests it: an object in JSON, or `null` before it has begun.
    pub fn status(&self) -> String {
        self.runner.app_mut::<App>().map_or_else(|| "null".into(), |app| status(&app))
    }

    /// How it came to a stop by a mistake of sinew's own, if it did.
    pub fn panicked(&self) -> Option<String> {
        self.runner.panic_summary().map(|summary| summary.message())
    }
}

fn status(app: &App) -> String {
    let state: &State = app.state();
    let loaded = state.loaded.as_ref();
    json!({
        "scene": loaded.map(|loaded| loaded.scene.path.display().to_string()),
        "number": loaded.map(|loaded| loaded.number),
        "backend": loaded.map(|loaded| loaded.backend.clone()),
        "drawn_by": app.drawn_by(),
        "step": state.step,
        "time": state.time,
        "running": state.running,
        "finished": state.finished,
        "real_time_factor": state.real_time_factor,
        "refusal": state.refusal.as_ref().map(|refusal| refusal.reason.clone()),
        "mistakes": app.mistakes(),
        "breakdown": state.breakdown.as_ref().map(|broken| broken.to_string()),
    })
    .to_string()
}
