use super::*;

#[test]
fn strided_patches_hold_the_same_elements() {
    for count in [1, 15, 16, 17, 1000, 1024, 1025, 3000] {
        let elements: Vec<u32> = (0..count).collect();
        let mut strided = strided(elements.clone(), ElementKind::Tet4);
        if count >= 1024 {
            assert_eq!(strided[1] - strided[0], 64, "lanes come from all over the patch");
        }
        assert!(strided.chunks(1024).zip(elements.chunks(1024)).all(|(a, b)| a.iter().min() == b.iter().min()));
        strided.sort_unstable();
        assert_eq!(strided, elements);
    }
}

#[test]
fn each_corner_finds_its_node() {
    let connectivity: Vec<u32> = (0..4 * 1040).map(|i| i * 7919 % 501).collect();
    let patches = cut(ElementKind::Tet4, &connectivity);
    assert_eq!(patches.count(), 2);
    for (place, &node) in connectivity.iter().enumerate() {
        let first = patches.starts[place / 4096] as usize;
        assert_eq!(patches.nodes[first + patches.connectivity[place] as usize], node);
    }
}
