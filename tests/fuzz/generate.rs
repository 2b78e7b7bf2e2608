//! Whole scenes made up from a seed: small, sound, with every feature that a scene can have. Every other one is
//! violent: loads and motions far beyond what holds it, steps that are too large, guards that hardly check.

use crate::dice::{Dice, Temper, number, one_of, size, vector};
use crate::materials::materials;
use crate::surgery::{Surgery, skin};
use fastrand::Rng;
use glam::DVec3;
use std::fmt::Write;

/// A scene of a seed. Times in it are shares of `duration` (s), so that the same scene can be had for as many steps as
/// wanted.
pub struct Made {
    /// The text.
    pub text: String,
    /// Whether elements go, or turn inside out, as soon as a number passes a limit: what rounding may decide.
    pub decides: bool,
    /// How violent it is.
    pub temper: Temper,
}

/// The scene of a seed, and where known the step that is stable at the start (s): then it may have a step of its own.
/// With `surgery` bodies are near each other, and tools at them.
pub fn scene(seed: u64, duration: f64, stable: Option<f64>, surgery: bool) -> Made {
    let mut dice = Dice::of(seed);
    let r = &mut dice;
    let mut text = format!("(duration: {duration:?}, ");
    let statics = r.u8(..12) == 0;
    if statics {
        let _ = write!(text, "analysis: Static(max_steps: {}), ", r.u64(50..400));
    }
    let two = r.u8(..6);
    let mut bodies = vec![Geometry::of(None, surgery, r)];
    if two == 0 || surgery && two < 4 {
        bodies.push(Geometry::of(Some(&bodies[0]), surgery, r));
    }
    let surgery = surgery.then(|| Surgery::of(seed, &bodies, duration, statics));
    let described: Vec<String> = bodies.iter().map(|body| body.text.clone()).collect();
    let _ = write!(text, "bodies: {{{}}}, ", described.join(", "));
    let (materials, mut decides) = materials(r);
    let _ = write!(text, "materials: {{{materials}}}, ");
    let some = |r: &mut Dice, most: u8, make: &dyn Fn(&mut Dice) -> String| {
        (0..r.u8(..=most)).map(|_| make(r)).collect::<Vec<_>>().join(", ")
    };
    let constraints = some(r, 3, &|r| constraint(&bodies, duration, statics, r));
    let loads = some(r, 3, &|r| load(&bodies, duration, r));
    let _ = write!(text, "constraints: [{constraints}], loads: [{loads}], ");
    let mut removed: Vec<String> = surgery.iter().flat_map(|surgery| surgery.removal.clone()).collect();
    if !statics && r.u8(..3) == 0 {
        removed.extend((0..r.u8(..=2)).map(|_| removal(&bodies, duration, r)));
    }
    let removal = removed.join(", ");
    decides |= removal.contains("Above") || removal.contains("Below");
    let _ = write!(text, "removal: [{removal}], ");
    if let Some(surgery) = &surgery {
        text += &surgery.text();
        decides |= surgery.decides();
    }
    let mild = integration(statics, r);
    let temper = r.temper;
    let steps = match r.wild() {
        Some(wild) if !statics => violent_steps(mild, stable, temper, wild),
        _ => mild,
    };
    let _ = write!(text, "integration: ({steps}), ");
    decides |= text.contains("when_unstable: Remove");
    let _ = write!(text, "fuse: {}, ", r.bool());
    if !statics && r.u8(..3) > 0 {
        let _ = write!(text, "output: (energies_every: {:?}), ", duration * number(r, 0.01, 0.4));
    }
    let every = r.u64(1..80);
    let guards = match r.wild() {
        Some(wild) => violent_guards(every, !text.contains("beyond_stable_step"), temper, wild),
        None => format!("every: {every}"),
    };
    let _ = write!(text, "guards: ({guards}), ");
    text.push(')');
    // of a row of its own, so that all else of a seed stays as it was
    let mut later = Rng::with_seed(seed ^ 0x5eed);
    if later.u8(..5) == 0 && !text.contains("inversion: Recover") {
        let damping = format!("\": (stiffness_damping: {:?}, density:", size(&mut later, 1e-5, 1e-2));
        // of materials: tools that move freely have a density, too
        text = text.replace("\": (density:", &damping);
    }
    let moves = ["start: ", "velocity: ", "spin: "].iter().any(|word| text.contains(word));
    if later.u8(..6) == 0 && !statics && !moves {
        text = text.replacen('(', "(start: Equilibrium(tolerance: 1e-6, max_steps: 4000), ", 1);
        // what stands at several places in equilibrium, or at the edge of one, rounding may decide
        decides = true;
    }
    // violent motion multiplies what rounding leaves, up to the size of the body and beyond
    Made { text, decides: decides || temper != Temper::Mild, temper }
}

