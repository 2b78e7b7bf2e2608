//! One free tetrahedron by the linearised step of implicit Euler, beside its 12×12 equation solved densely: products by
//! difference against the tangents of two laws in closed form. A law in a frame of edges, whose tangent is not
//! symmetric, by Newton's iterations until nothing is left. With damping by mass and by stiffness, and without.

use crate::columns::{internal_forces, masses, positions, velocities};
use crate::implicit::options;
use glam::{DMat3, DVec3};
use sinew::components::Precision;
use sinew::{SceneFile, Simulation};

const SHEAR: f64 = 3e3 / (2.0 * 1.3);
const LAME: f64 = 3e3 * 0.3 / (1.3 * 0.4);
const BULK: f64 = LAME + 2.0 / 3.0 * SHEAR;
/// No two of its edges are of one length, no face is upright.
const REST: [DVec3; 4] = [
    DVec3::new(0.0, 0.0, 0.0),
    DVec3::new(0.1, 0.01, -0.02),
    DVec3::new(0.03, 0.08, 0.01),
    DVec3::new(0.02, -0.01, 0.12),
];
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.1 0.01 -0.02\n3 0.03 0.08 0.01\n\
                    4 0.02 -0.01 0.12\n$EndNodes\n$Elements\n1\n1 4 2 0 0 1 2 3 4\n$EndElements\n";

/// S_iso and p (Pa), whose rates damp.
type Parts = (DMat3, f64);

/// A law: P (Pa) of F, and its change δP along δF.
struct Law {
    word: &'static str,
    /// What stands in a scene beside its moduli.
    more: &'static str,
    /// Iterations of Newton's, and the tolerance of conjugate gradients.
    newton: (usize, f64),
    /// What a step is off by, as a share of how far forces take the tetrahedron in one.
    error: f64,
    stress: fn(DMat3) -> DMat3,
    change: fn(DMat3, DMat3) -> DMat3,
    parts: fn(DMat3) -> Parts,
    /// P of F where the parts are as told, and its change along δF where they stay.
    of_parts: fn(DMat3, Parts) -> DMat3,
    of_parts_change: fn(DMat3, DMat3, Parts) -> DMat3,
}

const LAWS: [Law; 2] = [
    Law {
        word: "corotational",
        more: "",
        newton: (1, 1e-9),
        error: LINEARISED,
        stress: corotational,
        change: corotational_change,
        parts: corotational_parts,
        of_parts: |f, (s, p)| f * s + rotation(f) * p,
        of_parts_change: |f, along, (s, p)| along * s + rotation_change(f, along) * p,
    },
    Law {
        word: "neo_hookean",
        more: "",
        newton: (1, 1e-9),
        error: LINEARISED,
        stress: neo_hookean,
        change: neo_hookean_change,
        parts: neo_hookean_parts,
        of_parts: |f, (s, p)| f * s + f.inverse().transpose() * (f.determinant() * p),
        of_parts_change: |f, along, (s, p)| {
            let (inverse, j) = (f.inverse().transpose(), f.determinant());
            let turned = inverse * along.transpose() * inverse;
            along * s + (inverse * contract(inverse, along) - turned) * (j * p)
        },
    },
];
const IN_FRAME: Law = Law {
    word: "corotational",
    more: ", rotation: Frame",
    newton: (40, 1e-10),
    error: SOLVED,
    stress: in_frame,
    change: in_frame_change,
    parts: |f| frame_parts(f).1,
    of_parts: |f, (s, p)| frame_parts(f).0 * (s + DMat3::IDENTITY * p),
    of_parts_change: |f, along, parts| by_difference(|f| (IN_FRAME.of_parts)(f, parts), f, along),
};
/// Half the curvature of a law over a strain of 1e-7 is 5e-8 of its forces where J is near 1, and rounding 1e-16/1e-7;
/// forces are a part of what the equation has, the masses the other.
const LINEARISED: f64 = 1e-8;
/// Newton's iterations end where 1e-10 of all forces are left.
const SOLVED: f64 = 1.8e-10;

fn contract(a: DMat3, b: DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}

/// The rotation nearest to F, by Newton's iteration R ← (R + R⁻ᵀ)/2 (Higham 1986).
fn rotation(f: DMat3) -> DMat3 {
    (0..60).fold(f, |r, _| (r + r.inverse().transpose()) * 0.5)
}

/// P = 2μ (F − R) + λ tr(RᵀF − I) R (Chao et al. 2010).
fn corotational(f: DMat3) -> DMat3 {
    let r = rotation(f);
    (f - r) * (2.0 * SHEAR) + r * (LAME * (contract(r, f) - 3.0))
}

