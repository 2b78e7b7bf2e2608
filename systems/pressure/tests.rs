use super::*;

/// The norm of −∂f/∂u over the masses of a cube of n³ cells of size 1 and density 1, at a pressure of 1 all around.
/// Forces are of second order in places: central differences are exact.
fn norm_of_stiffness(n: usize, split: bool) -> f64 {
    let node = |place: [usize; 3]| place[0] + (n + 1) * (place[1] + (n + 1) * place[2]);
    let (mut points, mut masses) = (Vec::new(), Vec::new());
    for number in 0..(n + 1).pow(3) {
        let place = [number % (n + 1), number / (n + 1) % (n + 1), number / (n + 1).pow(2)];
        points.push(place.map(|x| x as f64));
        masses.push(place.iter().map(|&x| if x == 0 || x == n { 0.5 } else { 1.0 }).product::<f64>());
    }
    let mut faces: Vec<[usize; 4]> = Vec::new();
    for (axis, far, a, b) in (0..3)
        .flat_map(|axis| [(axis, 0), (axis, n)])
        .flat_map(|(axis, far)| (0..n * n).map(move |cell| (axis, far, cell % n, cell / n)))
    {
        let corner = |i: usize, j: usize| {
            let mut place = [0; 3];
            (place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3]) = (far, a + i, b + j);
            node(place)
        };
        let mut face = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
        if far == 0 {
            face.reverse();
        }
        let [p, q, r, s] = face;
        faces.extend(if split { vec![[p, q, r, r], [p, r, s, s]] } else { vec![face] });
    }
    let forces = |points: &[[f64; 3]]| {
        let mut all = vec![0.0; 3 * points.len()];
        for face in &faces {
            let count = if face[2] == face[3] { 3 } else { 4 };
            for (&node, area) in face.iter().zip(corner_areas(face.map(|node| points[node]))).take(count) {
                (0..3).for_each(|i| all[3 * node + i] -= area[i]);
            }
        }
        all
    };
    let root = |number: usize| masses[number / 3].sqrt();
    let columns: Vec<Vec<f64>> = (0..3 * points.len())
        .map(|column| {
            let [to, from] = [0.5, -0.5].map(|far| {
                let mut moved = points.clone();
                moved[column / 3][column % 3] += far;
                forces(&moved)
            });
            (0..to.len()).map(|row| (from[row] - to[row]) / (root(row) * root(column))).collect()
        })
        .collect();
    // powers of AᵀA
    let mut vector: Vec<f64> = (0..columns.len()).map(|i| (7.1 * i as f64).sin()).collect();
    let mut norm = 0.0;
    for _ in 0..100 {
        let mut image = vec![0.0; columns.len()];
        for (column, part) in columns.iter().zip(&vector) {
            image.iter_mut().zip(column).for_each(|(sum, number)| *sum += number * part);
        }
        let dot = |column: &Vec<f64>| column.iter().zip(&image).map(|(a, b)| a * b).sum::<f64>();
        vector = columns.iter().map(dot).collect();
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        norm = length.sqrt();
        vector.iter_mut().for_each(|x| *x /= length);
    }
    norm
}

#[test]
fn stiffness_of_a_pressure_is_little_more_than_that_of_elements_of_such_a_modulus() {
    // of elements of a modulus of 1 the waves alone have 4; split the other way on every second face, 4.69
    for (n, split, expected) in [(2, false, 4.1943), (3, false, 3.9976), (2, true, 4.4198), (3, true, 4.3660)] {
        let norm = norm_of_stiffness(n, split);
        assert!((norm - expected).abs() < 1e-3, "{n} cells, split {split}: {norm}");
    }
}

/// 2×2 Gauss points integrate the bilinear quadrilateral exactly.
#[test]
fn corner_areas_of_a_warped_quadrilateral_are_the_exact_integrals() {
    let points = [[0.0, 0.1, 0.0], [1.2, 0.0, 0.3], [1.0, 0.9, -0.2], [-0.1, 1.1, 0.25_f64]];
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f64]];
    for a in 0..4 {
        let mut exact = [0.0; 3];
        for gauss in signs {
            let [x, y] = gauss.map(|s| s / 3.0_f64.sqrt());
            let (mut by_x, mut by_y) = ([0.0; 3], [0.0; 3]);
            for b in 0..4 {
                for i in 0..3 {
                    by_x[i] += points[b][i] * signs[b][0] * (1.0 + signs[b][1] * y) / 4.0;
                    by_y[i] += points[b][i] * signs[b][1] * (1.0 + signs[b][0] * x) / 4.0;
                }
            }
            let weight = (1.0 + signs[a][0] * x) * (1.0 + signs[a][1] * y) / 4.0;
            let normal = cross(by_x, by_y);
            (0..3).for_each(|i| exact[i] += weight * normal[i]);
        }
        let found = corner_areas(points)[a];
        for i in 0..3 {
            assert!((found[i] - exact[i]).abs() < 1e-14, "corner {a}: {found:?} instead of {exact:?}");
        }
    }
}
