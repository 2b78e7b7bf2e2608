use super::*;

#[test]
fn units_are_those_in_which_a_body_is_tissue() {
    let names = |length: f64| units(length).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
    assert_eq!(names(0.1), ["m"]);
    assert_eq!(names(9.0), ["cm", "mm"], "a lens of 9 mm, or a piece of 9 cm");
    assert_eq!(names(250.0), ["mm"]);
    assert_eq!(names(1e9), Vec::<String>::new());
}
