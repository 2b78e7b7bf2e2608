//! Paths of equilibria by arc length: through limit points and beyond buckling, against closed forms.

use crate::configurations::scene_of;
use crate::implicit::options;
use sinew::components::Precision;
use sinew::{Folder, SceneFile, Simulation};
use std::f64::consts::PI;
use std::path::Path;

/// A point: the load factor, whether bodies give way, and what probes see.
struct Point {
    factor: f64,
    unstable: bool,
    seen: Vec<f64>,
}

/// The rows of `path.csv`, and the simulation at the end of the path.
fn follow(file: &SceneFile) -> (Vec<Point>, Simulation) {
    let place = tempfile::tempdir().unwrap();
    let mut folder = Folder::create(&place.path().join("out")).unwrap();
    let mut simulation = Simulation::new(file, &options(Precision::F64, 1)).unwrap();
    simulation.write_into(&mut folder).unwrap();
    simulation.finish().unwrap();
    let found = simulation.equilibrium().unwrap();
    println!("{found:?}\n{:?}", simulation.implicit_steps());
    assert!(found.reached && found.newton_iterations > 0);
    let text = std::fs::read_to_string(place.path().join("out/path.csv")).unwrap();
    let row = |line: &str| -> Vec<f64> { line.split(',').map(|number| number.trim().parse().unwrap()).collect() };
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(row).collect();
    assert!(rows.iter().map(|row| row[1]).eq(found.path.iter().map(|point| point.load_factor)), "{text}");
    let point = |row: &Vec<f64>| Point { factor: row[1], unstable: row[4] == 1.0, seen: row[5..].to_vec() };
    (rows.iter().map(point).collect(), simulation)
}

fn follow_text(text: &str) -> (Vec<Point>, Simulation) {
    follow(&scene_of(text, Path::new(".")))
}

