//! The kernels of `glue`. In a step, for each body: where its tied nodes are (`shaders/glue_place.wgsl`), and where
//! they would go (`surface_contact_foresee`, and `surface_contact_hold` where tools may hold it); how far its ties are
//! off (`glue`). Then for all: into how many shares masses are split (`glue_share`), and in each sweep the forces
//! (`glue_correct`) and what they do to nodes (`glue_apply`). At last, for each body: what becomes of its ties
//! (`glue_note`), and its loads (`glue_push`).

use super::work::{TieNodes, nodes_of, parts_of};
use super::{BROKE, HOLDS};
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::shader;
use crate::systems::surface_contact::{FORESEEN_NUMBERS, ForeseenNodes, note_farther};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How many there are, and where in `glue_ties` things begin; nodes and ties of the body whose columns are bound.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct GlueTies {
    nodes: u32,
    ties: u32,
    first_node: u32,
    node_count: u32,
    first_tie: u32,
    tie_count: u32,
    parts: u32,
    inverse: u32,
    relaxed: u32,
}
uniform!(GlueTies { nodes, ties, first_node, node_count, first_tie, tie_count, parts, inverse, relaxed });

/// Words of a tie in `glue_ties`, and numbers that a step finds of it.
const TIE_WORDS: usize = 21;
const FOUND_NUMBERS: usize = 13;

/// All ties, in the order in which kernels have them: by bodies of points, then as in the scene.
struct Tied<'a> {
    glue: &'a Glue,
    nodes: Vec<(usize, u32)>,
    ties: Vec<&'a TiedPoint>,
    /// Of each.
    parts: Vec<TieNodes>,
}

impl<'a> Tied<'a> {
    fn of(glue: &'a Glue) -> Self {
        let nodes = nodes_of(glue);
        let mut ties: Vec<&TiedPoint> = glue.ties.iter().collect();
        ties.sort_by_key(|tie| tie.bodies[0]);
        let parts = ties.iter().map(|tie| parts_of(tie, &nodes)).collect();
        Self { glue, nodes, ties, parts }
    }

    /// Where a node is at rest (m, from the reference).
    fn rest(&self, (body, row): (usize, u32), world: &World) -> DVec3 {
        let rest = world.get::<RestPosition>(self.glue.bodies[body]);
        rest.map_or(DVec3::ZERO, |rest| rest.0[row as usize] - self.glue.reference)
    }

    /// Words of `glue_ties`, and where the parts of ties and the ties of nodes begin.
    fn words(&self, world: &World) -> (Vec<u32>, [usize; 2]) {
        let (mut words, mut parts) = (Vec::new(), Vec::new());
        let mut of_nodes: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.nodes.len()];
        for (number, (tie, TieNodes { parts: of_tie, corners })) in self.ties.iter().zip(&self.parts).enumerate() {
            words.extend([parts.len() / 2, parts.len() / 2 + of_tie.len()].map(|part| part as u32));
            words.extend(corners);
            let at = |node: u32| self.rest(self.nodes[node as usize], world);
            let [a, b, c] = corners.map(at);
            let off: DVec3 = of_tie.iter().map(|&(node, weight)| at(node) * weight).sum();
            for vector in [tie.gap, b - a, c - a, off] {
                words.extend(vector.as_vec3().to_array().map(f32::to_bits));
            }
            words.extend(strength(tie.strength));
            words.push(tie.place as u32);
            for &(node, weight) in of_tie {
                let weight = (weight as f32).to_bits();
                parts.extend([node, weight]);
                of_nodes[node as usize].push([number as u32, weight]);
            }
        }
        debug_assert_eq!(words.len(), TIE_WORDS * self.ties.len());
        let begin = words.len();
        words.extend(parts);
        let inverse = words.len();
        let mut ends = 0;
        words.push(0);
        words.extend(of_nodes.iter().map(|ties| {
            ends += ties.len() as u32;
            ends
        }));
        words.extend(of_nodes.into_iter().flatten().flatten());
        (words, [begin, inverse])
    }

    /// Nodes or ties of a body: the first, and how many.
    fn range(of_body: impl Iterator<Item = usize>, body: usize) -> [u32; 2] {
        let (mut first, mut count) = (0, 0);
        for other in of_body {
            first += u32::from(other < body);
            count += u32::from(other == body);
        }
        [first, count]
    }
}

/// What bounds a force: 0 for nothing, 1 for what it may be, 2 for parts of it, off and along; and these numbers.
fn strength(strength: Strength) -> [u32; 3] {
    // infinity is no number that a shader must know
    let number = |number: f64| (number as f32).min(f32::MAX).to_bits();
    match strength {
        Strength::Any => [0; 3],
        Strength::Force(most) => [1, number(most), 0],
        Strength::Stress { area, normal, shear } => [2, number(1.0 / (area * normal)), number(1.0 / (area * shear))],
    }
}

/// Buffers that all have.
struct Shared {
    ties: BufferId,
    /// Fifteen numbers a node: displacement, next step, last step, response, last step for work that is counted.
    nodes: BufferId,
    shares: BufferId,
    /// What a step finds of ties.
    found: BufferId,
}

impl Shared {
    fn kernel(&self, entry: &'static str, text: Fragment, of: BufferId, world: &World) -> Kernel {
        let kernel = Kernel::new(entry, entry)
            .fragment(text)
            .fragment(shader!("glue_ties"))
            .fragment(shader!("row"))
            .bind_uniform::<GlueTies>("glue_of", of);
        with_step(kernel, world)
    }

    /// One that asks which ties there are and what a step has found of them.
    fn of_ties(&self, entry: &'static str, text: Fragment, of: BufferId, world: &World) -> Kernel {
        self.kernel(entry, text, of, world).bind("glue_ties", self.ties).bind("glue_found", self.found)
    }

