//! What contact between bodies costs on the CPU (C32): whole steps of three blocks without contact, with contact where
//! nothing is near, and with a quarter of the surface touching, with nodes and with points of faces; and how long lists
//! take that tell what is near what.
//!
//! `cargo bench --bench contact`; `-- quick` leaves the large ones out, `-- near` runs only steps with a quarter that
//! touches, for profiles. Steps are timed in blocks by turns, and the best of each counts: so other work on the machine
//! does not.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::Precision;
use sinew::systems::SurfaceContacts;
use sinew::{BackendChoice, Options, SceneFile, Simulation};
use std::path::Path;
use std::time::Instant;

/// Steps that are timed at once, and how often.
const BLOCK: u64 = 8;
const TURNS: usize = 60;

/// Three blocks of 2 cm one above the other, so far apart (m), the lowest held; the middle one is turned, so that no
/// node meets another.
fn blocks(elements: &str, cells: u32, apart: f64, points: Option<&str>) -> String {
    let block = |name: &str, place: &str| {
        format!(
            "\"{name}\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements}), \
             material: \"m\", {place})"
        )
    };
    let (middle, high) = (0.02 + apart, 2.0 * (0.02 + apart));
    let bodies = [
        block("low", ""),
        block("middle", &format!("rotate: (0, 0, 10), translate: (0.002, -0.0015, {middle})")),
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
        if apart > 1e-4 { String::new() } else { gravity.concat() }
    )
}

fn start(text: &str, threads: usize) -> Simulation {
    let scene = SceneFile::from_text("blocks", text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let options = Options { backend: BackendChoice::Cpu, precision: Precision::F32, threads, ..Options::default() };
    Simulation::new(&scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// Whole steps, and what contact adds to them.
fn shares((elements, points): (&str, &str), cells: u32, threads: usize) {
    let texts = [(0.01, None), (0.01, Some(points)), (0.0, None), (0.0, Some(points))]
        .map(|(apart, points)| blocks(elements, cells, apart, points));
    let mut all = texts.map(|text| start(&text, threads));
    let mut best = [f64::INFINITY; 4];
    // until they bear each other
    all[3].advance(200).unwrap();
    let before = all[3].world().resource::<SurfaceContacts>().figures();
    for _ in 0..TURNS {
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
    println!(
        "{elements} 3 x {cells}^3, points: {points}, {threads} thread(s): {:.1} us a step; nothing near {:+.1} %; {:.0} % of \
         {all_points} points near {:+.1} % ({:.0} ns a point near; {:.0} contacts; {faces} faces; {:.0} steps between lists)",
        best[2] * 1e6,
        100.0 * (best[1] / best[0] - 1.0),
        100.0 * near / all_points as f64,
        100.0 * (best[3] / best[2] - 1.0),
        (best[3] - best[2]) * 1e9 / near,
        (after.contacts - before.contacts) as f64 / steps,
        steps / (after.builds - before.builds).max(1) as f64,
    );
}

/// How long lists take, found by making them in every step and in none.
fn lists(cells: u32) {
    let text = blocks("Hex8", cells, 0.0, Some("Nodes"))
        .replace("rotate: (0, 0, 10)", "rotate: (0, 0, 10), velocity: (1e-4, 0, 0)");
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

fn main() {
    let asked = |word: &str| std::env::args().any(|argument| argument == word);
    if asked("near") {
        let mut near = start(&blocks("Hex8", 8, 0.0, Some("Nodes")), 1);
        return near.advance(20000).unwrap();
    }
    let [nodes, faces] = [("Tet4", "Nodes"), ("Tet4", "Faces")];
    shares(("Hex8", "Nodes"), 8, 1);
    shares(nodes, 12, 1);
    shares(faces, 12, 1);
    lists(24);
    if asked("quick") {
        return;
    }
    shares(nodes, 24, 1);
    shares(nodes, 24, 2);
    shares(faces, 24, 1);
    lists(76);
}
