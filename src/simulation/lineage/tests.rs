use super::*;

#[test]
fn a_state_is_of_the_past_only_with_the_same_changes_before_it() {
    let mut lineage = Lineage::default();
    let start = lineage.before(3).unwrap_or(1);
    lineage.note(3, "a");
    lineage.note(3, "b");
    lineage.note(7, "c");
    let [three, four, eight] = [3, 4, 8].map(|step| lineage.before(step).unwrap_or(1));
    assert!(start == 0 && three == start && four != start && eight != four);
    // the present and the past are its own, the future is not
    assert!(lineage.go_on_from(5, four, 9));
    assert_eq!(lineage.before(9), Some(four));
    assert!(!lineage.go_on_from(6, four, 5));
    assert_eq!((lineage.before(5), lineage.before(6)), (None, Some(four)));
    // nor is what went elsewhere
    let mut other = Lineage::default();
    other.note(3, "other");
    assert!(!other.go_on_from(4, four, 9));
    assert!(other.go_on_from(4, four, 4));
}

#[test]
fn what_is_long_past_is_forgotten() {
    let mut lineage = Lineage::default();
    (0..=MOST as u64).for_each(|step| lineage.note(step, "moved"));
    let left = MOST as u64 / 2;
    assert!(lineage.changes.len() == MOST / 2 + 1 && lineage.before(left - 1).is_none());
    assert!(lineage.before(left).is_some() && lineage.before(left) != lineage.before(left + 1));
}
