//! The device of the screen, for simulations to run on, too.

use eframe::CreationContext;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use sinew::Host;
use std::sync::Arc;
use wgpu::DownlevelFlags;

/// How a screen's device is opened: with all that it allows.
pub fn configuration() -> WgpuConfiguration {
    let setup = WgpuSetupCreateNew {
        device_descriptor: Arc::new(Host::device_descriptor),
        ..WgpuSetupCreateNew::without_display_handle()
    };
    WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..WgpuConfiguration::default() }
}

/// The canvas of a page likewise.
#[cfg(target_arch = "wasm32")]
pub fn web_options() -> eframe::WebOptions {
    eframe::WebOptions { wgpu_options: configuration(), ..eframe::WebOptions::default() }
}

/// The screen's device: what is simulated on it is drawn from where it is. None where it draws only, as WebGL does.
pub fn host(context: &CreationContext<'_>) -> Option<Host> {
    let screen = context.wgpu_render_state.as_ref()?;
    let computes = screen.adapter.get_downlevel_capabilities().flags.contains(DownlevelFlags::COMPUTE_SHADERS);
    computes.then(|| Host {
        adapter: screen.adapter.clone(),
        device: screen.device.clone(),
        queue: screen.queue.clone(),
    })
}
