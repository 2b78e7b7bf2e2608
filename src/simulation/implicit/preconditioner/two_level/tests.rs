#![allow(clippy::unwrap_used)]
use super::super::SpringSlope;
use super::*;
use crate::scene::schema::ImplicitScheme;
use crate::simulation::implicit::axes::{Axes, Motion};
use crate::simulation::implicit::formula::Formula;
use crate::simulation::implicit::sums::Sums;
use crate::simulation::tangent::Tangent;
use crate::{Options, SceneFile, Simulation};
use glam::DQuat;

/// A block that may slide on the plane z = 0, and one that nothing holds; in f64.
fn two_blocks() -> Simulation {
    let scene = "(duration: 1, solver: Implicit(),
        bodies: {
            \"sliding\": (mesh: Box(size: (0.1, 0.04, 0.03), cells: (8, 4, 3), elements: Tet4), material: \"m\"),
            \"free\": (mesh: Box(size: (0.04, 0.03, 0.05), cells: (4, 3, 5), elements: Hex8MeanDilatation), material: \"m\"),
        },
        materials: {\"m\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45))},
        constraints: [Fixed(body: \"sliding\", on: Plane(normal: (0, 0, 1), at: 0), axes: [Z])])";
    let scene = SceneFile::from_text("test", scene, std::path::Path::new("."), &[]).unwrap();
    let options = Options { precision: Precision::F64, threads: 1, ..Options::default() };
    Simulation::new(&scene, &options).unwrap()
}

/// What is preconditioned, with its vectors.
struct Made {
    axes: Axes,
    motion: Motion,
    formula: Formula,
}

impl Made {
    fn of(simulation: &mut Simulation) -> Self {
        let axes = Axes::of(&mut simulation.world);
        let mut motion = axes.motion();
        axes.read(&simulation.world, &mut motion);
        Self { axes, motion, formula: Formula::of(ImplicitScheme::Euler) }
    }

    fn operator<'a>(&'a self, simulation: &'a Simulation) -> Operator<'a> {
        Operator {
            world: &simulation.world,
            bodies: &self.axes.bodies,
            free: &self.motion.free,
            inertia: self.motion.inertia(&self.formula, 0.01),
            stiffness: 1.0,
            springs: &[],
        }
    }

    fn vector(&self, seed: f64) -> Reals {
        let number = |axis: usize| if self.motion.free[axis] { (seed * (axis as f64 + 1.0)).sin() } else { 0.0 };
        Reals::F64((0..self.axes.len()).map(number).collect())
    }
}

/// Turns all nodes about the z axis, and bends them.
fn turn(simulation: &mut Simulation, made: &Made, angle: f64, bend: f64) {
    let rotation = DQuat::from_rotation_z(angle);
    for (body, _) in made.axes.each() {
        let rest = simulation.world.get::<RestPosition>(body).unwrap().0.clone();
        let mut u = simulation.world.get_mut::<Displacement>(body).unwrap();
        for (row, x) in rest.into_iter().enumerate() {
            let bent = x + DVec3::new(0.0, bend * x.x * x.x, 0.0);
            u.set_vector(row, rotation * bent - x);
        }
    }
}

#[test]
fn it_is_symmetric_and_positive_at_rest_and_turned_where_nodes_slide_and_where_they_are_free() {
    let mut simulation = two_blocks();
    let made = Made::of(&mut simulation);
    let sums = Sums::on(simulation.world.resource::<Cpu>());
    // on one node, between two of a body, and between bodies, far stiffer than elements
    let slope = DMat3::from_diagonal(DVec3::new(1e4, 1e3, 3e4));
    let ends =
        [vec![(3, 1.0)], vec![(60, 1.0), (240, -0.3), (243, -0.7)], vec![(90, 1.0), (made.axes.len() - 3, -1.0)]];
    let springs: Vec<SpringSlope<'_>> = ends.iter().map(|parts| SpringSlope { parts, slope }).collect();
    for (angle, bend, springs) in [(0.0, 0.0, &[][..]), (1.2, 3.0, &[]), (0.0, 0.0, &springs), (1.2, 3.0, &springs)] {
        turn(&mut simulation, &made, angle, bend);
        let mut two_level = TwoLevel::of(Precision::F64);
        two_level.follow(&Operator { springs, ..made.operator(&simulation) });
        assert_eq!(two_level.turned, angle > 0.0);
        let (p, q) = (made.vector(0.37), made.vector(0.91));
        let [mut of_p, mut of_q] = [made.axes.zeros(), made.axes.zeros()];
        two_level.apply(sums.cpu(), &p, &mut of_p);
        two_level.apply(sums.cpu(), &q, &mut of_q);
        let (one, other) = (sums.dot(&q, &of_p), sums.dot(&p, &of_q));
        let size = (sums.dot(&p, &of_p) * sums.dot(&q, &of_q)).sqrt();
        assert!((one - other).abs() < 1e-12 * size, "{angle}: {one} and {other} of {size}");
        for seed in [0.37, 0.91, 1.7, 0.01] {
            let r = made.vector(seed);
            let mut z = made.axes.zeros();
            two_level.apply(sums.cpu(), &r, &mut z);
            assert!(sums.dot(&r, &z) > 0.0, "{angle}, {seed}");
            assert!((0..r.len()).all(|axis| made.motion.free[axis] || z.get(axis) == 0.0));
        }
        // gone again, it is as if there had been none
        let mut without = TwoLevel::of(Precision::F64);
        without.follow(&made.operator(&simulation));
        two_level.follow(&made.operator(&simulation));
        let mut again = made.axes.zeros();
        two_level.apply(sums.cpu(), &p, &mut of_p);
        without.apply(sums.cpu(), &p, &mut again);
        assert_eq!(of_p, again);
    }
}

/// Pᵀ K P of elements' columns against products of the tangent with the motions.
#[test]
fn the_coarse_matrix_is_that_of_the_tangent() {
    let mut simulation = two_blocks();
    let made = Made::of(&mut simulation);
    let operator = made.operator(&simulation);
    let mut fine = BlockJacobi::of(Precision::F64);
    fine.begin(&operator);
    let pieces = find_pieces(&operator, &mut fine);
    assert_eq!(pieces.len(), 2);
    let mut tangent = Tangent::at_present(&simulation.world, &made.axes.bodies).unwrap();
    for piece in &pieces {
        piece.coarse.compare_with(&operator, |motion, image| tangent.times(motion, image));
    }
}

/// However a residual is: tᵀ D B r = tᵀ r of the translations t that nothing holds.
#[test]
fn what_moves_a_piece_as_a_whole_is_solved_exactly() {
    let mut simulation = two_blocks();
    let made = Made::of(&mut simulation);
    turn(&mut simulation, &made, 0.8, 1.0);
    let mut two_level = TwoLevel::of(Precision::F64);
    two_level.follow(&made.operator(&simulation));
    let (sums, r) = (Sums::on(simulation.world.resource::<Cpu>()), made.vector(0.77));
    let mut z = made.axes.zeros();
    two_level.apply(sums.cpu(), &r, &mut z);
    let inertia = made.operator(&simulation).inertia;
    let ranges: Vec<_> = made.axes.each().map(|(_, range)| range).collect();
    for (range, axis, is_free) in [(0, 0, true), (0, 2, false), (1, 0, true), (1, 2, true)] {
        let own = || ranges[range].clone().skip(axis).step_by(3);
        let force: f64 = own().map(|i| r.get(i)).sum();
        let momentum: f64 = own().map(|i| inertia.of(i / 3) * z.get(i)).sum();
        let size: f64 = own().map(|i| r.get(i).abs()).sum();
        assert_eq!((force - momentum).abs() < 1e-12 * size, is_free, "{range}, {axis}: {force}, {momentum}");
    }
}
