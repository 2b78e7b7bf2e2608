//! Which triangles of a point's list matter: most are behind others that are nearer, and stay so while little moves.

/// So many triangles at most; points with more in their way look at all of their lists.
pub(super) const MOST: usize = 13;

/// Numbers of a shortlist that is not known.
const NONE: u8 = u8::MAX;

/// The triangles of a point's list that may be in its way as long as nodes move no farther than [`Stays`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortlist {
    /// So much nearer than when the list was made (m) the others must come before they are anything to see.
    pub(super) wakes: f64,
    /// Their numbers, ascending.
    triangles: [u32; MOST],
    /// Of which of them is known what the next two say: a bit each.
    asked: u16,
    /// Which of them stay turned away from all around the point, a node: a bit each.
    turned: u16,
    /// Which of them may have a rim: a bit each.
    rims: u16,
    /// How many, or [`NONE`].
    count: u8,
    /// The number of the one that alone matters, or [`NONE`], until nodes have [gone](Lately::gone) so far (m).
    alone: u8,
    until: f32,
}

/// How much may change while a shortlist holds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stays {
    /// How far any two nodes may move against each other (m).
    pub moved: f64,
    /// How much farther faces may be looked at (m).
    pub reach: f64,
}

/// How far nodes have gone against each other lately.
#[derive(Clone, Copy, Debug)]
pub struct Lately {
    /// Step by step, since some time (m); infinite where steps do not tell.
    pub gone: f64,
    /// So much farther they may go where one triangle alone is to matter (m).
    pub farther: f64,
}

impl Shortlist {
    /// Of a point that has not been looked at.
    pub const UNKNOWN: Self = Self {
        wakes: f64::INFINITY,
        triangles: [0; MOST],
        asked: 0,
        turned: 0,
        rims: 0,
        count: NONE,
        alone: NONE,
        until: f32::NEG_INFINITY,
    };

    /// Of a list of triangles, without those that stay away, each of which is so far (m); both by their places in the
    /// list.
    pub(super) fn of(triangles: &[u32], away: impl Fn(usize) -> bool, nearest: impl Fn(usize) -> f64) -> Self {
        let mut short = Self { count: 0, ..Self::UNKNOWN };
        for (place, &triangle) in triangles.iter().enumerate() {
            if away(place) {
                short.wakes = short.wakes.min(nearest(place));
                continue;
            }
            let Some(free) = short.triangles.get_mut(usize::from(short.count)) else { return Self::UNKNOWN };
            *free = triangle;
            short.count += 1;
        }
        short
    }

    /// Whether it is known.
    #[inline]
    pub fn is_known(&self) -> bool {
        self.count != NONE
    }

    /// The triangles, if they are known.
    #[inline]
    pub(super) fn triangles(&self) -> Option<&[u32]> {
        self.triangles.get(..usize::from(self.count))
    }

    /// The triangles that matter now, if they are known, and the number of the first.
    #[inline(always)] // with the instructions of whoever asks
    pub(super) fn triangles_now(&self, lately: Lately) -> Option<(&[u32], usize)> {
        let alone = usize::from(self.alone);
        match self.triangles.get(alone..alone + 1) {
            Some(one) if lately.gone <= f64::from(self.until) => Some((one, alone)),
            _ => Some((self.triangles()?, 0)),
        }
    }

    /// Whether it may be asked whether one alone matters.
    #[inline(always)] // likewise
    pub(super) fn may_be_alone(&self, lately: Lately) -> bool {
        lately.gone.is_finite() && lately.gone > f64::from(self.until)
    }

    /// Notes which alone matters, by its number, or that none does, until nodes have gone farther.
    #[inline(always)] // likewise
    pub(super) fn note_alone(&mut self, number: Option<usize>, lately: Lately) {
        self.alone = number.map_or(NONE, |number| number as u8);
        self.until = ((lately.gone + lately.farther) as f32).next_down();
    }

    /// Forgets that, for it is counted anew how far nodes go.
    pub fn count_anew(&mut self) {
        (self.alone, self.until) = (NONE, f32::NEG_INFINITY);
    }

    /// Whether it is known of the one of that number what the next two ask.
    #[inline(always)] // likewise
    pub(super) fn is_asked(&self, number: usize) -> bool {
        self.asked >> number & 1 == 1
    }

    /// Notes it: of most nobody asks as long as a shortlist holds.
    pub(super) fn note_asked(&mut self, number: usize, [is_turned_away, may_have_rim]: [bool; 2]) {
        self.asked |= 1 << number;
        self.turned |= u16::from(is_turned_away) << number;
        self.rims |= u16::from(may_have_rim) << number;
    }

    /// Whether the one of that number stays turned away from all around the point, a node.
    #[inline]
    pub(super) fn is_turned_away(&self, number: usize) -> bool {
        self.turned >> number & 1 == 1
    }

    /// Whether the one of that number may have a rim.
    #[inline]
    pub(super) fn may_have_rim(&self, number: usize) -> bool {
        self.rims >> number & 1 == 1
    }
}

#[cfg(test)]
mod tests;
