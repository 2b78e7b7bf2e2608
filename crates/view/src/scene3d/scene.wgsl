// Bodies, tools, their shadows, and what is behind them. Directions of lights are as the eye sees them: to the right,
// up, towards the eye. The light on what is coloured by a field is that of the pictures (crates/pictures, light.rs).

struct View {
    clip: mat4x4f,
    // where lights see points: the key light, and the sky
    key_clip: mat4x4f,
    sky_clip: mat4x4f,
    right: vec4f,
    up: vec4f,
    back: vec4f,
    eye: vec4f,
    // of length 1, and where it stands along it; 0 where nothing is cut
    plane: vec4f,
    // what is up, and where the ground is along it
    ground: vec4f,
    // of the bodies, and their diagonal
    middle: vec4f,
    // least value, inverse span, whether light is encoded here, how wet tissue is
    range: vec4f,
    // strength of shadows, half the width of lines (pixels), whether the ground is seen, light of what is around
    shade: vec4f,
    top: vec4f,
    bottom: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var ramp: texture_2d<f32>;
@group(0) @binding(2) var<uniform> tissues: array<vec4f, 512>;
// pictures on surfaces
@group(0) @binding(3) var pictures: texture_2d_array<f32>;
@group(0) @binding(4) var repeated: sampler;
@group(1) @binding(0) var key_map: texture_depth_2d;
@group(1) @binding(1) var sky_map: texture_depth_2d;
@group(1) @binding(2) var nearer: sampler_comparison;
// the same maps as numbers
@group(1) @binding(3) var key_depths: texture_2d<f32>;
@group(1) @binding(4) var sky_depths: texture_2d<f32>;

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // where noise is taken: it sticks to the tissue; of what has a picture on it the place there, and which it is
    @location(2) rest: vec3f,
    @location(3) value: f32,
    @location(4) flags: u32,
}

struct Seen {
    @builtin(position) place: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) rest: vec3f,
    @location(3) value: f32,
    @location(4) share: vec3f,
    @location(5) @interpolate(flat) flags: u32,
}

const PLAIN = 0u;
const BARED = 1u;
const SHEET = 2u;
const GHOST = 3u;
const STEEL = 4u;
const TABLE = 5u;
const PANE = 6u;
const TISSUE = 7u;
const PICTURED = 8u;

// Some of the bits of flags; `extractBits` is not in all of WebGL.
fn bits(flags: u32, first: u32, count: u32) -> u32 { return (flags >> first) & ((1u << count) - 1u); }

fn finish_of(flags: u32) -> u32 { return bits(flags, 13u, 4u); }

// Light as it is stored: encoded here where the texture does not do so by itself.
fn stored(light: vec4f) -> vec4f {
    let low = max(light.rgb, vec3f(0));
    let encoded = select(1.055 * pow(low, vec3f(1.0 / 2.4)) - 0.055, 12.92 * low, low < vec3f(0.0031308));
    return select(light, vec4f(encoded, light.a), view.range.z > 0.5);
}

@vertex fn corner(it: Corner) -> Seen {
    let number = it.flags & 3u;
    let share = vec3f(f32(number == 0u), f32(number == 1u), f32(number == 2u));
    return Seen(view.clip * vec4f(it.position, 1), it.position, it.normal, it.rest, it.value, share, it.flags);
}

fn is_cut(flags: u32, position: vec3f) -> bool {
    return (flags & 0x2000000u) != 0u && dot(view.plane.xyz, position) > view.plane.w;
}

struct Shadow {
    @builtin(position) place: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) flags: u32,
}

@vertex fn shadow_of_key(it: Corner) -> Shadow {
    return Shadow(view.key_clip * vec4f(it.position, 1), it.position, it.flags);
}

@vertex fn shadow_of_sky(it: Corner) -> Shadow {
    return Shadow(view.sky_clip * vec4f(it.position, 1), it.position, it.flags);
}

@fragment fn shadow(it: Shadow) {
    if is_cut(it.flags, it.position) { discard; }
}

// One of so many places of a disc of radius 1, those of a sunflower.
fn seed(number: i32, count: i32) -> vec2f {
    let turn = 2.39996 * f32(number);
    return sqrt((f32(number) + 0.5) / f32(count)) * vec2f(cos(turn), sin(turn));
}