/// S_iso = 2μ F⁻¹ (F − R − ⅓ tr(RᵀF − I) R), p = κ tr(RᵀF − I).
fn corotational_parts(f: DMat3) -> Parts {
    let r = rotation(f);
    let trace = contract(r, f) - 3.0;
    (f.inverse() * (f - r * (1.0 + trace / 3.0)) * (2.0 * SHEAR), BULK * trace)
}

/// δR = R [(tr(S) I − S)⁻¹ a]×, S = RᵀF, a the axial vector of RᵀδF − δFᵀR.
fn rotation_change(f: DMat3, along: DMat3) -> DMat3 {
    let r = rotation(f);
    let (s, w) = (r.transpose() * f, r.transpose() * along);
    let skew = w - w.transpose();
    let axial = DVec3::new(skew.y_axis.z, skew.z_axis.x, skew.x_axis.y);
    let trace = s.x_axis.x + s.y_axis.y + s.z_axis.z;
    let turn = (DMat3::IDENTITY * trace - s).inverse() * axial;
    let cross = DMat3::from_cols(
        DVec3::new(0.0, turn.z, -turn.y),
        DVec3::new(-turn.z, 0.0, turn.x),
        DVec3::new(turn.y, -turn.x, 0.0),
    );
    r * cross
}

fn corotational_change(f: DMat3, along: DMat3) -> DMat3 {
    let (r, turned) = (rotation(f), rotation_change(f, along));
    (along - turned) * (2.0 * SHEAR) + r * (LAME * contract(r, along)) + turned * (LAME * (contract(r, f) - 3.0))
}

/// The frame of edges 01 and 02: along the first, across the plane of both (SOFA's `large`).
fn frame(first: DVec3, second: DVec3) -> DMat3 {
    let (x, z) = (first.normalize(), first.cross(second).normalize());
    DMat3::from_cols(x, z.cross(x), z)
}

/// R, and 2μ dev ε and κ tr ε in it, ε = sym(RᵀF − I).
fn frame_parts(f: DMat3) -> (DMat3, Parts) {
    let [a, b] = [REST[1] - REST[0], REST[2] - REST[0]];
    let r = frame(f * a, f * b) * frame(a, b).transpose();
    let off = r.transpose() * f - DMat3::IDENTITY;
    let strain = (off + off.transpose()) * 0.5;
    let trace = strain.x_axis.x + strain.y_axis.y + strain.z_axis.z;
    (r, ((strain - DMat3::IDENTITY * (trace / 3.0)) * (2.0 * SHEAR), BULK * trace))
}

/// P = R (2μ ε + λ tr ε I).
fn in_frame(f: DMat3) -> DMat3 {
    let (r, (isochoric, pressure)) = frame_parts(f);
    r * (isochoric + DMat3::IDENTITY * pressure)
}

/// By central differences, whose third of 1e-10 is nothing where iterations end by the residual.
fn by_difference(of: impl Fn(DMat3) -> DMat3, f: DMat3, along: DMat3) -> DMat3 {
    let step = 1e-5 / contract(along, along).sqrt();
    (of(f + along * step) - of(f - along * step)) * (0.5 / step)
}

fn in_frame_change(f: DMat3, along: DMat3) -> DMat3 {
    by_difference(in_frame, f, along)
}

/// Ψ = μ/2 (I₁ J^(−2/3) − 3) + κ/2 (J − 1)².
fn neo_hookean(f: DMat3) -> DMat3 {
    let (j, inverse) = (f.determinant(), f.inverse().transpose());
    (f - inverse * (contract(f, f) / 3.0)) * (SHEAR * j.powf(-2.0 / 3.0)) + inverse * (BULK * (j - 1.0) * j)
}

/// S_iso = μ J^(−2/3) (I − I₁/3 C⁻¹), p = κ (J − 1).
fn neo_hookean_parts(f: DMat3) -> Parts {
    let (j, inverse) = (f.determinant(), (f.transpose() * f).inverse());
    let isochoric = (DMat3::IDENTITY - inverse * (contract(f, f) / 3.0)) * (SHEAR * j.powf(-2.0 / 3.0));
    (isochoric, BULK * (j - 1.0))
}

fn neo_hookean_change(f: DMat3, along: DMat3) -> DMat3 {
    let (j, inverse, squares) = (f.determinant(), f.inverse().transpose(), contract(f, f));
    let growth = contract(inverse, along);
    let turned = inverse * along.transpose() * inverse;
    let isochoric = along - inverse * (2.0 / 3.0 * contract(f, along)) + turned * (squares / 3.0)
        - (f - inverse * (squares / 3.0)) * (2.0 / 3.0 * growth);
    isochoric * (SHEAR * j.powf(-2.0 / 3.0)) + inverse * (BULK * (2.0 * j - 1.0) * j * growth)
        - turned * (BULK * (j - 1.0) * j)
}

