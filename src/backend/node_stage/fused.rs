//! Stages put together into one kernel.

use super::items::{Items, renamed, storage_variable};
use super::{Forces, NodePass, NodeStage, Rows};
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Layout, Uniform};
use crate::backend::user_law::declared_names;
use crate::components::{Column, ExternalForce, InternalForce};
use crate::shader;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The WGSL of several stages in one, and what it binds.
pub struct Fused {
    shared: Vec<Fragment>,
    own: Vec<Fragment>,
    /// WGSL access and type of each column, the widest access that any stage asks for.
    columns: BTreeMap<String, (bool, String)>,
    buffers: BTreeMap<&'static str, BufferId>,
    bindings: Vec<(Cow<'static, str>, BufferId)>,
    layouts: Vec<(Cow<'static, str>, Layout)>,
    /// Lines of the kernel's beginning, of its body, and of its end.
    sums: String,
    calls: String,
    finish: String,
    /// Texts of the structs, by name.
    structs: BTreeMap<String, String>,
    /// Variables that hold a stage's rows, or, where others share the kernel, each node's place among them; and whose.
    lists: Vec<(String, usize)>,
    storage_variables: usize,
}

impl Fused {
    /// Puts stages together.
    pub fn of(stages: &[&NodeStage]) -> Self {
        let mut fused = Self {
            shared: Vec::new(),
            own: Vec::new(),
            columns: BTreeMap::new(),
            buffers: BTreeMap::new(),
            bindings: Vec::new(),
            layouts: Vec::new(),
            sums: String::new(),
            calls: String::new(),
            finish: String::new(),
            structs: BTreeMap::new(),
            lists: Vec::new(),
            storage_variables: 0,
        };
        let mut declared: BTreeSet<String> = BTreeSet::new();
        for fragment in forces_between(stages).into_iter().chain(stages.iter().flat_map(|s| s.shared.clone())) {
            if fused.shared.iter().any(|there| there.path == fragment.path) {
                continue;
            }
            let text = fused.without_columns(&fragment.text, &|_| true);
            declared.extend(declared_names(&text));
            fused.shared.push(Fragment { text: text.into(), ..fragment });
        }
        let single = stages.len() == 1;
        for (number, stage) in stages.iter().enumerate() {
            fused.add(number, stage, single, &mut declared);
        }
        fused
    }

    fn add(&mut self, number: usize, stage: &NodeStage, single: bool, declared: &mut BTreeSet<String>) {
        // a column that another stage has under the name of one of its own is not shared
        let is_other = |(name, buffer): &(&'static str, BufferId)| self.buffers.get(name).is_some_and(|b| b != buffer);
        let (own, columns): (Vec<_>, Vec<_>) = stage.columns.iter().copied().partition(is_other);
        self.buffers.extend(columns.iter().copied());
        declared.extend(columns.iter().map(|(name, _)| (*name).to_owned()));
        let is_column = |name: &str| columns.iter().any(|(column, _)| *column == name);
        let texts: Vec<String> =
            stage.own.iter().map(|fragment| self.without_columns(&fragment.text, &is_column)).collect();
        let mut names: BTreeMap<String, String> = BTreeMap::new();
        // the same system's stages have the same structs; those of patches are made of constants that may differ
        let of_patch = matches!(stage.rows, Rows::Patch);
        let structs = texts.iter().filter(|_| !of_patch).flat_map(|text| Items::of(text).structs());
        let (known, new): (Vec<_>, Vec<_>) = structs.partition(|(name, text)| self.structs.get(name) == Some(text));
        let known: BTreeSet<String> = known.into_iter().map(|(name, _)| name).collect();
        for name in texts.iter().flat_map(|text| declared_names(text)).filter(|name| !known.contains(name)) {
            if declared.contains(&name) {
                let mut other = format!("{name}_{number}");
                while declared.contains(&other) {
                    other.push('_');
                }
                declared.insert(other.clone());
                names.insert(name.clone(), other);
            } else {
                declared.insert(name);
            }
        }
        self.structs.extend(new.into_iter().filter(|(name, _)| !names.contains_key(name)));
        for (fragment, text) in stage.own.iter().zip(texts) {
            let text = renamed(&Items::of(&text).without(&known), &names);
            self.storage_variables += text.matches("var<storage").count();
            self.own.push(Fragment { path: fragment.path.clone(), text: text.into() });
        }
        let now = |name: &Cow<'static, str>| names.get(name.as_ref()).map_or(name.clone(), |name| name.clone().into());
        let own = own.into_iter().map(|(name, buffer)| (name.into(), buffer));
        self.bindings.extend(stage.bindings.iter().cloned().chain(own).map(|(name, buffer)| (now(&name), buffer)));
        self.layouts.extend(stage.layouts.iter().map(|(name, layout)| (now(name), *layout)));
        let call = now(&stage.call);
        match (&stage.rows, single) {
            (Rows::Patch, _) => self.sums += &format!("    {call}(number, local, kept);\n"),
            (Rows::All, _) => self.calls += &format!("    {call}(node);\n"),
            (Rows::Some(_), true) => {
                self.calls += &format!("    {call}(node, rows[node]);\n");
                self.lists.push(("rows".to_owned(), number));
            }
            (Rows::Some(_), false) => {
                let places = format!("places_{number}");
                let place = format!("place_{number}");
                self.calls += &format!("    let {place} = {places}[node - pass_rows.first];\n");
                self.calls += &format!("    if {place} != 0xffffffffu {{ {call}({place}, node); }}\n");
                self.lists.push((places, number));
            }
        }
        if let Some(finish) = stage.finish {
            self.finish += &format!("    {finish}(local, node);\n");
        }
    }

    /// Takes the declarations of columns out of a text: they stand once for all.
    fn without_columns(&mut self, text: &str, is_column: &dyn Fn(&str) -> bool) -> String {
        let mut rest = String::new();
        for line in text.lines() {
            match storage_variable(line).filter(|(name, ..)| is_column(name)) {
                Some((name, writes, of)) => {
                    let entry = self.columns.entry(name.to_owned()).or_insert((writes, of.to_owned()));
                    entry.0 |= writes;
                }
                None => rest = rest + line + "\n",
            }
        }
        rest
    }

    /// Names of the columns that it writes.
    pub fn written(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().filter(|(_, (writes, _))| *writes).map(|(name, _)| name.as_str())
    }

    /// How many storage buffers it binds.
    pub fn storage(&self) -> usize {
        self.columns.len() + self.storage_variables + self.lists.len()
    }

    /// How many uniform buffers it binds, the number of rows counted in.
    pub fn uniforms(&self) -> usize {
        let fragments = self.own.iter().chain(&self.shared);
        1 + fragments.map(|fragment| fragment.text.matches("var<uniform>").count()).sum::<usize>()
    }

    /// The kernel of some rows, but for the function `entry`, which calls `sum_all`, `call_all` and `finish_all`.
    pub fn into_kernel(
        self,
        entry: &'static str,
        stages: &[&NodeStage],
        rows: NodePass,
        buffers: &mut dyn Buffers,
    ) -> Kernel {
        let mut systems: Vec<&str> = stages.iter().map(|stage| stage.system.as_ref()).collect();
        systems.dedup();
        let mut text = String::new();
        for (number, (name, (writes, of))) in self.columns.iter().enumerate() {
            let access = if *writes { "read_write" } else { "read" };
            text += &format!("@group(0) @binding({number}) var<storage, {access}> {name}: {of};\n");
        }
        let mut kernel = Kernel::new(systems.join(" + "), entry);
        text += &self.calls_as_functions();
        for (variable, number) in self.lists {
            text += &format!("@group(0) @binding(0) var<storage, read> {variable}: array<u32>;\n");
            let NodeStage { system, within, rows: Rows::Some(rows), .. } = stages[number] else { continue };
            let list = match stages {
                [_] => buffers.constants(format!("rows of {system}"), bytemuck::cast_slice(rows)),
                _ => buffers.constants(format!("places of {system}"), bytemuck::cast_slice(&places(rows, within))),
            };
            kernel = kernel.bind(variable, list);
        }
        for (name, buffer) in self.buffers {
            kernel = kernel.bind(name, buffer);
        }
        kernel.bindings.extend(self.bindings);
        kernel.layouts.extend(self.layouts);
        kernel.fragments.extend(self.own);
        kernel.fragments.extend(self.shared);
        let pass = buffers.uniform(format!("rows of {}", kernel.label), &rows.bytes());
        kernel
            .fragment(shader!("pass_rows"))
            .fragment(Fragment::new("generated: columns and calls of the kernel", text))
            .bind_uniform::<NodePass>("pass_rows", pass)
    }

    fn calls_as_functions(&self) -> String {
        let sums = match self.sums.as_str() {
            "" => String::new(),
            sums => format!("fn sum_all(number: u32, local: u32, kept: u32) {{\n{sums}}}\n"),
        };
        let Self { calls, finish, .. } = self;
        sums + &format!("fn call_all(node: u32) {{\n{calls}}}\nfn finish_all(local: u32, node: u32) {{\n{finish}}}\n")
    }
}

/// The place of each of some nodes among a stage's rows; of others the largest number.
fn places(rows: &[u32], nodes: &Range<u32>) -> Vec<u32> {
    let mut places = vec![u32::MAX; nodes.len()];
    for (place, &row) in rows.iter().enumerate().filter(|(_, row)| nodes.contains(row)) {
        places[(row - nodes.start) as usize] = place as u32;
    }
    places
}

/// How forces get from who sums them and who adds to them to who uses them: through memory, or, where one kernel does
/// both, in the invocation's own registers.
fn forces_between(stages: &[&NodeStage]) -> Vec<Fragment> {
    let calls = |name: &str| stages.iter().any(|stage| stage.columns.iter().any(|(column, _)| *column == name));
    let (inner, outer) = (calls(InternalForce::NAME), calls(ExternalForce::NAME));
    let do_with_them = |what: Forces| stages.iter().any(|stage| stage.forces == what);
    let at_hand = do_with_them(Forces::Sums) && do_with_them(Forces::UsesUp);
    let loaded = stages.iter().any(|stage| stage.loaded);
    let integrates = do_with_them(Forces::UsesUp) || do_with_them(Forces::AsksFor);
    let mut fragments = Vec::new();
    match (inner, at_hand) {
        (true, true) => fragments.push(shader!("internal_force_at_hand")),
        (true, false) => fragments.push(shader!("internal_force")),
        (false, _) if integrates => fragments.push(Fragment::new(
            "generated: no forces of elements",
            "fn internal_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n",
        )),
        (false, _) => {}
    }
    match (outer && loaded, at_hand) {
        (true, true) => fragments.push(shader!("external_force_at_hand")),
        (true, false) => fragments.push(shader!("external_force")),
        (false, _) if inner || integrates => fragments.push(Fragment::new(
            "generated: no loads",
            "fn clear_loads(node: u32) {}\nfn external_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n",
        )),
        (false, _) => {}
    }
    fragments
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::kernel::compose;
    use bevy_ecs::prelude::Entity;

    fn stage(call: &'static str, of: &str) -> NodeStage {
        let text = format!(
            "struct Load {{\n    {of}: u32,\n}}\n@group(0) @binding(0) var<uniform> load: Load;\n\
             fn {call}(node: u32) {{\n    let now = load.{of} + node;\n}}\n"
        );
        NodeStage::new("loads", call, Entity::PLACEHOLDER, 1, Fragment::new(of.to_owned(), text))
            .bind("load", BufferId::NONE)
    }

    /// Those of one system's stages are one; a stage of another may have something else under the name.
    #[test]
    fn structs_of_one_name_are_one_only_if_they_are_the_same() {
        let stages = [stage("push", "slot"), stage("pull", "slot"), stage("turn", "axis")];
        let fused = Fused::of(&[&stages[0], &stages[1], &stages[2]]);
        let text: String = fused.own.iter().map(|fragment| fragment.text.as_ref()).collect();
        let found: Vec<&str> = text.lines().filter(|line| line.starts_with("struct")).collect();
        assert_eq!(found, ["struct Load {", "struct Load_2 {"]);
        assert!(compose(&fused.own).is_ok(), "{text}");
        // a law of the user's own, which no stage may break: it goes first
        let law = "  struct Load { mu: f32 } @group(0) @binding(0) var<uniform> load: Load; fn push(f: f32) -> f32 { return load.mu * f; }";
        let patch = NodeStage { rows: Rows::Patch, own: vec![Fragment::new("law", law)], ..stage("push", "mu") };
        let with_law = Fused::of(&[&patch, &stages[0]]);
        let text: String = with_law.own.iter().map(|fragment| fragment.text.as_ref()).collect();
        assert!(compose(&with_law.own).is_ok() && text.contains("fn push_1(node: u32)"), "{text}");
        let bound: Vec<&str> = fused.bindings.iter().map(|(name, _)| name.as_ref()).collect();
        assert_eq!(bound, ["load", "load_1", "load_2"]);
    }
}
