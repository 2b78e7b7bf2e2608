//! Running: many steps of several kernels in few submissions.

use std::num::NonZeroU64;
use std::sync::Arc;

use wgpu::{
    Buffer, BufferBinding, BufferDescriptor, BufferUsages, CommandEncoderDescriptor, ComputePass,
    ComputePassDescriptor, Device, SubmissionIndex,
};

use super::pipelines::Prepared;
use super::submission_throttle::MOST_STEPS;
use super::{Gpu, GpuError};
use crate::backend::kernel::KernelId;

/// Dynamic offsets of uniforms are multiples of this on every WebGPU device.
const RECORD_ALIGNMENT: u64 = 256;

/// Bytes of the number of records before packed records, with the padding behind it.
pub(super) const PACKED_HEADER: usize = 16;

/// The records of one submission's steps, one 256-byte slot each (several, where a record is longer); and their number
/// and all of them one after the other, for kernels that run all those steps in one dispatch.
pub(super) struct StepRecords {
    buffer: Buffer,
    packed: Buffer,
}

impl StepRecords {
    pub(super) fn new(device: &Device) -> Self {
        let size = RECORD_ALIGNMENT * u64::from(MOST_STEPS);
        let buffer = |label, size, usage| {
            let usage = usage | BufferUsages::COPY_DST;
            device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        Self {
            buffer: buffer("step records", size, BufferUsages::UNIFORM),
            packed: buffer("packed step records", PACKED_HEADER as u64 + size, BufferUsages::STORAGE),
        }
    }

    /// What a kernel binds that runs all steps of a submission in one dispatch.
    pub(super) fn packed(&self) -> BufferBinding<'_> {
        self.packed.as_entire_buffer_binding()
    }

    /// What a kernel binds; the dynamic offset chooses the step.
    pub(super) fn binding(&self, bytes: u32) -> BufferBinding<'_> {
        BufferBinding { buffer: &self.buffer, offset: 0, size: NonZeroU64::new(u64::from(bytes)) }
    }

    /// Bytes from one step's record to the next's, or None where a record is longer than the buffer.
    fn stride(&self, record_size: usize) -> Option<u64> {
        let stride = (record_size.max(1) as u64).checked_next_multiple_of(RECORD_ALIGNMENT)?;
        (stride <= self.buffer.size()).then_some(stride)
    }
}

/// One submission's steps.
struct Batch<'a> {
    kernels: Vec<&'a Prepared>,
    steps: u32,
    stride: u64,
}

impl Gpu {
    /// Runs `count` steps: the kernels in order, then again with the next record. `step_records` holds `count` records
    /// of `record_size` bytes, which the kernels see as the uniform `step`. Returns when all is submitted; it may
    /// still be running ([`wait`](Self::wait)).
    ///
    /// # Errors
    /// [`GpuError::Records`] when the records do not fit `count` or the kernels' `step`; what went wrong on the device.
    pub fn run(
        &mut self,
        kernels: &[KernelId],
        step_records: &[u8],
        record_size: usize,
        count: u32,
    ) -> Result<(), GpuError> {
        self.check("an earlier call")?;
        let stride = self.admit_records(kernels, step_records, record_size, count)?;
        let room = self.records.buffer.size() / stride;
        let most = self.timing.as_ref().map_or(MOST_STEPS, |t| t.steps(kernels.len())).min(room as u32);
        let key: Arc<[KernelId]> = Arc::from(kernels);
        let mut done = 0;
        while done < count {
            let steps = self.throttle.batch(kernels).min(most).min(count - done);
            let records = &step_records[done as usize * record_size..][..steps as usize * record_size];
            if self.any(kernels, |kernel| kernel.record.is_some()) {
                self.write_records(records, record_size, stride);
            }
            if self.any(kernels, |kernel| kernel.packed_record.is_some()) {
                self.write_packed_records(records, steps);
            }
            self.submit(&key, steps, stride)?;
            done += steps;
        }
        Ok(())
    }

