//! Systems that work node by node: each in a kernel of its own, or neighbours of a step in one.

mod items;

use super::Buffers;
use super::kernel::{BufferId, Fragment, Kernel, Layout, Uniform, uniform};
use crate::components::{Column, ExternalForce, InternalForce, Mass};
use crate::shader;
use bevy_ecs::prelude::*;
use items::{Items, renamed};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// Describes what a system does to nodes, body by body, bound to buffers.
pub type DescribeStages = fn(&mut World, &mut dyn Buffers) -> Vec<NodeStage>;

/// What a system does to the nodes of one body: a WGSL function of a row, which kernels call.
#[derive(Clone, Debug)]
pub struct NodeStage {
    body: Entity,
    system: &'static str,
    /// The WGSL function: of a node, or of a place in `rows`.
    call: &'static str,
    /// Called by all invocations of a workgroup after that, with their place in it and their row.
    finish: Option<&'static str>,
    nodes: u32,
    rows: Option<Vec<u32>>,
    own: Vec<Fragment>,
    shared: Vec<Fragment>,
    columns: Vec<(&'static str, BufferId)>,
    bindings: Vec<(&'static str, BufferId)>,
    layouts: Vec<(&'static str, Layout)>,
    elsewhere: Vec<&'static str>,
    loaded: bool,
}

impl NodeStage {
    /// For each of the body's nodes calls `call(node)`, which `fragment` declares.
    pub fn new(system: &'static str, call: &'static str, body: Entity, nodes: u32, fragment: Fragment) -> Self {
        Self {
            body,
            system,
            call,
            finish: None,
            nodes,
            rows: None,
            own: vec![fragment],
            shared: Vec::new(),
            columns: Vec::new(),
            bindings: Vec::new(),
            layouts: Vec::new(),
            elsewhere: Vec::new(),
            loaded: false,
        }
    }

    /// Only for some nodes, ascending: calls `call(i)` for each place `i` in `rows`.
    pub fn of_rows(mut self, rows: Vec<u32>) -> Self {
        self.rows = Some(rows);
        self
    }

    /// Calls `finish(place in the workgroup, node)` afterwards, in all invocations.
    pub fn finish(mut self, finish: &'static str) -> Self {
        self.finish = Some(finish);
        self
    }

    /// Adds a piece of WGSL that may name things as it likes: what another stage calls the same is renamed.
    pub fn own(mut self, fragment: Fragment) -> Self {
        self.own.push(fragment);
        self
    }

    /// Adds a piece of WGSL that other stages may have too, and share.
    pub fn shared(mut self, fragment: Fragment) -> Self {
        self.shared.push(fragment);
        self
    }

    /// Adds what declares `step` for a world's signals.
    pub fn with_step(self, world: &World) -> Self {
        super::step::step_fragments(world).into_iter().fold(self, Self::shared)
    }

    /// Binds a column of the body, or of a block of it, that other stages may use under the same name.
    pub fn column(mut self, name: &'static str, buffer: BufferId) -> Self {
        self.columns.push((name, buffer));
        self
    }

    /// Binds what no other stage uses.
    pub fn bind(mut self, variable: &'static str, buffer: BufferId) -> Self {
        self.bindings.push((variable, buffer));
        self
    }

    /// Binds a `var<uniform>`.
    pub fn bind_uniform<U: Uniform>(mut self, variable: &'static str, buffer: BufferId) -> Self {
        self.layouts.push((variable, U::LAYOUT));
        self.bind(variable, buffer)
    }

    /// Says that it reads a column of other nodes than its own: who writes that must not share a kernel with it.
    pub fn reads_elsewhere(mut self, name: &'static str) -> Self {
        self.elsewhere.push(name);
        self
    }

    /// Says whether the body has loads: whether there is a column of external forces.
    pub fn loaded(mut self, loaded: bool) -> Self {
        self.loaded = loaded;
        self
    }
}

/// How many nodes a body has.
pub fn rows_of(body: Entity, world: &World) -> u32 {
    world.get::<Mass>(body).map_or(0, |mass| mass.len()) as u32
}

/// How many rows a kernel of nodes has.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct NodePass {
    count: u32,
}
uniform!(NodePass { count });

/// Kernels of stages that follow one another in a step. Those of one body share as few kernels as can be: none in which a
/// stage reads of other nodes what another writes, and none with more storage buffers than the device has for a kernel. With
/// `fuse` false each has its own.
pub fn node_kernels(stages: Vec<NodeStage>, fuse: bool, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let mut bodies: Vec<Entity> = Vec::new();
    for stage in &stages {
        if !bodies.contains(&stage.body) {
            bodies.push(stage.body);
        }
    }
    let mut kernels = Vec::new();
    for body in bodies {
        let mut waiting: Vec<&NodeStage> = Vec::new();
        for stage in stages.iter().filter(|stage| stage.body == body) {
            waiting.push(stage);
            if waiting.len() == 1 || (fuse && may_share(&waiting, buffers.storage_buffers().min(MOST_SHARED))) {
                continue;
            }
            let before = &waiting[..waiting.len() - 1];
            kernels.push(Fused::of(before).into_kernel(before, buffers));
            waiting = vec![stage];
        }
        if !waiting.is_empty() {
            kernels.push(Fused::of(&waiting).into_kernel(&waiting, buffers));
        }
    }
    kernels
}

/// Storage buffers of a kernel that several stages share, however many the device allows: what more loads gain is little.
const MOST_SHARED: usize = 32;

/// Whether all may run in one kernel, where nodes go their way independently of each other.
fn may_share(stages: &[&NodeStage], most: usize) -> bool {
    let fused = Fused::of(stages);
    let far: BTreeSet<&str> = stages.iter().flat_map(|stage| stage.elsewhere.iter().copied()).collect();
    fused.storage() <= most && fused.written().all(|name| !far.contains(name))
}

/// The WGSL of several stages in one, and what it binds.
struct Fused {
    shared: Vec<Fragment>,
    own: Vec<Fragment>,
    /// WGSL access and type of each column, the widest access that any stage asks for.
    columns: BTreeMap<String, (bool, String)>,
    buffers: BTreeMap<&'static str, BufferId>,
    bindings: Vec<(Cow<'static, str>, BufferId)>,
    layouts: Vec<(Cow<'static, str>, Layout)>,
    /// Lines of the kernel's body, and of its end.
    calls: String,
    finish: String,
    /// Variables that hold each node's place in a stage's rows, and those rows.
    places: Vec<(String, usize)>,
    storage_variables: usize,
}

impl Fused {
    fn of(stages: &[&NodeStage]) -> Self {
        let mut fused = Self {
            shared: Vec::new(),
            own: Vec::new(),
            columns: BTreeMap::new(),
            buffers: BTreeMap::new(),
            bindings: Vec::new(),
            layouts: Vec::new(),
            calls: String::new(),
            finish: String::new(),
            places: Vec::new(),
            storage_variables: 0,
        };
        let mut declared: BTreeSet<String> = BTreeSet::new();
        for fragment in forces_between(stages).into_iter().chain(stages.iter().flat_map(|s| s.shared.clone())) {
            if fused.shared.iter().any(|there| there.path == fragment.path) {
                continue;
            }
            let text = fused.without_columns(&fragment.text, &|_| true);
            declared.extend(Items::of(&text).names().map(str::to_owned));
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
        let mut structs: BTreeSet<String> = BTreeSet::new();
        for item in texts.iter().flat_map(|text| Items::of(text).0) {
            let Some(name) = item.name else { continue };
            match declared.contains(name) {
                // the same system's stages have the same structs
                true if item.is_struct => _ = structs.insert(name.to_owned()),
                true => _ = names.insert(name.to_owned(), format!("{name}_{number}")),
                false => _ = declared.insert(name.to_owned()),
            }
        }
        for (fragment, text) in stage.own.iter().zip(texts) {
            let text = renamed(&Items::of(&text).without(&structs), &names);
            self.storage_variables += text.matches("var<storage").count();
            self.own.push(Fragment { path: fragment.path.clone(), text: text.into() });
        }
        let now = |name: &'static str| names.get(name).map_or(Cow::Borrowed(name), |name| Cow::Owned(name.clone()));
        self.bindings.extend(stage.bindings.iter().chain(&own).map(|&(name, buffer)| (now(name), buffer)));
        self.layouts.extend(stage.layouts.iter().map(|&(name, layout)| (now(name), layout)));
        let call = now(stage.call);
        self.calls += &match (&stage.rows, single) {
            (None, _) => format!("        {call}(node);\n"),
            (Some(_), true) => format!("        {call}(node);\n"),
            (Some(_), false) => {
                let places = format!("places_{number}");
                let line = format!("        if {places}[node] != NO_PLACE {{ {call}({places}[node]); }}\n");
                self.places.push((places, number));
                line
            }
        };
        if let Some(finish) = stage.finish {
            self.finish += &format!("    {finish}(local, node);\n");
        }
    }

    /// Takes the declarations of columns out of a text: they stand once for all.
    fn without_columns(&mut self, text: &str, is_column: &dyn Fn(&str) -> bool) -> String {
        let mut rest = String::new();
        for line in text.lines() {
            match items::storage_variable(line).filter(|(name, ..)| is_column(name)) {
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
    fn written(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().filter(|(_, (writes, _))| *writes).map(|(name, _)| name.as_str())
    }

    /// How many storage buffers it binds.
    fn storage(&self) -> usize {
        self.columns.len() + self.storage_variables + self.places.len()
    }

    fn into_kernel(self, stages: &[&NodeStage], buffers: &mut dyn Buffers) -> Kernel {
        let single = stages.len() == 1;
        let mut systems: Vec<&str> = stages.iter().map(|stage| stage.system).collect();
        systems.dedup();
        let count = match &stages[0].rows {
            Some(rows) if single => rows.len() as u32,
            _ => stages[0].nodes,
        };
        let mut text = String::new();
        for (number, (name, (writes, of))) in self.columns.iter().enumerate() {
            let access = if *writes { "read_write" } else { "read" };
            text += &format!("@group(0) @binding({number}) var<storage, {access}> {name}: {of};\n");
        }
        let mut kernel = Kernel::new(systems.join(" + "), "node_pass");
        text += &self.calls_as_function();
        if !self.places.is_empty() {
            text += "const NO_PLACE: u32 = 0xffffffffu;\n";
        }
        for (variable, number) in self.places {
            text += &format!("@group(0) @binding(0) var<storage, read> {variable}: array<u32>;\n");
            let stage = &stages[number];
            let mut places = vec![u32::MAX; stage.nodes as usize];
            for (place, &row) in stage.rows.iter().flatten().enumerate() {
                places[row as usize] = place as u32;
            }
            let label = format!("places of {}", stage.system);
            kernel = kernel.bind(variable, buffers.constants(label, bytemuck::cast_slice(&places)));
        }
        for (name, buffer) in self.buffers {
            kernel = kernel.bind(name, buffer);
        }
        kernel.bindings.extend(self.bindings);
        kernel.layouts.extend(self.layouts);
        kernel.fragments.extend(self.own);
        kernel.fragments.extend(self.shared);
        let pass = buffers.uniform(format!("rows of {}", kernel.label), &NodePass { count }.bytes());
        kernel
            .fragment(shader!("row"))
            .fragment(shader!("node_pass"))
            .fragment(Fragment::new("generated: columns and calls of the kernel", text))
            .bind_uniform::<NodePass>("pass_rows", pass)
            .threads(count)
    }

    fn calls_as_function(&self) -> String {
        format!(
            "fn call_all(node: u32) {{\n{}}}\nfn finish_all(local: u32, node: u32) {{\n{}}}\n",
            self.calls, self.finish
        )
    }
}

/// How forces get from who sums them and who adds to them to who uses them: through memory, or, where one kernel does both,
/// in the invocation's own registers.
fn forces_between(stages: &[&NodeStage]) -> Vec<Fragment> {
    let calls = |name: &str| stages.iter().any(|stage| stage.columns.iter().any(|(column, _)| *column == name));
    let (inner, outer) = (calls(InternalForce::NAME), calls(ExternalForce::NAME));
    let at_hand = ["gather", "integrate"].iter().all(|call| stages.iter().any(|stage| stage.call == *call));
    let loaded = stages.iter().any(|stage| stage.loaded);
    // the second half of integrate asks for none of them, but the fragment does
    let integrates = stages.iter().any(|stage| stage.system == "integrate");
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
