//! Tools that suck and take what they cannot.

use crate::complaints::told_of;
use crate::tools::{ROD, TOUCH, told};

#[test]
fn what_is_wrong_with_what_a_tool_takes_and_sucks_is_told() {
    let takes = |fields: &str| format!("removal: [(when: InTool({fields}))],");
    let sucks = |fields: &str| format!("suction: [({fields})],");
    let good = "tool: \"rod\", reach: 0.1, rate: 1e-6";
    let mouth = "tool: \"rod\", reach: 0.1, pressure: 100, bore: 0.02";
    let passes = |threshold: &str| takes(&format!("tool: \"rod\", reach: 0.1, threshold: {threshold}"));
    for good in [takes(good), takes(&format!("{good}, crumb: 0")), passes("StretchAbove(1.2)"), sucks(mouth)] {
        assert_eq!(told(ROD, TOUCH, &good), "");
        // who takes or sucks need not touch
        assert_eq!(told(ROD, "", &good), "");
    }
    let cases = [
        (takes("tool: \"ro\", reach: 0.1, rate: 1"), "3: error: there is no tool `ro` | did you mean `rod`?"),
        (takes("tool: \"rod\", reach: 0, rate: 1"), "3: error: `reach` must be above 0, found 0 m"),
        (takes("tool: \"rod\", reach: 1, rate: -1"), "3: error: `rate` must be above 0, found -1 m³/s"),
        (takes(&format!("{good}, bore: 0")), "3: error: `bore` must be above 0, found 0 m"),
        (takes(&format!("{good}, burst: 0")), "3: error: `burst` must be between 1 and 1024, found 0"),
        (takes(&format!("{good}, curve: Smooth(start: 1, end: 0)")), "3: error: "),
        (takes("tool: \"rod\", rate: 1"), "`reach`"),
        (takes(&format!("{good}, crumb: -1")), "3: error: `crumb` must be 0 or above, found -1 m³"),
        (
            takes("tool: \"rod\", reach: 1"),
            "3: error: the tool `rod` takes elements by nothing | either `rate`, the volume in a second (m³/s), or",
        ),
        (
            takes(&format!("{good}, threshold: StretchAbove(2)")),
            "3: error: a `threshold` beside a `rate` | either `rate`",
        ),
        (passes("StretchAbove(-1)"), "3: error: `StretchAbove` must be above 0, found -1"),
        (passes("StretchAbove(0.5)"), "3: warning: `StretchAbove` of 0.5 holds at rest"),
        (passes("EnergyDensityAbove(-1)"), "3: error: `EnergyDensityAbove` must be 0 or above, found -1"),
        (passes("Above(1)"), "`threshold` cannot be `Above`"),
        (sucks("tool: \"ro\", reach: 0.1, pressure: 1"), "3: error: there is no tool `ro` | did you mean `rod`?"),
        (sucks("tool: \"rod\", reach: 0.1, pressure: 1"), "3: error: the tool `rod` is no tube: where is its mouth?"),
        (
            sucks("tool: \"rod\", reach: 0.1, pressure: -1, bore: 1"),
            "3: error: `pressure` must be above 0, found -1 Pa",
        ),
        (sucks(&format!("{mouth}, delay: -1")), "3: error: `delay` must be 0 or above, found -1 s"),
        (
            sucks("tool: \"rod\", reach: 0.1, pressure: 4e3, bore: 0.01"),
            "3: warning: the suction of 4.000e3 Pa is more than",
        ),
        (
            sucks("tool: \"rod\", reach: 0.1, pressure: 100, bore: 0.005"),
            "3: warning: the mouth is 1.000e-2 m across, and edges of the surface that it sucks are 2.845e-2 m long",
        ),
        (format!("analysis: Static(), {}", sucks(mouth)), "3: error: a static analysis cannot suck"),
        (format!("analysis: Static(), {}", takes(good)), "3: error: a static analysis cannot remove elements"),
        (format!("removal: [{}],", format!("(when: InTool({good})),").repeat(9)), "at most 8 tools may take elements"),
        (format!("suction: [{}],", format!("({mouth}),").repeat(9)), "at most 8 tools may suck at a body"),
    ];
    for (more, expected) in cases {
        let found = told(ROD, TOUCH, &more);
        println!("{found}");
        assert!(found.contains(expected), "{more}:\n{found}\nexpected\n{expected}");
    }
}

