//! Whole scenes made up from a seed: small, sound, with every feature that a scene can have.

use fastrand::Rng;
use std::fmt::Write;

/// A scene of a seed. Times in it are shares of `duration` (s), so that the same scene can be had for as many steps as wanted.
pub struct Made {
    /// The text.
    pub text: String,
    /// Whether elements go, or turn inside out, as soon as a number passes a limit: what rounding may decide.
    pub decides: bool,
}

/// The scene of a seed.
pub fn scene(seed: u64, duration: f64) -> Made {
    let mut rng = Rng::with_seed(seed);
    let r = &mut rng;
    let mut text = format!("(duration: {duration:?}, ");
    let statics = r.u8(..12) == 0;
    if statics {
        let _ = write!(text, "analysis: Static(max_steps: {}), ", r.u64(50..400));
    }
    let bodies: Vec<Geometry> = (0..if r.u8(..6) == 0 { 2 } else { 1 }).map(|number| Geometry::of(number, r)).collect();
    let described: Vec<String> = bodies.iter().map(|body| body.text.clone()).collect();
    let _ = write!(text, "bodies: {{{}}}, ", described.join(", "));
    let (materials, mut decides) = materials(r);
    let _ = write!(text, "materials: {{{materials}}}, ");
    let some = |r: &mut Rng, most: u8, make: &dyn Fn(&mut Rng) -> String| {
        (0..r.u8(..=most)).map(|_| make(r)).collect::<Vec<_>>().join(", ")
    };
    let constraints = some(r, 3, &|r| constraint(&bodies, duration, statics, r));
    let loads = some(r, 3, &|r| load(&bodies, duration, r));
    let _ = write!(text, "constraints: [{constraints}], loads: [{loads}], ");
    if !statics && r.u8(..3) == 0 {
        let removal = some(r, 2, &|r| removal(&bodies, duration, r));
        decides |= removal.contains("Above") || removal.contains("Below");
        let _ = write!(text, "removal: [{removal}], ");
    }
    let _ = write!(text, "integration: ({}), ", integration(statics, r));
    decides |= text.contains("when_unstable: Remove");
    let _ = write!(text, "fuse: {}, ", r.bool());
    if !statics && r.u8(..3) > 0 {
        let _ = write!(text, "output: (energies_every: {:?}), ", duration * number(r, 0.01, 0.4));
    }
    let _ = write!(text, "guards: (every: {}), ", r.u64(1..80));
    text.push(')');
    // of a row of its own, so that all else of a seed stays as it was
    let mut later = Rng::with_seed(seed ^ 0x5eed);
    if later.u8(..5) == 0 && !text.contains("inversion: Recover") {
        let damping = format!("(stiffness_damping: {:?}, density:", size(&mut later, 1e-5, 1e-2));
        text = text.replace("(density:", &damping);
    }
    let moves = ["start: ", "velocity: ", "spin: "].iter().any(|word| text.contains(word));
    if later.u8(..6) == 0 && !statics && !moves {
        text = text.replacen('(', "(start: Equilibrium(tolerance: 1e-6, max_steps: 4000), ", 1);
        // what stands at several places in equilibrium, or at the edge of one, rounding may decide
        decides = true;
    }
    Made { text, decides }
}

fn number(r: &mut Rng, least: f64, most: f64) -> f64 {
    least + (most - least) * r.f64()
}

/// Anything between two numbers, each power of ten alike.
fn size(r: &mut Rng, least: f64, most: f64) -> f64 {
    (number(r, least.ln(), most.ln())).exp()
}

fn vector(r: &mut Rng, most: f64) -> String {
    let mut one = || if r.u8(..4) == 0 { 0.0 } else { number(r, -most, most) };
    format!("({:?}, {:?}, {:?})", one(), one(), one())
}

fn one_of<'a>(r: &mut Rng, all: &[&'a str]) -> &'a str {
    all[r.usize(..all.len())]
}

/// A body, and what must be known to act on it.
struct Geometry {
    name: String,
    text: String,
    /// Its size (m), and half of that where it lies about the origin.
    size: f64,
}

impl Geometry {
    fn of(number_of_it: usize, r: &mut Rng) -> Self {
        let size = size(r, 1e-3, 1.0);
        let kind = one_of(r, &["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation"]);
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
        let name = format!("b{number_of_it}");
        let mut text =
            format!("\"{name}\": (mesh: {mesh}, material: \"m\", translate: ({:?}, 0, 0)", 20.0 * number_of_it as f64);
        let mut add = |r: &mut Rng, one_in: u8, what: &dyn Fn(&mut Rng) -> String| {
            if r.u8(..one_in) == 0 {
                let _ = write!(text, ", {}", what(r));
            }
        };
        add(r, 4, &|r| format!("velocity: {}", vector(r, 0.3)));
        add(r, 6, &|r| format!("spin: {}", vector(r, 5.0)));
        add(r, 8, &|r| format!("copies: 2, apart: ({:?}, 0, 0)", size * number(r, 1.5, 3.0)));
        add(r, 10, &|r| format!("refine: {}", r.u8(..=1)));
        add(r, 6, &|r| format!("rotate: {}", vector(r, 90.0)));
        add(r, 6, &|r| format!("hourglass: {:?}", number(r, 0.5, 2.0)));
        add(r, 6, &|r| match r.bool() {
            true => format!("start: Affine(gradient: ({}, {}, {}))", vector(r, 0.1), vector(r, 0.1), vector(r, 0.1)),
            false => format!("start: Scrambled(amplitude: {:?}, seed: {})", 0.02 * size, r.u8(..)),
        });
        add(r, 5, &|r| format!("regions: [(on: {}, material: \"n\")]", place(size, r)));
        text.push(')');
        Self { name, text, size }
    }
}

