//! Kernels compose, validate and fit what Rust knows of them, for every combination of effects; no GPU needed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
mod kernel_support;
mod kernel_units;
mod kernel_worlds;
use bevy_ecs::prelude::World;
use kernel_support::SUPPORT;
use kernel_worlds::{AROUND, Described, Effects, Grouped, OF_NODES, VARIED, all_kernels, shared_kernels};
use sinew::backend::Buffers;
use sinew::backend::dispatch::{Dispatched, ElementsThenNodes, decide_interior_nodes, decide_many_steps};
use sinew::backend::kernel::{BindingKind, Composer, Kernel, Layout, MostBuffers, Uniform};
use sinew::backend::patch_lists::WEBGPU_WORKGROUP_MEMORY;
use sinew::components::{Scheme, Signals};
use sinew::systems::Registry;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::collections::BTreeSet;

fn kernels(effects: &Effects) -> Vec<(String, Kernel)> {
    all_kernels(effects.simulation(BackendChoice::Cpu).world_mut()).0
}

/// With those that systems of nodes share, and those of the guards.
fn all(effects: &Effects) -> Vec<(String, Kernel)> {
    let mut simulation = effects.simulation(BackendChoice::Cpu);
    let world = simulation.world_mut();
    let (mut all, _) = all_kernels(world);
    let without: Vec<&str> = OF_NODES.into_iter().filter(|system| *system != "pressure").collect();
    for systems in [&OF_NODES[..], &without] {
        let small = sharing(systems, world, MostBuffers::WEBGPU);
        all.extend(small.into_iter().map(|kernel| (kernel.label.clone(), kernel)));
        all.extend(sharing(systems, world, LARGER).into_iter().map(|kernel| (LARGER_DEVICE.to_owned(), kernel)));
    }
    // whose steps are element forces and one pass over the nodes
    if !effects.removal && !effects.averaged && effects.scheme == Scheme::Patches {
        let small =
            kernel_worlds::small_bodies(&without, world, &mut Described { most: LARGER, ..Described::default() });
        // two copies are more than a patch, and so are six tetrahedra a cell in place of a hexahedron
        let bodies = if effects.others == Some("Tet10") { 1 } else { 2 };
        assert_eq!(small.len(), if effects.copies { 0 } else { bodies }, "{effects:?}");
        all.extend(small.into_iter().map(|kernel| (LARGER_DEVICE.to_owned(), kernel)));
    }
    if effects.scheme == Scheme::Patches {
        let mut described = Described { most: LARGER, ..Described::default() };
        let Grouped { moving, others, .. } = kernel_worlds::interior_nodes(&without, world, &mut described);
        assert!(moving.len() >= 2, "{effects:?}");
        all.extend(moving.into_iter().chain(others).map(|kernel| (LARGER_DEVICE.to_owned(), kernel)));
    }
    all.extend(kernel_worlds::guard_kernels(world));
    // one of each kind is enough
    let mut seen: Vec<Vec<String>> = Vec::new();
    all.retain(|(_, kernel)| {
        let texts: Vec<String> = kernel.all_fragments().iter().map(|fragment| fragment.text.to_string()).collect();
        let fresh = !seen.contains(&texts);
        if fresh {
            seen.push(texts);
        }
        fresh
    });
    all
}

/// In place of the system's name: put together for a device that allows more buffers than the smallest.
const LARGER_DEVICE: &str = "larger device";

/// What it allows.
const LARGER: MostBuffers = MostBuffers::new(64, 32);

/// The kernels that systems of nodes share where a kernel may have so many buffers.
fn sharing(systems: &[&str], world: &mut World, most: MostBuffers) -> Vec<Kernel> {
    shared_kernels(systems, world, &mut Described { most, ..Described::default() })
}