// How far before a place (shares of the map's depth) that is which keeps a light from it, over a disc around it.
fn gap(map: texture_2d<f32>, place: vec2f, depth: f32, disc: f32) -> f32 {
    let size = vec2f(textureDimensions(map));
    var sum = 0.0;
    var count = 0.0;
    for (var number = 0; number < 9; number++) {
        let texel = clamp((place + disc * seed(number, 9)) * size, vec2f(0), size - 1.0);
        let before = depth - textureLoad(map, vec2i(texel), 0).r;
        if before > 0.0 {
            sum += before;
            count += 1.0;
        }
    }
    return sum / max(count, 1.0);
}

// The share of a light that reaches a place. The light is a disc, seen under an angle whose tangent is `wide`: shadows
// are sharp where they touch what casts them, and wide (shares of the map) far from it.
fn reaches(map: texture_depth_2d, depths: texture_2d<f32>, clip: mat4x4f, position: vec3f, wide: f32, least: f32, most: f32) -> f32 {
    let at = (clip * vec4f(position, 1)).xyz;
    let depth = clamp(at.z, 0.0, 1.0);
    let place = vec2f(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
    let disc = clamp(wide * gap(depths, place, depth, most), least, most);
    var sum = 0.0;
    for (var number = 0; number < 24; number++) {
        sum += textureSampleCompareLevel(map, nearer, place + disc * seed(number, 24), depth);
    }
    return sum / 24.0;
}

// The light left at a place of a surface, or on the ground: of the key light and of the sky.
fn light_at(position: vec3f, normal: vec3f) -> vec2f {
    let off = position + normal * (0.012 * view.middle.w);
    let key = reaches(key_map, key_depths, view.key_clip, off, 0.14, 0.004, 0.03);
    let sky = 0.5 * (reaches(sky_map, sky_depths, view.sky_clip, off, 0.5, 0.02, 0.03)
        + reaches(sky_map, sky_depths, view.sky_clip, off, 1.0, 0.05, 0.08));
    return mix(vec2f(1), vec2f(key, sky), view.shade.x);
}

const KEY = vec3f(-0.4196, 0.5781, 0.6993);
const FILL = vec3f(0.8830, 0.0519, 0.4675);
const GLOSS = vec3f(-0.2277, 0.3137, 0.9219);

fn in_eye(direction: vec3f) -> vec3f {
    return vec3f(dot(view.right.xyz, direction), dot(view.up.xyz, direction), dot(view.back.xyz, direction));
}

fn lit(normal: vec3f, colour: vec3f, light: vec2f) -> vec3f {
    let around = (0.44 + 0.08 * normal.y) * mix(0.45, 1.0, light.y);
    let key = max(dot(normal, KEY), 0.0);
    let diffuse = around + 0.52 * key * light.x + 0.18 * max(dot(normal, FILL), 0.0) * mix(0.6, 1.0, light.y);
    return colour * diffuse + 0.05 * pow(max(dot(normal, GLOSS), 0.0), 60.0) * light.x;
}

fn steel(normal: vec3f, light: vec2f) -> vec3f {
    let mirrored = 2.0 * normal.z * normal - vec3f(0, 0, 1);
    let above = 1.0 / (1.0 + exp(-4.0 * mirrored.y));
    let level = normal.xz;
    let lamps = 0.95 * pow(max(dot(level, vec2f(-0.52, 0.854)), 0.0), 22.0)
        + 0.5 * pow(max(dot(level, vec2f(0.88, 0.475)), 0.0), 26.0);
    let dull = 0.42 + 0.52 * max(dot(normal, KEY), 0.0) + 0.15 * max(dot(normal, FILL), 0.0);
    let gloss = pow(max(dot(mirrored, KEY), 0.0), 80.0);
    let colour = vec3f(0.4918, 0.5307, 0.5779);
    return (colour * (0.55 * (0.42 + 0.36 * above + lamps) + 0.45 * dull) + 0.2 * gloss) * mix(0.5, 1.0, light.y);
}

fn hash(cell: vec3f) -> f32 {
    let p = fract(cell * 0.3183099 + vec3f(0.71, 0.113, 0.419));
    let q = p * 17.0;
    return fract(q.x * q.y * q.z * (p.x + p.y + p.z));
}

fn noise(place: vec3f) -> f32 {
    let cell = floor(place);
    let f = fract(place);
    let s = f * f * (3.0 - 2.0 * f);
    let low = mix(
        mix(hash(cell), hash(cell + vec3f(1, 0, 0)), s.x),
        mix(hash(cell + vec3f(0, 1, 0)), hash(cell + vec3f(1, 1, 0)), s.x), s.y);
    let high = mix(
        mix(hash(cell + vec3f(0, 0, 1)), hash(cell + vec3f(1, 0, 1)), s.x),
        mix(hash(cell + vec3f(0, 1, 1)), hash(cell + vec3f(1, 1, 1)), s.x), s.y);
    return mix(low, high, s.z);
}

// The gloss of a wet film: a lamp mirrored sharply, one mirrored in a rougher layer below, and the room at the rim.
// What is too fine for a pixel to be seen as waves of the film (0 to 1) makes its mirror dull: as bright, and wider.
fn film(normal: vec3f, light: vec2f, dull: f32) -> f32 {
    let mirrored = 2.0 * normal.z * normal - vec3f(0, 0, 1);
    let rim = 0.04 + 0.96 * pow(1.0 - clamp(normal.z, 0.0, 1.0), 5.0);
    let power = mix(vec2f(260.0, 120.0), vec2f(70.0, 50.0), dull);
    let strength = mix(vec2f(1.1, 0.35), vec2f(0.42, 0.18), dull);
    let sharp = strength.x * pow(max(dot(mirrored, KEY), 0.0), power.x)
        + strength.y * pow(max(dot(mirrored, FILL), 0.0), power.y);
    let broad = 0.16 * pow(max(dot(mirrored, KEY), 0.0), 18.0) * light.x;
    let room = rim * (0.25 + 0.45 * smoothstep(-0.4, 0.9, mirrored.y)) * light.y;
    return sharp * mix(0.15, 1.0, light.x) + broad + 0.7 * room;
}

// Tissue: light goes in, is scattered, and comes out redder beyond the edge of its shadow and where it is thin.
// `place`: where noise is taken, and `pixel`: how far that goes on from a pixel to the next, both so that 34 is about
// the size of a body. `painted`: the colour of a picture, with a weight of 1, or 0.
fn tissue(normal: vec3f, place: vec3f, number: u32, light: vec2f, pixel: f32, painted: vec4f) -> vec3f {
    let colour = tissues[2u * number];
    let scatter = tissues[2u * number + 1u];
    let mottled = 0.6 * noise(place) + 0.4 * noise(place * 3.1);
    // a film over what is not quite even: long waves, and finer ones as far as a pixel shows them
    let long = place * 1.7;
    let fine = place * 5.0;
    let dull = smoothstep(0.12, 0.5, 5.0 * pixel);
    let waves = vec3f(noise(long), noise(long + vec3f(31.7)), noise(long + vec3f(77.1))) - 0.5;
    let ripples = vec3f(noise(fine), noise(fine + vec3f(31.7)), noise(fine + vec3f(77.1))) - 0.5;
    let uneven = normalize(normal + scatter.w * (0.09 * waves + 0.05 * (1.0 - dull) * ripples));
    let own = colour.rgb * mix(vec3f(1), 0.72 + 0.5 * vec3f(mottled, mottled * 0.92, mottled * 0.9), colour.w);
    let albedo = mix(own, painted.rgb, painted.a);
    let wrap = scatter.rgb;
    let key = clamp((vec3f(dot(normal, KEY)) + wrap) / (1.0 + wrap), vec3f(0), vec3f(1));
    let fill = clamp((vec3f(dot(normal, FILL)) + wrap) / (1.0 + wrap), vec3f(0), vec3f(1));
    let around = (0.36 + 0.1 * normal.y) * mix(0.3, 1.0, light.y);
    // what is in shadow still gets red light through its neighbours
    let through = mix(wrap * 0.5, vec3f(1), light.x);
    let thin = pow(1.0 - clamp(normal.z, 0.0, 1.0), 2.5) * 0.35 * wrap;
    let diffuse = around + 0.72 * key * key * through + 0.2 * fill * mix(0.5, 1.0, light.y) + thin;
    return albedo * diffuse + view.range.w * film(uneven, light, dull * scatter.w);
}

fn ink_of(it: Seen, width: vec3f) -> f32 {
    let edges = vec3f(f32((it.flags >> 2u) & 1u), f32((it.flags >> 3u) & 1u), f32((it.flags >> 4u) & 1u));
    let lines = (view.shade.y + 0.5 - it.share / max(width, vec3f(1e-9))) * edges;
    let ink = max(lines.x, max(lines.y, lines.z));
    return clamp(ink, 0.0, 1.0) * f32(bits(it.flags, 5u, 8u)) / 255.0;
}

fn of_value(value: f32) -> vec3f {
    let step = clamp((value - view.range.x) * view.range.y, 0.0, 1.0) * 1023.0;
    return textureLoad(ramp, vec2i(i32(step + 0.5), 0), 0).rgb;
}

struct Side {
    world: vec3f,
    eye: vec3f,
}

fn side_of(it: Seen, front: bool) -> Side {
    let world = normalize(it.normal) * select(-1.0, 1.0, front);
    return Side(world, in_eye(world));
}

@fragment fn solid(it: Seen, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let width = fwidth(it.share);
    let pixel = length(fwidth(it.rest));
    let across = dpdx(it.rest.xy);
    let down = dpdy(it.rest.xy);
    if is_cut(it.flags, it.position) { discard; }
    let side = side_of(it, front);
    let light = light_at(it.position, side.world);
    let ink = ink_of(it, width);
    let finish = finish_of(it.flags);
    var colour: vec3f;
    if finish == STEEL {
        colour = steel(side.eye, light);
    } else if finish == TABLE {
        let table = select(vec3f(0.8388, 0.8528, 0.8686), vec3f(0.045, 0.055, 0.07), view.shade.w < 0.5);
        colour = lit(side.eye, table, vec2f(mix(0.55, 1.0, light.x), light.y));
    } else if finish == TISSUE {
        let large = 34.0 / view.middle.w;
        let number = bits(it.flags, 17u, 8u);
        colour = tissue(side.eye, it.rest * large, number, light, pixel * large, vec4f(0)) * (1.0 - ink);
    } else if finish == PICTURED {
        let painted = textureSampleGrad(pictures, repeated, it.rest.xy, i32(it.rest.z + 0.5), across, down);
        let number = bits(it.flags, 17u, 8u);
        colour = tissue(side.eye, it.rest * 34.0, number, light, pixel * 34.0, vec4f(painted.rgb, 1)) * (1.0 - ink);
    } else {
        var value = of_value(it.value);
        if finish == BARED { value = mix(value, vec3f(0.7098, 0.3424, 0.2957), 0.72); }
        colour = lit(side.eye, value, light) * (1.0 - ink);
        // a field stays legible under the film
        colour += 0.35 * view.range.w * film(side.eye, light, 0.0);
    }
    return stored(vec4f(colour, 1));
}

// What is seen through: sheets, the shape at rest, planes from behind.
@fragment fn clear(it: Seen, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let width = fwidth(it.share);
    if is_cut(it.flags, it.position) { discard; }
    let side = side_of(it, front);
    let ink = ink_of(it, width);
    let askew = 1.0 / clamp(abs(side.eye.z), 0.2, 1.0);
    let finish = finish_of(it.flags);
    if finish == GHOST {
        let line = vec3f(0.2140, 0.2747, 0.3663);
        return stored(vec4f(line * view.shade.w, max(0.05, 0.75 * ink)));
    }
    let colour = select(vec3f(0.8388, 0.8528, 0.8686), of_value(it.value), finish == SHEET);
    return stored(vec4f(lit(side.eye, colour, vec2f(1)) * (1.0 - ink), 1.0 - pow(0.88, askew)));
}

struct Behind {
    @builtin(position) place: vec4f,
    @location(0) at: vec2f,
}

@vertex fn whole(@builtin(vertex_index) number: u32) -> Behind {
    let at = vec2f(f32(number & 1u), f32(number >> 1u)) * 2.0;
    return Behind(vec4f(at * 2.0 - 1.0, 0, 1), at);
}

@fragment fn behind(it: Behind) -> @location(0) vec4f {
    return stored(vec4f(mix(view.bottom.rgb, view.top.rgb, it.at.y), 1));
}

struct Ground {
    @builtin(position) place: vec4f,
    @location(0) position: vec3f,
}

@vertex fn below(@builtin(vertex_index) number: u32) -> Ground {
    let side = vec2f(f32(number & 1u), f32(number >> 1u)) * 2.0 - 1.0;
    let up = view.ground.xyz;
    let other = select(vec3f(1, 0, 0), vec3f(0, 1, 0), abs(up.x) > 0.7);
    let across = normalize(cross(up, other));
    let along = cross(up, across);
    let foot = view.middle.xyz - up * (dot(up, view.middle.xyz) - view.ground.w);
    let position = foot + 3.0 * view.middle.w * (side.x * across + side.y * along);
    return Ground(view.clip * vec4f(position, 1), position);
}

// Only the shadow is seen, which fades far from the bodies.
@fragment fn ground(it: Ground) -> @location(0) vec4f {
    let light = light_at(it.position, view.ground.xyz * 0.2);
    let far = distance(it.position, view.middle.xyz) / view.middle.w;
    let dark = (1.0 - light.y) * 0.62 + (1.0 - light.x) * 0.20;
    return vec4f(0, 0, 0, dark * view.shade.z * smoothstep(2.0, 0.6, far));
}
