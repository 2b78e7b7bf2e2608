//! How the engine waits for a device in a page: `page/wait.js`.

use sinew::backend::gpu::{Waiting, wait_by};
use wasm_bindgen::prelude::*;

#[wasm_bindgen(raw_module = "./wait.js")]
extern "C" {
    #[wasm_bindgen(js_name = canWait, thread_local_v2)]
    static CAN_WAIT: bool;
    fn suspend() -> f64;
    fn wake();
}

/// Tells the engine, where the browser can; without it scenes run on the CPU.
pub fn begin() {
    if CAN_WAIT.with(|can| *can) {
        let suspend = || _ = suspend();
        wait_by(Waiting { suspend, wake });
    }
}
