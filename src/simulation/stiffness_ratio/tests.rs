use super::*;
use crate::materials::{
    ElasticLaw, Linear, MooneyRivlin, NeoHookean, OGDEN_TERMS, Ogden, StVenantKirchhoff, StableNeoHookean,
};

fn law(elastic: ElasticLaw<f64>) -> BlockLaw<f64> {
    BlockLaw {
        elastic,
        fibres: None,
        exponential: vec![],
        prony: vec![],
        volumetric: vec![],
        reproject: false,
        copies: None,
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

/// Laws of E = 100 kPa.
fn laws(poisson: f64) -> [ElasticLaw<f64>; 5] {
    let (shear, bulk) = (1e5 / (2.0 * (1.0 + poisson)), 1e5 / (3.0 * (1.0 - 2.0 * poisson)));
    let (mut mu, mut alpha) = ([0.0; OGDEN_TERMS], [1.0; OGDEN_TERMS]);
    [mu[0], mu[1], alpha[0], alpha[1]] = [0.5 * shear, -0.5 * shear, 2.0, -2.0];
    [
        ElasticLaw::NeoHookean(NeoHookean { shear, bulk }),
        ElasticLaw::StableNeoHookean(StableNeoHookean { shear, bulk }),
        ElasticLaw::MooneyRivlin(MooneyRivlin { c10: 0.25 * shear, c01: 0.25 * shear, bulk }),
        ElasticLaw::Ogden(Ogden { mu, alpha, bulk, terms: 2 }),
        ElasticLaw::StVenantKirchhoff(StVenantKirchhoff { shear, bulk }),
    ]
}

/// Homogeneous states about as wide as tissue is that is free there: pulled and pressed in one direction, in one and
/// held across, and in two. (By the eigenvalues of C⁻¹ alone it was down to .73 of what waves come to held across, and
/// to .6 in two directions.)
#[test]
fn of_all_is_no_less_than_what_waves_through_homogeneous_tissue_come_to() {
    for poisson in [0.2, 0.3, 0.4, 0.45] {
        let across = poisson / (1.0 - poisson);
        let stretched = |law: ElasticLaw<f64>| [0.8, 1.1, 1.2, 1.5, 1.9].map(|stretch| (law, stretch));
        for (elastic, stretch) in laws(poisson).into_iter().flat_map(stretched) {
            let law = law(elastic);
            let mut ratio = StiffnessRatio::of(&law);
            let free = |power: f64| f64::powf(stretch, -power);
            for stretches in [
                [stretch, free(poisson), free(poisson)],
                [stretch, 1.0, free(across)],
                [stretch, stretch, free(2.0 * across)],
            ] {
                let mut gradient = Mat3::zero(0.0);
                (0..3).for_each(|i| gradient.0[i][i] = stretches[i] - 1.0);
                let [first, inverse, squeeze] = sizes(&with_identity(&gradient), ratio.ends);
                let size = first.max(inverse);
                ratio.reach(size, squeeze);
                let (found, at_rest) = (ratio.of_all(size, squeeze), tangents(&law, &[1.0; 3])[3]);
                let expected = tangents(&law, &stretches)[3] / at_rest;
                println!("{} {poisson} {stretches:?}: {found:.3} for {expected:.3}", elastic.name());
                assert!(expected > 0.5 && found >= 0.99 * expected, "{}: {found}, {expected}", elastic.name());
            }
        }
    }
}

#[test]
fn what_is_met_between_two_samples_of_a_stiff_kind_does_not_lower_what_is_between_them() {
    let mut table = Table::new();
    table.add(0, (2.0, 4.0));
    table.add(1, (1.9, 1.1));
    table.sort();
    assert!((table.at(1.9) - 3.7).abs() < 1e-12 && (table.at(1.5) - 2.5).abs() < 1e-12, "{table:?}");
    // beyond its last sample a kind counts with that
    table.add(1, (3.0, 5.0));
    table.sort();
    assert_eq!([2.0, 2.1, 3.0].map(|size| table.at(size) >= 4.0), [true; 3]);
}
