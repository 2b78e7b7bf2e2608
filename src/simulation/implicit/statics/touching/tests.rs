use super::*;

#[test]
fn loads_grow_to_all_of_them_by_halves_where_rest_is_not_found() {
    let mut growth = Growth::from(0.25, 3.0);
    assert_eq!(growth.next(), [0.25, 0.5]);
    growth.succeeded();
    assert!(growth.failed());
    assert_eq!(growth.next(), [0.5, 0.625]);
    let (mut searches, mut last) = (0, 0.5);
    while growth.next()[1] < 1.0 {
        growth.succeeded();
        (searches, last) = (searches + 1, growth.next()[0]);
    }
    assert_eq!((searches, last), (3, 0.875));
    assert!((0..5).all(|_| growth.failed()) && !growth.failed());
    assert!(!Growth::at_once().failed());
}
