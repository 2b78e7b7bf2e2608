//! Buffers: make, fill, read, free, count.

use std::collections::BTreeMap;

use bytemuck::{AnyBitPattern, NoUninit};
use wgpu::{BufferDescriptor, BufferUsages, BufferView, CommandEncoder, CommandEncoderDescriptor, MapMode};

use super::waiting::Mapped;
use super::{BufferKind, Gpu, GpuError, Memory};
use crate::backend::kernel::BufferId;

/// Bytes moved at a time between the computer's memory and the GPU's: bounds the staging memory.
const PIECE: u64 = 64 << 20;

/// A buffer and what is known of it.
pub(super) struct Slot {
    pub(super) buffer: wgpu::Buffer,
    pub(super) label: String,
    pub(super) bytes: u64,
    pub(super) kind: BufferKind,
}

impl Gpu {
    /// Makes a buffer of `bytes` zero bytes, rounded up to a multiple of 4. The device gets at least 16 bytes (a buffer
    /// of none cannot be bound), so that `arrayLength` of an empty column is not 0: dispatch 0 threads for it.
    ///
    /// # Errors
    /// [`GpuError::OverLimit`] and [`GpuError::OutOfMemory`] name label, bytes and limit.
    pub fn create(&mut self, label: &str, bytes: u64, kind: BufferKind) -> Result<BufferId, GpuError> {
        self.check("an earlier call")?;
        let bytes = bytes.checked_next_multiple_of(4).unwrap_or(bytes);
        let size = bytes.max(16);
        let limits = &self.limits;
        let (binding, name) = match kind {
            BufferKind::Storage => (limits.max_storage_buffer_binding_size, "maxStorageBufferBindingSize"),
            BufferKind::Uniform => (limits.max_uniform_buffer_binding_size, "maxUniformBufferBindingSize"),
        };
        self.within(label, bytes, binding, "bytes", name)?;
        self.within(label, bytes, self.limits.max_buffer_size, "bytes", "maxBufferSize")?;
        let kind_usage = match kind {
            BufferKind::Storage => BufferUsages::STORAGE,
            BufferKind::Uniform if self.safe_uniforms.is_some() => BufferUsages::UNIFORM | BufferUsages::STORAGE,
            BufferKind::Uniform => BufferUsages::UNIFORM,
        };
        let usage = kind_usage | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let descriptor = BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.heard(|| self.device.create_buffer(&descriptor));
        self.check_memory(label, bytes)?;
        self.buffers.push(Some(Slot { buffer, label: label.to_owned(), bytes, kind }));
        Ok(BufferId(self.buffers.len() as u32 - 1))
    }

    /// Makes a buffer that holds these rows.
    ///
    /// # Errors
    /// As [`create`](Self::create) and [`upload`](Self::upload).
    pub fn create_with<T: NoUninit>(
        &mut self,
        label: &str,
        rows: &[T],
        kind: BufferKind,
    ) -> Result<BufferId, GpuError> {
        let id = self.create(label, size_of_val(rows) as u64, kind)?;
        self.upload(id, 0, bytemuck::cast_slice(rows))?;
        Ok(id)
    }

    /// Gives a buffer's memory back. Kernels bound to it keep it alive until they are gone.
    ///
    /// # Errors
    /// [`GpuError::Unknown`] when there is no such buffer.
    pub fn free(&mut self, id: BufferId) -> Result<(), GpuError> {
        let slot = self.buffers.get_mut(id.0 as usize).and_then(Option::take);
        slot.map(drop).ok_or_else(|| GpuError::Unknown(format!("buffer {}", id.0)))
    }

    /// Writes bytes from byte `offset` on; both multiples of 4. Kernels run later see them, those running do not.
    ///
    /// # Errors
    /// [`GpuError::Range`] outside the buffer or off the 4-byte boundary.
    pub fn upload(&mut self, id: BufferId, offset: u64, bytes: &[u8]) -> Result<(), GpuError> {
        self.check("an earlier call")?;
        let slot = self.slot(id)?;
        slot.admit("upload", offset, bytes.len() as u64)?;
        let label = slot.label.clone();
        let pieces = bytes.chunks(PIECE as usize);
        let last = pieces.len();
        for (index, piece) in pieces.enumerate() {
            let buffer = &self.slot(id)?.buffer;
            self.heard(|| self.queue.write_buffer(buffer, offset + index as u64 * PIECE, piece));
            if index + 1 < last {
                // staging memory is only given back once its copy was submitted and has ended
                self.last = Some(self.heard(|| self.queue.submit([])));
                self.wait_for(None)?;
            }
        }
        self.check_memory(&label, bytes.len() as u64)
    }

    /// Reads whole buffers, waiting for the kernels before. Buffers that fit the staging memory together share one
    /// submission.
    ///
    /// # Errors
    /// [`GpuError::Unknown`], and what went wrong on the device.
    pub fn download(&mut self, ids: &[BufferId]) -> Result<Vec<Vec<u8>>, GpuError> {
        let mut ranges = Vec::new();
        for id in ids {
            ranges.push((*id, 0, self.slot(*id)?.bytes));
        }
        self.download_ranges(&ranges)
    }

