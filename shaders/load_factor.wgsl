// What a load is multiplied with at each of its rows along each axis.
fn factor_of(i: u32) -> vec3<f32> {
    return vec3<f32>(factors[3u * i], factors[3u * i + 1u], factors[3u * i + 2u]);
}
