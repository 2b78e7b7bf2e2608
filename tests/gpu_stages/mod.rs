//! Stages of different authors in one kernel: each names things as it likes.

use sinew::backend::Buffers;
use sinew::backend::gpu::{BufferKind, Gpu, gpu_or_reason};
use sinew::backend::kernel::{BufferId, Composed, Fragment, Kernel, KernelError, MostBuffers};
use sinew::backend::node_stage::{NodeStage, node_kernels};
use sinew::bevy_ecs::entity::Entity;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Nodes: more than a workgroup has.
const NODES: u32 = 100;

/// Scales and shifts; laid out in one line, with a struct in a struct, constants that are folded, and what begins with
/// a value.
const SCALE: &str = "struct Part { scale: f32, @align(16) more: Inner } struct Inner { shift: f32 } @group(0) @binding(0) var<uniform> load: Part; @group(0) @binding(0) var<storage, read_write> state: array<f32>; const SIZE = 1 + 2; const FACTOR = array<f32, SIZE>(1.0, 2.0, 4.0); var<private> sum: f32 = 1.0; fn helper(x: f32) -> f32 { sum += x; return FACTOR[u32(x) % 3u] * sum; } fn act(node: u32) { state[node] = helper(state[node]) * load.scale + load.more.shift; }";

/// Takes away: other things under the same names, one of WGSL's own functions among them.
const LESS: &str = "alias Number = f32;
struct Part { more: Number, scale: vec2<f32> }
@group(0) @binding(3) var<uniform> load: Part;
@group(0) @binding(3)
var<storage, read_write>
    state : array<Number>;
/* fn act(node: u32) {} */ const FACTOR: f32 = -3.0;
var<private> sum: vec2<f32> = vec2<f32>(10.0, 20.0);
fn max(a: Number, b: Number) -> Number { return a - b; }
fn helper(x: Number) -> Number { sum.y -= x; return FACTOR * sum.y + sum.x; }
fn act(node: u32) { state[node] = max(helper(state[node]), load.scale.y * load.more); }
";

/// WGSL's own `max`, and what the other end of sixty-four has.
const TURN: &str = "@group(0) @binding(0) var<storage, read_write> state: array<f32>;
@group(0) @binding(0) var<storage, read_write> turned: array<f32>;
@group(0) @binding(0) var<storage, read> spare: array<f32>;
var<workgroup> sum: array<f32, 64>;
fn act(node: u32) { state[node] = max(state[node], -1e3); }
fn turn(local: u32, node: u32) {
    if node < arrayLength(&state) { sum[local] = state[node]; }
    workgroupBarrier();
    if node < arrayLength(&state) { turned[node] = sum[63u - local]; }
}
";

/// Some nodes only.
const SOME: &str = "@group(0) @binding(0) var<storage, read_write> state: array<f32>;
@group(0) @binding(0) var<storage, read> rows: array<f32>;
fn act(i: u32, node: u32) { state[node] += rows[i]; }
";

struct OnGpu<'a> {
    gpu: &'a mut Gpu,
    columns: BTreeMap<&'static str, BufferId>,
    most: MostBuffers,
}

impl Buffers for OnGpu<'_> {
    fn column(&mut self, _: Entity, name: &'static str) -> BufferId {
        self.columns[name]
    }
    fn constants(&mut self, label: String, bytes: &[u8]) -> BufferId {
        self.gpu.create_with(&label, bytes, BufferKind::Storage).unwrap()
    }
    fn uniform(&mut self, label: String, bytes: &[u8]) -> BufferId {
        self.gpu.create_with(&label, bytes, BufferKind::Uniform).unwrap()
    }
    fn most_buffers(&self) -> MostBuffers {
        self.most
    }
    fn compose(&mut self, kernel: &Kernel) -> Result<Arc<Composed>, KernelError> {
        self.gpu.compose(kernel)
    }
}

