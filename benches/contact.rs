//! What contact between bodies costs on the CPU (C32): whole steps of three blocks without contact, with contact where
//! nothing is near, and with a fifth of the surface touching, at rest and sliding, with nodes and with points of faces;
//! how long lists take that tell what is near what, and what contact keeps in memory. The largest blocks have 10 092
//! triangles and 146 334 tetrahedra each.
//!
//! `cargo bench --bench contact`; `-- large` and `-- small` run only some of it, `-- turns` whole steps of 10 368 and
//! of 82 944 tetrahedra a block on one thread and on two, to compare two programs by turns (`-- turns 12` only the
//! former), `-- near` only steps with a fifth that touches, for profiles (`-- near faces`; `-- near 500` so many),
//! `-- far 2500` of blocks a centimetre apart, which fall onto each other, `-- cells 64` whole steps of blocks of 64³
//! cells (147 456 faces, 4.7 million tetrahedra, some gigabytes), `-- lists 168` lists of a million faces. Steps are
//! timed in blocks by turns, and the best of each counts: so other work on the machine does not. What lists take is
//! added, spread over the steps that they serve.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use bevy_ecs::change_detection::DetectChangesMut;
use sinew::components::{ContactForce, Precision};
use sinew::systems::SurfaceContacts;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::path::Path;
use std::time::Instant;

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Steps that are timed at once, and how often; of blocks with more cells along an edge less often.
const BLOCK: u64 = 8;
const TURNS: usize = 60;
const MANY_CELLS: u32 = 40;