/// A body, and what must be known to act on it.
pub struct Geometry {
    pub name: String,
    text: String,
    /// Its size (m), and half of that where it lies about the origin.
    pub size: f64,
    /// The corners of its box (m), as it is if it is not turned.
    pub low: DVec3,
    pub high: DVec3,
}

impl Geometry {
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// A body, far from the first one or near it.
    fn of(first: Option<&Self>, near: bool, r: &mut Dice) -> Self {
        let any_size = size(r, 1e-3, 1.0);
        let size = match first {
            Some(first) if near => first.size * (0.5 + any_size),
            _ => any_size,
        };
        let kind = one_of(r, &["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation", "Wedge6", "Tet10"]);
        let cells = |r: &mut Rng| (r.u8(1..=3), r.u8(1..=3), r.u8(1..=3));
        let mesh = match r.u8(..8) {
            0 => {
                let across = 2 * r.u8(1..=2);
                format!(
                    "Cylinder(radius: {:?}, height: {size:?}, across: {across}, along: {}, elements: {kind})",
                    0.5 * size,
                    r.u8(1..=3)
                )
            }
            1 => format!(
                "Ellipsoid(radii: ({:?}, {:?}, {:?}), across: {}, elements: {kind})",
                0.5 * size,
                0.4 * size,
                0.5 * size,
                2 * r.u8(1..=2)
            ),
            2 => {
                let mut corner = |x: f64, y: f64, z: f64| {
                    let mut at = |c: f64| size * (c + number(r, -0.15, 0.15));
                    format!("({:?}, {:?}, {:?})", at(x), at(y), at(z))
                };
                let corners: Vec<String> = [0.0, 1.0]
                    .into_iter()
                    .flat_map(|z| [(0.0, 0.0, z), (1.0, 0.0, z), (1.0, 1.0, z), (0.0, 1.0, z)])
                    .map(|(x, y, z)| corner(x, y, z))
                    .collect();
                format!("Hexahedron(corners: ({}), cells: {:?}, elements: {kind})", corners.join(", "), cells(r))
            }
            3 => format!(
                "Lens(diameter: {size:?}, thickness: {:?}, across: {}, through: 2, elements: {kind})",
                0.4 * size,
                2 * r.u8(1..=2)
            ),
            _ => format!(
                "Box(size: ({size:?}, {:?}, {:?}), cells: {:?}, elements: {kind})",
                size * number(r, 0.3, 1.0),
                size * number(r, 0.3, 1.0),
                cells(r)
            ),
        };
        let name = if first.is_some() { "b1" } else { "b0" }.to_string();
        let (low, high) = bounds(&mesh, size);
        let away = match first {
            None => 0.0,
            Some(first) if near => first.high.x - low.x + size * number(r, -0.01, 0.1),
            Some(_) => 20.0,
        };
        let mut text = format!("\"{name}\": (mesh: {mesh}, material: \"m\", translate: ({away:?}, 0, 0)");
        let mut add = |r: &mut Dice, one_in: u8, what: &dyn Fn(&mut Dice) -> String| {
            if r.u8(..one_in) == 0 {
                let _ = write!(text, ", {}", what(r));
            }
        };
        let (velocity, spin) = (0.3 * r.beyond(1e3), 5.0 * r.beyond(1e3));
        let (gradient, scrambled) = (0.1 * r.beyond(12.0), 0.02 * size * r.beyond(20.0));
        add(r, 4, &|r| format!("velocity: {}", vector(r, velocity)));
        add(r, 6, &|r| format!("spin: {}", vector(r, spin)));
        add(r, 8, &|r| format!("copies: 2, apart: ({:?}, 0, 0)", size * number(r, 1.5, 3.0)));
        add(r, 10, &|r| format!("refine: {}", r.u8(..=1)));
        add(r, 6, &|r| format!("rotate: {}", vector(r, 90.0)));
        add(r, 6, &|r| format!("hourglass: {:?}", number(r, 0.5, 2.0)));
        add(r, 6, &|r| match r.bool() {
            true => {
                let [x, y, z] = [0; 3].map(|_| vector(r, gradient));
                format!("start: Affine(gradient: ({x}, {y}, {z}))")
            }
            false => format!("start: Scrambled(amplitude: {scrambled:?}, seed: {})", r.u8(..)),
        });
        add(r, 5, &|r| format!("regions: [(on: {}, material: \"n\")]", place(size, r)));
        if near && r.u8(..6) == 0 {
            let _ = write!(text, ", {}", skin(size, r));
        }
        text.push(')');
        Self { name, text, size, low: low + away * DVec3::X, high: high + away * DVec3::X }
    }
}

