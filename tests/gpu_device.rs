//! The GPU layer on whatever device there is: lavapipe suffices.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod gpu_kernels;
mod gpu_stages;

use gpu_kernels::{march, march_on, march_records, saxpy, storage};
use sinew::backend::gpu::{BufferKind, GpuError, SmallerLimits, gpu_or_reason};

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
fn many_steps_share_a_submission_and_256_at_most() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = storage(&mut gpu, "state", &[0.0; 10]);
    let kernel = gpu.prepare(&march(state, 10)).unwrap();
    gpu.run(&[kernel], &march_records(5000), 8, 5000).unwrap();
    gpu.wait().unwrap();
    assert!((20..1000).contains(&gpu.submissions()), "{} submissions", gpu.submissions());
}

#[test]
fn a_kernel_of_many_steps_is_dispatched_once_a_submission_and_sees_all_records() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let (apart, at_once) = (storage(&mut gpu, "apart", &[0.5; 100]), storage(&mut gpu, "at once", &[0.5; 100]));
    let kernel = gpu.prepare(&march(apart, 100)).unwrap();
    let records: Vec<u8> = march_records(1000).chunks(8).flat_map(|record| [record, &[0; 8]].concat()).collect();
    gpu.run(&[kernel], &records, 16, 1000).unwrap();
    assert_eq!(gpu.dispatches(), 1000);
    let before = gpu.submissions();
    let kernel = gpu.prepare(&march_on(at_once, 100)).unwrap();
    gpu.run(&[kernel], &records, 16, 1000).unwrap();
    assert_eq!(gpu.dispatches() - 1000, gpu.submissions() - before);
    let both = gpu.download(&[apart, at_once]).unwrap();
    assert_eq!(both[0], both[1]);
    // beside a kernel that is dispatched step by step
    let steps = gpu.prepare(&march(apart, 100)).unwrap();
    gpu.run(&[steps, kernel], &records, 16, 1000).unwrap();
    let both = gpu.download(&[apart, at_once]).unwrap();
    assert_eq!(both[0], both[1]);
    let refused = gpu.run(&[kernel], &records, 32, 500).unwrap_err().to_string();
    assert!(refused.contains("reads records of 16 bytes, these have 32"), "{refused}");
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

/// The device goes away between two observations: what was written stays whole, and the message says up to when.
#[test]
fn a_gpu_lost_in_a_run_leaves_what_was_observed_before() {
    let scene = r#"(duration: 1, bodies: {"b": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1)), material: "m")},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        loads: [Gravity(acceleration: (0, 0, -1))], integration: (step: 1e-2), guards: (every: 1),
        output: (fields_every: 0.25, energies_every: 0.25))"#;
    let scene = sinew::SceneFile::from_text("lost.ron", scene, std::path::Path::new("."), &[]).unwrap();
    let options = sinew::Options {
        backend: sinew::BackendChoice::Gpu,
        gpu: sinew::backend::gpu::Choice::parse(&std::env::var("SINEW_GPU").unwrap_or_default()),
        ..sinew::Options::default()
    };
    if gpu_or_reason().is_none() {
        return;
    }
    let path = std::env::temp_dir().join(format!("sinew-lost-{}", std::process::id()));
    let mut simulation = sinew::Simulation::new(&scene, &options).unwrap();
    let mut folder = sinew::output::Folder::create(&path).unwrap();
    simulation.write_into(&mut folder).unwrap();
    simulation.observe().unwrap();
    simulation.advance_to(0.6).unwrap();
    simulation.world_mut().resource_mut::<sinew::backend::device::Device>().gpu().destroy();
    let error = simulation.advance_to(1.0).unwrap_err();
    let text = error.to_string();
    let sinew::Error::GpuFailed(failure) = error else { panic!("{text}") };
    assert!(matches!(failure.reason, GpuError::Lost(_)), "{text}");
    assert!((0.49..0.62).contains(&failure.good_until) && failure.time >= 0.59, "{text}");
    assert!(text.contains("the GPU was lost") && text.contains("s are kept"), "{text}");
    // the last state that was on the host can be gone on from, on the CPU
    let file = failure.snapshot.clone().unwrap();
    assert!(text.contains(&format!("--resume {}", sinew::shell_word(&file))), "{text}");
    assert!(file.starts_with(&path), "{}", file.display());
    let kept = sinew::Snapshot::read(&file).unwrap();
    let cpu = sinew::Options { backend: sinew::BackendChoice::Cpu, ..sinew::Options::default() };
    let mut rest = sinew::Simulation::new(&scene, &cpu).unwrap();
    rest.restore(&kept).unwrap();
    assert!(rest.time() > 0.0 && rest.time() < 0.61, "{}", rest.time());
    rest.finish().unwrap();
    // again and again the same, never a panic
    assert!(matches!(simulation.step(), Err(sinew::Error::GpuFailed(_))));
    assert!(simulation.energies().is_err() && simulation.displacements("b").is_err());
    let pvd = std::fs::read_to_string(path.join("fields.pvd")).unwrap();
    let frames: Vec<&str> = pvd.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(frames.len(), 3, "{pvd}");
    for frame in frames {
        assert!(std::fs::read(path.join(frame)).unwrap().ends_with(b"</VTKFile>\n"), "{frame} is cut");
    }
    assert_eq!(std::fs::read_to_string(path.join("energy.csv")).unwrap().lines().count(), 1 + 3);
    std::fs::remove_dir_all(&path).unwrap();
}

