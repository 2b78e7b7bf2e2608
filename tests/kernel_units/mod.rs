//! Units: parts of a kernel that do not see each other's names. No GPU needed.

use sinew::backend::kernel::{BindingKind, Composed, Composer, Fragment, Kernel, KernelError, Link, Unit, UnitId};
use sinew::systems::Registry;
use sinew::{Options, SceneFile, Simulation};
use std::sync::Arc;

/// What both units have.
const COUNTER: &str = "var<private> calls: u32;\nfn count() { calls += 1u; }\n";

/// Two units, whose `add` a kernel calls one after the other.
fn in_units(first: &str, second: &str) -> Kernel {
    let common = vec![Fragment::new("counter.wgsl", COUNTER)];
    let unit = |path: &str, text: &str, name: &'static str| Unit {
        common: common.clone(),
        own: vec![Fragment::new(path, text.to_owned())],
        variables: vec![("sums".into(), "sums".into()), ("load".into(), name.into())],
        links: Vec::new(),
    };
    let main = "fn add_all(i: u32) {}\n@compute @workgroup_size(64)\n\
                fn main(@builtin(global_invocation_id) id: vec3<u32>) { add_all(id.x); count(); }\n";
    let calls = [0, 1].map(|unit| (UnitId(unit), "add".into())).into();
    Kernel {
        common: common.clone(),
        units: vec![unit("first.wgsl", first, "load"), unit("second.wgsl", second, "load_1")],
        links: vec![Link { function: "add_all".into(), calls }],
        ..Kernel::new("both", "main").fragment(Fragment::new("main.wgsl", main))
    }
}

const FIRST: &str = "struct Load { push: f32 }
@group(0) @binding(0) var<uniform> load: Load;
@group(0) @binding(0) var<storage, read_write> sums: array<f32>;
var<private> own: f32;
fn add(i: u32) { count(); own += load.push; sums[i] += own; }
";

const SECOND: &str = "struct Load { axis: u32, pull: vec2<f32> }
@group(0) @binding(0) var<uniform> load: Load;
@group(0) @binding(0) var<storage, read> sums: array<f32>;
@group(0) @binding(0) var<storage, read_write> kept: array<f32>;
var<private> own: u32;
fn unused() { kept[0] = 1.0; }
fn add(i: u32) { count(); own += load.axis + u32(sums[i]); }
";

fn names(composed: &Composed) -> Vec<&str> {
    composed.bindings.iter().map(|binding| binding.name.as_str()).collect()
}

#[test]
fn units_share_what_is_common_and_buffers_of_one_name_and_nothing_else() {
    let composed = Composer::default().compose(&in_units(FIRST, SECOND)).unwrap();
    let mut all = names(&composed);
    all.sort_unstable();
    assert_eq!(all, ["kept", "load", "load_1", "sums"]);
    let types = ["load", "load_1"].map(|name| composed.binding(name).unwrap().size);
    assert_eq!(types, [4, 16]);
    // as accessible as either wants it, and used by the entry point; nobody calls what writes `kept`
    assert_eq!(composed.binding("sums").unwrap().kind, BindingKind::ReadWrite);
    let entry = composed.entry("main").unwrap();
    assert_eq!((entry.uses.len(), composed.storage_buffers(entry)), (3, 1));
}

#[test]
fn a_kernel_is_composed_once() {
    let mut composer = Composer::default();
    let one = composer.compose(&in_units(FIRST, SECOND)).unwrap();
    assert!(Arc::ptr_eq(&one, &composer.compose(&in_units(FIRST, SECOND)).unwrap()));
    let other = composer.compose(&in_units(SECOND, FIRST)).unwrap();
    assert!(!Arc::ptr_eq(&one, &other));
    let mut again = in_units(FIRST, SECOND);
    again.units[0].variables.clear();
    // the same texts, put together otherwise: nobody else has the first unit's buffers
    let again = composer.compose(&again).unwrap();
    let mut all = names(&again);
    all.sort_unstable();
    assert_eq!(all, ["kept", "load", "load_1", "sums", "sums_"]);
}

