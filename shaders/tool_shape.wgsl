// Signed distances to shapes of tools; twin of crates/tools/src/form.rs.

// The shape that is smaller by the rounding all round.
struct ToolShape {
    kind: u32,
    // sizes (m), but for directions: radius of a sphere; half edges of a box; radius of a capsule, z of the ends of its
    // axis; radius of a cylinder, z of its ends; radii at the ends of a cone, z of these, parts across and along z of
    // the mantle's normal; inner and outer radius of a tube, z of its ends, sine and cosine of the bevel
    a: f32,
    b: f32,
    c: f32,
    d: f32,
    e: f32,
    f: f32,
    rounding: f32,
}

const TOOL_PLANE: u32 = 0u;
const TOOL_SPHERE: u32 = 1u;
const TOOL_BOX: u32 = 2u;
const TOOL_CAPSULE: u32 = 3u;
const TOOL_CYLINDER: u32 = 4u;
const TOOL_CONE: u32 = 5u;

// Beyond one (m) squares are no numbers; below the other so small that devices which round them to 0 lose digits.
const TOOL_FAR: f32 = 1e15;
const TOOL_NEAR: f32 = 1e-15;

// How far beyond the nearer of two ends (m), and the direction there; the first end first.
fn tool_ends(z: f32, low: f32, high: f32) -> vec2<f32> {
    let first = low - z >= z - high;
    return vec2<f32>(select(z - high, low - z, first), select(1.0, -1.0, first));
}

// A gradient across and along the axis and a distance (m), turned to where the place is. On the axis, across is x.
fn tool_turned(y: vec3<f32>, rho: f32, flat: vec3<f32>) -> vec4<f32> {
    var across = vec2<f32>(1.0, 0.0);
    if rho > TOOL_NEAR {
        across = y.xy / rho;
    }
    return vec4<f32>(across * flat.x, flat.y, flat.z);
}

fn tool_sphere(y: vec3<f32>, radius: f32) -> vec4<f32> {
    let size = length(y);
    if size > TOOL_NEAR {
        return vec4<f32>(y / size, size - radius);
    }
    return vec4<f32>(1.0, 0.0, 0.0, size - radius);
}

// Outside the nearest point counts, inside the nearest face: x before y before z, positive before negative.
fn tool_box(y: vec3<f32>, half_edges: vec3<f32>) -> vec4<f32> {
    let side = select(vec3<f32>(1.0), vec3<f32>(-1.0), y < vec3<f32>(0.0));
    let q = abs(y) - half_edges;
    let beyond = max(q, vec3<f32>(0.0));
    let size = length(beyond);
    if size > TOOL_NEAR {
        return vec4<f32>(side * (beyond / size), size);
    }
    if q.x >= q.y && q.x >= q.z {
        return vec4<f32>(side.x, 0.0, 0.0, q.x);
    }
    if q.y >= q.z {
        return vec4<f32>(0.0, side.y, 0.0, q.y);
    }
    return vec4<f32>(0.0, 0.0, side.z, q.z);
}

// Beyond the nearer of two sides across and along the axis, and the directions there; the first side first.
fn tool_rectangle(across: vec2<f32>, along: vec2<f32>) -> vec3<f32> {
    let beyond = max(vec2<f32>(across.x, along.x), vec2<f32>(0.0));
    let size = length(beyond);
    if size > TOOL_NEAR {
        return vec3<f32>(vec2<f32>(across.y, along.y) * (beyond / size), size);
    }
    if across.x >= along.x {
        return vec3<f32>(across.y, 0.0, across.x);
    }
    return vec3<f32>(0.0, along.y, along.x);
}

// The half section of a cone: mantle before the low end before the high one.
fn tool_trapezium(p: vec2<f32>, radii: vec2<f32>, ends: vec2<f32>, normal: vec2<f32>) -> vec3<f32> {
    let from_low = p - vec2<f32>(radii.x, ends.x);
    let from_high = p - vec2<f32>(radii.y, ends.y);
    // along the mantle from the low end on
    let along = vec2<f32>(-normal.y, normal.x);
    // the same from either end, but for rounding
    let off = dot(normal, select(from_high, from_low, dot(from_low, from_low) <= dot(from_high, from_high)));
    let inside = max(off, max(ends.x - p.y, p.y - ends.y));
    let past_low = dot(along, from_low) >= 0.0;
    let past_high = dot(along, from_high) <= 0.0;
    if inside <= 0.0 {
        if off >= inside {
            return vec3<f32>(normal, off);
        }
        if ends.x - p.y >= inside {
            return vec3<f32>(0.0, -1.0, ends.x - p.y);
        }
        return vec3<f32>(0.0, 1.0, p.y - ends.y);
    }
    if off > 0.0 && past_low && past_high {
        return vec3<f32>(normal, off);
    }
    if p.y < ends.x && from_low.x <= 0.0 {
        return vec3<f32>(0.0, -1.0, ends.x - p.y);
    }
    if p.y > ends.y && from_high.x <= 0.0 {
        return vec3<f32>(0.0, 1.0, p.y - ends.y);
    }
    let corner = select(from_low, from_high, past_low);
    let size = length(corner);
    if size > TOOL_NEAR {
        return vec3<f32>(corner / size, size);
    }
    return vec3<f32>(normal, size);
}

// The unit gradient, and in w the signed distance (m) from a place in the tool's frame (m).
fn tool_distance(shape: ToolShape, place: vec3<f32>) -> vec4<f32> {
    let y = clamp(place, vec3<f32>(-TOOL_FAR), vec3<f32>(TOOL_FAR));
    let rho = length(y.xy);
    var found = vec4<f32>(0.0, 0.0, 1.0, y.z);
    switch shape.kind {
        case TOOL_PLANE: {}
        case TOOL_SPHERE: {
            found = tool_sphere(y, shape.a);
        }
        case TOOL_BOX: {
            found = tool_box(y, vec3<f32>(shape.a, shape.b, shape.c));
        }
        case TOOL_CAPSULE: {
            found = tool_sphere(vec3<f32>(y.xy, y.z - clamp(y.z, shape.b, shape.c)), shape.a);
        }
        case TOOL_CYLINDER: {
            let flat = tool_rectangle(vec2<f32>(rho - shape.a, 1.0), tool_ends(y.z, shape.b, shape.c));
            found = tool_turned(y, rho, flat);
        }
        case TOOL_CONE: {
            let radii = vec2<f32>(shape.a, shape.b);
            let ends = vec2<f32>(shape.c, shape.d);
            found = tool_turned(y, rho, tool_trapezium(vec2<f32>(rho, y.z), radii, ends, vec2<f32>(shape.e, shape.f)));
        }
        default: {
            // the outside first
            let outside = rho - shape.b >= shape.a - rho;
            let wall = select(vec2<f32>(shape.a - rho, -1.0), vec2<f32>(rho - shape.b, 1.0), outside);
            found = tool_turned(y, rho, tool_rectangle(wall, tool_ends(y.z, shape.c, shape.d)));
            // through the foremost point of the tube as it is before it is rounded
            let off = shape.rounding - shape.e * (y.x - (shape.b + shape.rounding)) - shape.f * y.z;
            if shape.e > 0.0 && off > found.w {
                found = vec4<f32>(-shape.e, 0.0, -shape.f, off);
            }
        }
    }
    return vec4<f32>(found.xyz, found.w - shape.rounding);
}