/// One element that is drawn out sideways held, of a law that softens and hardens: every point is one of P(x).
#[test]
fn a_law_that_softens_is_followed_through_both_limit_points() {
    let (bulk, shear, soft, hard) = (1e4, 100.0, 3.0, 2.5);
    let (points, _) = follow_text(&format!(
        "(duration: 1, analysis: Static(method: Newton, arc: (first: 0.05, longest: 0.003)),
        bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1), elements: Hex8MeanDilatation), material: \"m\")}},
        materials: {{\"m\": (density: 1000, law: (
            energy: \"mu/2*I1bar_minus_3 + k*(J_minus_1^2/2 - a*J_minus_1^3/3 + b*J_minus_1^4/4)\",
            parameters: {{\"mu\": {shear}, \"k\": {bulk}, \"a\": {soft}, \"b\": {hard}}}))}},
        constraints: [Fixed(on: Set(\"x0\")), Fixed(on: All, axes: [Y, Z])],
        loads: [NodalForce(on: Set(\"x1\"), force: (20, 0, 0), share: Total)],
        probes: {{\"end\": (what: Displacement, on: Set(\"x1\"))}})"
    ));
    let pressure = |x: f64| {
        let of_shear = 0.5 * shear * 4.0 / 3.0 * ((1.0 + x).cbrt() - (1.0 + x).powf(-5.0 / 3.0));
        of_shear + bulk * (x - soft * x * x + hard * x.powi(3))
    };
    let slope = |x: f64| pressure(x + 1e-6) - pressure(x - 1e-6);
    for Point { factor, unstable, seen } in &points {
        let (x, force) = (seen[0] / 0.1, 20.0 * factor);
        let expected = pressure(x) * 0.01;
        assert!((force - expected).abs() < 1e-8 * 20.0, "{force} N at {x}: {expected} N");
        assert_eq!(*unstable, slope(x) < 0.0, "at {x}");
    }
    let most = (1..800).map(|i| f64::from(i) * 1e-3).filter(|&x| x < 0.4).map(pressure).fold(0.0, f64::max) * 0.01;
    let highest = points.iter().filter(|point| point.seen[0] < 0.04).map(|point| 20.0 * point.factor);
    let highest = highest.fold(0.0, f64::max);
    assert!(highest <= most * (1.0 + 1e-8) && highest > 0.99 * most, "{highest} N of {most} N");
    assert!(points.iter().filter(|point| point.unstable).count() > 5);
    let last = points.last().unwrap();
    assert!(last.factor == 1.0 && last.seen[0] > 0.07 && !last.unstable, "{} m", last.seen[0]);
}

/// How stiff a bar of such a mesh is under a small load across its end, as a share of what a beam is: EI of a few
/// layers of elements is not quite that.
fn share_of_bending([length, side]: [f64; 2], cells: &str, young: f64) -> f64 {
    let (bending, force) = (young * side.powi(4) / 12.0, 1e-6 * young * side.powi(4) / (length * length));
    let scene = format!(
        "(duration: 1, analysis: Static(method: Newton),
        bodies: {{\"b\": (mesh: Box(size: ({side}, {side}, {length}), cells: {cells}, elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: {young}, poisson: 0))}},
        constraints: [Fixed(on: Set(\"z0\"))],
        loads: [NodalForce(on: Set(\"z1\"), force: ({force:e}, 0, 0), share: Total)],
        probes: {{\"end\": (what: Displacement, on: Set(\"z1\"))}})"
    );
    let mut simulation = Simulation::new(&scene_of(&scene, Path::new(".")), &options(Precision::F64, 1)).unwrap();
    simulation.finish().unwrap();
    let share = force * length.powi(3) / (3.0 * bending) / simulation.probe("end").unwrap()[0];
    println!("{cells}: {share} of the bending stiffness of a beam");
    assert!((share - 1.0).abs() < 0.1, "{share}");
    share
}

/// How hard a shallow arch of radius R, thickness t, width t and length L is pushed in the middle where it has gone
/// down by so much (m, N): its deflection is Σ aₙ (1 − cos 2πn x/L), whose aₙ do not know of each other for a given
/// axial force, and the push is then a root of a quadratic equation (shallow arches: Schreyer & Masur 1966). `share` of
/// EI is there.
fn shallow_arch([radius, thickness, length]: [f64; 3], young: f64, share: f64) -> Vec<[f64; 2]> {
    let (bending, stretching) = (share * young * thickness.powi(4) / 12.0, young * thickness.powi(2));
    let k: Vec<f64> = (1..40).map(|n| 2.0 * PI * f64::from(n) / length).collect();
    let middle: Vec<f64> = (1..40).map(|n| 1.0 - (PI * f64::from(n)).cos()).collect();
    let mut found = Vec::new();
    for i in 1..3990 {
        let axial = -1e-3 * f64::from(i) * bending * k[0] * k[0];
        let stiff: Vec<f64> = k.iter().map(|k| 0.5 * length * (bending * k.powi(4) + axial * k * k)).collect();
        // aₙ = P alongₙ + aloneₙ
        let along: Vec<f64> = middle.iter().zip(&stiff).map(|(middle, stiff)| -middle / stiff).collect();
        let alone: Vec<f64> = stiff.iter().map(|stiff| -axial * length / radius / stiff).collect();
        let sum = |of: &dyn Fn(usize) -> f64| (0..k.len()).map(of).sum::<f64>();
        let square = stretching / 4.0 * sum(&|n| (k[n] * along[n]).powi(2));
        let linear = stretching * sum(&|n| along[n] / radius + 0.5 * k[n] * k[n] * along[n] * alone[n]);
        let constant = stretching * sum(&|n| alone[n] / radius + 0.25 * (k[n] * alone[n]).powi(2)) - axial;
        let inside = linear * linear - 4.0 * square * constant;
        for sign in [1.0, -1.0] {
            let force = (sign * inside.sqrt() - linear) / (2.0 * square);
            let down = sum(&|n| (force * along[n] + alone[n]) * middle[n]);
            if inside >= 0.0 {
                found.push([-down, force]);
            }
        }
    }
    found
}

/// The example, to what the theory leaves out where the ends slope by α = .3: α²/2.
#[test]
#[ignore = "long"]
fn an_arch_snaps_where_the_theory_of_shallow_arches_has_it() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/snap.ron");
    let (points, _) = follow(&SceneFile::load(Path::new(path), &[]).unwrap());
    let (angle, radius) = (34.4_f64.to_radians(), 0.06);
    let rise = radius * (1.0 - (0.5 * angle).cos());
    let share = share_of_bending([radius * angle, 1e-3], "(4, 1, 72)", 1e5);
    let theory = shallow_arch([radius, 1e-3, radius * angle], 1e5, share);
    let within = |down: f64, range: [f64; 2]| down > range[0] * rise && down < range[1] * rise;
    let extreme = |range: [f64; 2], of: &dyn Fn(f64, f64) -> f64, from: f64| {
        let found = points.iter().map(|point| [-point.seen[1], 1.2e-4 * point.factor]);
        let found = found.filter(|[down, _]| within(*down, range)).map(|[_, force]| force).fold(from, of);
        let expected = theory.iter().filter(|[down, _]| within(*down, range)).map(|[_, force]| *force).fold(from, of);
        println!("{found:e} N, expected {expected:e} N");
        [found, expected]
    };
    let [highest, expected] = extreme([0.0, 0.8], &f64::max, 0.0);
    assert!((highest - expected).abs() < 0.045 * expected, "{highest} N, expected {expected} N");
    let [lowest, least] = extreme([0.8, 1.5], &f64::min, f64::INFINITY);
    assert!((lowest - least).abs() < 0.045 * least, "{lowest} N, expected {least} N");
    let last = points.last().unwrap();
    assert!(last.factor == 1.0 && !last.unstable && -last.seen[1] > 1.4 * rise, "{:?}", last.seen);
    assert!(points.iter().any(|point| point.unstable));
}

/// K(k) and E(k) by the arithmetic-geometric mean.
fn complete_integrals(k: f64) -> [f64; 2] {
    let (mut a, mut b, mut sum, mut power) = (1.0, (1.0 - k * k).sqrt(), 0.5 * k * k, 1.0);
    for _ in 0..8 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += power * c * c;
        power *= 2.0;
    }
    let whole = 0.5 * PI / a;
    [whole, whole * (1.0 - sum)]
}

/// A column under 1.15 of its critical load and a hundredth across, beyond buckling: the elastica whose end is as far
/// aside bears (2 K/π)² of the critical load, its end being 2 k/K of its length aside.
#[test]
#[ignore = "long"]
fn a_column_bears_beyond_buckling_what_the_elastica_does() {
    let (length, side) = (0.2, 0.01_f64);
    let share = share_of_bending([length, side], "(4, 1, 40)", 3e3);
    let critical = share * PI.powi(2) * 3e3 * side.powi(4) / 12.0 / (4.0 * length * length);
    let (points, _) = follow_text(&format!(
        "(duration: 1, analysis: Static(method: Newton, arc: (first: 0.3, longest: 0.006)),
        bodies: {{\"b\": (mesh: Box(size: ({side}, {side}, {length}), cells: (4, 1, 40), elements: Hex8), material: \"m\")}},
        materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0))}},
        constraints: [Fixed(on: Set(\"z0\"))],
        loads: [NodalForce(on: Set(\"z1\"), force: ({:e}, 0, {:e}), share: Total)],
        probes: {{\"end\": (what: Displacement, on: Set(\"z1\"))}})",
        1e-3 * critical,
        -1.15 * critical
    ));
    let mut checked = 0;
    for Point { factor, unstable, seen } in &points {
        let aside = seen[0].hypot(seen[1]) / length;
        assert!(!unstable, "at {aside}");
        if !(0.25..0.65).contains(&aside) {
            continue;
        }
        let (mut low, mut high) = (0.0, 0.9);
        for _ in 0..60 {
            let k = 0.5 * (low + high);
            if 2.0 * k / complete_integrals(k)[0] < aside { low = k } else { high = k }
        }
        let expected = (2.0 * complete_integrals(low)[0] / PI).powi(2);
        let found = 1.15 * factor;
        println!("{aside:.3} aside: {found:.4}, expected {expected:.4}");
        // what is across, a thousandth, bends it where it leans, and it is 1/1600 P/EA shorter
        assert!((found - expected).abs() < 0.02 * expected, "{aside} aside: {found}, expected {expected}");
        checked += 1;
    }
    assert!(checked > 2 && points.last().unwrap().factor == 1.0);
}

#[test]
fn a_path_ends_after_as_many_points_as_are_wanted_and_is_refused_where_it_has_no_meaning() {
    let scene = |analysis: &str, more: &str| {
        format!(
            "(duration: 1, {analysis}, bodies: {{\"b\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (1, 1, 1), elements: Hex8MeanDilatation), material: \"m\")}},
            materials: {{\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.3))}},
            constraints: [Fixed(on: Set(\"z0\"))], loads: [Gravity(acceleration: (0, 0, -2))]{more})"
        )
    };
    let (points, simulation) =
        follow_text(&scene("analysis: Static(method: Newton, arc: (first: 0.1, longest: 3e-4, points: 3))", ""));
    let factor = points.last().unwrap().factor;
    assert!(points.len() == 3 && factor > 0.1 && factor < 0.9, "{} points to {factor}", points.len());
    assert!((simulation.time() - factor).abs() < 1e-12, "{} s", simulation.time());
    let tool = ", tools: {\"t\": (shape: Plane())}, contacts: [Tool(tool: \"t\", law: Penalty(share: 1))]";
    for (analysis, more, expected) in [
        ("analysis: Static(arc: ())", "", "is one of Newton's iterations"),
        ("analysis: Static(method: Newton, arc: (first: 0))", "", "`first` must be above 0 and at most 1"),
        ("analysis: Static(method: Newton, arc: (longest: 0))", "", "`longest`"),
        ("analysis: Static(method: Newton, arc: (points: 0))", "", "`points` must be from 1"),
        ("analysis: Static(method: Newton, arc: ())", tool, "takes no part in contact"),
        ("start: Equilibrium(method: Newton, arc: ())", "", "at no point of a path"),
    ] {
        let told = match SceneFile::from_text("test", &scene(analysis, more), Path::new("."), &[]) {
            Ok(read) => {
                Simulation::new(&read, &options(Precision::F64, 1)).err().map_or("nothing".into(), |e| e.to_string())
            }
            Err(wrong) => wrong.render(false),
        };
        assert!(told.contains(expected), "{analysis}: {told}");
    }
    let read = scene_of(&scene("analysis: Static(method: Newton, arc: ())", ""), Path::new("."));
    let told = Simulation::new(&read, &options(Precision::F32, 1)).err().map_or("nothing".into(), |e| e.to_string());
    assert!(told.contains("is followed in f64") && told.contains("--precision f64"), "{told}");
}
