//! What WGSL texts declare, by name and place, and the names that a law cannot have because they are ours.

use crate::backend::block_kernel::element_shader;
use crate::backend::kernel::Fragment;
use crate::materials::program::{is_name, words};
use crate::mesh::ElementKind;
use crate::shader;
use std::collections::HashMap;
use std::ops::Range;

/// Something declared outside of all functions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Declared {
    /// `fn`, `struct`, `var`, `const`, `alias`, `override`.
    pub(super) kind: String,
    pub(super) name: String,
    /// Where the name stands.
    pub(super) at: Range<usize>,
}

/// What a text declares.
pub(super) fn declared(text: &str) -> Vec<Declared> {
    let mut found = Vec::new();
    let (mut depth, mut template) = (0_usize, 0_usize);
    let mut kind: Option<&str> = None;
    for range in words(text) {
        let word = &text[range.clone()];
        match word {
            "{" | "(" => depth += 1,
            "}" | ")" => depth = depth.saturating_sub(1),
            // var<storage, read> x
            "<" if kind.is_some() => template += 1,
            ">" if kind.is_some() => template = template.saturating_sub(1),
            "fn" | "struct" | "var" | "const" | "alias" | "override" if depth == 0 => {
                (kind, template) = (Some(word), 0)
            }
            _ if is_name(word) && depth == 0 && template == 0 => {
                if let Some(kind) = kind.take() {
                    found.push(Declared { kind: kind.to_owned(), name: word.to_owned(), at: range });
                }
            }
            _ => {}
        }
    }
    found
}

/// The names of what a text declares, however it is laid out.
fn declared_names(text: &str) -> impl Iterator<Item = String> {
    declared(text).into_iter().map(|declared| declared.name)
}

/// Where a member of a struct stands, else the struct itself.
pub(super) fn member(text: &str, of: &Declared, member: &str) -> Range<usize> {
    let behind = words(text).skip_while(|range| range.start < of.at.end);
    let within = behind.take_while(|range| &text[range.clone()] != "}");
    let mut names = within.filter(|range| is_name(&text[range.clone()]));
    names.find(|range| &text[range.clone()] == member).unwrap_or_else(|| of.at.clone())
}

/// The fragments that a law may call, and with which it is compiled.
pub(super) fn callable_fragments() -> Vec<Fragment> {
    vec![
        shader!("tensor"),
        shader!("inverse_cbrt"),
        shader!("kinematics"),
        shader!("elementary"),
        shader!("eigen"),
        shader!("invariants"),
    ]
}

/// The other fragments that can be in one kernel with a law.
pub(super) fn sibling_fragments() -> Vec<Fragment> {
    let kinds = ElementKind::ALL.into_iter().map(element_shader);
    let others = vec![
        shader!("alive"),
        shader!("block"),
        shader!("criterion"),
        shader!("element_forces"),
        shader!("element_removal"),
        shader!("energy"),
        shader!("exponential_fibres"),
        shader!("fibres"),
        shader!("fibres_field"),
        shader!("fibres_uniform"),
        shader!("finite_strain"),
        shader!("many_steps"),
        shader!("mean_pressure"),
        shader!("nodal_mean"),
        shader!("nodal_volume"),
        shader!("note_inverted"),
        shader!("pass_rows"),
        shader!("patch_gather"),
        shader!("patch_pass"),
        shader!("patch_step"),
        shader!("patch_volume"),
        shader!("patches"),
        shader!("point"),
        shader!("point_pressure"),
        shader!("prony"),
        shader!("remove_inverted"),
        shader!("row"),
        shader!("step"),
        shader!("tet4_nodal_pressure"),
        shader!("volume_ratio"),
        shader!("guard_elements"),
    ];
    kinds.chain(others).collect()
}

/// Names that kernels are generated with.
const GENERATED: [&str; 21] = [
    "add_forces",
    "force_of_patch",
    "call_all",
    "finish_all",
    "sum_all",
    "LEAST_INTERIOR",
    "isochoric_stress",
    "energy_density",
    "fibres_energy_at",
    "viscous_pressure",
    "family_direction",
    "FAMILIES",
    "VOLUMETRIC_TERMS",
    "TERMS",
    "LANES",
    "NODES",
    "POINTS",
    "CHECKED_POINTS",
    "ROWS",
    "VOLUME_ROW",
    "J_FLOOR",
];

/// The names that are ours where there is a law, each with the file that has it.
pub(super) fn law_owners() -> HashMap<String, String> {
    let mut owners = owners_among(&[callable_fragments(), sibling_fragments()].concat());
    owners.extend(GENERATED.map(|name| (name.to_owned(), "a generated part of the kernel".to_owned())));
    owners
}

/// The names that fragments declare, each with its file.
pub(super) fn owners_among(fragments: &[Fragment]) -> HashMap<String, String> {
    let mut owners = HashMap::new();
    for fragment in fragments {
        for name in declared_names(&fragment.text) {
            owners.entry(name).or_insert_with(|| fragment.path.clone());
        }
    }
    owners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_found_with_their_places() {
        let text = "// fn no\nstruct Law { mu: f32 }\n@group(0) @binding(0) var<uniform> elastic: Law;\n\
                    const a: f32 = max(1.0, 2.0); /* var b */ fn f(x: f32) -> f32 { var y = x; return y; }";
        let found = declared(text);
        let names: Vec<_> = found.iter().map(|d| (d.kind.as_str(), d.name.as_str(), &text[d.at.clone()])).collect();
        let expected = [("struct", "Law"), ("var", "elastic"), ("const", "a"), ("fn", "f")];
        assert_eq!(names, expected.map(|(kind, name)| (kind, name, name)));
        assert_eq!(&text[member(text, &found[0], "mu")], "mu");
    }

    /// A shader that is in none of the lists could break a kernel with a law in it, far from the law's file.
    #[test]
    fn every_shader_that_can_meet_a_law_is_in_the_list() {
        let known: Vec<String> = callable_fragments().into_iter().chain(sibling_fragments()).map(|f| f.path).collect();
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = format!("shaders/{}", entry.file_name().to_string_lossy());
            let text = std::fs::read_to_string(entry.path()).unwrap_or_default();
            let names: Vec<String> = declared(&text).into_iter().map(|d| d.name).collect();
            let law = names.iter().any(|name| name == "elastic_isochoric");
            // kernels of nodes and faces have no element
            let elements =
                ["alive", "block", "prony", "fibres", "element", "point", "nodal_v", "nodal_m", "tet4_nodal"];
            let meets = elements.iter().any(|part| name.contains(part)) || text.contains("Kinematics");
            assert!(law || !meets || known.contains(&name), "{name} is in no list of src/backend/user_law/names.rs");
        }
    }
}
