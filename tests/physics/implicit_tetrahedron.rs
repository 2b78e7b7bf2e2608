//! One free tetrahedron by the linearised step of implicit Euler, beside its 12×12 equation solved densely: products by
//! difference against the tangents of two laws in closed form. A law in a frame of edges, whose tangent is not
//! symmetric, by Newton's iterations until nothing is left.

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

/// A law: P (Pa) of F, and its change δP along δF.
struct Law {
    word: &'static str,
    /// What stands in a scene beside its moduli.
    more: &'static str,
    /// Iterations of Newton's, and the tolerance of conjugate gradients.
    newton: (usize, f64),
    stress: fn(DMat3) -> DMat3,
    change: fn(DMat3, DMat3) -> DMat3,
}

const LAWS: [Law; 2] = [
    Law { word: "corotational", more: "", newton: (1, 1e-9), stress: corotational, change: corotational_change },
    Law { word: "neo_hookean", more: "", newton: (1, 1e-9), stress: neo_hookean, change: neo_hookean_change },
];
const IN_FRAME: Law = Law {
    word: "corotational",
    more: ", rotation: Frame",
    newton: (40, 1e-10),
    stress: in_frame,
    change: in_frame_change,
};

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

/// δR = R [(tr(S) I − S)⁻¹ a]×, S = RᵀF, a the axial vector of RᵀδF − δFᵀR.
fn corotational_change(f: DMat3, along: DMat3) -> DMat3 {
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
    let turned = r * cross;
    (along - turned) * (2.0 * SHEAR) + r * (LAME * contract(r, along)) + turned * (LAME * (trace - 3.0))
}

/// The frame of edges 01 and 02: along the first, across the plane of both (SOFA's `large`).
fn frame(first: DVec3, second: DVec3) -> DMat3 {
    let (x, z) = (first.normalize(), first.cross(second).normalize());
    DMat3::from_cols(x, z.cross(x), z)
}

/// P = R (2μ ε + λ tr ε I), ε = sym(RᵀF − I).
fn in_frame(f: DMat3) -> DMat3 {
    let [a, b] = [REST[1] - REST[0], REST[2] - REST[0]];
    let r = frame(f * a, f * b) * frame(a, b).transpose();
    let off = r.transpose() * f - DMat3::IDENTITY;
    let strain = (off + off.transpose()) * 0.5;
    let trace = strain.x_axis.x + strain.y_axis.y + strain.z_axis.z;
    r * (strain * (2.0 * SHEAR) + DMat3::IDENTITY * (LAME * trace))
}

/// By central differences, whose third of 1e-10 is nothing where iterations end by the residual.
fn in_frame_change(f: DMat3, along: DMat3) -> DMat3 {
    let step = 1e-5 / contract(along, along).sqrt();
    (in_frame(f + along * step) - in_frame(f - along * step)) * (0.5 / step)
}

