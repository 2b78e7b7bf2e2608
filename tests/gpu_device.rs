//! The GPU layer on whatever device there is: lavapipe suffices.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::backend::gpu::{BufferKind, Choice, Gpu, GpuError, NoGpu, gpu_or_reason};
use sinew::backend::kernel::{BufferId, Fragment, Kernel, KernelError};
use sinew::shader;

/// y <- a x + y, a from a uniform found by name.
const SAXPY: &str = "struct Scale { a: f32, count: u32 }
@group(0) @binding(0) var<storage, read> x: array<f32>;
@group(0) @binding(1) var<storage, read_write> y: array<f32>;
@group(0) @binding(2) var<uniform> scale: Scale;
@compute @workgroup_size(64)
fn saxpy(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i < scale.count { y[i] += scale.a * x[i]; }
}
";

/// Each row is a recurrence of the step's record: order and completeness of the steps show in every bit.
const MARCH: &str = "struct Step { number: u32, push: f32 }
@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(1) var<storage, read_write> state: array<f32>;
@compute @workgroup_size(64)
fn march(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&state) {
        state[id.x] = state[id.x] * 0.75 + step.push + f32(step.number % 7u) * f32(id.x + 1u);
    }
}
";

fn saxpy(x: BufferId, y: BufferId, scale: BufferId, threads: u32) -> Kernel {
    let kernel = Kernel::new("saxpy", "saxpy").fragment(Fragment::new("saxpy.wgsl", SAXPY)).fragment(shader!("row"));
    kernel.bind("x", x).bind("y", y).bind("scale", scale).threads(threads)
}

fn march(state: BufferId, threads: u32) -> Kernel {
    Kernel::new("march", "march").fragment(Fragment::new("march.wgsl", MARCH)).bind("state", state).threads(threads)
}

fn march_records(count: u32) -> Vec<u8> {
    (0..count).flat_map(|n| bytemuck::cast::<_, [u8; 8]>([n, (1.0 / (n + 1) as f32).to_bits()])).collect()
}

fn storage(gpu: &mut Gpu, label: &str, rows: &[f32]) -> BufferId {
    gpu.create_with(label, rows, BufferKind::Storage).unwrap()
}

#[test]
fn more_workgroups_than_one_dimension_holds_reach_every_row() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    const COUNT: u32 = 5_000_000; // 78 125 workgroups of 64
    let rows: Vec<f32> = (0..COUNT).map(|i| i as f32).collect();
    let (x, y) = (storage(&mut gpu, "x", &rows), gpu.create("y", 4 * u64::from(COUNT), BufferKind::Storage).unwrap());
    let scale = gpu.create_with("scale", &[2.0f32.to_bits(), COUNT], BufferKind::Uniform).unwrap();
    let kernel = gpu.prepare(&saxpy(x, y, scale, COUNT)).unwrap();
    gpu.run_once(&[kernel]).unwrap();
    let got = gpu.download_rows::<f32>(y).unwrap();
    let wrong = (0..COUNT as usize).find(|i| got[*i] != 2.0 * *i as f32);
    assert_eq!((got.len(), wrong), (COUNT as usize, None));
}

#[test]
fn a_thousand_steps_see_their_own_records_in_order() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = storage(&mut gpu, "state", &[0.0; 100]);
    let kernel = gpu.prepare(&march(state, 100)).unwrap();
    gpu.run(&[kernel], &march_records(1000), 8, 1000).unwrap();
    let got = gpu.download_rows::<f32>(state).unwrap();
    for (i, got) in got.iter().enumerate() {
        let expected = (0..1000u32)
            .fold(0.0f64, |s, n| s * 0.75 + f64::from(1.0 / (n + 1) as f32) + f64::from(n % 7) * (i as f64 + 1.0));
        assert!((f64::from(*got) - expected).abs() < 1e-5 * expected, "row {i}: {got} for {expected}");
    }
}