    fn with_nodes(&self, kernel: Kernel) -> Kernel {
        kernel.bind("glue_nodes", self.nodes)
    }

    /// Constants of the state of a tie, the same here and there.
    fn with_state(kernel: Kernel, body: Entity, buffers: &mut dyn Buffers) -> Kernel {
        let text = format!(
            "const TIE_NUMBERS: u32 = {TIE_NUMBERS}u;\nconst HOLDS: f32 = {HOLDS:?};\nconst BROKE: f32 = {BROKE:?};\n"
        );
        kernel
            .fragment(Fragment::new("generated: what is kept of a tie", text))
            .bind(TieState::NAME, buffers.column(body, TieState::NAME))
    }
}

/// See the module.
pub(super) fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let Some(glue) = world.get_resource::<Glue>().cloned() else { return Vec::new() };
    let world = &*world;
    let tied = Tied::of(&glue);
    let (words, [parts, inverse]) = tied.words(world);
    let (nodes, ties) = (tied.nodes.len(), tied.ties.len());
    let rows: Vec<u32> = tied.nodes.iter().flat_map(|&(_, row)| [row, 0, 0, 0]).collect();
    let rows = buffers.constants("rows of tied nodes".into(), bytemuck::cast_slice(&rows));
    let shared = Shared {
        ties: buffers.constants("ties".into(), bytemuck::cast_slice(&words)),
        nodes: buffers.constants("nodes that are tied".into(), &vec![0; 4 * FORESEEN_NUMBERS * nodes]),
        shares: buffers.constants("shares of nodes that are tied".into(), &vec![0; 4 * nodes]),
        found: buffers.constants("forces of ties".into(), &vec![0; 4 * FOUND_NUMBERS * ties]),
    };
    let whole = GlueTies {
        nodes: nodes as u32,
        ties: ties as u32,
        first_node: 0,
        node_count: nodes as u32,
        first_tie: 0,
        tie_count: ties as u32,
        parts: parts as u32,
        inverse: inverse as u32,
        relaxed: u32::from(world.resource::<Clock>().relaxation.is_some()),
    };
    let of_whole = buffers.uniform("glue".into(), &whole.bytes());
    let of_bodies: Vec<(Entity, GlueTies, BufferId)> = (0..)
        .zip(&glue.bodies)
        .map(|(body, &entity)| {
            let [first_node, node_count] = Tied::range(tied.nodes.iter().map(|(of, _)| *of), body);
            let [first_tie, tie_count] = Tied::range(tied.ties.iter().map(|tie| tie.bodies[0]), body);
            let of = GlueTies { first_node, node_count, first_tie, tie_count, ..whole };
            (entity, of, buffers.uniform("glue of a body".into(), &of.bytes()))
        })
        .filter(|(_, of, _)| of.node_count > 0)
        .collect();
    let mut all = Vec::new();
    for &(body, of, uniform) in &of_bodies {
        let place = shared.with_nodes(shared.kernel("glue_place", shader!("glue_place"), uniform, world));
        let columns = [Displacement::NAME, DisplacementIncrement::NAME];
        let place = columns.into_iter().fold(place, |kernel, name| kernel.bind(name, buffers.column(body, name)));
        all.push(place.bind("glue_rows", rows).threads(of.node_count));
        let foreseen = ForeseenNodes::new([rows, shared.nodes], [of.first_node, of.node_count], buffers);
        all.push(foreseen.foresee("glue_foresee", body, world, buffers));
        let own = &tied.nodes[of.first_node as usize..][..of.node_count as usize];
        let place = |row| own.binary_search_by_key(&row, |node| node.1).ok().map(|place| of.first_node + place as u32);
        all.extend(foreseen.hold("glue_hold", body, place, world, buffers));
    }
    let of_ties = |entry, text: Fragment, body, of: GlueTies, uniform, buffers: &mut dyn Buffers| {
        let kernel = shared.with_nodes(shared.of_ties(entry, text, uniform, world));
        Shared::with_state(kernel, body, buffers).threads(of.tie_count)
    };
    for &(body, of, uniform) in of_bodies.iter().filter(|(_, of, _)| of.tie_count > 0) {
        all.push(of_ties("glue", shader!("glue"), body, of, uniform, buffers));
    }
    let of_all = |entry, text, threads: usize| shared.of_ties(entry, text, of_whole, world).threads(threads as u32);
    all.push(of_all("glue_share", shader!("glue_share"), nodes).bind("glue_shares", shared.shares));
    let correct = shared.with_nodes(of_all("glue_correct", shader!("glue_correct"), ties));
    all.push(correct.bind("glue_shares", shared.shares).repeated());
    let apply = of_all("glue_apply", shader!("glue_apply"), nodes).fragment(shader!("glue_forces"));
    all.push(shared.with_nodes(apply).repeated());
    for &(body, of, uniform) in of_bodies.iter().filter(|(_, of, _)| of.tie_count > 0) {
        all.push(of_ties("glue_note", shader!("glue_note"), body, of, uniform, buffers));
    }
    for &(body, of, uniform) in &of_bodies {
        let push = shared.of_ties("glue_push", shader!("glue_push"), uniform, world).fragment(shader!("glue_forces"));
        let (text, columns) = note_farther(body, world);
        let push = text.into_iter().fold(push, Kernel::fragment);
        let push = columns.iter().fold(push, |push, name| push.bind(*name, buffers.column(body, name)));
        let push = shared.with_nodes(push).bind(ExternalForce::NAME, buffers.column(body, ExternalForce::NAME));
        all.push(push.bind("glue_rows", rows).threads(of.node_count));
    }
    all
}
