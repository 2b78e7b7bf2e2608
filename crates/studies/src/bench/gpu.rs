//! What only a GPU has: work that goes on after it was ordered, a name, a clock of its own.

use sinew::Error;
use sinew::Simulation;
use sinew::backend::device::Device;

/// Windows of steps that are timed on the GPU's own clock.
const WINDOWS: usize = 5;

/// Takes steps and waits until they are done; on the CPU there is nothing to wait for.
pub fn advance(simulation: &mut Simulation, steps: u64) -> Result<(), Error> {
    simulation.advance(steps)?;
    if let Some(mut device) = simulation.world_mut().get_resource_mut::<Device>() {
        device.gpu().wait()?;
    }
    Ok(())
}

/// The GPU's name, kind, interface and driver.
pub fn adapter(simulation: &mut Simulation) -> Option<String> {
    let mut device = simulation.world_mut().get_resource_mut::<Device>()?;
    Some(device.gpu().report().to_string())
}

/// Time of a step's kernels on the GPU's own clock (s), the best of some windows; `None` on the CPU and on devices
/// without such a clock.
pub fn kernel_seconds(simulation: &mut Simulation, steps: u64) -> Result<Option<f64>, Error> {
    let mut best: Option<f64> = None;
    for _ in 0..WINDOWS {
        let Some(mut device) = simulation.world_mut().get_resource_mut::<Device>() else { return Ok(None) };
        if !device.gpu().limits().time_stamps {
            return Ok(None);
        }
        device.gpu().time_kernels(true)?;
        advance(simulation, steps)?;
        let Some(mut device) = simulation.world_mut().get_resource_mut::<Device>() else { return Ok(None) };
        let nanoseconds: f64 = device.gpu().kernel_times().iter().map(|kernel| kernel.nanoseconds).sum();
        device.gpu().time_kernels(false)?;
        let seconds = 1e-9 * nanoseconds / steps as f64;
        best = Some(best.map_or(seconds, |best| best.min(seconds)));
    }
    Ok(best)
}