#[test]
fn what_sucks_or_takes_twice_is_told() {
    let entry = "(tool: \"rod\", pressure: 100, bore: 0.01, reach: 0.02)";
    let said = told(ROD, TOUCH, &format!("suction: [{entry}, {entry}],"));
    assert!(said.contains("error: `rod` sucks at this body by suction[0] already | leave one of both out"), "{said}");
    let entry = "(when: InTool(tool: \"rod\", reach: 0.02, rate: 1e-6))";
    let said = told(ROD, TOUCH, &format!("removal: [{entry}, {entry}],"));
    assert!(
        said.contains("error: `rod` takes the same elements by two entries: they would go twice as fast"),
        "{said}"
    );
    // who is meant counts, and not how it is written
    let with_body = entry.replacen('(', "(body: \"b\", ", 1);
    let said = told(ROD, TOUCH, &format!("removal: [{entry}, {with_body}],"));
    assert!(said.contains("error: `rod` takes the same elements by two entries"), "{said}");
    let tube = "(shape: Tube(length: 0.2, inner: 0.02, outer: 0.03), at: (0.05, 0.05, 0.11))";
    let sucks = |bore: &str| format!("(tool: \"rod\", pressure: 100, reach: 0.02{bore})");
    let both = |bore: &str| told(tube, "", &format!("suction: [{}, {}],", sucks(""), sucks(bore)));
    let said = both(", bore: 0.02");
    assert!(said.contains("error: `rod` sucks at this body by suction[0] already"), "{said}");
    assert_eq!(both(", bore: 0.025"), "");
    let other =
        "(on: Box(min: (0, 0, 0), max: (0.05, 0.1, 0.1)), when: InTool(tool: \"rod\", reach: 0.02, rate: 1e-6))";
    assert_eq!(told(ROD, TOUCH, &format!("removal: [{entry}, {other}],")), "");
}

#[test]
fn a_mouth_that_comes_nowhere_near_what_it_sucks_is_told() {
    let tube =
        |rest: &str| format!("(shape: Tube(length: 0.2, inner: 0.02, outer: 0.03), at: (0.05, 0.05, 0.5){rest})");
    let sucks = "integration: (step: 1e-5), suction: [(tool: \"rod\", pressure: 100, reach: 0.02)],";
    let said = told(&tube(""), "", sucks);
    let expected =
        "3: warning: as `b` is at the start, the mouth of `rod` comes no nearer to it than 4.000e-1 m: it sucks";
    assert!(said.contains(expected) && said.contains("`reach` is 2.000e-2 m"), "{said}");
    // it comes for a moment, or a program or forces may move it
    let comes = |curve: &str| format!(", moves: [(displacement: (0, 0, -0.39), curve: {curve})]");
    assert_eq!(told(&tube(&comes("Table([(0.04, 0), (0.05, 1), (0.06, 0)])")), "", sucks), "");
    assert_eq!(told(&tube(&comes("Input(name: \"way\", rate: 1)")), "", sucks), "");
    let free = tube(", free: (mass: 1)");
    assert!(!told(&free, TOUCH, sucks).contains("it sucks nothing"));
}

