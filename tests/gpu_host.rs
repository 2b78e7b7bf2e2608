//! A program's own device: what is computed on it, what is lent of it, and that it stays the program's.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::backend::gpu::{BufferKind, Choice, Gpu, GpuError, NoGpu};
use sinew::components::Displacement;
use sinew::{BackendChoice, Host, Options, SceneFile, Simulation};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An adapter; none where there is none and none must be.
fn adapter() -> Option<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let found = pollster::block_on(wgpu::Instance::new(descriptor).request_adapter(&Default::default())).ok();
    let required = std::env::var_os("SINEW_REQUIRE_GPU").is_some_and(|value| value != "0");
    assert!(found.is_some() || !required, "no graphics device, and SINEW_REQUIRE_GPU is set");
    found
}

/// A program's device, and how often its handler of errors was called.
fn host() -> Option<(Host, Arc<AtomicUsize>)> {
    let adapter = adapter()?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Host::device_descriptor(&adapter))).unwrap();
    let calls = Arc::<AtomicUsize>::default();
    let counts = calls.clone();
    device.on_uncaptured_error(Arc::new(move |_| {
        counts.fetch_add(1, Ordering::Relaxed);
    }));
    Some((Host { adapter, device, queue }, calls))
}

fn cube(host: Option<Host>) -> Simulation {
    let text = include_str!("../scenes/cube_under_gravity.ron").replace("(10, 10, 10)", "(3, 3, 3)");
    let scene = SceneFile::from_text("cube.ron", &text, Path::new(""), &[]).unwrap();
    let gpu = Choice::parse(&std::env::var("SINEW_GPU").unwrap_or_default());
    Simulation::new(&scene, &Options { backend: BackendChoice::Gpu, gpu, host, ..Options::default() }).unwrap()
}

#[test]
fn a_device_with_the_least_limits_is_refused_with_what_to_do() {
    let Some(adapter) = adapter() else { return };
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap();
    if adapter.limits().max_storage_buffers_per_shader_stage <= 8 {
        return;
    }
    let Err(refused) = Gpu::adopt(Host { adapter, device, queue }, &Choice::Best) else { panic!("taken") };
    assert!(matches!(refused, NoGpu::TooSmall { what: "storage", allowed: 8, .. }));
    let text = refused.to_string();
    assert!(text.contains("8 storage buffers") && text.ends_with("sinew::Host::device_descriptor(&adapter)"), "{text}");
}

#[test]
fn mistakes_of_the_engine_are_its_errors_and_those_of_the_program_go_to_its_handler() {
    let Some((host, calls)) = host() else { return };
    let mut gpu = Gpu::adopt(host.clone(), &Choice::Best).unwrap();
    let x = gpu.create_with("x", &[1.0f32; 4], BufferKind::Storage).unwrap();
    let y = gpu.create_with("y", &[2.0f32; 4], BufferKind::Storage).unwrap();
    // what is lent is for reading, and this program does worse
    gpu.lend(x).unwrap().destroy();
    assert!(matches!(gpu.upload(x, 0, &[0; 16]), Err(GpuError::Device { .. })));
    assert_eq!(calls.load(Ordering::Relaxed), 0, "the program's handler hears nothing of it");
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE;
    let wrong = wgpu::BufferDescriptor { label: None, size: 16, usage, mapped_at_creation: false };
    drop(host.device.create_buffer(&wrong));
    assert_eq!(calls.load(Ordering::Relaxed), 1, "its own mistakes are told to it");
    assert_eq!(gpu.download_rows::<f32>(y).unwrap(), [2.0; 4], "and are none of ours");
}

#[test]
fn a_simulation_has_the_same_bits_on_a_device_of_its_own_and_on_a_programs() {
    let Some((host, calls)) = host() else { return };
    let mut own = cube(None);
    let mut adopted = cube(Some(host));
    for simulation in [&mut own, &mut adopted] {
        simulation.advance(40).unwrap();
    }
    let moved = adopted.displacements("cube").unwrap();
    assert_eq!(moved, own.displacements("cube").unwrap());
    assert!(moved.iter().any(|u| u.z < -1e-6), "it has sagged");
    assert_eq!(calls.load(Ordering::Relaxed), 0);
}

#[test]
fn what_is_lent_holds_the_displacements_of_the_last_step() {
    let Some((host, _)) = host() else { return };
    let mut simulation = cube(Some(host.clone()));
    let before = simulation.gpu_column::<Displacement>("cube").unwrap().unwrap();
    simulation.advance(40).unwrap();
    let lent = simulation.gpu_column::<Displacement>("cube").unwrap().unwrap();
    assert!(lent.buffer == before.buffer && lent.numbers == 3);
    // submitted after the steps: what the program draws or copies sees them
    let bytes = lent.bytes.end - lent.bytes.start;
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let copy = wgpu::BufferDescriptor { label: None, size: bytes, usage, mapped_at_creation: false };
    let copy = host.device.create_buffer(&copy);
    let mut encoder = host.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(&lent.buffer, lent.bytes.start, &copy, 0, bytes);
    host.queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |_| ());
    host.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let mapped = copy.get_mapped_range(..).unwrap();
    let rows: Vec<[f32; 3]> = bytemuck::pod_collect_to_vec(&mapped);
    let moved = simulation.displacements("cube").unwrap();
    assert_eq!(lent.node_rows.len(), moved.len());
    for (row, u) in lent.node_rows.iter().zip(&moved) {
        assert_eq!(rows[*row as usize], u.as_vec3().to_array());
    }
    assert!(moved.iter().any(|u| u.z < -1e-6), "it has sagged");
    let text = include_str!("../scenes/cube_under_gravity.ron").replace("(10, 10, 10)", "(1, 1, 1)");
    let scene = SceneFile::from_text("cube.ron", &text, Path::new(""), &[]).unwrap();
    let cpu = Options { backend: BackendChoice::Cpu, ..Options::default() };
    let mut on_cpu = Simulation::new(&scene, &cpu).unwrap();
    assert!(on_cpu.gpu_column::<Displacement>("cube").unwrap().is_none());
}

#[test]
fn a_programs_device_that_goes_away_is_an_error_and_its_handler_stays() {
    let Some((host, _)) = host() else { return };
    let lost = Arc::<AtomicUsize>::default();
    let counts = lost.clone();
    host.device.set_device_lost_callback(move |_, _| {
        counts.fetch_add(1, Ordering::Relaxed);
    });
    let mut simulation = cube(Some(host.clone()));
    simulation.advance(4).unwrap();
    host.device.destroy();
    let error = simulation.advance(4).and_then(|()| simulation.displacements("cube").map(drop)).unwrap_err();
    assert!(error.to_string().contains("no longer takes work") || error.to_string().contains("GPU"), "{error}");
    assert_eq!(lost.load(Ordering::Relaxed), 1, "the program's handler was not replaced");
}