/// Three blocks of 2 cm one above the other, so far apart (m), the lowest held; the middle one is turned, so that no
/// node meets another, and goes at a speed (m/s). All are heavy, or contact would have to pay for the column of loads.
fn blocks(elements: &str, cells: u32, (apart, speed): (f64, f64), points: Option<&str>) -> String {
    let block = |name: &str, place: &str| {
        format!(
            "\"{name}\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements}), \
             material: \"m\", {place})"
        )
    };
    let (middle, high) = (0.02 + apart, 2.0 * (0.02 + apart));
    let bodies = [
        block("low", ""),
        block(
            "middle",
            &format!("rotate: (0, 0, 10), translate: (0.002, -0.0015, {middle}), velocity: ({speed}, 0, 0)"),
        ),
        block("high", &format!("translate: (0, 0, {high})")),
    ];
    let contacts = points.map_or(String::new(), |points| {
        let between = |pair: &str| format!("Between(bodies: ({pair}), friction: 0.3, points: {points})");
        format!("contacts: [{}, {}],", between("\"low\", \"middle\""), between("\"middle\", \"high\""))
    });
    let gravity =
        ["low", "middle", "high"].map(|body| format!("Gravity(body: \"{body}\", acceleration: (0, 0, -9.81)), "));
    format!(
        "(duration: 1000, bodies: {{{}}}, materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 20)}},
        constraints: [Fixed(body: \"low\", on: Set(\"z0\"))], {contacts} loads: [{}], guards: (every: 1000000))",
        bodies.join(", "),
        gravity.concat()
    )
}

fn start(text: &str, threads: usize) -> Simulation {
    let scene = SceneFile::from_text("blocks", text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let options = Options { backend: BackendChoice::Cpu, precision: Precision::F32, threads, ..Options::default() };
    Simulation::new(&scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// How long lists of a simulation take (s): steps that make them, since somebody has written what bodies carry on, and
/// steps that do not, by turns.
fn build_time(simulation: &mut Simulation) -> f64 {
    let mut best = [f64::INFINITY; 2];
    for turn in 0..20 {
        let written = turn % 2;
        if written == 1 {
            let bodies = simulation.world().resource::<SurfaceContacts>().bodies.clone();
            simulation.world_mut().get_mut::<ContactForce>(bodies[0]).unwrap().set_changed();
        }
        let started = Instant::now();
        simulation.advance(1).unwrap();
        best[written] = best[written].min(started.elapsed().as_secs_f64());
    }
    (best[1] - best[0]).max(0.0)
}

/// Whole steps, and what contact adds to them.
fn shares((elements, points): (&str, &str), cells: u32, threads: usize, speed: f64) {
    let texts = [(0.01, None), (0.01, Some(points)), (0.0, None), (0.0, Some(points))]
        .map(|(apart, points)| blocks(elements, cells, (apart, speed), points));
    let mut all = texts.map(|text| start(&text, threads));
    let mut best = [f64::INFINITY; 4];
    // until they bear each other
    all[3].advance(200).unwrap();
    let before = all[3].world().resource::<SurfaceContacts>().figures();
    for _ in 0..if cells > MANY_CELLS { TURNS / 5 } else { TURNS } {
        for (simulation, best) in all.iter_mut().zip(&mut best) {
            let started = Instant::now();
            simulation.advance(BLOCK).unwrap();
            *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
        }
    }
    let contacts = all[3].world().resource::<SurfaceContacts>();
    let (after, [all_points, faces]) = (contacts.figures(), contacts.size());
    let steps = (after.steps - before.steps) as f64;
    let near = (after.examined - before.examined) as f64 / steps;
    let between = steps / (after.builds - before.builds) as f64;
    let build = build_time(&mut all[3]);
    println!(
        "{elements} 3 x {cells}^3, {speed} m/s, points: {points}, {threads} thread(s): {:.1} us a step; nothing near {:+.1} %; \
         {:.0} % of {all_points} points near {:+.1} %, with lists {:+.1} % ({:.0} ns a point near; {:.0} contacts; {faces} \
         faces; {between:.0} steps between lists, {:.2} ms each)",
        best[2] * 1e6,
        100.0 * (best[1] / best[0] - 1.0),
        100.0 * near / all_points as f64,
        100.0 * (best[3] / best[2] - 1.0),
        100.0 * ((best[3] + build / between) / best[2] - 1.0),
        (best[3] - best[2]) * 1e9 / near,
        (after.contacts - before.contacts) as f64 / steps,
        build * 1e3,
    );
}

/// How long lists take, found by making them in every step and in none.
fn lists(cells: u32) {
    let text = blocks("Hex8", cells, (0.0, 1e-4), Some("Nodes"));
    let [mut never, mut always] = [start(&text, 1), start(&text, 1)];
    never.world_mut().resource_mut::<SurfaceContacts>().skin = 1.0;
    always.world_mut().resource_mut::<SurfaceContacts>().skin = 1e-9;
    let mut best = [f64::INFINITY; 2];
    for _ in 0..20 {
        for (simulation, best) in [&mut never, &mut always].into_iter().zip(&mut best) {
            let started = Instant::now();
            simulation.advance(2).unwrap();
            *best = best.min(started.elapsed().as_secs_f64() / 2.0);
        }
    }
    let contacts = always.world().resource::<SurfaceContacts>();
    println!(
        "lists of {} faces: {:.2} ms ({} in {} steps)",
        contacts.size()[1],
        (best[1] - best[0]) * 1e3,
        contacts.figures().builds,
        contacts.figures().steps
    );
}

/// What a rigid block costs under a cube of 24³ cells: far off, and where the cube lies on it, with friction.
fn tools(elements: &str) {
    let text = |tools: &str| {
        format!(
            "(duration: 1000, bodies: {{\"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (24, 24, 24), elements: {elements}), \
             material: \"m\")}}, materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e4, poisson: 0.45), damping: 20)}},
            loads: [Gravity(acceleration: (0, 0, -9.81))], {tools} guards: (every: 1000000))"
        )
    };
    let tool = |below: f64| {
        text(&format!(
            "tools: {{\"t\": (shape: Box(size: (0.04, 0.04, 0.02)), at: (0.01, 0.01, {}))}}, \
             contacts: [Tool(tool: \"t\", friction: 0.3)],",
            -0.01 - below
        ))
    };
    let mut all = [text(""), tool(0.05), tool(0.0)].map(|text| start(&text, 1));
    all.iter_mut().for_each(|simulation| simulation.advance(100).unwrap());
    let mut best = [f64::INFINITY; 3];
    for _ in 0..TURNS {
        for (simulation, best) in all.iter_mut().zip(&mut best) {
            let started = Instant::now();
            simulation.advance(BLOCK).unwrap();
            *best = best.min(started.elapsed().as_secs_f64() / BLOCK as f64);
        }
    }
    println!(
        "{elements} 24^3 and a tool: {:.1} us a step; far off {:+.1} %; with 625 nodes on it {:+.1} %",
        best[0] * 1e6,
        100.0 * (best[1] / best[0] - 1.0),
        100.0 * (best[2] / best[0] - 1.0)
    );
}

/// What contact keeps in memory, a face: the same scene with it and without.
fn memory(points: &str, cells: u32) {
    let mut faces = 0;
    let [without, with] = [None, Some(points)].map(|points| {
        let region = Region::new(COUNTED);
        let mut simulation = start(&blocks("Tet4", cells, (0.0, 0.0), points), 1);
        simulation.advance(50).unwrap();
        faces = simulation.world().get_resource::<SurfaceContacts>().map_or(0, |contacts| contacts.size()[1]);
        let change = region.change();
        change.bytes_allocated as f64 - change.bytes_deallocated as f64
    });
    println!(
        "points: {points}: {:.0} bytes a face of {faces}, of {:.0} without contact",
        (with - without) / faces as f64,
        without / faces as f64
    );
}

fn main() {
    let asked = |word: &str| std::env::args().any(|argument| argument == word);
    let points = if asked("faces") { "Faces" } else { "Nodes" };
    if asked("near") || asked("far") {
        let apart = if asked("far") { 0.01 } else { 0.0 };
        let mut near = start(&blocks("Tet4", 12, (apart, 0.0), Some(points)), 1);
        let steps = std::env::args().find_map(|argument| argument.parse().ok());
        return near.advance(steps.unwrap_or(10000)).unwrap();
    }
    let [nodes, faces] = [("Tet4", "Nodes"), ("Tet4", "Faces")];
    let number = || std::env::args().find_map(|argument| argument.parse().ok()).expect("how many cells");
    if asked("cells") {
        return [nodes, faces].into_iter().for_each(|points| shares(points, number(), 1, 0.0));
    }
    if asked("lists") {
        return lists(number());
    }
    if asked("turns") {
        for (cells, threads) in [(12, 1), (12, 2), (24, 1), (24, 2)] {
            if [12, 24].iter().all(|only| *only == cells || !asked(&only.to_string())) {
                [nodes, faces].into_iter().for_each(|points| shares(points, cells, threads, 0.0));
            }
        }
        return;
    }
    if !asked("large") {
        shares(("Hex8", "Nodes"), 8, 1, 0.0);
        shares(nodes, 12, 1, 0.0);
        shares(faces, 12, 1, 0.0);
        lists(24);
        tools("Tet4");
        tools("Hex8");
        memory("Nodes", 24);
        memory("Faces", 24);
    }
    if !asked("small") {
        for points in [nodes, faces] {
            shares(points, 29, 1, 0.0);
            shares(points, 29, 1, 0.1);
        }
        shares(nodes, 29, 2, 0.0);
        lists(76);
    }
}