/// A selection by place: nodes, faces or elements may be in it, or none.
fn place(size: f64, r: &mut Rng) -> String {
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

fn curve(duration: f64, r: &mut Rng) -> String {
    let mut time = || duration * number(r, 0.0, 1.0);
    let (a, b) = (time(), time());
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

fn constraint(bodies: &[Geometry], duration: f64, statics: bool, r: &mut Rng) -> String {
    let body = &bodies[r.usize(..bodies.len())];
    let head = format!("body: \"{}\", on: {}{}", body.name, place(body.size, r), axes(r));
    if r.bool() || statics && r.bool() {
        return format!("Fixed({head})");
    }
    let mut further = String::new();
    if r.u8(..3) > 0 {
        let _ = write!(further, ", displacement: {}", vector(r, 0.3 * body.size));
    }
    if r.u8(..3) == 0 {
        let _ = write!(further, ", rotation: {}, center: {}", vector(r, 60.0), vector(r, body.size));
    }
    if r.u8(..4) == 0 {
        let _ = write!(further, ", gradient: ({}, {}, {})", vector(r, 0.2), vector(r, 0.2), vector(r, 0.2));
    }
    format!("Prescribed({head}{further}{})", curve(duration, r))
}

fn load(bodies: &[Geometry], duration: f64, r: &mut Rng) -> String {
    let body = &bodies[r.usize(..bodies.len())];
    let on = format!("body: \"{}\", on: {}", body.name, place(body.size, r));
    let course = curve(duration, r);
    match r.u8(..5) {
        0 => format!(
            "NodalForce({on}, force: {}, share: {}{course})",
            vector(r, 100.0 * body.size * body.size),
            one_of(r, &["Each", "Total"])
        ),
        1 => format!("Pressure({on}, pressure: {:?}{course})", number(r, -300.0, 300.0)),
        2 => format!("Traction({on}, traction: {}{course})", vector(r, 300.0)),
        _ => format!("Gravity(body: \"{}\", acceleration: {}{course})", body.name, vector(r, 10.0)),
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

/// Two materials, `m` and `n`; and whether elements go when they turn inside out.
fn materials(r: &mut Rng) -> (String, bool) {
    let both = ["m", "n"].map(|name| format!("\"{name}\": ({})", material(r)));
    let decides = both.iter().any(|text| text.contains("inversion: Remove"));
    (both.join(", "), decides)
}

fn material(r: &mut Rng) -> String {
    let shear = size(r, 100.0, 1e5);
    let bulk = shear * size(r, 2.0, 200.0);
    let moduli = format!("Moduli(shear: {shear:?}, bulk: {bulk:?})");
    let law = match r.u8(..9) {
        0 => format!("linear: {moduli}"),
        1 => format!("st_venant_kirchhoff: {moduli}"),
        2 => format!("stable_neo_hookean: {moduli}"),
        3 => format!("mooney_rivlin: (c10: {:?}, c01: {:?}, bulk: {bulk:?})", 0.4 * shear, 0.1 * shear),
        4 => format!(
            "ogden: (terms: [(mu: {:?}, alpha: {:?}), (mu: {:?}, alpha: {:?})], bulk: {bulk:?})",
            0.3 * shear,
            number(r, 1.0, 8.0),
            -0.1 * shear,
            number(r, -5.0, -1.0)
        ),
        5 => format!("arruda_boyce: (shear: {shear:?}, locking_stretch: {:?}, bulk: {bulk:?})", number(r, 1.5, 7.0)),
        _ => format!("neo_hookean: {moduli}"),
    };
    let recovers = law.starts_with("stable");
    let mut all = vec![format!("density: {:?}", size(r, 500.0, 3000.0)), law];
    let direction = |r: &mut Rng| match r.bool() {
        true => format!("Along({:?}, {:?}, 1)", r.f64(), r.f64()),
        false => "Around(axis: (0, 0.2, 1))".to_string(),
    };
    if r.u8(..4) == 0 {
        all.push(format!(
            "fibres: (eta: {:?}, direction: {}, tension_only: {})",
            shear * size(r, 0.1, 20.0),
            direction(r),
            r.bool()
        ));
    }
    if r.u8(..6) == 0 {
        all.push(format!(
            "exponential_fibres: [(k1: {:?}, k2: {:?}, dispersion: {:?}, direction: {})]",
            shear * size(r, 0.1, 3.0),
            size(r, 0.5, 20.0),
            number(r, 0.0, 0.33),
            direction(r)
        ));
    }
    if r.u8(..3) == 0 {
        let term = |r: &mut Rng| format!("(alpha: {:?}, tau: {:?})", number(r, 0.0, 0.45), size(r, 1e-5, 10.0));
        let integrator = one_of(r, &["Exact", "BackwardEuler"]);
        all.push(format!(
            "prony: (terms: [{}, {}], volumetric: [{}], integrator: {integrator}, reproject: {})",
            term(r),
            term(r),
            term(r),
            r.bool()
        ));
    }
    if r.u8(..3) == 0 {
        all.push(format!("damping: {:?}", size(r, 0.1, 100.0)));
    }
    let plain = !all.iter().any(|part| part.contains("fibres") || part.contains("prony"));
    match r.u8(..6) {
        0 => all.push("inversion: Remove".into()),
        1 => all.push("inversion: Stop".into()),
        2 if recovers && plain => all.push("inversion: Recover".into()),
        _ => {}
    }
    all.join(", ")
}