#[test]
fn what_copies_would_share_is_refused() {
    let of = |entry: &str| {
        let folder = tempfile::tempdir().unwrap();
        let body = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\", copies: 2";
        let text = format!(
            "(duration: 0.1, bodies: {{\"b\": ({body})}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {entry},
            tools: {{\"rod\": (shape: Tube(length: 0.1, inner: 0.02, outer: 0.03), at: (0.05, 0.05, 0.105))}})"
        );
        told_of(&text, folder.path())
    };
    let said = of("suction: [(tool: \"rod\", pressure: 100, reach: 0.02)]");
    assert!(said.contains("error: what the tool sucks at is shared by the 2 copies of `b`"), "{said}");
    let taken = |by: &str| of(&format!("removal: [(when: InTool(tool: \"rod\", reach: 0.02, {by}))]"));
    let said = taken("rate: 1e-6");
    assert!(said.contains("error: what the tool takes from is shared by the 2 copies of `b`"), "{said}");
    assert_eq!(taken("threshold: StretchAbove(1.5)"), "");
}

/// There are 384 elements of 2.604 cm³. Explicit steps look in every tenth what is in reach, implicit ones in each.
#[test]
fn a_rate_that_a_burst_starves_is_told() {
    let takes = |steps: &str, fields: &str| {
        told(ROD, "", &format!("{steps}, removal: [(when: InTool(tool: \"rod\", reach: 0.1, {fields}))],"))
    };
    let explicit = "integration: (step: 1e-4)";
    let said = takes(explicit, "rate: 0.1, burst: 1");
    let expected = "warning: `rod` takes in up to 1.000e-1 m³/s, of which `burst` lets 2.604e-3 go: one element of \
                    2.604e-6 m³ in the mean on its way every 1.000e-3 s; the rest waits | `burst: 39` keeps up; so \
                    does a `rate` of at most 2.604e-3 m³/s, and so do steps of at most 2.604e-6 s";
    assert!(said.contains(expected), "{said}");
    let slow = "rate: 0.1, burst: 1, curve: Table([(0, 0.02), (1, 0.02)])";
    for mends in ["rate: 0.1, burst: 39", "rate: 0.0026, burst: 1", slow] {
        assert_eq!(takes(explicit, mends), "", "{mends}");
    }
    assert_eq!(takes("integration: (step: 2.6e-6)", "rate: 0.1, burst: 1"), "");
    // of all that there is none waits
    let [few, all] = [383, 384].map(|burst| takes(explicit, &format!("rate: 10, burst: {burst}")));
    assert!(few.contains("`burst: 384` keeps up") && all.is_empty(), "{few}\n{all}");
    let said = takes("solver: Implicit(step: 0.05)", "rate: 0.1, burst: 96");
    let expected = "of which `burst` lets 5.000e-3 go: 96 elements of 2.604e-6 m³ in the mean on its way every";
    assert!(said.contains(expected), "{said}");
    // what its curve would be after the end does not count
    for never in ["Table([(0, 0.01), (0.1, 0.01), (50, 1)])", "Step(start: 5)"] {
        let said = takes(explicit, &format!("rate: 0.1, burst: 1, curve: {never}"));
        assert!(!said.contains("`burst` lets"), "{never}: {said}");
    }
}

/// A ball of 27 m/s that reaches .035 m is looked at every .65 ms at least, which is six steps of .1 ms and ten of .06.
#[test]
fn shorter_steps_that_keep_up_do_so_where_a_tip_is_quick() {
    let of = |step: &str| {
        let path = "path: [(t: 0, at: (-1.3, 0.05, 0.1)), (t: 0.1, at: (1.4, 0.05, 0.1))]";
        let takes = "removal: [(when: InTool(tool: \"rod\", reach: 0.03, rate: 5e-3, burst: 1))]";
        told(&format!("(shape: Sphere(radius: 5e-3), {path})"), "", &format!("{takes}, integration: (step: {step}),"))
    };
    let said = of("1e-4");
    assert!(said.contains("every 6.000e-4 s; the rest") && said.contains("steps of at most 5.208e-5 s"), "{said}");
    for step in ["5.208e-5", "4e-5", "1e-5"] {
        assert!(!of(step).contains("`burst` lets"), "{step}: {}", of(step));
    }
}

/// Elements are the smaller the nearer they are to the bore of a tube: .07 mm³ in the mean where the tip is there, .45
/// at the outside, .27 in all.
#[test]
fn a_burst_is_of_elements_where_the_tip_is() {
    let of = |at: &str, rate: &str| {
        let folder = tempfile::tempdir().unwrap();
        let mesh = "Tube(inner: 0.0005, outer: 0.0105, height: 0.004, angle: 90, cells: (20, 8, 8))";
        let text = format!(
            "(duration: 0.1, integration: (step: 2e-6), bodies: {{\"b\": (mesh: {mesh}, material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Set(\"outer\"))],
            tools: {{\"tip\": (shape: Sphere(radius: 5e-4), at: {at})}},
            removal: [(when: InTool(tool: \"tip\", reach: 1.5e-3, rate: {rate}, burst: 6))])"
        );
        // a cell is six tetrahedra
        told_of(&text, folder.path())
    };
    let said = of("(0.0002, 0.0002, 0.002)", "7.5e-6");
    assert!(said.contains("`burst` lets") && said.contains("in the mean on its way every"), "{said}");
    let said = of("(0.0072, 0.0072, 0.002)", "1.75e-5");
    assert!(!said.contains("`burst` lets"), "{said}");
}

/// It goes along the upper side, .12 m in .1 s, and reaches .035 m.
#[test]
fn a_tip_that_is_too_quick_for_its_looks_is_told() {
    let takes = |tool: &str, steps: &str, more: &str| {
        let takes = format!("removal: [(when: InTool(tool: \"rod\", reach: 0.03, rate: 1e-4{more}))], {steps},");
        told(tool, "", &takes)
    };
    let long = "solver: Implicit(step: 0.05)";
    let ball = |way: &str| format!("(shape: Sphere(radius: 5e-3), {way})");
    let way = "path: [(t: 0, at: (-0.01, 0.05, 0.1)), (t: 0.1, at: (0.11, 0.05, 0.1))]";
    let said = takes(&ball(way), long, "");
    let expected = "warning: `rod` goes 6.000e-2 m from one look at what is in its reach to the next, in 5.000e-2 s, \
                    and reaches 3.500e-2 m from its middle: it leaves what it passes between them | steps of at most \
                    1.458e-2 s leave no gaps";
    assert!(said.contains(expected), "{said}");
    let hand = ball("at: (0.05, 0.05, 0.1), port: (name: \"hand\", speed: 1.2)");
    assert!(
        takes(&hand, long, "").contains("`rod` may go up to 6.000e-2 m from one look"),
        "{}",
        takes(&hand, long, "")
    );
    let comes =
        "path: [(t: 0, at: (-3, 0.05, 0.1)), (t: 0.05, at: (0.02, 0.05, 0.1)), (t: 0.1, at: (0.03, 0.05, 0.1))]";
    let along = way.replace("0.1))", "0.1), rotation: (0, 90, 0))");
    let quiet = [
        takes(&ball(way), "solver: Implicit(step: 0.0145)", ""),
        takes(&ball(way), "integration: (step: 1e-4)", ""),
        // beside the body, and while it takes nothing, it may be as quick as it likes
        takes(&ball(comes), long, ""),
        takes(&ball(way), long, ", curve: Step(start: 0.2)"),
        // what goes along itself is there at one look or the next
        takes(&format!("(shape: Capsule(length: 0.1, radius: 5e-3), {along})"), long, ""),
    ];
    quiet.iter().for_each(|said| assert!(!said.contains("from one look"), "{said}"));
    // right through within a look, in and out again
    let through = "path: [(t: 0, at: (-0.15, 0.05, 0.1)), (t: 0.1, at: (0.25, 0.05, 0.1))]";
    let key = |time: &str, x: &str| format!("(t: {time}, at: ({x}, 0.05, 0.1))");
    let keys = [key("0", "-0.15"), key("0.06", "-0.15"), key("0.07", "0.05"), key("0.08", "-0.15")];
    let dart = format!("path: [{}]", keys.join(", "));
    for (way, goes, steps) in [(through, "2.000e-1", "4.375e-3"), (dart.as_str(), "4.000e-1", "8.750e-4")] {
        let said = takes(&ball(way), long, "");
        assert!(said.contains(&format!("`rod` goes {goes} m from one look")), "{said}");
        assert!(said.contains(&format!("steps of at most {steps} s leave no gaps")), "{said}");
        let said = takes(&ball(way), &format!("solver: Implicit(step: {steps})"), "");
        assert!(!said.contains("from one look"), "{said}");
    }
}

/// A needle that turns by a right angle from look to look is beside a block at one of them and above it at the other.
#[test]
fn a_tip_that_turns_too_quickly_for_its_looks_is_told() {
    let at = "at: (-0.05, 0.05, 0.098)";
    let path = format!("path: [(t: 0, {at}, rotation: (0, 0, 0)), (t: 0.1, {at}, rotation: (0, 180, 0))]");
    let of = |step: &str| {
        let takes = "removal: [(when: InTool(tool: \"rod\", reach: 5e-3, rate: 1e-4))]";
        let tool = format!("(shape: Capsule(length: 0.3, radius: 5e-3), {path})");
        told(&tool, "", &format!("{takes}, solver: Implicit(step: {step}),"))
    };
    let said = of("0.05");
    assert!(said.contains("`rod` goes 2.352e-1 m from one look"), "{said}");
    assert!(!of("1e-3").contains("from one look"), "{}", of("1e-3"));
}

/// What a tool does that gives way to one copy another copy feels. Who goes where it is led does the same to all.
#[test]
fn a_tool_that_gives_way_to_copies_is_refused() {
    let of = |copies: u32, moves: &str, uses: &str| {
        let folder = tempfile::tempdir().unwrap();
        let body = "mesh: Box(size: (0.1, 0.1, 0.1), cells: (4, 4, 4)), material: \"m\"";
        let text = format!(
            "(duration: 0.1, bodies: {{\"b\": ({body}, copies: {copies})}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))}},
            constraints: [Fixed(on: Plane(normal: (0, 0, 1), at: 0))], {uses},
            tools: {{\"ball\": (shape: Sphere(radius: 0.06), at: (0.05, 0.05, 0.17), {moves})}})"
        );
        told_of(&text, folder.path())
    };
    let touches = "contacts: [Tool(tool: \"ball\")]";
    let holds = "attachments: [Grasp(tool: \"ball\", closed: Step(start: 0.05), reach: 0.02)]";
    let free = "free: (density: 1000)";
    let follows = |how: &str| format!("port: (name: \"hand\", speed: 0.1, follow: {how})");
    let proxy = follows("Proxy(stiffness: 100)");
    let by_proxy = "error: the tool `ball`, which follows its port as a `Proxy`, is shared by the 2 copies of `b`";
    let cases = [
        (free, touches, "error: the tool `ball`, which is `free`, is shared by the 2 copies of `b`: they would not do"),
        (proxy.as_str(), touches, by_proxy),
        (proxy.as_str(), holds, by_proxy),
    ];
    for (moves, uses, expected) in cases {
        let said = of(2, moves, uses);
        assert!(said.contains(expected) && said.contains("| leave `copies` out, or give each its own body"), "{said}");
        assert!(!of(1, moves, uses).contains("copies"), "{}", of(1, moves, uses));
        assert!(!of(2, &follows("Position"), uses).contains("shared"), "{}", of(2, &follows("Position"), uses));
    }
}

#[test]
fn suction_that_has_begun_before_the_first_step_is_refused() {
    let sucks = |curve: &str| {
        let entry = format!("(tool: \"rod\", pressure: 100, bore: 0.02, reach: 0.02{curve})");
        told(
            ROD,
            TOUCH,
            &format!("start: Equilibrium(), loads: [Gravity(acceleration: (0, 0, -9.81))], suction: [{entry}],"),
        )
    };
    let said = sucks("");
    assert!(said.contains("error: it sucks at t = 0, and `start: Equilibrium()` knows nothing of suction"), "{said}");
    assert_eq!(sucks(", curve: Smooth(end: 0.1)"), "");
}