/// Systems of nodes share as few kernels as can be: on a device that allows enough buffers one for each body, but for
/// pressure, which looks at the displacements of its neighbours before any of them moves.
#[test]
fn systems_of_nodes_share_kernels() {
    let labels = |effects: &Effects, most: MostBuffers| -> Vec<String> {
        let mut simulation = effects.simulation(BackendChoice::Cpu);
        sharing(&OF_NODES, simulation.world_mut(), most).into_iter().map(|kernel| kernel.label).collect()
    };
    assert_eq!(labels(&Effects::default(), LARGER), ["gather + integrate"; 2]);
    let moved = Effects { moved: true, compensated: true, damping: true, ..Effects::default() };
    assert_eq!(labels(&moved, LARGER), ["gather + boundary + integrate"; 2]);
    let loads = Effects { loads: true, ..moved.clone() };
    let two = ["gather + gravity + nodal_force + traction + pressure + boundary", "integrate"];
    assert_eq!(labels(&loads, LARGER), [two, two].concat());
    let few = labels(&moved, MostBuffers::WEBGPU);
    assert!(few.len() > 2 && few.iter().all(|label| label != "gather + boundary + integrate"), "{few:?}");
}

/// Patches move the nodes inside them where nothing looks at other nodes and the device allows the buffers.
#[test]
fn patches_move_the_nodes_inside_them_where_they_may() {
    let told = |effects: &Effects, systems: &[&str], most: MostBuffers| -> (Vec<String>, [usize; 2], String) {
        let mut simulation = effects.simulation(BackendChoice::Cpu);
        let mut described = Described { most, ..Described::default() };
        let grouped = kernel_worlds::interior_nodes(systems, simulation.world_mut(), &mut described);
        let Grouped { moving, others, told, .. } = grouped;
        assert!(told.iter().all(|body| (body.interior == 0) == moving.is_empty()), "{told:?}");
        let labels = moving.iter().map(|kernel| kernel.label.split(" of ").next().unwrap().to_owned());
        (labels.collect(), [moving.len(), others.len()], told[0].interior_because.clone())
    };
    let plain = Effects::default();
    let (labels, counts, because) = told(&plain, &OF_NODES, LARGER);
    assert!(labels.iter().all(|label| label == "element_forces + gather + integrate"), "{labels:?}");
    // two bodies of two blocks
    assert_eq!((counts, because.as_str()), ([4, 2], "no other patch has them"));
    let loads = Effects { loads: true, ..Effects::default() };
    let without: Vec<&str> = OF_NODES.into_iter().filter(|system| *system != "pressure").collect();
    assert_eq!(told(&loads, &without, LARGER).1, [4, 2]);
    let (_, counts, because) = told(&loads, &OF_NODES, LARGER);
    // the pass is in two, for the same reason
    assert_eq!(
        (counts, because.as_str()),
        ([0, 4], "`pressure` reads other nodes than its own, which must not have moved")
    );
    let (_, counts, because) = told(&plain, &OF_NODES, MostBuffers { storage: 9, ..LARGER });
    assert_eq!((counts, because.as_str()), ([0, 2], "it would need 10 storage buffers, and 9 may be"));
    let two_pass = Effects { scheme: Scheme::TwoPass, ..plain };
    assert_eq!(told(&two_pass, &OF_NODES, LARGER).2, "its forces are not summed by patches");
}