fn stage(path: &'static str, text: &'static str, state: BufferId) -> NodeStage {
    NodeStage::new(path, "act", Entity::PLACEHOLDER, NODES, Fragment::new(path, text)).column("state", state)
}

fn four_stages(buffers: &mut OnGpu<'_>) -> Vec<NodeStage> {
    let [state, turned] = ["state", "turned"].map(|name| buffers.columns[name]);
    let scale = buffers.uniform("scale".into(), bytemuck::cast_slice(&[3.0f32, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]));
    let less = buffers.uniform("less".into(), bytemuck::cast_slice(&[2.0f32, 0.0, 7.0, 0.25]));
    let rows: Vec<u32> = (0..NODES).filter(|row| row % 7 == 3).collect();
    let added: Vec<f32> = rows.iter().map(|&row| 0.125 * row as f32).collect();
    let added = buffers.constants("added".into(), bytemuck::cast_slice(&added));
    let spare = buffers.constants("spare".into(), &[0; 4]);
    vec![
        stage("scale.wgsl", SCALE, state).bind("load", scale),
        stage("less.wgsl", LESS, state).bind("load", less),
        stage("some.wgsl", SOME, state).bind("rows", added).of_rows(rows),
        stage("turn.wgsl", TURN, state).column("turned", turned).bind("spare", spare).finish("turn"),
    ]
}

/// The same on the host.
fn expected() -> (Vec<f32>, Vec<f32>) {
    let state: Vec<f32> = (0..NODES)
        .map(|node| {
            let x = node as f32;
            let scaled = [1.0, 2.0, 4.0][node as usize % 3] * (1.0 + x) * 3.0 + 0.5;
            let less = (-3.0 * (20.0 - scaled) + 10.0) - 0.25 * 2.0;
            (less + if node % 7 == 3 { 0.125 * x } else { 0.0 }).max(-1e3)
        })
        .collect();
    let turned = (0..NODES as usize).map(|node| {
        let other = node / 64 * 64 + 63 - node % 64;
        // beyond the last node nothing has been written
        state.get(other).copied().unwrap_or(f32::NAN)
    });
    (state.clone(), turned.collect())
}

fn run(fuse: bool, most: MostBuffers) -> Option<(usize, Vec<f32>, Vec<f32>)> {
    let mut gpu = gpu_or_reason()?;
    let first: Vec<f32> = (0..NODES).map(|node| node as f32).collect();
    let state = gpu.create_with("state", &first, BufferKind::Storage).unwrap();
    let turned = gpu.create_with("turned", &[0.0f32; NODES as usize], BufferKind::Storage).unwrap();
    let columns = BTreeMap::from([("state", state), ("turned", turned)]);
    let mut buffers = OnGpu { gpu: &mut gpu, columns, most };
    let stages = four_stages(&mut buffers);
    let kernels = node_kernels(stages, fuse, &mut buffers);
    let prepared: Vec<_> =
        kernels.iter().map(|kernel| gpu.prepare(kernel).unwrap_or_else(|error| panic!("{error}"))).collect();
    gpu.run_once(&prepared).unwrap();
    Some((kernels.len(), gpu.download_rows(state).unwrap(), gpu.download_rows(turned).unwrap()))
}

#[test]
fn stages_with_the_same_names_for_other_things_do_what_they_do_alone() {
    let (state, turned) = expected();
    for (fuse, count) in [(true, 1), (false, 4)] {
        let Some((kernels, found, found_turned)) = run(fuse, MostBuffers::DESKTOP) else { return };
        assert_eq!(kernels, count);
        assert_eq!(found, state);
        let there = turned.iter().zip(&found_turned).filter(|(expected, _)| !expected.is_nan());
        assert!(there.clone().count() > 64 && there.clone().all(|(expected, found)| expected == found));
    }
}

