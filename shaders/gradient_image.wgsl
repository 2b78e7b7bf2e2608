// A p of a body by a difference of forces; see conjugate_gradients.wgsl. external_force_of and displace_velocity are in
// external_force.wgsl and gradient_velocity.wgsl, or generated where loads are none or look at no velocity.
struct Part {
    first: u32, // its first node among those of all bodies
    nodes: u32,
    first_group: u32, // among the partials
    groups: u32,
}
@group(0) @binding(3) var<uniform> part: Part;
@group(0) @binding(4) var<storage, read> direction: array<f32>; // p
@group(0) @binding(5) var<storage, read> place: array<f32>; // w (m)
@group(0) @binding(6) var<storage, read_write> displacement: array<f32>;
@group(0) @binding(7) var<storage, read> internal_force: array<f32>;
@group(0) @binding(8) var<storage, read> net_force: array<f32>; // F − R at w (N)
@group(0) @binding(9) var<storage, read> inertia: array<f32>; // D (N/m); below 0 where an axis is not free
@group(0) @binding(10) var<storage, read_write> image: array<f32>;

// w + ε p.
@compute @workgroup_size(64)
fn displace(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let node = row(id, groups);
    if node >= part.nodes {
        return;
    }
    for (var axis = 0u; axis < 3u; axis++) {
        let at = 3u * (part.first + node) + axis;
        let moved = solve.reach * direction[at];
        displacement[3u * node + axis] = place[at] + moved;
        displace_velocity(3u * node + axis, at, moved);
    }
}

// D p + c (F(w + ε p) − F(w))/ε on free axes, and its product with p.
@compute @workgroup_size(64)
fn image_of(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let node = row(id, groups);
    var product = 0.0;
    if node < part.nodes {
        let load = external_force_of(node);
        for (var axis = 0u; axis < 3u; axis++) {
            let at = 3u * (part.first + node) + axis;
            let force = internal_force[3u * node + axis] - load[axis];
            var q = 0.0;
            if inertia[at] >= 0.0 {
                q = inertia[at] * direction[at];
                if solve.reach > 0.0 {
                    q += extent.stiffness / solve.reach * (force - net_force[at]);
                }
            }
            image[at] = q;
            product += q * direction[at];
        }
    }
    let of_group = sum_of_group(local, vec2<f32>(product, 0.0));
    let group = patch_row(group_id, groups);
    if local == 0u && group < part.groups {
        partials[part.first_group + group] = of_group;
    }
}