/// A decision is data, and kernels follow it: where nothing moves with patches, forces and nodes have their own.
#[test]
fn kernels_are_made_as_was_decided() {
    let mut simulation = Effects::default().simulation(BackendChoice::Cpu);
    let world = simulation.world_mut();
    type Decide = fn(&mut [Dispatched], ElementsThenNodes<'_>, &World, &mut dyn Buffers);
    let mut counts = |decide: Decide| {
        let mut described = Described { most: LARGER, ..Described::default() };
        let Grouped { alone, moving, others, .. } = kernel_worlds::grouped(&OF_NODES, world, &mut described, decide);
        [alone.len(), moving.len(), others.len()]
    };
    // two bodies of two blocks
    assert_eq!(counts(|_, _, _, _| {}), [4, 0, 2]);
    assert_eq!(counts(decide_interior_nodes), [0, 4, 2]);
    let many_steps: Decide = |told, step, world, buffers| decide_many_steps(usize::MAX, told, step, world, buffers);
    assert_eq!(counts(many_steps), [0, 2, 0]);
}

fn members(layout: &Layout) -> Vec<(String, u32, u32)> {
    layout.members.iter().map(|&(name, offset, size)| (name.to_owned(), offset as u32, size as u32)).collect()
}

#[test]
#[ignore = "long"]
fn every_combination_of_effects_composes_with_no_more_buffers_than_there_may_be() {
    let mut composer = Composer::default();
    for effects in Effects::combinations() {
        for (system, kernel) in all(&effects) {
            let composed = composer.compose(&kernel).unwrap_or_else(|e| panic!("{}: {e}", kernel.label));
            let entry = composed.entry(kernel.entry).unwrap_or_else(|| panic!("{}: no {}", kernel.label, kernel.entry));
            let patches = kernel.all_fragments().iter().any(|fragment| fragment.path == "shaders/patches.wgsl");
            let width = match (kernel.entry, patches) {
                ("many_steps", _) => kernel.threads,
                (_, true) => 128,
                (_, false) => 64,
            };
            assert_eq!(entry.workgroup_size, [width, 1, 1], "{}", kernel.label);
            assert!(entry.workgroup_memory as usize <= WEBGPU_WORKGROUP_MEMORY, "{}", kernel.label);
            assert!(!patches || entry.workgroup_memory > 0, "{}", kernel.label);
            let storage = composed.storage_buffers(entry);
            let most = if system == LARGER_DEVICE { LARGER } else { MostBuffers::WEBGPU };
            let problem = most.exceeded_by(storage, entry.uses.len() - storage);
            assert_eq!(problem, None, "{} of {system}: {effects:?}", kernel.label);
        }
    }
}

#[test]
#[ignore = "long"]
fn every_variable_in_use_has_a_buffer_and_every_buffer_is_in_use() {
    let mut composer = Composer::default();
    for effects in Effects::combinations() {
        for (_, kernel) in all(&effects) {
            uses_its_buffers(&kernel, &mut composer);
        }
    }
}

/// Every variable in use has a buffer, and every buffer is in use.
fn uses_its_buffers(kernel: &Kernel, composer: &mut Composer) {
    let composed = composer.compose(kernel).unwrap();
    let entry = composed.entry(kernel.entry).unwrap();
    let names = entry.uses.iter().map(|i| composed.bindings[*i].name.as_str());
    let used: BTreeSet<_> = names.filter(|name| !["step", "step_records"].contains(name)).collect();
    let given: BTreeSet<_> = kernel.bindings.iter().map(|(name, _)| name.as_ref()).collect();
    assert_eq!(used, given, "{}", kernel.label);
}

#[test]
fn structs_have_the_same_members_at_the_same_places_in_rust_and_wgsl() {
    let mut composer = Composer::default();
    for effects in Effects::combinations() {
        for (_, kernel) in kernels(&effects) {
            has_the_structs_of_rust(&kernel, &mut composer);
        }
    }
}

/// Structs of a kernel's uniforms are the same in Rust and WGSL.
fn has_the_structs_of_rust(kernel: &Kernel, composer: &mut Composer) {
    let composed = composer.compose(kernel).unwrap();
    for binding in composed.bindings.iter().filter(|b| b.kind == BindingKind::Uniform && b.name != "step") {
        let layout = kernel.layouts.iter().find(|(name, _)| *name == binding.name).map(|(_, layout)| layout);
        let Some(layout) = layout else {
            // `parameters` are declared by what Rust has
            let known = ["limits", "parameters"].contains(&binding.name.as_str());
            assert!(known, "{}: Rust says nothing of `{}`", kernel.label, binding.name);
            continue;
        };
        assert!(binding.type_name.contains(layout.name), "{} is not {}", binding.type_name, layout.name);
        let wgsl = composed.struct_layout(layout.name).unwrap();
        let wgsl: Vec<_> = wgsl.into_iter().map(|m| (m.name, m.offset, m.size)).collect();
        assert_eq!(wgsl, members(layout), "{}", layout.name);
        assert_eq!(composed.struct_size(layout.name).unwrap() as usize, layout.size, "{}", layout.name);
    }
}

#[test]
fn kernels_of_attachments_and_surfaces_have_the_buffers_and_the_structs_that_they_name() {
    let mut composer = Composer::default();
    let attached = (kernel_units::attached(""), ["glue", "suture_tension"], 11);
    for (mut simulation, systems, entries) in [attached, (kernel_units::meeting(), ["surface_contact"; 2], 11)] {
        let (all, _) = all_kernels(simulation.world_mut());
        let mut found = BTreeSet::new();
        for (_, kernel) in all.iter().filter(|(system, _)| systems.contains(&system.as_str())) {
            uses_its_buffers(kernel, &mut composer);
            has_the_structs_of_rust(kernel, &mut composer);
            found.insert(kernel.entry);
        }
        assert_eq!(found.len(), entries, "{found:?}");
    }
}

#[test]
fn the_steps_record_is_what_kernels_read() {
    let mut composer = Composer::default();
    let mut simulation = Effects::all().simulation(BackendChoice::Cpu);
    let world = simulation.world_mut();
    let size = sinew::backend::step::record_size(world.resource::<Signals>());
    let layout = sinew::backend::step::Step::LAYOUT;
    let mut readers = 0;
    for (_, kernel) in all_kernels(world).0 {
        let composed = composer.compose(&kernel).unwrap();
        let Some(binding) = composed.binding("step") else { continue };
        readers += 1;
        assert_eq!(binding.size as usize, size, "{}", kernel.label);
        let wgsl: Vec<_> =
            composed.struct_layout("Step").unwrap().into_iter().map(|m| (m.name, m.offset, m.size)).collect();
        let (signals, header) = wgsl.split_last().unwrap();
        assert_eq!((signals.0.as_str(), signals.1 as usize), ("signals", layout.size));
        assert_eq!(header, members(&layout));
    }
    assert!(readers > 8);
}

#[test]
fn a_scene_without_an_effect_has_neither_its_fragments_nor_its_buffers() {
    let fragments = |effects: &Effects| -> BTreeSet<String> {
        kernels(effects)
            .iter()
            .flat_map(|(_, k)| k.all_fragments().iter().map(|f| f.path.clone()).collect::<Vec<_>>())
            .collect()
    };
    let buffers = |effects: &Effects| -> BTreeSet<String> {
        kernels(effects).iter().flat_map(|(_, k)| k.bindings.iter().map(|(name, _)| name.to_string())).collect()
    };
    let plain = fragments(&Effects::default());
    let files: BTreeSet<&str> = plain.iter().filter_map(|p| p.strip_prefix("shaders/")).collect();
    let expected = [
        "block",
        "element_forces",
        "finite_strain",
        "gather",
        "hex8",
        "integrate",
        "internal_force",
        "kinematics",
        "neo_hookean",
        "node_pass",
        "note_inverted",
        "pass_rows",
        "patch_pass",
        "patches",
        "point",
        "point_pressure",
        "row",
        "law_of_all",
        "internal_work",
        "step",
        "tensor",
        "inverse_cbrt",
        "tet4",
        "volume_ratio",
    ];
    assert_eq!(files, expected.map(|stem| format!("{stem}.wgsl")).iter().map(String::as_str).collect());
    let without = buffers(&Effects::default());
    let varied = Some(VARIED[2].1);
    let cases: [(Effects, &[&str], &[&str]); 12] = [
        (Effects { copies: true, varied, ..Effects::default() }, &[], &["law_numbers"]),
        (Effects { grabs: true, ..Effects::default() }, &["grab", "external_force"], &["grabs", "external_force"]),
        (Effects { scheme: Scheme::TwoPass, ..Effects::default() }, &["two_pass", "corner"], &["connectivity"]),
        (Effects { inversion: Some("Remove"), ..Effects::default() }, &["remove_inverted"], &["removal_step"]),
        (Effects { fibres: Some(AROUND), ..Effects::default() }, &["fibres", "fibres_field"], &["fibre_direction"]),
        (Effects { prony: 1, ..Effects::default() }, &["prony"], &["viscous_memory"]),
        (Effects { damping: true, ..Effects::default() }, &["damping_coefficient"], &["damping_coefficient"]),
        (
            Effects { loads: true, ..Effects::default() },
            &["gravity", "pressure", "external_force"],
            &["external_force"],
        ),
        (
            Effects { compensated: true, ..Effects::default() },
            &["displacement_compensation"],
            &["displacement_compensation"],
        ),
        (Effects { energies: true, ..Effects::default() }, &["work"], &["work"]),
        (
            Effects { averaged: true, ..Effects::default() },
            &["nodal_volume", "nodal_mean", "tet4_nodal_pressure", "patch_volume", "hex8_mean_dilatation"],
            &["nodal_volume_change", "element_volume"],
        ),
        (Effects { removal: true, ..Effects::default() }, &["element_removal", "criterion", "node_mass"], &["alive"]),
    ];
    for (effects, stems, names) in cases {
        let (some, bound) = (fragments(&effects), buffers(&effects));
        for stem in stems {
            let path = format!("shaders/{stem}.wgsl");
            assert!(some.contains(&path) && !plain.contains(&path), "{path} of {effects:?}");
        }
        for name in names {
            assert!(bound.contains(*name) && !without.contains(*name), "{name} of {effects:?}");
        }
    }
}

#[test]
fn every_shader_is_named_after_a_system_an_element_or_a_material_or_listed() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let stems = |folder: &str| -> BTreeSet<String> {
        std::fs::read_dir(root.join(folder))
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
            .collect()
    };
    let mut known: BTreeSet<String> = SUPPORT.iter().map(|(stem, _)| (*stem).to_owned()).collect();
    for folder in ["systems", "src/elements"] {
        let others = [
            "mod",
            "kinds",
            "registry",
            "repeat",
            "rows",
            "runs_on",
            "stage",
            "host_forces",
            "node_shares",
            "node_slices",
            "node_slopes",
            "node_system",
            "node_stages",
            "node_views",
            "system",
        ];
        known.extend(stems(folder).into_iter().filter(|stem| !others.contains(&stem.as_str())));
    }
    // some run on the host only
    known.retain(|stem| Registry::default().get(stem).is_none_or(|system| system.device.is_some()));
    // that of one's own is a file of its author
    let laws = sinew::scene::schema::ELASTIC_LAWS.iter().filter(|word| **word != "law");
    let parts = [&kernel_units::SURFACES[..], &kernel_units::ATTACHMENTS, &kernel_units::CONJUGATE_GRADIENTS].concat();
    known.extend(laws.copied().chain(parts).map(str::to_owned));
    assert_eq!(stems("shaders"), known);
}

