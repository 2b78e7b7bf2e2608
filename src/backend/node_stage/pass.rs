//! Stages put together into one kernel: each is a unit of its own, and the kernel's frame calls them in their order.

use super::frames::Frame;
use super::{Forces, NodeStage, PassRows, Rows};
use crate::backend::Buffers;
use crate::backend::kernel::{
    BindingKind, BufferId, Composed, EntryPoint, Fragment, Kernel, Layout, Link, STEP_RECORDS_VARIABLE, STEP_VARIABLE,
    Uniform, Unit, UnitId,
};
use crate::components::{Column, ExternalForce, InternalForce};
use crate::shader;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Stages in a frame, without what only this kernel binds.
pub struct Pass {
    /// The kernel, with the columns and what stages bind.
    kernel: Kernel,
    /// Variables that hold a stage's rows, or, where others share the kernel, each node's place among them; and whose.
    lists: Vec<(String, usize)>,
}

/// Names that variables have in a kernel.
struct Names {
    /// With the buffer, where it is a column.
    taken: BTreeMap<String, Option<BufferId>>,
}

impl Names {
    /// What a stage's column is called: as another stage's, if it is the same.
    fn of_column(&mut self, name: &'static str, buffer: BufferId, stage: usize) -> Cow<'static, str> {
        match self.taken.get(name) {
            Some(Some(known)) if *known == buffer => name.into(),
            _ => self.fresh(name.into(), Some(buffer), stage),
        }
    }

    /// A name that nothing else has.
    fn fresh(&mut self, name: Cow<'static, str>, buffer: Option<BufferId>, stage: usize) -> Cow<'static, str> {
        let mut free = name.clone();
        if self.taken.contains_key(name.as_ref()) {
            free = format!("{name}_{stage}").into();
        }
        while self.taken.contains_key(free.as_ref()) {
            free.to_mut().push('_');
        }
        self.taken.insert(free.to_string(), buffer);
        free
    }
}

impl Pass {
    /// Puts stages together.
    pub fn of(stages: &[&NodeStage], frame: Frame) -> Self {
        let invocations = format!("const INVOCATIONS: u32 = {}u;\n", frame.invocations);
        let mut common = vec![shader!("pass_rows"), Fragment::new("generated: width of a workgroup", invocations)];
        if let Some(step) = stages.iter().find_map(|stage| stage.step.as_ref()) {
            common.extend(step.iter().cloned().chain([frame.step]));
        }
        common.extend(frame.common);
        let with_forces: Vec<Fragment> = common.iter().cloned().chain(forces_between(stages)).collect();
        let mut systems: Vec<Cow<'static, str>> = stages.iter().map(|stage| stage.system.clone()).collect();
        systems.dedup();
        let mut pass = Self { kernel: Kernel::new(systems.join(" + "), frame.entry), lists: Vec::new() };
        pass.kernel.systems = systems;
        pass.kernel.common = common.clone();
        let reserved = [STEP_VARIABLE, STEP_RECORDS_VARIABLE, PASS_ROWS].map(|name| (name.to_owned(), None));
        let mut names = Names { taken: reserved.into() };
        let mut columns: BTreeMap<Cow<'static, str>, BufferId> = BTreeMap::new();
        let [mut sums, mut calls, mut finish] = <[Vec<_>; 3]>::default();
        for (number, stage) in stages.iter().enumerate() {
            let of_column = |&(name, buffer)| (Cow::from(name), names.of_column(name, buffer, number), buffer);
            let bound: Vec<_> = stage.columns.iter().map(of_column).collect();
            columns.extend(bound.iter().map(|(_, there, buffer)| (there.clone(), *buffer)));
            let mut variables: Vec<_> = bound.into_iter().map(|(here, there, _)| (here, there)).collect();
            for (name, buffer) in &stage.bindings {
                let there = names.fresh(name.clone(), None, number);
                variables.push((name.clone(), there.clone()));
                pass.kernel.bindings.push((there, *buffer));
            }
            let there =
                |name: &Cow<'static, str>| variables.iter().find(|(here, _)| here == name).map(|(_, there)| there);
            let layouts = stage.layouts.iter().filter_map(|(name, layout)| Some((there(name)?.clone(), *layout)));
            let layouts: Vec<(Cow<'static, str>, Layout)> = layouts.collect();
            pass.kernel.layouts.extend(layouts);
            let of_patch = matches!(stage.rows, Rows::Patch);
            let links = stage.calls.iter().map(|called| {
                let unit = Unit { own: called.own.clone(), variables: variables.clone(), ..Unit::default() };
                Link { function: called.function.clone(), calls: vec![(pass.add(unit), called.name.clone())] }
            });
            let links: Vec<Link> = links.collect();
            if of_patch && frame.has_patch {
                pass.kernel.fragments.extend(stage.own.iter().cloned());
                pass.kernel.links.extend(links);
                continue;
            }
            let common = if of_patch { &common } else { &with_forces };
            let unit = pass.add(Unit { common: common.clone(), own: stage.own.clone(), variables, links });
            let call = (unit, stage.call.clone());
            match &stage.rows {
                Rows::Patch => sums.push(call),
                Rows::All => calls.push(call),
                Rows::Some(_) => {
                    let list = names.fresh("rows".into(), None, number);
                    calls.push(pass.at_rows(call, list.into_owned(), number, stages.len() == 1));
                }
            }
            finish.extend(stage.finish.map(|finish| (unit, finish.into())));
        }
        let links = [("sum_all", sums), ("call_all", calls), ("finish_all", finish)];
        pass.kernel.links.extend(links.map(|(function, calls)| Link { function: function.into(), calls }));
        pass.kernel.fragments.extend(frame.own);
        drop(pass.kernel.bindings.splice(..0, columns));
        pass
    }

    fn add(&mut self, unit: Unit) -> UnitId {
        self.kernel.units.push(unit);
        UnitId(self.kernel.units.len() - 1)
    }

    /// What calls a stage for some nodes only: for rows of its list, or, where others share the kernel, for nodes that
    /// are on it.
    fn at_rows(
        &mut self,
        call: (UnitId, Cow<'static, str>),
        list: String,
        number: usize,
        single: bool,
    ) -> (UnitId, Cow<'static, str>) {
        let body = match single {
            true => "    call(node, list[node]);\n",
            false => {
                "    let place = list[node - pass_rows.first];\n    if place != 0xffffffffu { call(place, node); }\n"
            }
        };
        let text = format!(
            "@group(0) @binding(0) var<storage, read> list: array<u32>;\nfn call(i: u32, node: u32) {{}}\n\
             fn call_at_rows(node: u32) {{\n{body}}}\n"
        );
        let unit = Unit {
            common: vec![shader!("pass_rows")],
            own: vec![Fragment::new("generated: rows of a system", text)],
            variables: vec![("list".into(), list.clone().into())],
            links: vec![Link { function: "call".into(), calls: vec![call] }],
        };
        self.lists.push((list, number));
        (self.add(unit), "call_at_rows".into())
    }

    /// The kernel, for composing.
    pub fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// The kernel of some rows.
    pub(super) fn into_kernel(self, stages: &[&NodeStage], rows: PassRows, buffers: &mut dyn Buffers) -> Kernel {
        let mut kernel = self.kernel;
        for (variable, number) in self.lists {
            let NodeStage { system, within, rows: Rows::Some(rows), .. } = stages[number] else { continue };
            let list = match stages {
                [_] => buffers.constants(format!("rows of {system}"), bytemuck::cast_slice(rows)),
                _ => buffers.constants(format!("places of {system}"), bytemuck::cast_slice(&places(rows, within))),
            };
            kernel = kernel.bind(variable, list);
        }
        let pass = buffers.uniform(format!("rows of {}", kernel.label), &rows.bytes());
        kernel.bind_uniform::<PassRows>(PASS_ROWS, pass)
    }
}

/// The variable of `shaders/pass_rows.wgsl`.
const PASS_ROWS: &str = "pass_rows";

/// Names of the buffers that an entry point writes.
pub fn written<'a>(composed: &'a Composed, entry: &EntryPoint) -> BTreeSet<&'a str> {
    let used = entry.uses.iter().map(|i| &composed.bindings[*i]);
    used.filter(|binding| binding.kind == BindingKind::ReadWrite).map(|binding| binding.name.as_str()).collect()
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
    let patch_local = do_with_them(Forces::Sums) && do_with_them(Forces::UsesUp);
    let loaded = stages.iter().any(|stage| stage.loaded);
    let integrates = do_with_them(Forces::UsesUp) || do_with_them(Forces::AsksFor);
    let mut fragments = Vec::new();
    match (inner, patch_local) {
        (true, true) => fragments.push(shader!("internal_force_local")),
        (true, false) => fragments.push(shader!("internal_force")),
        (false, _) if integrates => fragments.push(Fragment::new(
            "generated: no forces of elements",
            "fn internal_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n",
        )),
        (false, _) => {}
    }
    match (outer && loaded, patch_local) {
        (true, true) => fragments.push(shader!("external_force_local")),
        (true, false) => fragments.push(shader!("external_force")),
        (false, _) if inner || integrates => fragments.push(Fragment::new(
            "generated: no loads",
            "fn clear_loads(node: u32) {}\nfn external_force_of(node: u32) -> vec3<f32> {\n    return vec3<f32>(0.0);\n}\n",
        )),
        (false, _) => {}
    }
    fragments
}
