//! What a product with the tangent stiffness costs as a difference of forces, a pass over all elements, beside one with
//! a matrix that has been put together before: `cargo bench --bench products`. By turns, the best of each, one thread.
//! The matrix has blocks of 3 × 3 for each pair of nodes that share an element, in the order of a grid; what it takes
//! to put it together is not counted.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use sinew::components::Precision;
use sinew::prelude::*;
use std::hint::black_box;
use std::ops::{AddAssign, Mul};
use std::path::Path;
use std::time::Instant;

const PASSES: u64 = 10;
const TURNS: usize = 30;

/// Columns of a block, of four numbers of which the last is 0: what registers load at once.
type Block<T> = [[T; 4]; 3];

/// A matrix of blocks by rows.
struct Blocks<T> {
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Block<T>>,
}

impl<T: Copy + Default + AddAssign + Mul<Output = T>> Blocks<T> {
    /// Of a grid of so many nodes along each axis, of which those are coupled whose way along the axes `couples`.
    fn of_grid(nodes: i64, one: T, couples: impl Fn([i64; 3]) -> bool) -> Self {
        let mut all = Self { starts: vec![0], columns: Vec::new(), blocks: Vec::new() };
        let triples = |from: i64, to: i64| {
            (from..to).flat_map(move |z| (from..to).flat_map(move |y| (from..to).map(move |x| [x, y, z])))
        };
        for at in triples(0, nodes) {
            for by in triples(-1, 2).filter(|by| couples(*by)) {
                let [x, y, z] = [0, 1, 2].map(|axis| at[axis] + by[axis]);
                if [x, y, z].iter().all(|place| (0..nodes).contains(place)) {
                    all.columns.push(u32::try_from(x + nodes * (y + nodes * z)).unwrap());
                    all.blocks.push([[one; 4]; 3]);
                }
            }
            all.starts.push(u32::try_from(all.columns.len()).unwrap());
        }
        all
    }

    fn bytes(&self) -> usize {
        // of a block the 9 numbers that are one
        4 * self.columns.len() + 9 * size_of::<T>() * self.blocks.len()
    }

    fn product(&self, x: &[[T; 3]], y: &mut [[T; 3]]) {
        for (rows, y) in self.starts.windows(2).zip(y) {
            let rows = rows[0] as usize..rows[1] as usize;
            let mut sum = [T::default(); 4];
            for (block, &column) in self.blocks[rows.clone()].iter().zip(&self.columns[rows]) {
                for (column, &x) in block.iter().zip(&x[column as usize]) {
                    for (sum, &number) in sum.iter_mut().zip(column) {
                        *sum += number * x;
                    }
                }
            }
            y.copy_from_slice(&sum[..3]);
        }
    }
}

fn simulation(elements: &str, cells: i64, precision: Precision) -> Simulation {
    let text = format!(
        "(duration: 1000.0,
          bodies: {{ \"cube\": (mesh: Box(size: (0.1, 0.1, 0.1), cells: ({cells}, {cells}, {cells}), elements: {elements}),
                               material: \"tissue\") }},
          materials: {{ \"tissue\": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45)) }})"
    );
    let scene = SceneFile::from_text("cube", &text, Path::new("."), &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let options = Options { backend: BackendChoice::Cpu, precision, threads: 1, ..Options::default() };
    Simulation::new(&scene, &options).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// Seconds of a step, and of a product.
fn compare<T>(elements: &str, cells: i64, precision: Precision, one: T)
where
    T: Copy + Default + AddAssign + Mul<Output = T>,
{
    // six tetrahedra around the diagonal of each cell couple those that are ahead of each other along all axes
    let ahead = |by: [i64; 3]| by.iter().all(|way| *way >= 0) || by.iter().all(|way| *way <= 0);
    let nodes = cells + 1;
    let matrix = Blocks::of_grid(nodes, one, |by| elements == "Hex8" || ahead(by));
    let count = usize::try_from(nodes.pow(3)).unwrap();
    let (x, mut y) = (vec![[one; 3]; count], vec![[T::default(); 3]; count]);
    let mut simulation = simulation(elements, cells, precision);
    let mut best = [f64::INFINITY; 2];
    for _ in 0..TURNS {
        let started = Instant::now();
        simulation.advance(PASSES).expect("steps");
        let passed = Instant::now();
        (0..PASSES).for_each(|_| matrix.product(black_box(&x), black_box(&mut y)));
        let times = [passed.duration_since(started), passed.elapsed()];
        best.iter_mut().zip(times).for_each(|(best, time)| *best = best.min(time.as_secs_f64()));
    }
    let [step, product] = best.map(|time| time * 1e9 / (PASSES as f64 * count as f64));
    println!(
        "{elements}, {count} nodes, {precision:?}: a step {step:.1} ns a node, a product {product:.1} ({:.2} times), its matrix \
         {} bytes a node",
        product / step,
        matrix.bytes() / count
    );
}

fn main() {
    for (elements, cells) in [("Tet4", [8, 20, 40]), ("Hex8", [8, 20, 40])] {
        for cells in cells {
            compare(elements, cells, Precision::F32, 1.0f32);
            compare(elements, cells, Precision::F64, 1.0f64);
        }
    }
}
