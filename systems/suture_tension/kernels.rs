//! The kernels of `suture_tension`. In a step, for each body: where ends of threads are in it
//! (`shaders/suture_tension_place.wgsl`); how hard its threads pull (`suture_tension`), which are those whose first end
//! it has; and what that is to its nodes (`suture_tension_pull`).

use super::{CAME_OUT, HOLDS, TORE};
use crate::backend::Buffers;
use crate::backend::kernel::{BufferId, Fragment, Kernel, Uniform, uniform};
use crate::backend::step::with_step;
use crate::components::*;
use crate::shader;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// The part of a body: ends, threads or nodes from the first on.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct ThreadsOf {
    first: u32,
    count: u32,
    relaxed: u32,
}
uniform!(ThreadsOf { first, count, relaxed });

/// Ends, threads and pulled nodes, each by bodies.
struct Threads<'a> {
    sutures: &'a Sutures,
    bodies: Vec<Entity>,
    /// Places in [`Sutures::all`], and which end it is.
    ends: Vec<(usize, usize)>,
    /// Places in [`Sutures::all`].
    threads: Vec<usize>,
}

impl<'a> Threads<'a> {
    fn of(sutures: &'a Sutures) -> Self {
        let end = |&(suture, side): &(usize, usize)| &sutures.all[suture].ends[side];
        let mut ends: Vec<(usize, usize)> =
            (0..sutures.all.len()).flat_map(|suture| [(suture, 0), (suture, 1)]).collect();
        ends.sort_by_key(|place| end(place).body);
        let mut threads: Vec<usize> = (0..sutures.all.len()).collect();
        threads.sort_by_key(|&suture| sutures.all[suture].ends[0].body);
        let mut bodies: Vec<Entity> = ends.iter().map(|place| end(place).body).collect();
        bodies.dedup();
        Self { sutures, bodies, ends, threads }
    }

    fn end(&self, (suture, side): (usize, usize)) -> &'a Anchor {
        &self.sutures.all[suture].ends[side]
    }

    /// Words of `suture_ends`: where the nodes of each end begin, and after them these: row, weight and mass at the
    /// start.
    fn end_words(&self, world: &World) -> Vec<u32> {
        let (mut starts, mut nodes) = (vec![0], Vec::new());
        for end in self.ends.iter().map(|&place| self.end(place)) {
            let sutured = world.get::<Sutured>(end.body);
            let start = |row: u32| sutured.and_then(|of| Some(of.masses[of.place(row)?])).unwrap_or(0.0);
            for &(row, weight) in &end.nodes {
                nodes.extend([row, (weight as f32).to_bits(), (start(row) as f32).to_bits()]);
            }
            starts.push(nodes.len() as u32 / 3);
        }
        starts.into_iter().chain(nodes).collect()
    }

    /// Words of `suture_threads`: 11 a thread.
    fn thread_words(&self, world: &World) -> Vec<u32> {
        let mut place_of = vec![[0; 2]; self.sutures.all.len()];
        self.ends.iter().enumerate().for_each(|(place, &(suture, side))| place_of[suture][side] = place as u32);
        let rest = |end: &Anchor| -> DVec3 {
            let Some(rest) = world.get::<RestPosition>(end.body) else { return DVec3::ZERO };
            end.nodes.iter().map(|&(row, weight)| weight * (rest.0[row as usize] - self.sutures.reference)).sum()
        };
        let mut words = Vec::new();
        for &suture in &self.threads {
            let Suture { ends, stiffness, length, tighten, signal, strength, place, .. } = &self.sutures.all[suture];
            let way = rest(&ends[1]) - rest(&ends[0]);
            words.extend(place_of[suture]);
            words.extend(way.as_vec3().to_array().map(f32::to_bits));
            // infinity is no number that a shader must know
            let numbers = [*stiffness, length.unwrap_or(0.0), *tighten, *strength];
            words.extend(numbers.map(|number| (number as f32).min(f32::MAX).to_bits()));
            words.extend([*signal as u32, *place as u32]);
        }
        words
    }

    /// Words of `suture_pulled`: where the threads at each of a body's sutured nodes begin, and after them these:
    /// thread and weight, which is negative of second ends.
    fn pulled_words(&self, body: Entity, sutured: &Sutured) -> Vec<u32> {
        let mut of_nodes: Vec<Vec<[u32; 2]>> = vec![Vec::new(); sutured.rows.len()];
        for (thread, &suture) in (0..).zip(&self.threads) {
            for (end, sign) in self.sutures.all[suture].ends.iter().zip([1.0, -1.0]).filter(|(end, _)| end.body == body)
            {
                for &(row, weight) in &end.nodes {
                    let Some(place) = sutured.place(row) else { continue };
                    of_nodes[place].push([thread, ((sign * weight) as f32).to_bits()]);
                }
            }
        }
        let mut ends = 0;
        let starts = of_nodes.iter().map(|threads| {
            ends += threads.len() as u32;
            ends
        });
        let starts: Vec<u32> = std::iter::once(0).chain(starts).collect();
        starts.into_iter().chain(of_nodes.iter().flatten().flatten().copied()).collect()
    }

    /// Of things that are in bodies, in the order of these: which are in one.
    fn range(of: impl Iterator<Item = Entity>, body: Entity) -> [u32; 2] {
        let (mut first, mut count) = (0, 0);
        for other in of {
            first += u32::from(other < body);
            count += u32::from(other == body);
        }
        [first, count]
    }
}

