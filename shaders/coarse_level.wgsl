// How nodes belong to aggregates, which move rigidly on the coarse level; twin of
// src/simulation/implicit/preconditioner/two_level/coarse.rs.
@group(0) @binding(7) var<storage, read> arms: array<vec4<f32>>; // from the middle at rest; the aggregate, below 0 none
@group(0) @binding(8) var<storage, read> turns: array<f32>; // rotation of an aggregate, column by column

fn turn_of(aggregate: u32) -> mat3x3<f32> {
    let at = 9u * aggregate;
    return mat3x3<f32>(
        vec3<f32>(turns[at], turns[at + 1u], turns[at + 2u]),
        vec3<f32>(turns[at + 3u], turns[at + 4u], turns[at + 5u]),
        vec3<f32>(turns[at + 6u], turns[at + 7u], turns[at + 8u]),
    );
}
