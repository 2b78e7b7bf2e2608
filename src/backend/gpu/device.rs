//! One open device.

use std::collections::HashMap;
#[cfg(target_arch = "wasm32")]
use std::sync::Arc;
use std::time::Duration;

use wgpu::{Adapter, Device, ErrorFilter, Features, Limits, PollError, PollStatus, PollType, Queue, SubmissionIndex};

use super::adapter::choose;
use super::buffers::Slot;
use super::host::Host;
use super::inbox::{Event, Inbox};
use super::pipelines::{Pipelines, Prepared};
use super::quirks::safe_uniforms;
use super::run::StepRecords;
use super::submission_throttle::SubmissionThrottle;
use super::timing::Timing;
#[cfg(target_arch = "wasm32")]
use super::waiting::Bell;
use super::waiting::block_on;
use super::{AdapterReport, Choice, GpuError, GpuLimits, NoGpu, SmallerLimits};
use crate::backend::kernel::MostBuffers;

/// A submission that takes longer than this is taken for dead.
const PATIENCE: Duration = Duration::from_secs(300);

/// An open GPU with its buffers and kernels.
pub struct Gpu {
    pub(super) device: Device,
    pub(super) queue: Queue,
    pub(super) limits: Limits,
    pub(super) buffers: Vec<Option<Slot>>,
    pub(super) staging: Option<wgpu::Buffer>,
    pub(super) pipelines: Pipelines,
    pub(super) kernels: Vec<Prepared>,
    pub(super) records: StepRecords,
    pub(super) throttle: SubmissionThrottle,
    pub(super) timing: Option<Timing>,
    pub(super) times: HashMap<String, super::KernelTime>,
    /// Uniform buffers of a kernel, where the driver spoils memory with more.
    pub(super) safe_uniforms: Option<usize>,
    /// The last of our submissions.
    pub(super) last: Option<SubmissionIndex>,
    inbox: Inbox,
    /// The device is a program's, as are the handlers of its errors.
    adopted: bool,
    report: AdapterReport,
}

impl Gpu {
    /// Opens a device with all the limits it offers.
    ///
    /// # Errors
    /// [`NoGpu`] says why there is none: no driver, none that matches the choice, or the driver refused.
    pub fn open(choice: &Choice) -> Result<Self, NoGpu> {
        let (adapter, report) = choose(choice)?;
        let (device, queue) =
            request(&adapter).map_err(|e| NoGpu::Refused { adapter: report.to_string(), reason: e.to_string() })?;
        Ok(Self::on(device, queue, report, false))
    }

    /// On a device that is ours alone, or adopted.
    pub(super) fn on(device: Device, queue: Queue, report: AdapterReport, adopted: bool) -> Self {
        let inbox = if adopted { Inbox::default() } else { Inbox::listen(&device) };
        let records = heard(&device, &inbox, adopted, || StepRecords::new(&device));
        Self {
            limits: device.limits(),
            buffers: Vec::new(),
            staging: None,
            pipelines: Pipelines::default(),
            kernels: Vec::new(),
            records,
            throttle: SubmissionThrottle::new(adopted),
            timing: None,
            times: HashMap::new(),
            device,
            queue,
            last: None,
            inbox,
            adopted,
            safe_uniforms: safe_uniforms(&report),
            report,
        }
    }

    /// Does something by the device, so that what goes wrong is in the inbox by the next check.
    pub(super) fn heard<T>(&self, act: impl FnOnce() -> T) -> T {
        heard(&self.device, &self.inbox, self.adopted, act)
    }

    /// The device's name, driver and kind.
    pub fn report(&self) -> &AdapterReport {
        &self.report
    }

    /// Gives the device up, as when a driver resets it: all that follows is [`GpuError::Lost`]. For trying out what a
    /// program does then.
    pub fn destroy(&mut self) {
        self.device.destroy();
    }

    /// Keeps to less than the device allows.
    pub fn keep_to(&mut self, smaller: SmallerLimits) {
        let (binding, groups) =
            (&mut self.limits.max_storage_buffer_binding_size, &mut self.limits.max_compute_workgroups_per_dimension);
        *binding = smaller.storage_binding.map_or(*binding, |bytes| bytes.min(*binding));
        *groups = smaller.workgroups.map_or(*groups, |most| most.min(*groups));
    }

