//! Which configurations are worth their price.

/// Marks the points (time, error) that no other point beats in both: the Pareto front. Of equal points the first is on
/// it; points that are not finite are not.
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let finite = |(time, error): (f64, f64)| time.is_finite() && error.is_finite();
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    (0..points.len())
        .map(|i| {
            let earlier_twin = points[..i].contains(&points[i]);
            let beaten = points.iter().any(|&other| finite(other) && beats(other, points[i]));
            finite(points[i]) && !earlier_twin && !beaten
        })
        .collect()
}

/// The exponent p of error ~ sizeᵖ through points (size, error): least squares in logarithms; `None` for fewer than two
/// different sizes or errors that are not above 0.
pub fn observed_order(points: &[(f64, f64)]) -> Option<f64> {
    let logarithms: Vec<(f64, f64)> =
        points.iter().filter(|(size, error)| *size > 0.0 && *error > 0.0).map(|(s, e)| (s.ln(), e.ln())).collect();
    let count = logarithms.len() as f64;
    let (x, y) = logarithms.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let (square, product) = logarithms
        .iter()
        .fold((0.0, 0.0), |sum, point| (sum.0 + (point.0 - x).powi(2), sum.1 + (point.0 - x) * (point.1 - y)));
    (square > 1e-12).then(|| product / square)
}
