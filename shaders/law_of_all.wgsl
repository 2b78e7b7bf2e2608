// All elements of a block have the same law: its uniforms. Where copies differ, take_law is generated.
fn take_law(element: u32) {}
