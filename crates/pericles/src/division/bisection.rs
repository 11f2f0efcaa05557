//! Recursive coordinate bisection.

use crate::domain::Comm;
use crate::space::Point;

/// Where cuts may lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cuts {
    /// Between any two points, ordered by coordinate and then by number: parts of equal weight.
    #[default]
    Anywhere,
    /// Between points of different coordinates: parts of a lattice are boxes, which keep long rows of the stencil.
    Planes,
}

/// The points of the calling process.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    /// Spatial dimension.
    pub dimension: usize,
    /// Component-major coordinates, m.
    pub positions: &'a [f64],
    /// Number of each point in the whole body.
    pub numbers: &'a [u32],
    /// Work of each point, such as its number of bonds; zero counts as one. Empty if all are equal.
    pub weights: &'a [u32],
}

/// A box of points that is divided among some parts.
#[derive(Debug, Clone, Copy)]
struct Group {
    first: u32,
    parts: u32,
}

/// Search for the cut of a group: the item of the ordered points that contains the target of the cumulative weight.
#[derive(Debug, Clone, Copy)]
struct Search {
    axis: usize,
    /// Bits of the key known so far.
    key: u128,
    /// Weight of the items before those with these bits.
    before: i128,
    /// Weight of the group, and of the items with these bits.
    whole: i128,
    weight: i128,
}

/// Bits of a digit of the search.
const DIGIT: u32 = 8;
const BINS: usize = 1 << DIGIT;
/// Bits of the coordinate in a key, above those of the number.
const COORDINATE: u32 = 64;

/// Returns bits with the order of the numbers.
fn ordered(x: f64) -> u64 {
    // The sum replaces −0 by 0.
    let bits = (x + 0.0).to_bits();
    match bits >> 63 {
        0 => bits | 1 << 63,
        _ => !bits,
    }
}

/// One cut of each group, into the groups of the next level.
#[derive(Debug, Clone)]
struct Level {
    groups: Vec<Group>,
    searches: Vec<Search>,
    /// Index of the lower half of each group in the next level; the upper half follows.
    lower: Vec<u32>,
}

/// A division of space into parts by recursive coordinate bisection, see [`bisect`].
#[derive(Debug, Clone)]
pub struct Bisection {
    levels: Vec<Level>,
    /// The part of each group of the last level.
    parts: Vec<u32>,
    /// Lowest bit of keys that cuts distinguish.
    last: u32,
}

impl Bisection {
    /// Returns the part of a point of the body by its number and position, m.
    pub fn owner(&self, number: u32, position: Point) -> u32 {
        let mut g = 0;
        for level in &self.levels {
            let key = key(number, position[level.searches[g].axis]);
            g = level.next(g, key, self.last) as usize;
        }
        self.parts[g]
    }

    /// Returns the parts of some points.
    pub fn owners(&self, points: &Points<'_>) -> Vec<u32> {
        let n = points.numbers.len();
        let position = |i: usize| -> Point {
            std::array::from_fn(|c| match c < points.dimension {
                true => points.positions[c * n + i],
                false => 0.0,
            })
        };
        (0..n)
            .map(|i| self.owner(points.numbers[i], position(i)))
            .collect()
    }
}

impl Level {
    /// Returns the group of the next level to which an item of group g belongs.
    fn next(&self, g: usize, key: u128, last: u32) -> u32 {
        let group = &self.groups[g];
        let upper = group.parts > 1 && !self.searches[g].is_below(group, key >> last, last);
        self.lower[g] + u32::from(upper)
    }
}

/// Returns the key of a point along an axis.
fn key(number: u32, coordinate: f64) -> u128 {
    u128::from(ordered(coordinate)) << COORDINATE | u128::from(number)
}

