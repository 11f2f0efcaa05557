//! Parallel loops over points whose results do not depend on the number of threads.
//!
//! Points are divided into fixed blocks; one thread computes each block from start to end. Sums are in
//! [`sum`](crate::sum).
//!
//! Loops take a reference to a closure that computes a whole block, so that the code which distributes blocks is
//! compiled once and not for every loop.
//!
//! Handing work to another thread takes about as long as a thousand bonds. Each loop therefore states its [`Cost`]: short
//! loops run on the calling thread, and long ones are divided into tasks that are long enough. A thread outside of the
//! pool waits about 50 µs for each divided loop; programs make their main thread a part of the pool
//! (`rayon::ThreadPoolBuilder::use_current_thread`).

use std::ops::Range;

use rayon::prelude::*;

/// The subset of the points on which an evaluation is requested. The result at a point does not depend on the
/// subset, bit for bit.
#[derive(Debug, Clone)]
pub enum PointSubset<'a> {
    /// All points.
    All,
    /// A range of points.
    Range(Range<usize>),
    /// Point numbers in ascending order.
    Set(&'a [u32]),
}

impl PointSubset<'_> {
    /// Number of points in the subset, for a body of `points` points.
    pub fn count(&self, points: usize) -> usize {
        match self {
            Self::All => points,
            Self::Range(range) => range.len(),
            Self::Set(set) => set.len(),
        }
    }

    /// Calls `visit(point)` for every point of the subset in ascending order, for a body of `points` points.
    pub fn for_each(&self, points: usize, visit: impl FnMut(usize)) {
        match self {
            Self::All => (0..points).for_each(visit),
            Self::Range(range) => range.clone().for_each(visit),
            Self::Set(set) => set.iter().map(|&i| i as usize).for_each(visit),
        }
    }

    /// Calls `visit(index in the list, point)` for every point of the subset that is in an ascending list.
    pub fn common(&self, list: &[u32], mut visit: impl FnMut(usize, usize)) {
        match self {
            Self::All => {
                for (k, &i) in list.iter().enumerate() {
                    visit(k, i as usize);
                }
            }
            Self::Range(range) => {
                let from = list.partition_point(|&i| (i as usize) < range.start);
                let to = list.partition_point(|&i| (i as usize) < range.end);
                for (k, &i) in list.iter().enumerate().take(to).skip(from) {
                    visit(k, i as usize);
                }
            }
            // Iterates over the shorter of the two.
            Self::Set(set) if set.len() < list.len() => {
                for &i in *set {
                    if let Ok(k) = list.binary_search(&i) {
                        visit(k, i as usize);
                    }
                }
            }
            Self::Set(set) => {
                for (k, &i) in list.iter().enumerate() {
                    if set.binary_search(&i).is_ok() {
                        visit(k, i as usize);
                    }
                }
            }
        }
    }
}

/// Work on a part of the points; the arguments are the index of the part or its first point, one slice per
/// component, and the state of the part.
pub type PartWork<'a, const D: usize, S> = dyn Fn(usize, [&mut [f64]; D], &mut S) + Sync + 'a;

/// Number of points in a block.
pub const BLOCK: usize = 512;

/// Estimated duration of a loop on one thread. It determines the number of tasks of the loop; results do not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Cost {
    nanoseconds: f64,
}

impl Cost {
    /// Duration of the shortest task, ns: about ten times the time in which another thread takes a task.
    const TASK: f64 = 4000.0;

    /// A loop with a few operations for each of `count` entries of an array.
    pub const fn entries(count: usize) -> Self {
        Self {
            nanoseconds: 0.5 * count as f64,
        }
    }

    /// A loop over `count` directed bonds.
    pub const fn bonds(count: u64) -> Self {
        Self {
            nanoseconds: count as f64,
        }
    }

    /// The part of the loop over all of `points` points that belongs to a subset.
    pub fn on(self, subset: &PointSubset<'_>, points: usize) -> Self {
        let share = subset.count(points) as f64 / points.max(1) as f64;
        Self {
            nanoseconds: share * self.nanoseconds,
        }
    }

    /// Returns the number of parts of each task, for a loop over `parts` parts; all parts if the loop is not divided.
    pub fn parts_per_task(self, parts: usize) -> usize {
        let tasks = (self.nanoseconds / Self::TASK) as usize;
        if tasks < 2 {
            parts.max(1)
        } else {
            parts.div_ceil(tasks)
        }
    }
}

/// Calls `work(first point, one slice per component, state of the block)` for every block in parallel, without
/// allocation.
pub fn for_each_block<const D: usize, S: Send>(
    out: [&mut [f64]; D],
    states: &mut [S],
    cost: Cost,
    work: &PartWork<'_, D, S>,
) {
    let first = |block| block * BLOCK;
    for_each_part(out, states, cost, &first, &|block, out, state| {
        work(block * BLOCK, out, state);
    });
}