    /// Reads ranges (buffer, first byte, bytes); all multiples of 4.
    ///
    /// # Errors
    /// [`GpuError::Range`], [`GpuError::Unknown`], and what went wrong on the device.
    pub fn download_ranges(&mut self, ranges: &[(BufferId, u64, u64)]) -> Result<Vec<Vec<u8>>, GpuError> {
        self.check("an earlier call")?;
        let mut pieces = Vec::new();
        for (index, (id, offset, bytes)) in ranges.iter().enumerate() {
            let bytes = *bytes;
            self.slot(*id)?.admit("download", *offset, bytes)?;
            let mut done = 0;
            while done < bytes {
                let size = PIECE.min(bytes - done);
                pieces.push(Piece { index, id: *id, offset: offset + done, size });
                done += size;
            }
        }
        let mut out: Vec<Vec<u8>> = ranges.iter().map(|r| Vec::with_capacity(r.2 as usize)).collect();
        let mut rest = pieces.as_slice();
        while !rest.is_empty() {
            let mut total = 0;
            let fits = rest.iter().take_while(|p| {
                total += p.size;
                total <= PIECE
            });
            let (batch, later) = rest.split_at(fits.count());
            self.download_batch(batch, &mut out)?;
            rest = later;
        }
        Ok(out)
    }

    /// Reads a buffer as rows of `T`, for example `[f32; 4]`. Bytes after the last whole row are left out.
    ///
    /// # Errors
    /// As [`download`](Self::download).
    pub fn download_rows<T: AnyBitPattern>(&mut self, id: BufferId) -> Result<Vec<T>, GpuError> {
        let bytes = self.download(&[id])?.pop().unwrap_or_default();
        Ok(bytes.chunks_exact(size_of::<T>().max(1)).map(bytemuck::pod_read_unaligned).collect())
    }

    fn download_batch(&mut self, batch: &[Piece], out: &mut [Vec<u8>]) -> Result<(), GpuError> {
        let total: u64 = batch.iter().map(|p| p.size).sum();
        let staging = self.staging(total)?;
        let buffers =
            batch.iter().map(|piece| Ok(&self.slot(piece.id)?.buffer)).collect::<Result<Vec<_>, GpuError>>()?;
        let mut encoder = self.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("download") });
        self.heard(|| {
            let mut at = 0;
            for (piece, buffer) in batch.iter().zip(buffers) {
                encoder.copy_buffer_to_buffer(buffer, piece.offset, &staging, at, piece.size);
                at += piece.size;
            }
        });
        let view = self.read("download", encoder, &staging, total)?;
        let mut at = 0;
        for piece in batch {
            out[piece.index].extend_from_slice(&view[at..at + piece.size as usize]);
            at += piece.size as usize;
        }
        drop(view);
        staging.unmap();
        Ok(())
    }

    /// Submits what copies into a buffer that the CPU can read, and waits for that: its first bytes.
    pub(super) fn read(
        &mut self,
        label: &str,
        encoder: CommandEncoder,
        staging: &wgpu::Buffer,
        bytes: u64,
    ) -> Result<BufferView, GpuError> {
        let mapped = Mapped::default();
        let index = self.heard(|| {
            let index = self.queue.submit([encoder.finish()]);
            staging.map_async(MapMode::Read, 0..bytes, mapped.told());
            index
        });
        self.last = Some(index);
        if let Err(failed) = self.wait() {
            // it may stay mapped: the next to be read is another
            self.staging = None;
            return Err(failed);
        }
        mapped.wait();
        let view = staging.get_mapped_range(0..bytes);
        view.map_err(|e| GpuError::Device { during: label.to_owned(), message: e.to_string() })
    }

    /// A buffer the CPU can read, of at least this size; kept from one download to the next.
    pub(super) fn staging(&mut self, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        if let Some(kept) = self.staging.as_ref().filter(|b| b.size() >= bytes) {
            return Ok(kept.clone());
        }
        let descriptor = BufferDescriptor {
            label: Some("download"),
            size: bytes.next_power_of_two().max(4096),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        };
        let staging = self.heard(|| self.device.create_buffer(&descriptor));
        self.check_memory("download", descriptor.size)?;
        self.staging = Some(staging.clone());
        Ok(staging)
    }

    /// A buffer itself, for who draws by the same device from what is computed in it.
    pub fn lend(&self, id: BufferId) -> Option<wgpu::Buffer> {
        self.slot(id).ok().map(|slot| slot.buffer.clone())
    }

    /// Memory by label, the largest first, for reports.
    pub fn memory(&self) -> Vec<Memory> {
        let mut totals: BTreeMap<&str, (u64, usize)> = BTreeMap::new();
        for slot in self.buffers.iter().flatten() {
            let total = totals.entry(&slot.label).or_default();
            *total = (total.0 + slot.bytes, total.1 + 1);
        }
        let row = |(label, (bytes, count)): (&str, (u64, usize))| Memory { label: label.to_owned(), bytes, count };
        let mut rows: Vec<_> = totals.into_iter().map(row).collect();
        rows.sort_by_key(|m| std::cmp::Reverse(m.bytes));
        rows
    }

    /// Bytes in all buffers.
    pub fn memory_total(&self) -> u64 {
        self.buffers.iter().flatten().map(|slot| slot.bytes).sum()
    }

    pub(super) fn slot(&self, id: BufferId) -> Result<&Slot, GpuError> {
        let slot = self.buffers.get(id.0 as usize).and_then(Option::as_ref);
        slot.ok_or_else(|| GpuError::Unknown(format!("buffer {}", id.0)))
    }
}

/// A part of a download that fits the staging memory.
struct Piece {
    index: usize,
    id: BufferId,
    offset: u64,
    size: u64,
}

impl Slot {
    fn admit(&self, action: &'static str, offset: u64, bytes: u64) -> Result<(), GpuError> {
        let inside = offset.checked_add(bytes).is_some_and(|end| end <= self.bytes);
        if inside && offset.is_multiple_of(4) && bytes.is_multiple_of(4) {
            return Ok(());
        }
        Err(GpuError::Range { label: self.label.clone(), action, offset, bytes, size: self.bytes })
    }
}