/// Divides points, which may be spread over processes in any way, into `parts` parts by recursive coordinate bisection: the box
/// of a group of points is cut across its longest side at the weighted median, with ⌊p/2⌋ of its p parts on the lower side, until
/// each group is one part. Of equal sides the first one is cut, or the last one if the cuts lie between planes, so that the rows
/// of the stencil along x stay long. A point belongs to the lower side if the weight before it and half of its own are less than
/// that side's share.
///
/// The result does not depend on how the points are spread over the processes: cuts are found by exact sums of integer
/// weights over bins of the ordered coordinates, refined eight bits at a time. No process needs the points of others. All
/// processes must call it together.
///
/// # Panics
/// If numbers, weights and coordinates do not belong to the same points, or there are no parts.
pub fn bisect(comm: &dyn Comm, points: &Points<'_>, parts: usize, cuts: Cuts) -> Bisection {
    let n = points.numbers.len();
    assert!(
        (points.weights.is_empty() || points.weights.len() == n)
            && points.positions.len() == n * points.dimension,
        "one weight and one position per point"
    );
    assert!(parts > 0, "at least one part");
    let weight = |i: usize| points.weights.get(i).map_or(1, |&w| i128::from(w.max(1)));
    let key = |i: usize, axis: usize| key(points.numbers[i], points.positions[axis * n + i]);
    let last = match cuts {
        Cuts::Anywhere => 0,
        Cuts::Planes => COORDINATE,
    };
    let mut group = vec![0u32; n];
    let mut groups = vec![Group {
        first: 0,
        parts: parts as u32,
    }];
    let mut levels = Vec::new();
    while groups.iter().any(|one| one.parts > 1) {
        let axes = longest_sides(comm, points, (&group, groups.len()), cuts);
        let mut whole = vec![0; groups.len()];
        (0..n).for_each(|i| whole[group[i] as usize] += weight(i));
        comm.sum(&mut whole);
        let start = |(&axis, &whole)| Search {
            axis,
            key: 0,
            before: 0,
            whole,
            weight: whole,
        };
        let mut searches: Vec<Search> = axes.iter().zip(&whole).map(start).collect();
        let mut shift = u128::BITS;
        while shift > last {
            let known = shift;
            shift -= DIGIT;
            let mut bins = vec![0i128; groups.len() * BINS];
            for i in 0..n {
                let g = group[i] as usize;
                let key = key(i, searches[g].axis);
                if groups[g].parts > 1 && agree(key, searches[g].key, known) {
                    let digit = (key >> shift) as usize & (BINS - 1);
                    bins[g * BINS + digit] += weight(i);
                }
            }
            comm.sum(&mut bins);
            for ((search, group), bins) in searches.iter_mut().zip(&groups).zip(bins.chunks(BINS)) {
                search.refine(group, bins, shift);
            }
        }
        let mut next = Vec::with_capacity(2 * groups.len());
        let mut lower = Vec::with_capacity(groups.len());
        for one in &groups {
            lower.push(next.len() as u32);
            let left = one.parts / 2;
            if left > 0 {
                next.push(Group {
                    first: one.first,
                    parts: left,
                });
            }
            next.push(Group {
                first: one.first + left,
                parts: one.parts - left,
            });
        }
        let level = Level {
            groups: std::mem::replace(&mut groups, next),
            searches,
            lower,
        };
        for (i, own) in group.iter_mut().enumerate() {
            let g = *own as usize;
            *own = level.next(g, key(i, level.searches[g].axis), last);
        }
        levels.push(level);
    }
    Bisection {
        levels,
        parts: groups.iter().map(|one| one.first).collect(),
        last,
    }
}

/// Returns whether two keys have the same bits from `shift` on.
fn agree(a: u128, b: u128, shift: u32) -> bool {
    (a ^ b).checked_shr(shift).unwrap_or(0) == 0
}

/// Returns the axis of the longest side of the box of each group.
fn longest_sides(
    comm: &dyn Comm,
    points: &Points<'_>,
    (group, groups): (&[u32], usize),
    cuts: Cuts,
) -> Vec<usize> {
    let (n, dimension) = (group.len(), points.dimension);
    // Largest coordinates and largest opposites of coordinates.
    let mut ends = vec![f64::NEG_INFINITY; 2 * dimension * groups];
    for (c, axis) in points.positions.chunks(n.max(1)).enumerate() {
        for (&x, &g) in axis.iter().zip(group) {
            let place = 2 * (g as usize * dimension + c);
            ends[place] = ends[place].max(x);
            ends[place + 1] = ends[place + 1].max(-x);
        }
    }
    comm.max(&mut ends);
    let longest = |ends: &[f64]| {
        let side = |c: usize| ends[2 * c] + ends[2 * c + 1];
        (1..dimension).fold(0, |best, c| {
            let is_longer = match cuts {
                Cuts::Anywhere => side(c) > side(best),
                Cuts::Planes => side(c) >= side(best),
            };
            if is_longer { c } else { best }
        })
    };
    ends.chunks(2 * dimension).map(longest).collect()
}

impl Search {
    /// Selects the bin that contains the target.
    fn refine(&mut self, group: &Group, bins: &[i128], shift: u32) {
        let (parts, left) = (i128::from(group.parts), i128::from(group.parts / 2));
        for (digit, &weight) in bins.iter().enumerate() {
            if (self.before + weight) * parts > self.whole * left {
                self.key |= (digit as u128) << shift;
                self.weight = weight;
                return;
            }
            self.before += weight;
        }
    }

    /// Returns whether an item belongs to the lower side, by its key and the bits of the key of the cut from `last` on.
    fn is_below(&self, group: &Group, key: u128, last: u32) -> bool {
        let (parts, left) = (i128::from(group.parts), i128::from(group.parts / 2));
        let cut = self.key >> last;
        let middle = 2 * self.before + self.weight;
        key < cut || key == cut && middle * parts < 2 * self.whole * left
    }
}
