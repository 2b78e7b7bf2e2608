//! Which triangles of a point's list matter: most are behind others that are nearer, and stay so while little moves.

/// So many triangles at most; points with more in their way look at all of their lists.
const MOST: usize = 13;

/// Numbers of a shortlist that is not known.
const NONE: u8 = u8::MAX;

/// The triangles of a point's list that may be in its way as long as nodes move no farther than [`Stays`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortlist {
    /// So much nearer than when the list was made (m) the others must come before they are anything to see.
    pub(super) wakes: f64,
    /// How many, or [`NONE`].
    count: u8,
    /// Which of them stay turned away from all around the point, a node: a bit each.
    turned: u16,
    /// Their places in the list, ascending.
    places: [u8; MOST],
}

/// How much may change while a shortlist holds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stays {
    /// How far any two nodes may move against each other (m).
    pub moved: f64,
    /// How much farther faces may be looked at (m).
    pub reach: f64,
}

impl Shortlist {
    /// Of a point that has not been looked at.
    pub const UNKNOWN: Self = Self { wakes: f64::INFINITY, count: NONE, turned: 0, places: [0; MOST] };

    /// Without those that stay away, each of which is so far (m), and with which of the others stay turned away.
    pub(super) fn of(
        count: usize,
        away: impl Fn(usize) -> bool,
        nearest: impl Fn(usize) -> f64,
        turned: impl Fn(usize) -> bool,
    ) -> Self {
        let mut short = Self { count: 0, ..Self::UNKNOWN };
        for place in 0..count {
            if away(place) {
                short.wakes = short.wakes.min(nearest(place));
                continue;
            }
            let Some(free) = short.places.get_mut(usize::from(short.count)) else { return Self::UNKNOWN };
            let Ok(place) = u8::try_from(place) else { return Self::UNKNOWN };
            *free = place;
            short.turned |= u16::from(turned(usize::from(place))) << short.count;
            short.count += 1;
        }
        short
    }

    /// The places, if they are known.
    pub(super) fn places(&self) -> Option<&[u8]> {
        self.places.get(..usize::from(self.count))
    }

    /// Whether the one of that number stays turned away from all around the point, a node.
    pub(super) fn is_turned_away(&self, number: usize) -> bool {
        self.turned >> number & 1 == 1
    }
}

#[cfg(test)]
mod tests;