/// Ψ = μ/2 (I₁ J^(−2/3) − 3) + κ/2 (J − 1)².
fn neo_hookean(f: DMat3) -> DMat3 {
    let (j, inverse) = (f.determinant(), f.inverse().transpose());
    (f - inverse * (contract(f, f) / 3.0)) * (SHEAR * j.powf(-2.0 / 3.0)) + inverse * (BULK * (j - 1.0) * j)
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

/// One step of h: M (w − u − h v)/h² + c M (w − u)/h + F(w) = 0, linearised about w = u + h v, and about what that
/// leads to as often as the law is iterated.
fn dense_step(law: &Law, mass: f64, damping: f64, h: f64, x: &mut [DVec3; 4], v: &mut [DVec3; 4]) {
    let predicted: [DVec3; 4] = std::array::from_fn(|a| x[a] + h * v[a]);
    let mut new = predicted;
    let (g, _) = shape();
    for _ in 0..law.newton.0 {
        let f = gradient(&new);
        let force = forces((law.stress)(f));
        let mut matrix = [[0.0; 12]; 12];
        let mut right = [0.0; 12];
        for column in 0..12 {
            let (node, axis) = (column / 3, column % 3);
            let mut unit = DVec3::ZERO;
            unit[axis] = 1.0;
            let along = DMat3::from_cols(unit * g[node].x, unit * g[node].y, unit * g[node].z);
            let change = forces((law.change)(f, along));
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
    for a in 0..4 {
        v[a] = (new[a] - x[a]) / h;
        x[a] = new[a];
    }
}

fn start(law: &Law, damping: f64, h: f64) -> Simulation {
    let text = format!(
        "(duration: 1, solver: Implicit(step: {h}, newton: {}, tolerance: {:e}),
        bodies: {{\"b\": (mesh: File(path: \"one.msh\"), material: \"m\", spin: (3, -5, 8), velocity: (0.1, 0, 0.2),
            start: Affine(gradient: ((0.2, 0.3, 0), (0, -0.1, 0.1), (0.1, 0, 0.15))))}},
        materials: {{\"m\": (density: 1000, damping: {damping}, {}: Young(young: 3e3, poisson: 0.3{}))}})",
        law.newton.0, law.newton.1, law.word, law.more
    );
    let files = [("one.msh".to_owned(), MESH.into())].into();
    let scene = SceneFile::from_memory("one.ron", &text, files, &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    Simulation::new(&scene, &options(Precision::F64, 1)).unwrap()
}

/// Products are known to 1e-6 of their size (curvature of a law over 1e-7 of strain, and rounding of 1e-16/1e-7), and
/// so is a step to 1e-6 of how far forces take it; ten of them add up and turn.
#[test]
fn one_tetrahedron_steps_as_its_dense_equation_says() {
    for law in LAWS.iter().chain([&IN_FRAME]) {
        for (damping, h) in [(0.0, 0.01), (10.0, 0.01), (0.0, 0.002)] {
            let mut simulation = start(law, damping, h);
            let mass = masses(&mut simulation, "b")[0];
            let mut x: [DVec3; 4] = positions(&mut simulation, "b").try_into().unwrap();
            // a deformed body turns about its centre as a stiff one does
            let center = x.iter().sum::<DVec3>() / 4.0;
            let mut v = x.map(|x| DVec3::new(0.1, 0.0, 0.2) + DVec3::new(3.0, -5.0, 8.0).cross(x - center));
            let found = velocities(&mut simulation, "b");
            assert!((0..4).all(|a| found[a].distance(v[a]) < 1e-12), "{found:?}, not {v:?}");
            for step in 1..=10 {
                let flown = x[0] + h * v[0];
                dense_step(law, mass, damping, h, &mut x, &mut v);
                simulation.advance(1).unwrap();
                let found = positions(&mut simulation, "b");
                let scale = (x[0] - flown).length().max(1e-4);
                let off = (0..4).map(|a| found[a].distance(x[a])).fold(0.0, f64::max) / scale;
                println!("{}{}, c = {damping}, h = {h}, step {step}: {off:.1e} of {scale:.1e} m", law.word, law.more);
                assert!(off < 1e-5 * f64::from(step), "{}{}, step {step}: off by {off:e}", law.word, law.more);
            }
            let found = velocities(&mut simulation, "b");
            for a in 0..4 {
                assert!(found[a].distance(v[a]) < 1e-4 * v[a].length(), "velocity {}, not {}", found[a], v[a]);
            }
        }
    }
}

/// Σ f = 0 and Σ x × f = 0 where it is deformed, and f is V P g of the law in closed form. A law in a frame of edges
/// turns the element by its own forces.
#[test]
fn a_deformed_tetrahedron_has_no_torque_but_in_a_frame() {
    for law in LAWS.iter().chain([&IN_FRAME]) {
        let mut simulation = start(law, 0.0, 1e-6);
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
