//! What the GPU layer refuses, and how it says so.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod gpu_kernels;

use gpu_kernels::{SAXPY, march, saxpy, storage};
use sinew::backend::gpu::{BufferKind, Choice, Gpu, GpuError, NoGpu, gpu_or_reason};
use sinew::backend::kernel::{Fragment, Kernel, KernelError};
use sinew::shader;

#[test]
fn names_that_do_not_match_are_listed_on_both_sides() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let (x, y) = (storage(&mut gpu, "x", &[0.0]), storage(&mut gpu, "y", &[0.0]));
    let kernel = Kernel::new("saxpy", "saxpy").fragment(Fragment::new("saxpy.wgsl", SAXPY)).fragment(shader!("row"));
    let error = gpu.prepare(&kernel.bind("x", x).bind("z", y).bind("x", y)).unwrap_err();
    let GpuError::Kernel(kernel) = &error else { panic!("{error}") };
    let KernelError::Bindings(mismatch) = kernel.as_ref() else { panic!("{error}") };
    assert_eq!(mismatch.without_buffer, ["y", "scale"]);
    assert_eq!(mismatch.without_variable, ["z", "x (given twice)"]);
    let text = error.to_string();
    assert!(text.contains("kernel `saxpy` (`saxpy` in saxpy.wgsl + shaders/row.wgsl)"), "{text}");
    assert!(text.contains("declared: x, y, scale"), "{text}");
}

#[test]
fn an_unknown_entry_point_lists_the_known_ones() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let kernel = Kernel::new("saxpy", "main").fragment(Fragment::new("saxpy.wgsl", SAXPY)).fragment(shader!("row"));
    let text = gpu.prepare(&kernel).unwrap_err().to_string();
    assert!(text.contains("no compute entry point `main`") && text.ends_with("there is saxpy"), "{text}");
}

#[test]
fn buffers_of_the_wrong_kind_or_size_are_refused() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let (x, y) = (storage(&mut gpu, "x", &[0.0]), storage(&mut gpu, "y", &[0.0]));
    let text = gpu.prepare(&saxpy(x, y, x, 1)).unwrap_err().to_string();
    assert!(text.contains("`x` cannot be bound to `scale`: the variable is a uniform"), "{text}");
    let wide = SAXPY.replace("count: u32", "count: u32, more: array<vec4<f32>, 4>");
    let kernel = Kernel::new("wide", "saxpy").fragment(Fragment::new("wide.wgsl", wide)).fragment(shader!("row"));
    let scale = gpu.create("scale", 8, BufferKind::Uniform).unwrap();
    let text = gpu.prepare(&kernel.bind("x", x).bind("y", y).bind("scale", scale)).unwrap_err().to_string();
    assert!(text.ends_with("8 bytes, `Scale` needs 80"), "{text}");
}

#[test]
fn a_buffer_over_the_limit_is_refused_with_the_limit() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    for (kind, limit) in [
        (BufferKind::Storage, gpu.limits().storage_binding.min(gpu.limits().buffer)),
        (BufferKind::Uniform, gpu.limits().uniform_binding),
    ] {
        let error = gpu.create("element force", limit + 4, kind).unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with(&format!("`element force`: {} bytes wanted", limit + 4)), "{text}");
        assert!(text.contains(&format!("allows {limit}")), "{text}");
    }
    assert!(gpu.create("everything", u64::MAX, BufferKind::Storage).is_err());
    assert_eq!(gpu.memory_total(), 0);
}

#[test]
fn ranges_outside_a_buffer_are_refused() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let x = storage(&mut gpu, "x", &[0.0; 4]);
    assert!(matches!(gpu.upload(x, 12, &[0; 8]), Err(GpuError::Range { size: 16, .. })));
    assert!(matches!(gpu.upload(x, 0, &[0; 3]), Err(GpuError::Range { .. })));
    assert!(matches!(gpu.download_ranges(&[(x, u64::MAX - 3, 8)]), Err(GpuError::Range { .. })));
    gpu.free(x).unwrap();
    assert!(matches!(gpu.download(&[x]), Err(GpuError::Unknown(_))));
}

#[test]
fn records_that_do_not_fit_are_refused() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = storage(&mut gpu, "state", &[0.0]);
    let kernel = gpu.prepare(&march(state, 1)).unwrap();
    assert!(matches!(gpu.run(&[kernel], &[0; 12], 8, 2), Err(GpuError::Records(_))));
    let text = gpu.run(&[kernel], &[0; 8], 4, 2).unwrap_err().to_string();
    assert_eq!(text, "step records: kernel `march` reads a `step` of 8 bytes, the records have 4");
    assert!(matches!(gpu.run(&[kernel], &vec![0; 70_000], 70_000, 1), Err(GpuError::Records(_))));
}

#[test]
fn a_buffer_read_and_written_by_one_kernel_is_an_error_and_the_device_lives_on() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let y = storage(&mut gpu, "y", &[1.0; 4]);
    let scale = gpu.create_with("scale", &[1.0f32.to_bits(), 4], BufferKind::Uniform).unwrap();
    let error = gpu.prepare(&saxpy(y, y, scale, 4)).unwrap_err();
    assert!(error.to_string().contains("`y` cannot be bound to `y`: it is bound to `x` too"), "{error}");
    assert_eq!(gpu.download_rows::<f32>(y).unwrap(), [1.0; 4]);
}

#[test]
fn a_choice_that_no_device_meets_lists_the_devices_there_are() {
    let Err(error) = Gpu::open(&Choice::Named("no such device".to_owned())) else { panic!("opened") };
    match &error {
        NoGpu::NoMatch { found, .. } => assert!(!found.is_empty()),
        other => assert_eq!(other, &NoGpu::NoDriver),
    }
}

/// Set where the test below runs the one here, in a process without drivers.
const WITHOUT_DRIVERS: &str = "SINEW_TEST_WITHOUT_DRIVERS";

#[test]
fn opening_without_a_driver_is_an_error() {
    if std::env::var_os(WITHOUT_DRIVERS).is_none() {
        return;
    }
    assert!(matches!(Gpu::open(&Choice::Best), Err(NoGpu::NoDriver)));
    assert!(NoGpu::NoDriver.to_string().contains("mesa-vulkan-drivers"));
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_driver_opening_is_an_error_and_no_panic() {
    let child = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "opening_without_a_driver_is_an_error"])
        .env(WITHOUT_DRIVERS, "1")
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .output()
        .unwrap();
    assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
}
