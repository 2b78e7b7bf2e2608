//! Bodies that touch each other where tools and glue hold them, too: what contact foresees of such nodes these undo.

use crate::configurations::{configurations, cpu_and_long_gpu, near};

/// Two blocks of 2 cm on a table, of so many cells. One is pushed by 4 mm against the other, which the table holds by
/// friction.
fn pushed(elements: &str, [a, b]: [u32; 2], beside: f64) -> String {
    format!(
        "(duration: 0.5, bodies: {{
            \"a\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({a}, {a}, {a}), elements: {elements}), material: \"m\",
                translate: (-0.02, {beside}, 0)),
            \"b\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({b}, {b}, {b}), elements: {elements}), material: \"m\",
                translate: (2e-4, 0, 0))}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.4), damping: 40)}},
        tools: {{\"t\": (shape: Plane())}},
        constraints: [Prescribed(on: Set(\"x0\"), body: \"a\", axes: [X, Y], displacement: (0.004, 0, 0), curve: Smooth(end: 0.2))],
        contacts: [Tool(tool: \"t\", body: \"a\"), Tool(tool: \"t\", body: \"b\", friction: 1), Between(bodies: (\"a\", \"b\"))],
        loads: [Gravity(acceleration: (0, 0, -40))],
        probes: {{\"a\": (body: \"a\", what: ContactGap, on: All), \"b\": (body: \"b\", what: ContactGap, on: All)}})"
    )
}

/// In each step the table holds nodes that contact foresees to go: points were let in by that, deeper and deeper, by
/// 1.4 mm of the hexahedra and .24 of the tetrahedra.
#[test]
fn a_block_that_a_table_holds_is_not_gone_into() {
    for run in cpu_and_long_gpu() {
        for (elements, cells, beside) in [("Hex8MeanDilatation", [3, 3], 0.0), ("Tet4", [5, 4], 0.0013)] {
            let mut simulation = run.start(&pushed(elements, cells, beside));
            for time in [0.1, 0.2, 0.3, 0.5] {
                simulation.advance_to(time).unwrap();
                for gap in ["a", "b"].map(|body| simulation.probe(body).unwrap()[0]) {
                    near(&format!("{}, {elements}, {time} s: gap", run.name), gap.min(0.0), 0.0, 0.02, 5e-3);
                }
            }
        }
    }
}

/// Two blocks on a table, pressed from above and pushed against each other, all by tools: what these do is what loads
/// do and contact takes. Contact finds what it takes from where nodes would go, which the tools at them change.
#[test]
fn books_close_where_tools_hold_what_touches() {
    let block = |name: &str, elements: &str, cells: u32, x: f64| {
        format!(
            "\"{name}\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                material: \"m\", translate: ({x}, 0, 0))"
        )
    };
    let text = format!(
        "(duration: 0.2, bodies: {{{}, {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.4), damping: 40)}},
        tools: {{
            \"table\": (shape: Plane()),
            \"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.02),
                moves: [(displacement: (0, 0, -5e-4), curve: Smooth(end: 0.05))]),
            \"side\": (shape: Plane(), rotation: (0, 90, 0), at: (-0.0201, 0, 0),
                moves: [(displacement: (3e-3, 0, 0), curve: Smooth(start: 0.05, end: 0.15))])}},
        contacts: [Tool(tool: \"table\", body: \"a\"), Tool(tool: \"table\", body: \"b\", friction: 1),
            Tool(tool: \"top\", body: \"a\"), Tool(tool: \"top\", body: \"b\"), Tool(tool: \"side\", body: \"a\"),
            Between(bodies: (\"a\", \"b\"), friction: 0.2)],
        output: (energies_every: 0.05))",
        block("a", "Hex8MeanDilatation", 3, -0.0201),
        block("b", "Tet4", 4, 0.0),
    );
    for run in configurations() {
        let mut simulation = run.start(&text);
        for time in [0.1, 0.2] {
            simulation.advance_to(time).unwrap();
            let tools = ["table", "top", "side"].map(|tool| simulation.tool(tool).unwrap());
            let work: f64 = tools.iter().map(|tool| tool.work.unwrap()).sum();
            let e = simulation.energies().unwrap();
            let (load_work, loss) = (e.load_work.unwrap(), e.contact_loss.unwrap());
            let what = format!("{}, {time} s", run.name);
            println!("{what}: {work:e} J by tools, {load_work:e} by loads, {loss:e} lost to contact");
            near(&format!("{what}: work"), load_work, work - loss, work, run.bound(1e-12, 1e-5));
            let taken: f64 = tools.iter().map(|tool| tool.loss.unwrap()).sum::<f64>()
                + ["a", "b"].map(|body| simulation.contact(body).unwrap().loss.unwrap()).iter().sum::<f64>();
            near(&format!("{what}: lost"), loss, taken, work, run.bound(1e-12, 1e-5));
            assert!(loss > -1e-3 * work, "{what}: contact seems to have given {} J of {work}", -loss);
        }
    }
}

/// Two blocks side by side on a table that holds them by friction, and one of them by a wall: as they squat they press
/// each other, and in each step the table undoes what contact foresees of their lowest nodes. What contact takes was
/// booked to who owns the points, and what the table undoes to who owns the nodes: at rest one seemed to give the other
/// an eighth of what both hold, each tenth of a second.
#[test]
fn of_what_rests_contact_takes_nothing() {
    let block = |cells: u32, x: f64| {
        format!(
            "(mesh: Box(size: (0.02, 0.02, 0.02), cells: ({cells}, {cells}, {cells}), elements: Hex8MeanDilatation),
                material: \"m\", translate: ({x}, 0, 0))"
        )
    };
    let text = format!(
        "(duration: 0.3, bodies: {{\"a\": {}, \"b\": {}}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 5e4, poisson: 0.3), stiffness_damping: 5e-4)}},
        loads: [Gravity(acceleration: (0, 0, -9.81), curve: Smooth(end: 0.05))],
        tools: {{\"table\": (shape: Plane()), \"wall\": (shape: Plane(), rotation: (0, 90, 0))}},
        contacts: [Tool(tool: \"table\", body: \"a\", friction: 0.3), Tool(tool: \"table\", body: \"b\", friction: 0.3),
            Tool(tool: \"wall\", body: \"a\"), Between(bodies: (\"a\", \"b\"))])",
        block(3, 0.0),
        block(2, 0.02),
    );
    for run in configurations() {
        let mut simulation = run.start(&text);
        let [earlier, later] = [0.2, 0.3].map(|time| {
            simulation.advance_to(time).unwrap();
            ["a", "b"].map(|body| simulation.contact(body).unwrap())
        });
        let held = simulation.energies().unwrap().strain;
        for (body, (earlier, later)) in ["a", "b"].iter().zip(earlier.iter().zip(&later)) {
            let what = format!("{}, {body}", run.name);
            assert!(later.force.x.abs() > 5e-3, "{what}: they press each other: {}", later.force);
            near(&what, later.loss.unwrap(), earlier.loss.unwrap(), held, 5e-3);
        }
    }
}

/// A block between two plates that hold it by friction, and a free box that gravity pushes against its side. The
/// plates push last, and undo what the box pushes nodes by: it went in deeper with every step, by 4 mm after .3 s. Now
/// it stops where the nodes' masses over the square of the step bear it.
#[test]
fn a_free_box_does_not_sink_into_what_plates_hold() {
    let text = "(duration: 0.3, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.004), cells: (5, 5, 1),
            elements: Hex8MeanDilatation), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 100)},
        loads: [Gravity(acceleration: (-8, 0, 0), curve: Smooth(end: 0.1))],
        tools: {\"table\": (shape: Plane()), \"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.004),
                moves: [(displacement: (0, 0, -0.0004), curve: Smooth(end: 0.02))]),
            \"box\": (shape: Box(size: (0.02, 0.03, 0.012)), rounding: 5e-4, at: (0.02005, 0.005, 0.0022),
                free: (density: 3000, inertia: (1, 1, 1)))},
        contacts: [Tool(tool: \"table\", friction: 2), Tool(tool: \"top\", friction: 2), Tool(tool: \"box\", thin: true)])";
    for run in cpu_and_long_gpu() {
        let mut simulation = run.start(text);
        for time in [0.15, 0.3] {
            simulation.advance_to(time).unwrap();
            let reading = simulation.tool("box").unwrap();
            let what = format!("{}, {time} s", run.name);
            println!(
                "{what}: {} m inside, at {}, lost {:e} J",
                reading.penetration,
                reading.place,
                reading.loss.unwrap()
            );
            // a seventh of an edge
            assert!(reading.penetration < 3e-4, "{what}: {} m", reading.penetration);
            assert!(reading.force.x > 0.1, "{what}: the block bears it: {}", reading.force);
        }
    }
}

/// A block that is drawn over a table along an axis that is told: friction takes μ m g of each metre; and one that is
/// lifted as told with a ramp on which it leans: nothing is lost. Forces along axes that are told were left out.
#[test]
fn what_is_lost_along_axes_that_are_told_is_counted() {
    let drawn = "(duration: 0.3, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2), elements: Hex8MeanDilatation),
            material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 100)},
        constraints: [Prescribed(on: Plane(normal: (0, 0, 1), at: 0), axes: [X], displacement: (0.01, 0, 0),
            curve: Smooth(start: 0.05, end: 0.25))],
        tools: {\"t\": (shape: Plane())}, loads: [Gravity(acceleration: (0, 0, -10), curve: Smooth(end: 0.04))],
        contacts: [Tool(tool: \"t\", friction: 0.3)])";
    let lifted = "(duration: 0.2, bodies: {\"b\": (mesh: Box(size: (0.01, 0.01, 0.01), cells: (2, 2, 2), elements: Hex8MeanDilatation),
            rotate: (0, -45, 0), translate: (-0.00001, 0, 0.00001), material: \"m\")},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 2e4, poisson: 0.3), damping: 200)},
        constraints: [Prescribed(on: All, axes: [Z], displacement: (0, 0, 0.02), curve: Smooth(end: 0.2))],
        loads: [Gravity(acceleration: (9.81, 0, 0), curve: Smooth(end: 0.05))],
        tools: {\"t\": (shape: Plane(), rotation: (0, -45, 0),
            moves: [(displacement: (0, 0, 0.02), curve: Smooth(end: 0.2))])},
        contacts: [Tool(tool: \"t\")])";
    for run in configurations() {
        let lost = [drawn, lifted].map(|text| {
            let mut simulation = run.start(text);
            simulation.finish().unwrap();
            simulation.tool("t").unwrap().loss.unwrap()
        });
        near(&format!("{}: drawn", run.name), lost[0], 0.3 * 0.01 * 0.01, 3e-5, 0.03);
        // of 200 µJ that its weight does along the ramp
        near(&format!("{}: lifted", run.name), lost[1], 0.0, 2e-4, 0.02);
    }
}

/// A block that hangs by glue on one that is pressed on a third: glue, and the tool that presses nodes which are glued,
/// change where nodes go that contact has foreseen. At rest nobody takes or gives anything.
#[test]
fn books_close_where_glue_holds_what_touches() {
    let text = "(duration: 0.4, bodies: {
            \"low\": (mesh: Box(size: (0.02, 0.02, 0.02), cells: (3, 3, 3), elements: Hex8MeanDilatation), material: \"m\"),
            \"high\": (mesh: Box(size: (0.02, 0.02, 0.01), cells: (4, 4, 2), elements: Tet4), material: \"m\",
                translate: (0.001, 0.0005, 0.0201)),
            \"side\": (mesh: Box(size: (0.01, 0.02, 0.02), cells: (2, 3, 4), elements: Hex8MeanDilatation), material: \"m\",
                translate: (0.021, 0.0005, 0.0101))},
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 1e4, poisson: 0.4), damping: 40)},
        tools: {\"top\": (shape: Plane(), rotation: (180, 0, 0), at: (0, 0, 0.0302),
            moves: [(displacement: (0, 0, -2e-3), curve: Smooth(end: 0.1))])},
        constraints: [Fixed(body: \"low\", on: Plane(normal: (0, 0, 1), at: 0))],
        attachments: [Glue(bodies: (\"high\", \"side\"))],
        contacts: [Tool(tool: \"top\", body: \"high\"), Between(bodies: (\"low\", \"high\"), friction: 0.3)],
        output: (energies_every: 0.05))";
    for run in configurations() {
        let mut simulation = run.start(text);
        let books = [0.2, 0.4].map(|time| {
            simulation.advance_to(time).unwrap();
            let (tool, e) = (simulation.tool("top").unwrap(), simulation.energies().unwrap());
            let (glue, loss) = (simulation.attachment("0").unwrap().loss, e.contact_loss.unwrap());
            let what = format!("{}, {time} s", run.name);
            println!(
                "{what}: {:e} J by the tool, {:e} by loads, {loss:e} lost to contact, {glue:e} to glue",
                tool.work.unwrap(),
                e.load_work.unwrap()
            );
            // of glue the second half of the last step is not known yet, nor how that changes with a step's length
            let sum = tool.work.unwrap() - loss - glue;
            near(&format!("{what}: work"), e.load_work.unwrap(), sum, tool.work.unwrap(), 2e-5);
            near(&format!("{what}: glue"), glue, 0.0, tool.work.unwrap(), 2e-3);
            near(&format!("{what}: contact"), loss, 0.0, tool.work.unwrap(), 0.05);
            [loss, glue, tool.work.unwrap()]
        });
        let [[contact, glue, work], [contact_later, glue_later, _]] = books;
        near(&format!("{}: contact at rest", run.name), contact_later, contact, work, 1e-4);
        near(&format!("{}: glue at rest", run.name), glue_later, glue, work, 1e-4);
    }
}