/// Gradients of the shape functions at rest (1/m), and the volume (m³).
fn shape() -> ([DVec3; 4], f64) {
    let edges = DMat3::from_cols(REST[1] - REST[0], REST[2] - REST[0], REST[3] - REST[0]);
    let rows = edges.inverse().transpose();
    ([-(rows.x_axis + rows.y_axis + rows.z_axis), rows.x_axis, rows.y_axis, rows.z_axis], edges.determinant() / 6.0)
}

/// Σ x⊗g.
fn gradient(x: &[DVec3; 4]) -> DMat3 {
    let (g, _) = shape();
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    (0..4).fold(DMat3::ZERO, |sum, a| sum + outer(x[a], g[a]))
}

/// V P g.
fn forces(stress: DMat3) -> [DVec3; 4] {
    let (g, volume) = shape();
    g.map(|g| stress * g * volume)
}

/// Solves a dense system by elimination with pivots.
fn solve(mut a: [[f64; 12]; 12], mut b: [f64; 12]) -> [f64; 12] {
    for column in 0..12 {
        let pivot = (column..12).max_by(|&i, &k| a[i][column].abs().total_cmp(&a[k][column].abs())).unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..12 {
            let factor = a[row][column] / a[column][column];
            for k in column..12 {
                a[row][k] -= factor * a[column][k];
            }
            b[row] -= factor * b[column];
        }
    }
    for row in (0..12).rev() {
        b[row] = (b[row] - (row + 1..12).map(|k| a[row][k] * b[k]).sum::<f64>()) / a[row][row];
    }
    b
}

/// Where the tetrahedron is, and the stresses whose rates damp, at the end of the last step.
struct State {
    x: [DVec3; 4],
    v: [DVec3; 4],
    parts: Parts,
}

/// Rates (1/s) and times (s) of damping by mass and by stiffness.
type Damping = (f64, f64);

/// One step of h: M (w − u − h v)/h² + c M (w − u)/h + F(w) + β Ḟ = 0, linearised about w = u + h v, and about what
/// that leads to as often as the law is iterated. The rates are those of S_iso and of the pressure over the step, so
/// that with b = β/h the stress is (1 + b) P less b of the parts of before, turned with what it is at the end. How far
/// forces take it (m).
fn dense_step(law: &Law, mass: f64, (damping, beta): Damping, h: f64, state: &mut State) -> f64 {
    let State { x, v, parts } = state;
    let predicted: [DVec3; 4] = std::array::from_fn(|a| x[a] + h * v[a]);
    let (mut new, b) = (predicted, beta / h);
    let (g, _) = shape();
    for _ in 0..law.newton.0 {
        let f = gradient(&new);
        let force = forces((law.stress)(f) * (1.0 + b) - (law.of_parts)(f, *parts) * b);
        let mut matrix = [[0.0; 12]; 12];
        let mut right = [0.0; 12];
        for column in 0..12 {
            let (node, axis) = (column / 3, column % 3);
            let mut unit = DVec3::ZERO;
            unit[axis] = 1.0;
            let along = DMat3::from_cols(unit * g[node].x, unit * g[node].y, unit * g[node].z);
            let change = forces((law.change)(f, along) * (1.0 + b) - (law.of_parts_change)(f, along, *parts) * b);
            for row in 0..12 {
                matrix[row][column] = change[row / 3][row % 3];
            }
        }
        for row in 0..12 {
            let (a, axis) = (row / 3, row % 3);
            let inertia = (new[a] - predicted[a]) / (h * h) + damping * (new[a] - x[a]) / h;
            matrix[row][row] += mass * (1.0 / (h * h) + damping / h);
            right[row] = -force[a][axis] - mass * inertia[axis];
        }
        for row in (0..12).filter(|_| law.more.is_empty()) {
            for column in 0..row {
                let (a, b) = (matrix[row][column], matrix[column][row]);
                assert!((a - b).abs() < 1e-10 * matrix[row][row], "{}: a tangent is symmetric: {a}, {b}", law.word);
            }
        }
        let step = solve(matrix, right);
        for a in 0..4 {
            new[a] += DVec3::new(step[3 * a], step[3 * a + 1], step[3 * a + 2]);
        }
    }
    *parts = (law.parts)(gradient(&new));
    for a in 0..4 {
        v[a] = (new[a] - x[a]) / h;
        x[a] = new[a];
    }
    (0..4).map(|a| new[a].distance(predicted[a])).fold(0.0, f64::max)
}

