use super::*;
use crate::materials::program::KNOWN_BY_NAME;

#[test]
fn what_has_no_twin_is_known_by_name() {
    let functions: Vec<&str> = OF_BITS.iter().flat_map(|(_, functions)| functions.iter().copied()).collect();
    assert_eq!(functions, KNOWN_BY_NAME);
    let ours = Form::law().ours;
    assert!(OF_BITS.iter().all(|(path, _)| ours.iter().any(|fragment| fragment.path == *path)));
    let others = ours.iter().filter(|fragment| !OF_BITS.iter().any(|(path, _)| *path == fragment.path));
    let looking: Vec<&str> = others.filter(|f| f.text.contains("bitcast")).map(|f| f.path.as_str()).collect();
    assert!(looking.is_empty(), "{looking:?}");
}
