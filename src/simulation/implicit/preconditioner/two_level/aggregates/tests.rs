use super::*;

fn grid(n: usize) -> Vec<DVec3> {
    (0..n * n * n).map(|i| DVec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64)).collect()
}

#[test]
fn aggregates_are_small_and_have_every_node() {
    let aggregates = Aggregates::within(&grid(11), 30);
    let mut sizes = vec![0; aggregates.count()];
    aggregates.of_node.iter().for_each(|&aggregate| sizes[aggregate as usize] += 1);
    assert_eq!(sizes, aggregates.sizes);
    assert_eq!(sizes.iter().sum::<usize>(), 1331);
    assert!(sizes.iter().all(|size| (10..=30).contains(size)), "{sizes:?}");
}

/// u = t + w × x of all nodes is made of the motions of the aggregates.
#[test]
fn motions_are_rigid() {
    let positions = grid(4);
    let aggregates = Aggregates::within(&positions, 30);
    let turn = DVec3::new(0.3, -0.7, 0.2);
    for a in 0..positions.len() {
        for b in (0..positions.len()).filter(|&b| aggregates.of_node[a] == aggregates.of_node[b]) {
            let expected = turn.cross(aggregates.arm[a] - aggregates.arm[b]);
            for axis in 0..3 {
                let [of_a, of_b] = [a, b].map(|node| motions(aggregates.arm[node], axis));
                let found: f64 = (0..3).map(|i| (of_a[3 + i] - of_b[3 + i]) * turn[i]).sum();
                assert!((found - expected[axis]).abs() < 1e-14, "{found} {expected}");
            }
        }
    }
}