fn start(law: &Law, (damping, beta): Damping, h: f64) -> Simulation {
    let text = format!(
        "(duration: 1, solver: Implicit(step: {h}, newton: {}, tolerance: {:e}),
        bodies: {{\"b\": (mesh: File(path: \"one.msh\"), material: \"m\", spin: (3, -5, 8), velocity: (0.1, 0, 0.2),
            start: Affine(gradient: ((0.2, 0.3, 0), (0, -0.1, 0.1), (0.1, 0, 0.15))))}},
        materials: {{\"m\": (density: 1000, damping: {damping}, stiffness_damping: {beta},
            {}: Young(young: 3e3, poisson: 0.3{}))}})",
        law.newton.0, law.newton.1, law.word, law.more
    );
    let files = [("one.msh".to_owned(), MESH.into())].into();
    let scene = SceneFile::from_memory("one.ron", &text, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    Simulation::new(&scene, &options(Precision::F64, 1)).unwrap()
}

/// A step is off by a share ε of how far forces take it, Δ; what its velocity is off by goes on, so that n of them are
/// off by ε Δ (1 + 2 + … + n) at most, and velocities by n ε Δ/h.
#[test]
fn one_tetrahedron_steps_as_its_dense_equation_says() {
    for law in LAWS.iter().chain([&IN_FRAME]) {
        let damped = [(0.0, 0.0), (10.0, 0.0), (0.0, 0.02), (10.0, 0.004)];
        for (damping, h) in damped.into_iter().map(|damping| (damping, 0.01)).chain([((0.0, 0.0), 0.002)]) {
            let mut simulation = start(law, damping, h);
            let mass = masses(&mut simulation, "b")[0];
            let x: [DVec3; 4] = positions(&mut simulation, "b").try_into().unwrap();
            // a deformed body turns about its centre as a stiff one does
            let center = x.iter().sum::<DVec3>() / 4.0;
            let v = x.map(|x| DVec3::new(0.1, 0.0, 0.2) + DVec3::new(3.0, -5.0, 8.0).cross(x - center));
            let found = velocities(&mut simulation, "b");
            assert!((0..4).all(|a| found[a].distance(v[a]) < 1e-12), "{found:?}, not {v:?}");
            let (mut state, mut farthest) = (State { x, v, parts: (law.parts)(gradient(&x)) }, 0.0);
            for step in 1..=10 {
                farthest = dense_step(law, mass, damping, h, &mut state).max(farthest);
                simulation.advance(1).unwrap();
                let steps = f64::from(step);
                let name = format!("{}{}, c, β = {damping:?}, h = {h}, step {step}", law.word, law.more);
                let of = |found: Vec<DVec3>, expected: &[DVec3; 4]| {
                    found.iter().zip(expected).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / farthest
                };
                let off = of(positions(&mut simulation, "b"), &state.x);
                let bound = law.error * steps * (steps + 1.0) / 2.0;
                println!("{name}: off by {off:.1e} of {farthest:.1e} m, allowed {bound:.1e}");
                assert!(off < bound, "{name}: off by {off:e}");
                let off = h * of(velocities(&mut simulation, "b"), &state.v);
                assert!(off < law.error * steps, "{name}: velocities off by {off:e}");
            }
        }
    }
}

/// Σ f = 0 and Σ x × f = 0 where it is deformed, and f is V P g of the law in closed form. A law in a frame of edges
/// turns the element by its own forces.
#[test]
fn a_deformed_tetrahedron_has_no_torque_but_in_a_frame() {
    for law in LAWS.iter().chain([&IN_FRAME]) {
        let mut simulation = start(law, (0.0, 0.0), 1e-6);
        for _ in 0..5 {
            simulation.advance(1).unwrap();
            let (x, f) = (positions(&mut simulation, "b"), internal_forces(&mut simulation, "b"));
            let expected = forces((law.stress)(gradient(&x.clone().try_into().unwrap())));
            let size = f.iter().map(|f| f.length()).sum::<f64>();
            assert!(size > 1e-3, "there must be forces for this to say something: {size}");
            let (sum, torque) = (f.iter().sum::<DVec3>(), (0..4).map(|a| x[a].cross(f[a])).sum::<DVec3>());
            println!("{}: {size:.3} N, sum {:.1e} N, torque {:.1e} N m", law.word, sum.length(), torque.length());
            assert!(sum.length() < 1e-13 * size, "{}: {sum}", law.word);
            match law.more.is_empty() {
                true => assert!(torque.length() < 1e-13 * size * 0.2, "{}: {torque}", law.word),
                false => assert!(torque.length() > 1e-3 * size * 0.2, "{}: {torque}", law.more),
            }
            for a in 0..4 {
                assert!(f[a].distance(expected[a]) < 1e-9 * size, "{}: {} not {}", law.word, f[a], expected[a]);
            }
        }
    }
}