#[test]
#[ignore = "long"]
fn all_fragments_of_the_folder_are_in_use() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut used: BTreeSet<String> = BTreeSet::new();
    // the guards' own
    used.extend(["guard_elements.wgsl".to_owned(), "guard_nodes.wgsl".to_owned()]);
    used.extend(kernel_units::CONJUGATE_GRADIENTS.map(|stem| format!("{stem}.wgsl")));
    let scene = SceneFile::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/own_system.ron"), &[]).unwrap();
    let explained = Simulation::new(&scene, &Options::default()).unwrap().explain_on_gpu(&Registry::default()).unwrap();
    let fragments = explained.kernels.iter().flat_map(|kernel| &kernel.fragments);
    used.extend(fragments.filter_map(|f| f.path.strip_prefix("shaders/").map(str::to_owned)));
    used.extend([kernel_units::of_tools(), kernel_units::of_surfaces(), kernel_units::of_attachments()].concat());
    for effects in Effects::combinations() {
        for (_, kernel) in all(&effects) {
            let all = kernel.all_fragments();
            used.extend(all.iter().filter_map(|f| f.path.strip_prefix("shaders/").map(str::to_owned)));
        }
    }
    let files: BTreeSet<String> =
        std::fs::read_dir(root).unwrap().map(|f| f.unwrap().file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(files, used);
}
