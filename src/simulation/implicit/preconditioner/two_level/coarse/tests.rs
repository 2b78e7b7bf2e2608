use super::*;

impl Coarse {
    /// Compares the matrix with what products of K with all motions of all aggregates make.
    pub fn compare_with(&self, operator: &Operator<'_>, mut times: impl FnMut(&[f64], &mut [f64])) {
        let along = |column: usize, vector: &mut [f64]| {
            for (node, aggregate, arm) in self.members() {
                if aggregate == column / RIGID {
                    for axis in (0..3).filter(|axis| operator.free[3 * node + axis]) {
                        vector[3 * node + axis] = motions(arm, axis)[column % RIGID];
                    }
                }
            }
        };
        let size = self.size();
        let mut largest = 0.0_f64;
        for column in 0..size {
            let (mut motion, mut image) = (vec![0.0; operator.free.len()], vec![0.0; operator.free.len()]);
            along(column, &mut motion);
            times(&motion, &mut image);
            for row in column..size {
                let mut other = vec![0.0; motion.len()];
                along(row, &mut other);
                let expected: f64 = image.iter().zip(&other).map(|(f, u)| f * u).sum();
                let entry = |row: usize, column: usize| self.stiffness[start(column, size) + row - column];
                let found = entry(row, column);
                let [a, b] = [row, column].map(|i| entry(i, i));
                // differences of forces of one side have the curvature of the law in them
                assert!((found - expected).abs() < 1e-5 * (a * b).sqrt(), "{row}, {column}: {found}, not {expected}");
                largest = largest.max(found);
            }
        }
        assert!(size > RIGID && largest > 0.0);
    }
}
