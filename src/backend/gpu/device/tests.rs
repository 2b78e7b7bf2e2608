#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use crate::backend::gpu::{BufferKind, gpu_or_reason};
use crate::backend::kernel::{Fragment, Kernel};

#[test]
fn a_device_that_went_away_gives_errors_and_no_panic() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let buffer = gpu.create("mass", 64, BufferKind::Storage).unwrap();
    let text = "@group(0) @binding(0) var<storage, read_write> mass: array<f32>;
            @compute @workgroup_size(64) fn zero() { mass[0] = 0.0; }";
    let kernel = Kernel::new("zero", "zero").fragment(Fragment::new("zero.wgsl", text)).bind("mass", buffer);
    let ready = gpu.prepare(&kernel.clone().threads(1)).unwrap();
    gpu.run_once(&[ready]).unwrap();
    gpu.destroy();
    assert!(matches!(gpu.wait(), Err(GpuError::Lost(_))));
    assert!(gpu.create("mass", 64, BufferKind::Storage).is_err());
    assert!(gpu.run_once(&[ready]).is_err());
    assert!(gpu.upload(buffer, 0, &[0; 64]).is_err());
    assert!(gpu.download(&[buffer]).is_err());
    assert!(gpu.prepare(&kernel.threads(2)).is_err());
    assert!(gpu.time_kernels(true).is_err());
}

#[test]
fn memory_that_is_full_is_an_error_and_the_device_lives_on() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let kept = gpu.create("mass", 64, BufferKind::Storage).unwrap();
    // as wgpu reports it: no driver can be asked to run out of memory here
    gpu.inbox.put(Event::OutOfMemory);
    let error = gpu.check_memory("element force", 4096).unwrap_err();
    assert!(matches!(&error, GpuError::OutOfMemory { bytes: 4096, used: 64, .. }), "{error}");
    assert!(error.to_string().contains("`element force` of 4096 bytes"), "{error}");
    gpu.upload(kept, 0, &[1; 64]).unwrap();
    assert_eq!(gpu.download(&[kept]).unwrap()[0], [1; 64]);
}

#[test]
fn a_gpu_may_move_between_threads() {
    fn sent<T: Send + Sync>() {}
    sent::<Gpu>();
}
