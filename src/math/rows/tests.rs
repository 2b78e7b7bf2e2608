use super::*;
use crate::math::LANES;
use pulp::WithSimd;

struct Both<T: SimdScalar>(Scratch<T>, [u16; LANES]);

impl<T: SimdScalar> WithSimd for Both<T> {
    type Output = (Vec<[T; 4]>, Vec<[T; 4]>);
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        let width = T::width::<S>();
        let mut seen = vec![[T::default(); 4]; LANES];
        for at in (0..LANES).step_by(width) {
            let columns = T::load_rows(simd, &self.0.read, &self.1[at..]);
            T::add_to_rows(simd, &mut self.0.sums, &self.1[at..], [columns[0], columns[1], columns[2]]);
            for (k, column) in columns.into_iter().enumerate() {
                let mut lanes = [T::default(); LANES];
                T::store(column, &mut lanes);
                (0..width).for_each(|lane| seen[at + lane][k] = lanes[lane]);
            }
        }
        (seen, self.0.sums[..20].to_vec())
    }
}

fn check<T: SimdScalar>() {
    // rows that stand next to each other, apart, and several times among the lanes
    let at = [3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3];
    let number = |row: usize, k: usize| T::from_f64((10 * row + k) as f64);
    let mut scratch = Scratch::<T>::default();
    for row in 0..20 {
        scratch.read[row] = std::array::from_fn(|k| number(row, k));
    }
    let mut sets = vec![pulp::Arch::Scalar, pulp::Arch::new()];
    #[cfg(target_arch = "x86_64")]
    sets.extend(V3::try_new().map(pulp::Arch::V3));
    for arch in sets {
        let mut own = Scratch::<T>::default();
        own.read.copy_from_slice(&scratch.read[..]);
        let (seen, sums) = arch.dispatch(Both(own, at));
        for lane in 0..LANES {
            let row = at[lane] as usize;
            assert_eq!(seen[lane], std::array::from_fn::<T, 4, _>(|k| number(row, k)), "{arch:?}");
        }
        for (row, sum) in sums.iter().enumerate() {
            let times = at.iter().filter(|&&r| r as usize == row).count() as f64;
            for k in 0..3 {
                assert_eq!(sum[k].to_f64(), times * number(row, k).to_f64(), "{arch:?}, row {row}");
            }
        }
    }
}

#[test]
fn rows_become_columns_and_are_added_to() {
    check::<f32>();
    check::<f64>();
}
