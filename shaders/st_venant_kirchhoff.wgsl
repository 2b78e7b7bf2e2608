// The St. Venant-Kirchhoff law; twin of src/materials/st_venant_kirchhoff.rs. With hooke.wgsl.
struct StVenantKirchhoff {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: StVenantKirchhoff;
