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
