// An element at an integration point, and how it is inverted; twin of PointState in src/elements/mod.rs.
struct PointState {
    gradient: mat3x3<f32>, // ∇u
    adjugate: mat3x3<f32>, // det(∂X/∂ξ) (∂X/∂ξ)⁻¹ (m²), where stresses are added up in natural coordinates
    volume: f32, // the point's share of the rest volume (m³)
}
