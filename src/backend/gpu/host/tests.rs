use super::*;

#[test]
fn a_device_may_have_less_than_kernels_need_where_its_adapter_has_no_more() {
    let small = Limits::default();
    assert_eq!(too_few(&small, &small), None);
    let large = Limits { max_storage_buffers_per_shader_stage: 500_000, ..small.clone() };
    assert_eq!(too_few(&small, &large), Some(("storage", 8, 16)));
    assert_eq!(too_few(&large, &large), None);
}
