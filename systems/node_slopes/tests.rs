use super::*;

#[test]
fn forces_at_the_same_node_act_together_and_others_do_not() {
    let slopes = |stiffness: f64, damping: f64| ForceSlopes { stiffness, damping };
    let [one, other] = [1, 2].map(Entity::from_raw_u32).map(|body| body.unwrap_or(Entity::PLACEHOLDER));
    let mut all = NodeSlopes::default();
    all.of_body(one).add(3, slopes(2.0, 0.0));
    all.of_body(one).add(0, slopes(1.0, 5.0));
    all.of_body(other).add(3, slopes(2.5, 0.0));
    assert_eq!(all.largest(), slopes(2.5, 5.0));
    all.of_body(one).add(3, slopes(4.0, 1.0));
    assert_eq!(all.largest(), slopes(6.0, 5.0));
    all.add_everywhere(slopes(10.0, 1.0));
    assert_eq!(all.largest(), slopes(16.0, 6.0));
}