/// Calls `work(part, one slice per component, state of the part)` for every part in parallel, without allocation.
/// Part k contains the points from `first(k)` to `first(k + 1)`, the last part all remaining points; `first(0)` is
/// 0.
pub fn for_each_part<const D: usize, S: Send>(
    out: [&mut [f64]; D],
    states: &mut [S],
    cost: Cost,
    first: &(dyn Fn(usize) -> usize + Sync),
    work: &PartWork<'_, D, S>,
) {
    let parts_per_task = cost.parts_per_task(states.len());
    let division = Division {
        parts_per_task,
        first,
        work,
    };
    division.run(0, out, states);
}

/// Division of a loop over parts into tasks.
struct Division<'a, const D: usize, S> {
    parts_per_task: usize,
    first: &'a (dyn Fn(usize) -> usize + Sync),
    work: &'a PartWork<'a, D, S>,
}

impl<const D: usize, S: Send> Division<'_, D, S> {
    /// Computes the parts from `part` on, one for each state.
    fn run(&self, part: usize, mut out: [&mut [f64]; D], states: &mut [S]) {
        if states.len() > self.parts_per_task {
            let middle = states.len() / 2;
            let (low, high) = cut(out, (self.first)(part + middle) - (self.first)(part));
            let (low_states, high_states) = states.split_at_mut(middle);
            join(
                || self.run(part, low, low_states),
                || self.run(part + middle, high, high_states),
            );
            return;
        }
        let parts = states.len();
        for (k, state) in states.iter_mut().enumerate() {
            if k + 1 == parts {
                return (self.work)(part + k, out, state);
            }
            let (own, rest) = cut(out, (self.first)(part + k + 1) - (self.first)(part + k));
            (self.work)(part + k, own, state);
            out = rest;
        }
    }
}

/// Calls two functions, in parallel if another thread is free.
///
/// Unlike `rayon::join`, which it calls, its code is compiled once and not for every pair of functions.
pub fn join(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    fn both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        rayon::join(a, b);
    }
    let (mut a, mut b) = (Some(a), Some(b));
    both(&mut || a.take().into_iter().for_each(|a| a()), &mut || {
        b.take().into_iter().for_each(|b| b())
    });
}

/// Cuts all components after a number of points.
fn cut<const D: usize>(out: [&mut [f64]; D], points: usize) -> ([&mut [f64]; D], [&mut [f64]; D]) {
    let mut high: [&mut [f64]; D] = std::array::from_fn(|_| Default::default());
    let mut component = 0;
    let low = out.map(|slice| {
        let (low, rest) = slice.split_at_mut(points);
        high[component] = rest;
        component += 1;
        low
    });
    (low, high)
}

/// Calls `work(first entry, entries)` for every block of entries in parallel; the work on an entry takes a few
/// operations.
pub fn for_each_chunk<T: Send>(entries: &mut [T], work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let cost = Cost::entries(entries.len());
    for_each_chunk_of(entries, cost, work);
}

/// Calls `work(first entry, entries)` for every block of entries in parallel, for a loop of the given cost.
pub fn for_each_chunk_of<T: Send>(
    entries: &mut [T],
    cost: Cost,
    work: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    fn divide<T: Send>(
        first: usize,
        entries: &mut [T],
        length: usize,
        work: &(dyn Fn(usize, &mut [T]) + Sync),
    ) {
        if entries.len() > length {
            let blocks = entries.len().div_ceil(BLOCK);
            let middle = (blocks / 2) * BLOCK;
            let (low, high) = entries.split_at_mut(middle);
            join(
                || divide(first, low, length, work),
                || divide(first + middle, high, length, work),
            );
        } else {
            for (block, chunk) in entries.chunks_mut(BLOCK).enumerate() {
                work(first + block * BLOCK, chunk);
            }
        }
    }
    let blocks = entries.len().div_ceil(BLOCK);
    divide(0, entries, cost.parts_per_task(blocks) * BLOCK, work);
}

/// Evaluates a function at all points in parallel.
pub fn for_each_point<T: Send>(points: usize, value: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    (0..points)
        .into_par_iter()
        .with_min_len(BLOCK / 2)
        .map(value)
        .collect()
}

/// Calls `set(point, entry)` in parallel for the entries of a component-major array that belong to the points of
/// `on`.
pub(crate) fn for_each_entry(
    on: &PointSubset<'_>,
    n: usize,
    out: &mut [f64],
    set: &(impl Fn(usize, &mut f64) + Sync),
) {
    for component in out.chunks_mut(n.max(1)) {
        match on {
            PointSubset::All => in_range(0, component, set),
            PointSubset::Range(range) => in_range(range.start, &mut component[range.clone()], set),
            PointSubset::Set(points) => in_set(0, component, points, &|first, entries| {
                for (k, entry) in entries.iter_mut().enumerate() {
                    set(first + k, entry);
                }
            }),
        }
    }
}