    /// What the device allows.
    pub fn limits(&self) -> GpuLimits {
        let limits = &self.limits;
        let (storage, uniform) =
            (limits.max_storage_buffers_per_shader_stage, limits.max_uniform_buffers_per_shader_stage);
        let both = MostBuffers::new(storage as usize, uniform as usize);
        // those beyond count as storage buffers
        let together = self.safe_uniforms.map_or(both.together, |safe| both.storage + safe);
        GpuLimits {
            storage_binding: limits.max_storage_buffer_binding_size,
            uniform_binding: limits.max_uniform_buffer_binding_size,
            buffer: limits.max_buffer_size,
            buffers: MostBuffers { together, ..both },
            workgroup_memory: limits.max_compute_workgroup_storage_size,
            workgroup_size: limits.max_compute_invocations_per_workgroup,
            time_stamps: self.device.features().contains(Features::TIMESTAMP_QUERY),
        }
    }

    /// Waits until everything submitted by this is done.
    ///
    /// # Errors
    /// [`GpuError::Lost`], [`GpuError::TimedOut`], and whatever went wrong since the last call.
    pub fn wait(&mut self) -> Result<(), GpuError> {
        while let Some(index) = self.throttle.oldest() {
            self.wait_for(Some(index))?;
            self.throttle.retire();
        }
        self.wait_for(None)
    }

    /// Waits for one submission, or for the last of ours: a program that shares the device may have more.
    pub(super) fn wait_for(&mut self, one: Option<SubmissionIndex>) -> Result<(), GpuError> {
        let polled = self.polled(match one.or_else(|| self.last.clone()) {
            None => PollType::Poll,
            submission_index => PollType::Wait { submission_index, timeout: Some(PATIENCE) },
        });
        self.check("waiting for the GPU")?;
        match polled {
            Ok(_) => Ok(()),
            Err(PollError::Timeout) => Err(GpuError::TimedOut(PATIENCE.as_secs())),
            Err(other) => {
                // what a lost device was handed was never submitted, and it says so when it is asked without a number
                // only
                let _ = self.polled(PollType::Poll);
                self.check("waiting for the GPU")?;
                match self.adopted {
                    // its handler is the program's: this is all that is heard of it
                    true => Err(GpuError::Lost(format!("the program's device no longer takes work ({other})"))),
                    false => {
                        Err(GpuError::Device { during: "waiting for the GPU".to_owned(), message: other.to_string() })
                    }
                }
            }
        }
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn polled(&self, what: PollType) -> Result<PollStatus, PollError> {
        self.device.poll(what)
    }

    /// A browser knows no submission by its number: this waits for all of them.
    #[cfg(target_arch = "wasm32")]
    fn polled(&self, what: PollType) -> Result<PollStatus, PollError> {
        if let PollType::Wait { .. } = what {
            let bell = Arc::new(Bell::default());
            let done = bell.clone();
            self.queue.on_submitted_work_done(move || done.ring());
            bell.wait();
        }
        Ok(PollStatus::QueueEmpty)
    }

    /// Err with what the device complained of since the last call.
    pub(super) fn check(&self, during: &str) -> Result<(), GpuError> {
        self.check_memory(during, 0)
    }

    /// The same where a buffer was asked for.
    pub(super) fn check_memory(&self, label: &str, bytes: u64) -> Result<(), GpuError> {
        match self.inbox.take() {
            None => Ok(()),
            Some(Event::Lost(text)) => Err(GpuError::Lost(text)),
            Some(Event::OutOfMemory) => {
                Err(GpuError::OutOfMemory { label: label.to_owned(), bytes, used: self.memory_total() })
            }
            Some(Event::Other(message)) => Err(GpuError::Device { during: label.to_owned(), message }),
        }
    }

    /// Err when `wanted` is more than `limit`.
    pub(super) fn within(
        &self,
        label: &str,
        wanted: u64,
        limit: u64,
        unit: &'static str,
        limit_name: &'static str,
    ) -> Result<(), GpuError> {
        if wanted <= limit {
            return Ok(());
        }
        let adapter = self.report.name.clone();
        Err(GpuError::OverLimit { label: label.to_owned(), wanted, unit, limit, limit_name, adapter })
    }
}

fn request(adapter: &Adapter) -> Result<(Device, Queue), wgpu::RequestDeviceError> {
    block_on(adapter.request_device(&Host::device_descriptor(adapter)))
}

/// Errors of a device of our own come by its callback. Of an adopted one they are caught around each of our calls, so
/// that its handler hears of the program's own only: scopes are those of this thread.
fn heard<T>(device: &Device, inbox: &Inbox, adopted: bool, act: impl FnOnce() -> T) -> T {
    if !adopted {
        return act();
    }
    let kinds = [ErrorFilter::Validation, ErrorFilter::OutOfMemory, ErrorFilter::Internal];
    let scopes = kinds.map(|kind| device.push_error_scope(kind));
    let done = act();
    for scope in scopes.into_iter().rev() {
        inbox.expect(scope.pop());
    }
    done
}

#[cfg(test)]
mod tests;
