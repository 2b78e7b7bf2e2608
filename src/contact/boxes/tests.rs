use super::*;
use crate::mesh::OnTriangle;

#[test]
fn all_triangles_within_a_radius_are_seen_after_they_have_moved() {
    let mut random = fastrand::Rng::with_seed(1);
    let mut place = || DVec3::new(random.f64(), random.f64(), random.f64());
    for count in [0, 1, 3, 4, 5, 100, 777] {
        let mut corners: Vec<[DVec3; 3]> = (0..count)
            .map(|_| {
                let at = place();
                [at, at + 0.1 * place(), at + 0.1 * place()]
            })
            .collect();
        let mut tree = Tree::new(0..count as u32, |triangle| corners[triangle as usize]);
        corners.iter_mut().flatten().for_each(|corner| *corner += 0.3 * DVec3::new(corner.y, -corner.x, 1.0));
        tree.refit(|triangle| corners[triangle as usize]);
        let mut all = 0;
        tree.near(DVec3::ZERO, f64::INFINITY, |_| all += 1);
        assert_eq!(all, count, "all are within any distance");
        for _ in 0..20 {
            let (at, radius) = (2.0 * place() - 0.5, 0.2);
            let mut seen = Vec::new();
            tree.near(at, radius, |triangle| seen.push(triangle));
            for (triangle, corners) in (0..).zip(&corners) {
                let near = OnTriangle::nearest(at, *corners).at.distance(at) <= radius;
                assert!(!near || seen.contains(&triangle));
            }
            seen.sort_unstable();
            assert!(seen.windows(2).all(|pair| pair[0] < pair[1]), "each once");
            assert!(count < 100 || seen.len() < count, "not all of {count}");
        }
    }
}
