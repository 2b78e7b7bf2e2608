#![allow(clippy::unwrap_used)]

use super::*;
use crate::backend::gpu::{BufferKind, gpu_or_reason};
use crate::backend::kernel::{Fragment, Kernel};

/// What makes the driver write where it must not: a condition that reads each of nine uniforms.
#[test]
fn kernels_have_no_more_uniforms_than_are_safe_and_read_the_same_numbers() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let names: Vec<String> = (1..=9).map(|i| format!("u{i}")).collect();
    let declared: String =
        names.iter().map(|u| format!("@group(0) @binding(0) var<uniform> {u}: vec4<u32>;\n")).collect();
    let counted: String = names.iter().map(|u| format!("if {u}.x < id.x {{ sum += {u}.y; }}\n")).collect();
    let text = declared
        + "@group(0) @binding(0) var<storage, read_write> sums: array<u32>;
            @compute @workgroup_size(64) fn count(@builtin(global_invocation_id) id: vec3<u32>) { var sum = 0u;\n"
        + &counted
        + "sums[id.x] = sum; }";
    let sums = gpu.create("sums", 64 * 4, BufferKind::Storage).unwrap();
    let mut kernel = Kernel::new("count", "count").fragment(Fragment::new("count.wgsl", text)).bind("sums", sums);
    for (i, name) in names.iter().enumerate() {
        let i = i as u32;
        let uniform = gpu.create_with(name, &[[7 * i, 1 << i, 0, 0]], BufferKind::Uniform).unwrap();
        kernel = kernel.bind(name.clone(), uniform);
    }
    let ready = gpu.prepare(&kernel.threads(64)).unwrap();
    let left = gpu.safe_uniforms.map_or(9, |safe| safe - 1);
    assert_eq!(gpu.moved_uniforms(), names[left..]);
    gpu.run_once(&[ready]).unwrap();
    let expected: Vec<u32> = (0..64).map(|id| (0..9).filter(|i| 7 * i < id).map(|i| 1 << i).sum()).collect();
    assert_eq!(gpu.download_rows::<u32>(sums).unwrap(), expected);
}

#[test]
fn software_gpus_before_23_2_are_spared() {
    let report = |driver: &str| AdapterReport {
        name: "a GPU".into(),
        driver: driver.into(),
        interface: "Vulkan".into(),
        software: true,
        kind: "software",
    };
    for spared in ["llvmpipe Mesa 22.3.6 (LLVM 15.0.6)", "llvmpipe Mesa 23.1.9 (LLVM 15.0.6)", "llvmpipe"] {
        assert_eq!(safe_uniforms(&report(spared)), Some(SAFE_UNIFORMS), "{spared}");
    }
    for sound in
        ["llvmpipe Mesa 23.2.0-devel", "llvmpipe Mesa 25.0.7-2 (LLVM 19.1.7)", "NVIDIA 570.12", "radv Mesa 22.3.6"]
    {
        assert_eq!(safe_uniforms(&report(sound)), None, "{sound}");
    }
}

#[test]
fn the_step_and_the_first_uniforms_stay() {
    let text = "struct Four { x: f32, y: vec3<f32>, z: u32 }
            @group(0) @binding(0) var<uniform> a: Four;
            @group(0) @binding(1) var<storage, read_write> sums: array<f32>;
            @group(0) @binding(2) var<uniform> b: Four;
            @group(0) @binding(3) var<uniform> c: Four;
            @group(0) @binding(4) var<uniform> d: Four;
            @group(0) @binding(5) var<uniform> step: Four;
            @compute @workgroup_size(64) fn sum() { sums[0] = a.x + b.x + c.x + d.x + step.x; }";
    let mut module = naga::front::wgsl::parse_str(text).unwrap();
    assert_eq!(read_from_storage(&mut module, SAFE_UNIFORMS), ["c", "d"]);
    let uniforms = module.global_variables.iter().filter(|(_, v)| v.space == AddressSpace::Uniform);
    assert_eq!(uniforms.map(|(_, v)| v.name.as_deref().unwrap()).collect::<Vec<_>>(), ["a", "b", "step"]);
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty()).validate(&module).unwrap();
}
