//! How near a tool's origin comes to the point that its shaft goes through.

use glam::DVec3;

/// Rounds of coordinate descent: each finds the least along one motion after the other exactly.
const ROUNDS: usize = 200;

/// The least distance (m) from a point to where an origin may be: straight from place to place, and to each of these
/// added moves, displacements (m) times factors within bounds. What one move does may depend on another, and on where
/// on its way it is: then the origin may stay farther away than this.
pub fn closest_approach(path: &[DVec3], moves: &[(DVec3, [f64; 2])], point: DVec3) -> f64 {
    let of_leg = |from: DVec3, way: Option<DVec3>| {
        let mut all: Vec<(DVec3, [f64; 2], f64)> =
            moves.iter().map(|&(move_, [low, high])| (move_, [low, high], 0.0_f64.clamp(low, high))).collect();
        all.extend(way.map(|way| (way, [0.0, 1.0], 0.0)));
        let mut off = from - point + all.iter().map(|(way, _, factor)| *way * *factor).sum::<DVec3>();
        for _ in 0..ROUNDS {
            for (way, [low, high], factor) in &mut all {
                let square = way.length_squared();
                if square > 0.0 {
                    let best = (*factor - off.dot(*way) / square).clamp(*low, *high);
                    off += *way * (best - *factor);
                    *factor = best;
                }
            }
        }
        off.length()
    };
    let legs = path.windows(2).map(|pair| of_leg(pair[0], Some(pair[1] - pair[0])));
    let last = path.last().map(|&place| of_leg(place, None));
    legs.chain(last).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