/// Storage buffers that they use: state, added, places, turned; declared, but unused: spare.
#[test]
fn only_buffers_that_are_used_count() {
    let Some((kernels, ..)) = run(true, MostBuffers::new(4, 3)) else { return };
    assert_eq!(kernels, 1);
    // less some.wgsl, all fits into two
    let Some((kernels, state, _)) = run(true, MostBuffers::new(3, 3)) else { return };
    assert_eq!((kernels, state), (2, expected().0));
    let Some((kernels, ..)) = run(true, MostBuffers::new(4, 2)) else { return };
    assert_eq!(kernels, 2);
}

/// What is said of a stage with this text, and of the same behind another stage.
fn refusals(text: &'static str) -> Option<[String; 2]> {
    let mut gpu = gpu_or_reason()?;
    let state = gpu.create_with("state", &[0.0f32; NODES as usize], BufferKind::Storage).unwrap();
    let columns = BTreeMap::from([("state", state), ("turned", state)]);
    let mut buffers = OnGpu { gpu: &mut gpu, columns, most: MostBuffers::DESKTOP };
    let first = four_stages(&mut buffers).swap_remove(0);
    let kernels = [vec![stage("mine.wgsl", text, state)], vec![first, stage("mine.wgsl", text, state)]]
        .map(|stages| node_kernels(stages, true, &mut buffers));
    Some(kernels.map(|kernels| {
        let wrong = kernels.iter().filter_map(|kernel| gpu.prepare(kernel).err());
        wrong.map(|error| error.to_string()).collect()
    }))
}

#[test]
fn mistakes_of_a_stage_are_told_at_their_place_in_its_own_text() {
    let declared = "@group(0) @binding(0) var<storage, read_write> state: array<f32>;\n";
    let cases = [
        ("// nothing\nfn act(node: u32) { let x = 1.0 +; }", "mine.wgsl:3:34", "expected expression"),
        ("fn act(node: u32) {\n    state[node] = sum;\n}", "mine.wgsl:3:19", "no definition in scope"),
        ("fn f(x: f32) {}\nfn act(node: u32, x: f32) {}", "mine.wgsl:3:1", "it must be: fn act(node: u32)"),
        ("fn pull(node: u32) {}", "no function `act` in mine.wgsl", "there is pull"),
        ("override scale: f32 = 2.0;\nfn act(node: u32) {}", "mine.wgsl:2:", "`scale` is an `override`"),
    ];
    for (text, place, message) in cases {
        let text: &'static str = format!("{declared}{text}").leak();
        let Some(told) = refusals(text) else { return };
        for told in told {
            assert!(told.contains(place) && told.contains(message), "{text}\n{told}");
        }
    }
}

/// A column is of one type to a kernel: stages that see it otherwise are in kernels of their own.
#[test]
fn a_column_of_another_type_is_seen_in_a_kernel_of_its_own() {
    let Some(mut gpu) = gpu_or_reason() else { return };
    let state = gpu.create_with("state", &[1.0f32; NODES as usize], BufferKind::Storage).unwrap();
    let mut buffers = OnGpu { gpu: &mut gpu, columns: BTreeMap::new(), most: MostBuffers::DESKTOP };
    let floats = "@group(0) @binding(0) var<storage, read_write> state: array<f32>;\n\
                  fn act(node: u32) { state[node] += 1.0; }";
    let words = "@group(0) @binding(0) var<storage, read_write> state: array<u32>;\n\
                 fn act(node: u32) { state[node] ^= 0x80000000u; }";
    let stages = vec![stage("floats.wgsl", floats, state), stage("words.wgsl", words, state)];
    let kernels = node_kernels(stages, true, &mut buffers);
    assert_eq!(kernels.len(), 2);
    let prepared: Vec<_> = kernels.iter().map(|kernel| gpu.prepare(kernel).unwrap()).collect();
    gpu.run_once(&prepared).unwrap();
    assert_eq!(gpu.download_rows::<f32>(state).unwrap(), [-2.0; NODES as usize]);
}