fn smaller(limits: SmallerLimits, gpu: &str, backend: sinew::BackendChoice) -> Result<sinew::Simulation, sinew::Error> {
    // all kinds of kernels: elements, averaged pressure, gather, loads on nodes and faces, removal, guards
    let scene = r#"(duration: 1, bodies: {"b": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (5, 5, 5), elements: Tet4NodalPressure), material: "m"),
            "c": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (13, 11, 10), elements: Hex8), material: "m", translate: (1, 0, 0), spin: (1, 2, 3))},
        materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), prony: (terms: [(alpha: 0.3, tau: 0.1)]))},
        constraints: [Fixed(body: "b", on: Plane(normal: (0, 0, 1), at: 0)),
            Prescribed(body: "b", on: Plane(normal: (0, 0, 1), at: 0.1), axes: [X], displacement: (0.01, 0, 0), curve: Smooth(end: 0.05))],
        loads: [Gravity(acceleration: (0, 0, -9.81)), Pressure(body: "b", on: Surface(normal: (1, 0, 0)), pressure: 200)],
        removal: [(body: "b", on: Box(min: (0.06, 0, 0), max: (0.1, 0.1, 0.1)), when: At(0.005))], integration: (step: 5e-4), guards: (every: 8))"#;
    let scene = sinew::SceneFile::from_text("smaller.ron", scene, std::path::Path::new("."), &[]).unwrap();
    let gpu = sinew::backend::gpu::Choice::Named(gpu.into());
    sinew::Simulation::new(&scene, &sinew::Options { backend, gpu, gpu_limits: limits, ..sinew::Options::default() })
}

/// More elements than workgroups in one dimension: the same bits in two.
#[test]
fn a_scene_in_dispatches_of_two_dimensions_gives_the_same_bits() {
    let Some(gpu) = gpu_or_reason() else { return };
    let name = gpu.report().name.clone();
    let end = |workgroups: Option<u32>| {
        let limits = SmallerLimits { workgroups, ..SmallerLimits::default() };
        let mut simulation = smaller(limits, &name, sinew::BackendChoice::Gpu).unwrap();
        simulation.advance(24).unwrap();
        let bodies = ["b", "c"].map(|body| simulation.displacements(body).unwrap());
        (bodies, format!("{:?} {:?}", simulation.energies().unwrap(), simulation.guards()))
    };
    // 1848 nodes are 29 workgroups of 64: five rows of 6, the last of them partly filled; 7 patches are two rows of 4
    assert!(end(None) == end(Some(6)), "other bits in two dimensions");
    let refused =
        smaller(SmallerLimits { workgroups: Some(3), ..SmallerLimits::default() }, &name, sinew::BackendChoice::Gpu);
    let Err(sinew::Error::Gpu(GpuError::OverLimit { wanted, limit: 3, limit_name, .. })) = refused else {
        panic!("{:?}", refused.err())
    };
    assert!(wanted > 3 && limit_name == "maxComputeWorkgroupsPerDimension", "{wanted} {limit_name}");
}

#[test]
fn a_scene_that_a_gpu_has_no_room_for_is_refused_or_runs_on_the_cpu() {
    let Some(gpu) = gpu_or_reason() else { return };
    let name = gpu.report().name.clone();
    // rest shapes of 750 tetrahedra: 752 · 10 numbers, less than those of the hexahedra
    let limits = SmallerLimits { storage_binding: Some(36_000), ..SmallerLimits::default() };
    let Err(error) = smaller(limits, &name, sinew::BackendChoice::Gpu) else { panic!("it fits") };
    assert!(matches!(error, sinew::Error::Gpu(GpuError::OverLimit { limit: 36_000, unit: "bytes", .. })), "{error}");
    assert!(error.to_string().contains("allows 36000 (maxStorageBufferBindingSize)"), "{error}");
    // where the GPU was not asked for
    let mut simulation = smaller(limits, &name, sinew::BackendChoice::Auto).unwrap();
    let summary = simulation.summary("").unwrap();
    assert!(summary.backend.starts_with("CPU"), "{}", summary.backend);
    assert!(
        summary.backend_because.contains("the GPU cannot take this scene") && summary.backend_because.contains("36000")
    );
    simulation.advance(24).unwrap();
}
