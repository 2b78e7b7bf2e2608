#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::*;

const MATERIAL: &str = "struct NeoHookean { shear: f32, bulk: f32, fibre: vec3<f32>, rows: array<vec4<f32>, 2> }
@group(0) @binding(0) var<uniform> material: NeoHookean;
fn stress(x: f32) -> f32 { return material.shear * x; }
";

const MAIN: &str = "@group(0) @binding(0) var<storage, read> displacement: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> force: array<f32>;
@group(0) @binding(2) var<storage, read> unused: array<u32>;
@compute @workgroup_size(64)
fn forces(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i < arrayLength(&force) { force[i] = stress(displacement[i].x); }
}
";

fn fragments() -> Vec<Fragment> {
    vec![Fragment::new("main.wgsl", MAIN), Fragment::new("material.wgsl", MATERIAL), crate::shader!("row")]
}

fn error_of(path: &str, text: &'static str) -> KernelError {
    let mut all = fragments();
    all.push(Fragment::new(path, text));
    compose(&all).unwrap_err()
}

#[test]
fn fragments_with_the_same_binding_numbers_get_numbers_of_their_own() {
    let composed = compose(&fragments()).unwrap();
    let mut numbers: Vec<_> = composed.bindings.iter().map(|b| b.index).collect();
    numbers.sort_unstable();
    assert_eq!(numbers, [0, 1, 2, 3]);
}

#[test]
fn an_entry_point_uses_what_the_functions_it_calls_use_and_no_more() {
    let composed = compose(&fragments()).unwrap();
    let entry = composed.entry("forces").unwrap();
    let mut names: Vec<_> = entry.uses.iter().map(|i| composed.bindings[*i].name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["displacement", "force", "material"]);
    assert_eq!((entry.workgroup_size, composed.storage_buffers(entry)), ([64, 1, 1], 2));
}

#[test]
fn bindings_tell_kind_type_size_and_stride() {
    let composed = compose(&fragments()).unwrap();
    let displacement = composed.binding("displacement").unwrap();
    assert_eq!((displacement.kind, displacement.type_name.as_str()), (BindingKind::Read, "array<vec4<f32>>"));
    assert_eq!((displacement.size, displacement.stride), (16, Some(16)));
    assert_eq!(composed.binding("force").unwrap().kind, BindingKind::ReadWrite);
    let material = composed.binding("material").unwrap();
    assert_eq!((material.kind, material.size, material.stride), (BindingKind::Uniform, 64, None));
}

/// A uniform that an invocation has for itself: no buffer, and it may be written; another kernel of the same text has
/// it as it stands there.
#[test]
fn uniforms_become_variables_of_each_invocation_where_that_is_said() {
    let kernel = |material: Fragment| {
        let text = "fn take() { material.shear = 3.0; }\n";
        let all = [Fragment::new("main.wgsl", MAIN), crate::shader!("row"), material, Fragment::new("take.wgsl", text)];
        all.into_iter().fold(Kernel::new("forces", "forces"), Kernel::fragment)
    };
    let material = Fragment::new("material.wgsl", MATERIAL);
    let mut composer = Composer::default();
    let composed = composer.compose(&kernel(material.clone().with_private("material"))).unwrap();
    assert!(composed.binding("material").is_none() && composed.binding("force").is_some());
    // what is a uniform cannot be written
    assert!(matches!(composer.compose(&kernel(material.clone())), Err(KernelError::Wgsl { .. })));
    let unknown = composer.compose(&kernel(material.with_private("fibres"))).unwrap_err();
    assert!(unknown.to_string().contains("fibres") && unknown.to_string().contains("is no uniform"), "{unknown}");
}

#[test]
fn structs_tell_the_offset_type_and_size_of_each_member() {
    let composed = compose(&fragments()).unwrap();
    let layout = composed.struct_layout("NeoHookean").unwrap();
    let rows: Vec<_> = layout.iter().map(|m| (m.name.as_str(), m.type_name.as_str(), m.offset, m.size)).collect();
    let expected = [
        ("shear", "f32", 0, 4),
        ("bulk", "f32", 4, 4),
        ("fibre", "vec3<f32>", 16, 12),
        ("rows", "array<vec4<f32>, 2>", 32, 32),
    ];
    assert_eq!(rows, expected);
    assert_eq!(composed.struct_size("NeoHookean").unwrap(), 64);
}

#[test]
fn an_unknown_struct_lists_the_known_ones() {
    let error = compose(&fragments()).unwrap().struct_layout("Ogden").unwrap_err();
    assert_eq!(error.to_string(), "no WGSL struct `Ogden`; there is NeoHookean");
}

#[test]
fn a_parse_error_names_the_fragments_own_line_and_column() {
    let KernelError::Wgsl { path, line, column, report, .. } =
        error_of("mine.wgsl", "// a comment\nfn f() -> f32 {\n    return 1.0 +;\n}\n")
    else {
        panic!("not a WGSL error");
    };
    assert_eq!((path.as_str(), line, column), ("mine.wgsl", 3, 17), "{report}");
    assert!(report.contains("    return 1.0 +;"), "{report}");
}

#[test]
fn an_unknown_name_names_the_fragments_own_line() {
    let KernelError::Wgsl { path, line, message, .. } = error_of("mine.wgsl", "\nfn f() -> f32 { return shaer; }")
    else {
        panic!("not a WGSL error");
    };
    assert_eq!((path.as_str(), line), ("mine.wgsl", 2));
    assert!(message.contains("shaer"), "{message}");
}

#[test]
fn a_validation_error_names_the_fragments_own_line() {
    let text = "@group(0) @binding(9) var<storage, read> rest: array<f32>;\n\nfn f() { rest[0] = 1.0; }\n";
    let KernelError::Wgsl { path, line, report, .. } = error_of("mine.wgsl", text) else {
        panic!("not a WGSL error");
    };
    assert_eq!((path.as_str(), line), ("mine.wgsl", 3), "{report}");
    assert!(!report.contains("naga"), "{report}");
}

#[test]
fn a_function_defined_twice_shows_both_files() {
    let KernelError::Wgsl { report, .. } = error_of("mine.wgsl", "fn stress(x: f32) -> f32 { return x; }") else {
        panic!("not a WGSL error");
    };
    assert!(report.contains("material.wgsl:3:") && report.contains("mine.wgsl:1:"), "{report}");
}

#[test]
fn the_step_must_be_a_uniform() {
    let error = error_of("mine.wgsl", "@group(0) @binding(0) var<storage, read> step: array<f32>;");
    assert!(error.to_string().contains("must be a var<uniform>"), "{error}");
}

#[test]
fn textures_are_refused_by_name() {
    let error = error_of("mine.wgsl", "@group(0) @binding(0) var picture: texture_2d<f32>;");
    assert!(error.to_string().starts_with("WGSL variable `picture`: is not a buffer"), "{error}");
}

#[test]
fn a_brace_never_closed_names_the_last_fragment() {
    let KernelError::Wgsl { path, line, .. } = error_of("mine.wgsl", "fn f() {\n    let x = 1u;\n") else {
        panic!("not a WGSL error");
    };
    assert_eq!((path.as_str(), line), ("mine.wgsl", 3));
}