/// The box around a mesh of this size, of blocks that of the cube they are made of.
fn bounds(mesh: &str, size: f64) -> (DVec3, DVec3) {
    let half = DVec3::splat(0.5 * size);
    match mesh.split('(').next() {
        Some("Box") => {
            let lengths = mesh.split(['(', ')']).nth(2).unwrap().split(", ").map(|text| text.parse().unwrap());
            (DVec3::ZERO, DVec3::from_slice(&lengths.collect::<Vec<f64>>()))
        }
        Some("Cylinder") => (half * DVec3::new(-1.0, -1.0, 0.0), half * DVec3::new(1.0, 1.0, 2.0)),
        Some("Ellipsoid") => (half * DVec3::new(-1.0, -0.8, -1.0), half * DVec3::new(1.0, 0.8, 1.0)),
        Some("Lens") => (half * DVec3::new(-1.0, -1.0, -0.4), half * DVec3::new(1.0, 1.0, 0.4)),
        _ => (DVec3::ZERO, 2.0 * half),
    }
}

/// A selection by place: nodes, faces or elements may be in it, or none.
pub fn place(size: f64, r: &mut Rng) -> String {
    match r.u8(..6) {
        0 => "All".into(),
        1 => format!("Sphere(center: {}, radius: {:?})", vector(r, size), size * number(r, 0.3, 1.0)),
        2 => {
            format!("Not(Plane(normal: (0, 0, 1), at: {:?}, tolerance: {:?}))", size * number(r, 0.0, 1.0), 0.4 * size)
        }
        3 => format!("Surface(normal: {})", one_of(r, &["(0, 0, 1)", "(1, 0, 0)", "(0, -1, 0)"])),
        _ => {
            let axis = one_of(r, &["(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"]);
            format!(
                "Plane(normal: {axis}, at: {:?}, tolerance: {:?})",
                size * number(r, -0.5, 1.0),
                size * number(r, 0.05, 0.4)
            )
        }
    }
}

pub fn curve(duration: f64, r: &mut Dice) -> String {
    let mut time = || duration * number(r, 0.0, 1.0);
    let (a, b) = (time(), time());
    // all at once, and so late that only the last check can see it
    if let Some(share) = r.late() {
        return format!(", curve: Step(start: {:?})", share * duration);
    }
    let (start, end) = (a.min(b), a.max(b) + 1e-3 * duration);
    match r.u8(..6) {
        0 => String::new(),
        1 => format!(", curve: Step(start: {start:?}, end: {end:?})"),
        2 => format!(", curve: Ramp(start: {start:?}, end: {end:?})"),
        3 => format!(
            ", curve: Table([(0.0, {:?}), ({start:?}, {:?}), ({:?}, {:?})])",
            r.f64(),
            r.f64(),
            end + duration,
            r.f64() - 1.0
        ),
        _ => format!(", curve: Smooth(start: {start:?}, end: {end:?})"),
    }
}

fn axes(r: &mut Rng) -> &'static str {
    one_of(r, &["", "", ", axes: [X]", ", axes: [Y, Z]", ", axes: [X, Z]"])
}

fn constraint(bodies: &[Geometry], duration: f64, statics: bool, r: &mut Dice) -> String {
    let body = &bodies[r.usize(..bodies.len())];
    let head = format!("body: \"{}\", on: {}{}", body.name, place(body.size, r), axes(r));
    if r.bool() || statics && r.bool() {
        return format!("Fixed({head})");
    }
    let mut further = String::new();
    // up to right through the body, and more than a turn
    let (far, turned, strained) = (r.far_beyond(20.0), r.beyond(10.0), r.beyond(20.0));
    if r.u8(..3) > 0 {
        let _ = write!(further, ", displacement: {}", vector(r, 0.3 * body.size * far));
    }
    if r.u8(..3) == 0 {
        let _ = write!(further, ", rotation: {}, center: {}", vector(r, 60.0 * turned), vector(r, body.size));
    }
    if r.u8(..4) == 0 {
        let [x, y, z] = [0; 3].map(|_| vector(r, 0.2 * strained));
        let _ = write!(further, ", gradient: ({x}, {y}, {z})");
    }
    format!("Prescribed({head}{further}{})", curve(duration, r))
}