fn in_range(first: usize, entries: &mut [f64], set: &(impl Fn(usize, &mut f64) + Sync)) {
    for_each_chunk(entries, &|start, chunk| {
        for (k, entry) in chunk.iter_mut().enumerate() {
            set(first + start + k, entry);
        }
    });
}

/// Calls `work(first point, entries)` for every run of consecutive points.
fn in_set(
    first: usize,
    entries: &mut [f64],
    points: &[u32],
    work: &(dyn Fn(usize, &mut [f64]) + Sync),
) {
    if Cost::entries(points.len()).parts_per_task(2) == 2 {
        for run in runs(points) {
            work(run.start, &mut entries[run.start - first..run.end - first]);
        }
        return;
    }
    let (low_points, high_points) = points.split_at(points.len() / 2);
    let middle = high_points[0] as usize;
    let (low, high) = entries.split_at_mut(middle - first);
    join(
        || in_set(first, low, low_points, work),
        || in_set(middle, high, high_points, work),
    );
}

/// Returns the runs of consecutive numbers in an ascending list.
pub(crate) fn runs(points: &[u32]) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut rest = points;
    std::iter::from_fn(move || {
        let first = *rest.first()? as usize;
        let length = run_length(rest);
        rest = &rest[length..];
        Some(first..first + length)
    })
}

/// Returns the length of the first run, by doubling and bisection: most lists consist of few long runs.
fn run_length(points: &[u32]) -> usize {
    let is_run = |length: usize| (points[length - 1] - points[0]) as usize == length - 1;
    let (mut low, mut step) = (1, 1);
    while low + step <= points.len() && is_run(low + step) {
        low += step;
        step *= 2;
    }
    let mut high = (low + step).min(points.len() + 1);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if is_run(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Splits a component-major array into its components.
pub fn components_mut<const D: usize>(array: &mut [f64], n: usize) -> [&mut [f64]; D] {
    let mut rest = array;
    std::array::from_fn(|_| {
        let (component, tail) = std::mem::take(&mut rest).split_at_mut(n);
        rest = tail;
        component
    })
}

/// Splits a component-major array into its components.
pub fn components<const D: usize>(array: &[f64], n: usize) -> [&[f64]; D] {
    std::array::from_fn(|c| &array[c * n..(c + 1) * n])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_visited_exactly_once_at_any_cost() {
        let n = 5 * BLOCK + 17;
        for cost in [Cost::entries(0), Cost::bonds(12_000), Cost::bonds(u64::MAX)] {
            let mut out = vec![0.0; 2 * n];
            let mut states = vec![0usize; n.div_ceil(BLOCK)];
            let [x, y] = components_mut::<2>(&mut out, n);
            for_each_block([x, y], &mut states, cost, &|first, [x, y], state| {
                *state = x.len();
                for k in 0..x.len() {
                    x[k] += (first + k) as f64;
                    y[k] += 1.0;
                }
            });
            for_each_chunk_of(&mut out, cost, &|first, chunk| {
                chunk
                    .iter_mut()
                    .zip(first..)
                    .for_each(|(x, k)| *x += k as f64);
            });
            for i in 0..n {
                assert_eq!((out[i], out[n + i]), (2.0 * i as f64, 1.0 + (n + i) as f64));
            }
            assert_eq!(states.iter().sum::<usize>(), n);
        }
    }

    #[test]
    fn loops_are_divided_into_tasks_that_are_long_enough() {
        let all = Cost::bonds(100_000);
        assert_eq!(Cost::bonds(7_000).parts_per_task(10), 10);
        assert_eq!(all.parts_per_task(100), 4);
        assert_eq!(all.parts_per_task(10), 1);
        // A fifth of the points has a fifth of the bonds.
        let fifth = all.on(&PointSubset::Range(0..20), 100);
        assert_eq!(fifth, Cost::bonds(20_000));
        assert_eq!(fifth.parts_per_task(100), 20);
    }

    #[test]
    fn runs_are_maximal() {
        for skipped in [&[][..], &[0, 1, 5, 6, 7, 40, 99], &[50], &[1, 3, 5, 7, 9]] {
            let points: Vec<u32> = (0..100).filter(|i| !skipped.contains(i)).collect();
            let found: Vec<Range<usize>> = runs(&points).collect();
            let all: Vec<u32> = found
                .iter()
                .flat_map(|r| r.start as u32..r.end as u32)
                .collect();
            assert_eq!(all, points);
            assert!(found.windows(2).all(|pair| pair[0].end < pair[1].start));
        }
        assert_eq!(runs(&[]).count(), 0);
    }
}
