//! Time of each kernel on the GPU's own clock.
//!
//! Only passes can be stamped everywhere, so that every dispatch gets a pass of its own while timing is on: a little
//! slower than a normal run, which has one pass a submission.

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePassTimestampWrites,
    QuerySet, QuerySetDescriptor, QueryType,
};

use super::{Gpu, GpuError, KernelTime};

/// Dispatches that one submission can time: two stamps each, and 4096 stamps a query set.
const MOST_DISPATCHES: u32 = 2048;

pub(super) struct Timing {
    stamps: QuerySet,
    resolved: Buffer,
}

impl Timing {
    /// Steps that one submission can time.
    pub(super) fn steps(&self, kernels: usize) -> u32 {
        (MOST_DISPATCHES / (kernels as u32).max(1)).max(1)
    }

    /// The pass of the `index`th dispatch. Dispatches beyond the set's room go without stamps.
    pub(super) fn pass<'a>(&'a self, index: u32, label: &'a str) -> ComputePassDescriptor<'a> {
        let stamps = ComputePassTimestampWrites {
            query_set: &self.stamps,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        };
        let timestamp_writes = (index < MOST_DISPATCHES).then_some(stamps);
        ComputePassDescriptor { label: Some(label), timestamp_writes }
    }

    pub(super) fn resolve(&self, encoder: &mut CommandEncoder, dispatches: u32) {
        let stamps = 2 * dispatches.min(MOST_DISPATCHES);
        if stamps > 0 {
            encoder.resolve_query_set(&self.stamps, 0..stamps, &self.resolved, 0);
        }
    }
}

impl Gpu {
    /// Turns timing on (forgetting earlier times) or off.
    ///
    /// # Errors
    /// [`GpuError::NoTimeStamps`] when the device has no clock.
    pub fn time_kernels(&mut self, on: bool) -> Result<(), GpuError> {
        self.wait()?;
        if !on {
            self.timing = None;
            return Ok(());
        }
        if !self.limits().time_stamps {
            return Err(GpuError::NoTimeStamps(self.report().to_string()));
        }
        let label = Some("kernel times");
        let stamps = QuerySetDescriptor { label, ty: QueryType::Timestamp, count: 2 * MOST_DISPATCHES };
        let stamps = self.heard(|| self.device.create_query_set(&stamps));
        let resolved = BufferDescriptor {
            label,
            size: 16 * u64::from(MOST_DISPATCHES),
            usage: BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        };
        let resolved = self.heard(|| self.device.create_buffer(&resolved));
        self.check("making time stamps")?;
        self.times.clear();
        self.timing = Some(Timing { stamps, resolved });
        Ok(())
    }

    /// Times since timing was turned on, the longest first.
    pub fn kernel_times(&self) -> Vec<KernelTime> {
        let mut times: Vec<_> = self.times.values().cloned().collect();
        times.sort_by(|a, b| b.nanoseconds.total_cmp(&a.nanoseconds).then_with(|| a.label.cmp(&b.label)));
        times
    }

    /// Reads the stamps of the submission just made, one pair a dispatch, in the order of their labels.
    pub(super) fn collect_times(&mut self, labels: &[String]) -> Result<(), GpuError> {
        let Some(timing) = &self.timing else { return Ok(()) };
        let resolved = timing.resolved.clone();
        let bytes = 16 * labels.len().min(MOST_DISPATCHES as usize) as u64;
        let staging = self.staging(bytes)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.heard(|| encoder.copy_buffer_to_buffer(&resolved, 0, &staging, 0, bytes));
        let view = self.read("kernel times", encoder, &staging, bytes)?;
        let period = f64::from(self.queue.get_timestamp_period());
        for (pair, label) in view.chunks_exact(16).zip(labels) {
            let stamp = |half: &[u8]| bytemuck::pod_read_unaligned::<u64>(half);
            let ticks = stamp(&pair[8..]).saturating_sub(stamp(&pair[..8]));
            let time = self
                .times
                .entry(label.clone())
                .or_insert_with(|| KernelTime { label: label.clone(), ..Default::default() });
            time.nanoseconds += ticks as f64 * period;
            time.dispatches += 1;
        }
        drop(view);
        staging.unmap();
        Ok(())
    }
}