fn load(bodies: &[Geometry], duration: f64, r: &mut Dice) -> String {
    let body = &bodies[r.usize(..bodies.len())];
    let on = format!("body: \"{}\", on: {}", body.name, place(body.size, r));
    let course = curve(duration, r);
    let great = r.far_beyond(1e6);
    match r.u8(..5) {
        0 => format!(
            "NodalForce({on}, force: {}, share: {}{course})",
            vector(r, 100.0 * great * body.size * body.size),
            one_of(r, &["Each", "Total"])
        ),
        1 => format!("Pressure({on}, pressure: {:?}{course})", great * number(r, -300.0, 300.0)),
        2 => format!("Traction({on}, traction: {}{course})", vector(r, 300.0 * great)),
        _ => format!("Gravity(body: \"{}\", acceleration: {}{course})", body.name, vector(r, 10.0 * great)),
    }
}

fn removal(bodies: &[Geometry], duration: f64, r: &mut Rng) -> String {
    let body = &bodies[r.usize(..bodies.len())];
    let (start, length) = (duration * number(r, 0.0, 0.8), duration * number(r, 0.01, 0.5));
    let when = match r.u8(..6) {
        0 => format!("StretchAbove({:?})", number(r, 1.02, 1.6)),
        1 => format!("VolumeRatioBelow({:?})", number(r, 0.3, 0.99)),
        2 => format!("EnergyDensityAbove({:?})", size(r, 1.0, 1e3)),
        3 => format!("At({start:?})"),
        _ => format!("During(start: {start:?}, end: {:?})", start + length),
    };
    format!("(body: \"{}\", on: {}, when: {when})", body.name, place(body.size, r))
}

fn integration(statics: bool, r: &mut Rng) -> String {
    let mut all = Vec::new();
    if r.u8(..3) == 0 {
        all.push(format!("safety: {:?}", number(r, 0.2, 0.95)));
    }
    if r.u8(..3) == 0 && !statics {
        all.push(format!("bound: {}", one_of(r, &["Elements", "Iterated"])));
    }
    if r.u8(..3) == 0 && !statics {
        let mass = format!("ScaleMass(most: {:?})", size(r, 0.01, 1.0));
        all.push(format!("when_unstable: {}", one_of(r, &["Adapt", "Watch", "Remove", &mass, &mass])));
    }
    if r.u8(..4) == 0 {
        all.push("compensated: false".into());
    }
    all.join(", ")
}

/// How steps are taken in a violent scene: much as in a mild one, or with mass scaled, or of a length of its own, below
/// what is stable or just beyond it.
fn violent_steps(mild: String, stable: Option<f64>, temper: Temper, wild: &mut Rng) -> String {
    let kind = match temper {
        Temper::Heavy => wild.u8(2..4),
        Temper::Late => wild.u8(..6),
        _ => wild.u8(..8),
    };
    let share = number(wild, 0.3, 1.0);
    let most = if temper == Temper::Heavy { number(wild, 0.2, 1.0) } else { size(wild, 0.02, 1.0) };
    let own = |share: f64| stable.map_or(String::new(), |stable| format!(", step: {:?}", share * stable));
    match kind {
        0 | 1 => mild,
        2 => format!("when_unstable: ScaleMass(most: {most:?})"),
        3 => format!("when_unstable: ScaleMass(most: {most:?}){}", own(1.3 * share)),
        4 => format!("when_unstable: Watch{}", own(share)),
        5 => format!("when_unstable: {}{}", one_of(wild, &["Adapt", "Remove"]), own(share)),
        _ => format!("beyond_stable_step: true, when_unstable: Watch{}", own(1.1 + share)),
    }
}

/// How a violent scene is guarded: often so seldom that only the check at the end sees anything.
fn violent_guards(every: u64, may_be_off: bool, temper: Temper, wild: &mut Rng) -> String {
    let every = if wild.bool() { 1000 } else { every };
    match wild.u8(..if temper == Temper::Late { 2 } else { 4 }) {
        0 if may_be_off => format!("every: {every}, off: [Energy]"),
        1 => format!("every: {every}, energy: (stop: {:?})", size(wild, 0.01, 1e4)),
        _ => format!("every: {every}"),
    }
}