#[test]
fn runs_repeat_to_the_bit_however_the_steps_are_cut() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let records = march_records(600);
    let mut results = Vec::new();
    for cut in [600, 600, 7] {
        let state = storage(&mut gpu, "state", &[0.5; 300]);
        let kernel = gpu.prepare(&march(state, 300)).unwrap();
        for part in records.chunks(8 * cut) {
            gpu.run(&[kernel], part, 8, (part.len() / 8) as u32).unwrap();
        }
        results.push(gpu.download(&[state]).unwrap());
    }
    assert!(results.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn kernels_of_a_step_run_in_the_order_given() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let (x, y) = (storage(&mut gpu, "x", &[1.0; 64]), storage(&mut gpu, "y", &[1.0; 64]));
    let scale = gpu.create_with("scale", &[1.0f32.to_bits(), 64], BufferKind::Uniform).unwrap();
    let forth = gpu.prepare(&saxpy(x, y, scale, 64)).unwrap();
    let back = gpu.prepare(&saxpy(y, x, scale, 64)).unwrap();
    gpu.run(&[forth, back], &[], 0, 10).unwrap();
    let got = gpu.download(&[x, y]).unwrap();
    // the pair walks along the Fibonacci numbers
    assert_eq!(bytemuck::pod_read_unaligned::<f32>(&got[1][252..]), 10946.0);
    assert_eq!(bytemuck::pod_read_unaligned::<f32>(&got[0][252..]), 17711.0);
}

#[test]
fn a_kernel_of_no_threads_does_nothing() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = storage(&mut gpu, "state", &[3.0; 8]);
    let kernel = gpu.prepare(&march(state, 0)).unwrap();
    gpu.run(&[kernel], &march_records(5), 8, 5).unwrap();
    assert_eq!(gpu.download_rows::<f32>(state).unwrap(), [3.0; 8]);
    gpu.set_threads(kernel, 8).unwrap();
    gpu.run(&[kernel], &march_records(1), 8, 1).unwrap();
    assert_eq!(gpu.download_rows::<f32>(state).unwrap(), [3.25; 8]);
}

#[test]
fn names_that_do_not_match_are_listed_on_both_sides() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let (x, y) = (storage(&mut gpu, "x", &[0.0]), storage(&mut gpu, "y", &[0.0]));
    let kernel = Kernel::new("saxpy", "saxpy").fragment(Fragment::new("saxpy.wgsl", SAXPY)).fragment(shader!("row"));
    let error = gpu.prepare(&kernel.bind("x", x).bind("z", y).bind("x", y)).unwrap_err();
    let GpuError::Kernel(KernelError::Bindings { without_buffer, without_variable, .. }) = &error else {
        panic!("{error}");
    };
    assert_eq!(without_buffer, &["y", "scale"]);
    assert_eq!(without_variable, &["z", "x (given twice)"]);
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
fn memory_is_told_by_label() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    storage(&mut gpu, "mass", &[0.0; 10]);
    storage(&mut gpu, "force", &[0.0; 30]);
    storage(&mut gpu, "mass", &[0.0; 10]);
    let rows: Vec<_> = gpu.memory().into_iter().map(|m| (m.label, m.bytes, m.count)).collect();
    assert_eq!(rows, [("force".to_owned(), 120, 1), ("mass".to_owned(), 80, 2)]);
}

#[test]
fn kernels_are_timed_where_the_device_has_a_clock() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = storage(&mut gpu, "state", &[0.0; 1000]);
    let kernel = gpu.prepare(&march(state, 1000)).unwrap();
    if !gpu.limits().time_stamps {
        assert!(matches!(gpu.time_kernels(true), Err(GpuError::NoTimeStamps(_))));
        return;
    }
    gpu.time_kernels(true).unwrap();
    gpu.run(&[kernel], &march_records(300), 8, 300).unwrap();
    let times = gpu.kernel_times();
    assert_eq!((times.len(), times[0].label.as_str(), times[0].dispatches), (1, "march", 300));
    assert!(times[0].nanoseconds > 0.0);
}

#[test]
fn a_choice_that_no_device_meets_lists_the_devices_there_are() {
    let Err(error) = Gpu::open(&Choice::Named("no such device".to_owned())) else { panic!("opened") };
    match &error {
        NoGpu::NoMatch { found, .. } => assert!(!found.is_empty()),
        other => assert_eq!(other, &NoGpu::NoDriver),
    }
}

/// Run by the test below in a process without drivers.
#[test]
#[ignore = "only meaningful without drivers"]
fn opening_without_a_driver_is_an_error() {
    assert!(matches!(Gpu::open(&Choice::Best), Err(NoGpu::NoDriver)));
    assert!(NoGpu::NoDriver.to_string().contains("mesa-vulkan-drivers"));
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_driver_opening_is_an_error_and_no_panic() {
    let child = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "opening_without_a_driver_is_an_error", "--ignored"])
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .output()
        .unwrap();
    assert!(child.status.success(), "{}", String::from_utf8_lossy(&child.stdout));
}