    /// Runs kernels that use no step record, once.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_once(&mut self, kernels: &[KernelId]) -> Result<(), GpuError> {
        self.run(kernels, &[], 0, 1)
    }

    /// Submissions of steps so far: how far many steps share one.
    pub fn submissions(&self) -> u64 {
        self.throttle.submissions
    }

    /// Dispatches of kernels so far.
    pub fn dispatches(&self) -> u64 {
        self.throttle.dispatches
    }

    fn any(&self, kernels: &[KernelId], is_so: impl Fn(&Prepared) -> bool) -> bool {
        kernels.iter().any(|id| self.kernel(*id).is_ok_and(&is_so))
    }

    fn admit_records(
        &self,
        kernels: &[KernelId],
        records: &[u8],
        record_size: usize,
        count: u32,
    ) -> Result<u64, GpuError> {
        if record_size.checked_mul(count as usize) != Some(records.len()) {
            let got = records.len();
            return Err(GpuError::Records(format!("{count} steps of {record_size} bytes wanted, got {got} bytes")));
        }
        for id in kernels {
            let kernel = self.kernel(*id)?;
            let wanted = kernel.record.unwrap_or(0) as usize;
            if wanted > record_size {
                let label = &kernel.label;
                return Err(GpuError::Records(format!(
                    "kernel `{label}` reads a `step` of {wanted} bytes, the records have {record_size}"
                )));
            }
            if let Some(wanted) = kernel.packed_record.filter(|wanted| *wanted as usize != record_size) {
                let label = &kernel.label;
                return Err(GpuError::Records(format!(
                    "kernel `{label}` reads records of {wanted} bytes, these have {record_size}"
                )));
            }
        }
        self.records.stride(record_size).ok_or_else(|| {
            let most = self.records.buffer.size();
            GpuError::Records(format!("a record of {record_size} bytes is over the {most} allowed"))
        })
    }

    /// The queue writes in order: records of a submission in flight are not touched.
    fn write_records(&self, records: &[u8], record_size: usize, stride: u64) {
        if record_size == 0 {
            return;
        }
        let mut spread = vec![0; records.len() / record_size * stride as usize];
        for (slot, record) in spread.chunks_exact_mut(stride as usize).zip(records.chunks_exact(record_size)) {
            slot[..record_size].copy_from_slice(record);
        }
        self.heard(|| self.queue.write_buffer(&self.records.buffer, 0, &spread));
    }

    fn write_packed_records(&self, records: &[u8], steps: u32) {
        let mut packed = vec![0; PACKED_HEADER];
        packed[..size_of::<u32>()].copy_from_slice(&steps.to_le_bytes());
        packed.extend_from_slice(records);
        self.heard(|| self.queue.write_buffer(&self.records.packed, 0, &packed));
    }

    fn submit(&mut self, key: &Arc<[KernelId]>, steps: u32, stride: u64) -> Result<(), GpuError> {
        let kernels = key.iter().map(|id| self.kernel(*id)).collect::<Result<Vec<_>, _>>()?;
        let batch = Batch { kernels: kernels.into_iter().filter(|k| k.groups.0 > 0).collect(), steps, stride };
        let (index, timed) = self.heard(|| self.encode(&batch));
        let mut dispatches = 0;
        batch.each(|_, _| dispatches += 1);
        self.last = Some(index.clone());
        self.throttle.dispatches += dispatches;
        self.check("running kernels")?;
        self.throttle.submitted(index, key.clone(), steps);
        if !timed.is_empty() {
            return self.collect_times(&timed);
        }
        while let Some(due) = self.throttle.due() {
            self.wait_for(Some(due))?;
            self.throttle.retire();
        }
        Ok(())
    }
}

impl Gpu {
    /// Submits a batch: its number, and the labels of what is timed in it.
    fn encode(&self, batch: &Batch<'_>) -> (SubmissionIndex, Vec<String>) {
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("steps") });
        let mut labels = Vec::new();
        match &self.timing {
            None => {
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                batch.each(|kernel, offset| dispatch(&mut pass, kernel, offset));
            }
            Some(timing) => {
                batch.each(|kernel, offset| {
                    let descriptor = timing.pass(labels.len() as u32, &kernel.label);
                    dispatch(&mut encoder.begin_compute_pass(&descriptor), kernel, offset);
                    labels.push(kernel.label.clone());
                });
                timing.resolve(&mut encoder, labels.len() as u32);
            }
        }
        (self.queue.submit([encoder.finish()]), labels)
    }
}

impl Batch<'_> {
    /// Calls `run` for every kernel of every step with the offset of the step's record; once for those that run all
    /// steps.
    fn each(&self, mut run: impl FnMut(&Prepared, u32)) {
        for step in 0..self.steps {
            for kernel in self.kernels.iter().filter(|kernel| step == 0 || kernel.packed_record.is_none()) {
                run(kernel, (u64::from(step) * self.stride) as u32);
            }
        }
    }
}

fn dispatch(pass: &mut ComputePass<'_>, kernel: &Prepared, offset: u32) {
    pass.set_pipeline(&kernel.pipeline);
    let offsets = [offset];
    pass.set_bind_group(0, &kernel.group, if kernel.record.is_some() { &offsets } else { &[] });
    pass.dispatch_workgroups(kernel.groups.0, kernel.groups.1, 1);
}
