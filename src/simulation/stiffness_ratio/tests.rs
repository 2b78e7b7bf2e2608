use super::*;
use crate::materials::{ElasticLaw, Linear, NeoHookean};

fn law(elastic: ElasticLaw<f64>) -> BlockLaw<f64> {
    BlockLaw {
        elastic,
        fibres: None,
        exponential: vec![],
        prony: vec![],
        volumetric: vec![],
        reproject: false,
        own_kernels: None,
    }
}

#[test]
fn a_linear_law_never_stiffens_and_a_neo_hookean_one_with_the_size_of_the_deformation() {
    let mut linear = StiffnessRatio::of(&law(ElasticLaw::Linear(Linear { shear: 1e3, bulk: 1e4 })));
    linear.reach(4.0, 9.0);
    assert!((linear.of_all(4.0, 9.0) - 1.0).abs() < 1e-6);
    let mut soft = StiffnessRatio::of(&law(ElasticLaw::NeoHookean(NeoHookean { shear: 1e3, bulk: 1e5 })));
    soft.reach(10.0, 10.0);
    // at constant volume the volumetric part is κ tr C⁻¹, 3κ at rest: the size itself; isochoric parts and changes
    // of volume add to it
    for size in [1.5_f64, 3.0, 6.0] {
        let ratio = soft.own(size);
        println!("{size}: {ratio}");
        assert!(ratio > 0.9 * size && ratio < 4.0 * size, "{size}: {ratio}");
    }
    // beyond what was tried it goes on, and stays a number
    assert!(soft.own(1e3) > soft.own(10.0) && soft.own(f64::INFINITY) == LARGEST_RATIO);
    assert_eq!((soft.own(1.0), soft.own(0.999)), (1.0, 1.0));
    // waves through what is squeezed to half its height are twice as quick
    assert!((4.0..4.5).contains(&soft.of_all(1.0, 4.0)), "{}", soft.of_all(1.0, 4.0));
    for k in 0..2000 {
        let ratio = 1.0 + 5e-3 * f64::from(k);
        let [size, squeeze] = soft.until(ratio, 1.5 * ratio);
        assert!(soft.own(size) <= ratio && soft.of_all(size, squeeze) <= 1.5 * ratio, "{ratio}");
        // as far as it reaches it is also the largest
        assert!(size >= 10.0 || soft.own((1.0 + 1e-6) * size) > ratio * (1.0 - 1e-8), "{ratio}");
        let size = 1.0 + 4e-3 * f64::from(k);
        let after = soft.own.points.partition_point(|(s, _)| *s < size);
        let (s0, g0) = soft.own.points[after.max(1) - 1];
        let (s1, g1) = soft.own.points[after];
        let between = if after == 0 { 1.0 } else { g0 + (g1 - g0) * (size - s0) / (s1 - s0) };
        assert_eq!(soft.own(size), between, "{size}");
    }
}

#[test]
fn exponential_fibres_stiffen_much_more() {
    let mut fibrous = law(ElasticLaw::NeoHookean(NeoHookean { shear: 1e3, bulk: 1e5 }));
    let family = ExponentialFibre { k1: 1e3, k2: 10.0, dispersion: 0.0, tension_only: 1.0 };
    fibrous.exponential.push((family, FamilyDirection::Uniform([1.0, 0.0, 0.0])));
    let ratio = StiffnessRatio::of(&fibrous);
    let c = [2.25, 1.0 / 1.5, 1.0 / 1.5, 0.0, 0.0, 0.0];
    assert!(ratio.of_family(&family, c, [1.0, 0.0, 0.0]) > 1e4);
    assert_eq!(ratio.of_family(&family, c, [0.0, 1.0, 0.0]), 0.0);
    assert_eq!(ratio.of_family(&family, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 0.0);
}
