//! The examples run, and the custom system does the same on both backends.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)]
#[path = "../examples/custom_system.rs"]
mod custom_system;
#[path = "../examples/embed.rs"]
mod embed;

use sinew::{BackendChoice, SceneFile};

#[test]
fn embed_runs() {
    embed::main().unwrap();
}

#[test]
fn custom_system_pulls_alike_on_both_backends() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/magnet.ron");
    let scene = SceneFile::load(path, &["duration=0.3".into()]).unwrap();
    let cpu = custom_system::run(&scene, BackendChoice::Cpu, None).unwrap();
    assert!(cpu > 1e-3, "the gel rises by {cpu} m only");
    if sinew::backend::gpu::gpu_or_reason().is_some() {
        let gpu = custom_system::run(&scene, BackendChoice::Gpu, None).unwrap();
        assert!((gpu - cpu).abs() < 1e-4 * cpu, "{gpu} m on the GPU, {cpu} m on the CPU");
    }
}
