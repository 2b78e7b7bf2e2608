use super::*;
use crate::components::InternalWork;

/// However rows are shared out, in parts of no less than [`GROUP_ROWS`] but for the last, every task has a place of
/// its own.
#[test]
fn every_task_has_a_place_for_its_work() {
    let nodes = 1003;
    for cuts in [vec![16, 33, 49, 65, 1000], vec![1002], vec![31, 992]] {
        let (mut floats, mut work) = (vec![0.0_f32; 4 * 3 * nodes], InternalWork::zero(nodes));
        let (read, axes) = (vec![1.0; nodes], vec![0; nodes]);
        let mut parts = floats.chunks_mut(3 * nodes);
        let mut part = || parts.next().unwrap_or_default();
        let mut rest = NodeColumns {
            first: 0,
            rest: &[],
            element_force: &[],
            non_finite: &AtomicU32::new(u32::MAX),
            undeclared: &Undeclared::default(),
            declared: Declared::default(),
            mass: &read,
            inertia: &read,
            internal: part(),
            external: None,
            axes: &axes,
            damping: None,
            u: part(),
            step: part(),
            compensation: None,
            work: None,
            internal_work: &mut work,
            previous_prescribed: &mut [],
            touches: None,
            holds: None,
            met: None,
            own: OwnRows::default(),
        };
        let mut places = 0;
        for cut in cuts {
            let mut task = rest.take(cut - rest.first);
            assert!(task.sum_of(0).is_some() && task.sum_of(task.rows() - 1).is_some(), "until {cut}");
            places += task.internal_work.len() / 2;
        }
        assert!(rest.sum_of(0).is_some());
        assert_eq!(places + rest.internal_work.len() / 2, nodes.div_ceil(16) + 1);
    }
}