/// Constants of the state of a suture, the same here and there.
fn state_constants() -> Fragment {
    let states = [("HOLDS", HOLDS), ("TORE", TORE), ("CAME_OUT", CAME_OUT)];
    let states = states.map(|(name, number)| format!("const {name}: f32 = {number:?};\n")).concat();
    let text = format!("const SUTURE_NUMBERS: u32 = {SUTURE_NUMBERS}u;\n{states}");
    Fragment::new("generated: what is kept of a suture", text)
}

/// See the module.
pub(super) fn kernels(world: &mut World, buffers: &mut dyn Buffers) -> Vec<Kernel> {
    let Some(sutures) = world.get_resource::<Sutures>().cloned() else { return Vec::new() };
    let world = &*world;
    let all = Threads::of(&sutures);
    let relaxed = u32::from(world.resource::<Clock>().relaxation.is_some());
    let words = |label: &str, words: &[u32], buffers: &mut dyn Buffers| {
        buffers.constants(label.into(), bytemuck::cast_slice(words))
    };
    let ends = words("ends of sutures", &all.end_words(world), buffers);
    let threads = words("sutures", &all.thread_words(world), buffers);
    let places = words("places of ends of sutures", &vec![0; 4 * all.ends.len()], buffers);
    let pulls = words("forces of sutures", &vec![0; 3 * all.threads.len()], buffers);
    let kernel = |entry: &'static str, text: Fragment, [first, count]: [u32; 2], buffers: &mut dyn Buffers| {
        let of: BufferId = buffers.uniform(format!("{entry} of a body"), &ThreadsOf { first, count, relaxed }.bytes());
        let kernel = Kernel::new(entry, entry).fragment(text).fragment(shader!("row"));
        kernel.bind_uniform::<ThreadsOf>("threads", of).threads(count)
    };
    let (mut place, mut pull, mut tension) = (Vec::new(), Vec::new(), Vec::new());
    for &body in &all.bodies {
        let range = Threads::range(all.ends.iter().map(|&end| all.end(end).body), body);
        let of_ends = kernel("suture_tension_place", shader!("suture_tension_place"), range, buffers)
            .bind("suture_ends", ends)
            .bind("suture_places", places);
        let ends_count = format!("const ENDS: u32 = {}u;\n", all.ends.len());
        let columns = [Displacement::NAME, Mass::NAME];
        let of_ends = columns.into_iter().fold(of_ends, |kernel, name| kernel.bind(name, buffers.column(body, name)));
        place.push(of_ends.fragment(Fragment::new("generated: how many ends there are", ends_count)));
        let range = Threads::range(all.threads.iter().map(|&suture| sutures.all[suture].ends[0].body), body);
        if range[1] > 0 {
            let of_threads = kernel("suture_tension", shader!("suture_tension"), range, buffers)
                .fragment(state_constants())
                .bind("suture_threads", threads)
                .bind("suture_places", places)
                .bind("suture_pulls", pulls)
                .bind(SutureState::NAME, buffers.column(body, SutureState::NAME));
            tension.push(with_step(of_threads, world));
        }
        let Some(sutured) = world.get::<Sutured>(body) else { continue };
        let pulled = words("threads at nodes", &all.pulled_words(body, sutured), buffers);
        let of_nodes =
            kernel("suture_tension_pull", shader!("suture_tension_pull"), [0, sutured.rows.len() as u32], buffers);
        let of_nodes = of_nodes.bind("suture_pulled", pulled).bind("suture_pulls", pulls);
        pull.push(of_nodes.bind(SutureForce::NAME, buffers.column(body, SutureForce::NAME)));
    }
    place.into_iter().chain(tension).chain(pull).collect()
}