#[test]
fn what_is_invalid_only_when_put_together_is_told_at_its_place() {
    let later = "@group(0) @binding(0) var<storage, read> rest: array<f32>;\n\nfn add(i: u32) { rest[0] = 1.0; }\n";
    let KernelError::Wgsl { path, line, report, .. } =
        Composer::default().compose(&in_units(FIRST, later)).unwrap_err()
    else {
        panic!("not a WGSL error");
    };
    assert_eq!((path.as_str(), line), ("second.wgsl", 3), "{report}");
    assert!(!report.contains("naga"), "{report}");
}

#[test]
fn a_buffer_of_two_types_is_refused_by_name() {
    let words = SECOND.replace("sums: array<f32>", "sums: array<u32>");
    let error = Composer::default().compose(&in_units(FIRST, &words)).unwrap_err().to_string();
    let problem = "WGSL variable `sums`: is `array<f32>` to one part of the kernel and `array<u32>` to another";
    assert!(error.starts_with(problem), "{error}");
}

/// The fragments of a scene with a tool of triangles that touches, takes, sucks and holds, with a thread and with mass
/// that is scaled.
pub fn of_tools() -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    std::fs::write(folder.path().join("tool.obj"), obj).unwrap();
    let text = "(duration: 1, bodies: {\"b\": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: \"m\", translate: (0, 0, 2))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 1)},
        tools: {\"t\": (mesh: (path: \"tool.obj\"))}, contacts: [Tool(tool: \"t\")],
        removal: [(when: InTool(tool: \"t\", bore: 0.1, reach: 0.5, rate: 1e-3))],
        integration: (when_unstable: ScaleMass(most: 0.1)),
        suction: [(tool: \"t\", bore: 0.1, pressure: 100, reach: 0.5)],
        attachments: [Grasp(tool: \"t\", on: All, closed: Step(start: 0.5)),
            Suture(from: (at: (0, 0, 2)), to: (at: (1, 1, 3)), stiffness: 1)])";
    let scene = SceneFile::from_text("tools", text, folder.path(), &[]).unwrap();
    let mut simulation = Simulation::new(&scene, &Options::default()).unwrap();
    let explained = simulation.explain_on_gpu(&Registry::default()).unwrap();
    let fragments = explained.kernels.iter().flat_map(|kernel| &kernel.fragments);
    fragments.filter_map(|f| f.path.strip_prefix("shaders/").map(str::to_owned)).collect()
}

/// Parts of `surface_contact`.
pub const SURFACES: [&str; 23] = [
    "surface_contact_apply",
    "surface_contact_begin",
    "surface_contact_edges",
    "surface_contact_foresee",
    "surface_contact_friction",
    "surface_contact_hold",
    "surface_contact_impulse",
    "surface_contact_place",
    "surface_contact_push",
    "surface_contact_share",
    "surface_contact_touch",
    "surface_contacts",
    "surface_contacts_of",
    "surface_ends",
    "surface_faced",
    "surface_facing",
    "surface_lists",
    "surface_motion",
    "surface_motion_turns",
    "surface_point_face",
    "surface_point_node",
    "surface_relative",
    "surface_touch_edges",
];

/// Bodies that meet with nodes, with points of faces, and with edges.
pub fn meeting() -> Simulation {
    let block =
        |at: f64| format!("(mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: \"m\", translate: (0, 0, {at}))");
    let text = format!(
        "(duration: 1, bodies: {{\"a\": {}, \"b\": {}, \"c\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
        contacts: [Between(bodies: (\"a\", \"b\"), friction: 0.3, edges: true),
            Between(bodies: (\"b\", \"c\"), points: Faces), Tool(tool: \"u\", body: \"a\")],
        tools: {{\"t\": (shape: Sphere(radius: 0.1)), \"u\": (shape: Sphere(radius: 0.2), at: (0, 0, -1))}},
        attachments: [Grasp(tool: \"t\", body: \"a\", on: All, closed: Step())])",
        block(0.0),
        block(1.0),
        block(2.0)
    );
    let scene = SceneFile::from_text("meeting", &text, std::path::Path::new("."), &[]).unwrap();
    Simulation::new(&scene, &Options::default()).unwrap()
}

/// Files of their kernels.
pub fn of_surfaces() -> Vec<String> {
    let explained = meeting().explain_on_gpu(&Registry::default()).unwrap();
    let fragments = explained.kernels.iter().flat_map(|kernel| &kernel.fragments);
    fragments.filter_map(|f| f.path.strip_prefix("shaders/").map(str::to_owned)).collect()
}

/// Parts of `glue` and `suture_tension`.
pub const ATTACHMENTS: [&str; 9] = [
    "glue_apply",
    "glue_correct",
    "glue_note",
    "glue_place",
    "glue_push",
    "glue_share",
    "glue_ties",
    "suture_tension_place",
    "suture_tension_pull",
];

/// Texts of conjugate gradients, whose kernels are made when a step is solved for; `physics implicit_device` runs them.
pub const CONJUGATE_GRADIENTS: [&str; 9] = [
    "coarse_level",
    "coarse_motion",
    "coarse_solve",
    "conjugate_gradients",
    "gradient_image",
    "gradient_scalars",
    "gradient_vectors",
    "gradient_velocity",
    "precondition",
];

/// Two blocks that are glued, tied and sutured.
pub fn attached(more: &str) -> Simulation {
    let text = format!(
        "(duration: 1, bodies: {{
            \"low\": (mesh: Box(size: (1, 1, 1), cells: (2, 2, 2)), material: \"m\"),
            \"up\": (mesh: Box(size: (1, 1, 1), cells: (3, 3, 3)), material: \"m\", translate: (0, 0, 1))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}}, {more}
        attachments: [Glue(bodies: (\"low\", \"up\")),
            Suture(from: (body: \"low\", at: (0.5, 0.5, 0.5)), to: (body: \"up\", at: (0.5, 0.5, 1.5)), stiffness: 1)])"
    );
    let scene = SceneFile::from_text("attached", &text, std::path::Path::new("."), &[]).unwrap();
    Simulation::new(&scene, &Options::default()).unwrap()
}

/// Files of the kernels of bodies that are attached to each other.
pub fn of_attachments() -> Vec<String> {
    let explained = attached("").explain_on_gpu(&Registry::default()).unwrap();
    let fragments = explained.kernels.iter().flat_map(|kernel| &kernel.fragments);
    fragments.filter_map(|f| f.path.strip_prefix("shaders/").map(str::to_owned)).collect()
}

/// Where nothing can be taken from them, no column of theirs comes to the host in a step.
#[test]
fn attachments_run_on_a_gpu_where_no_element_can_go() {
    let removal = "removal: [(body: \"up\", on: Sphere(center: (0, 0, 2), radius: 0.3), when: At(0.5))],";
    for (more, on) in [("", "device"), (removal, "host")] {
        let explained = attached(more).explain_on_gpu(&Registry::default()).unwrap();
        for name in ["glue", "suture_tension", "suture"] {
            let system = explained.systems.iter().find(|system| system.name == name).unwrap();
            let expected = if name == "suture" { "device" } else { on };
            assert_eq!((system.on, system.travels.is_some()), (expected, expected == "host"), "{name}, {more}");
        }
        let entries: Vec<&str> = explained.kernels.iter().map(|kernel| kernel.entry).collect();
        let mut wanted =
            ATTACHMENTS.iter().copied().filter(|name| *name != "glue_ties").chain(["glue", "suture_tension"]);
        assert!(wanted.all(|name| entries.contains(&name) == (on == "device")), "{entries:?}");
    }
}
