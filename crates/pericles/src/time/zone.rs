//! Zones: point sets stored for fast parallel loops.

use std::ops::Range;

use crate::operator::PointSubset;
use crate::parallel::BLOCK;
use crate::space::PointSet;

/// Smallest number of points of a piece: enough work for a task.
const PIECE: usize = 8 * BLOCK;

/// A point set as runs of consecutive numbers, grouped into pieces of about equal size for parallel loops.
#[derive(Debug, Clone, Default)]
pub(super) struct Zone {
    points: PointSet,
    runs: Vec<Range<u32>>,
    /// First run of each piece, and at the end the number of runs.
    pieces: Vec<usize>,
    whole: bool,
}

impl Zone {
    /// Makes a zone of own points, in ascending order; `whole` if it has all points of the body, of all processes.
    pub(super) fn new(points: PointSet, whole: bool) -> Self {
        let mut runs: Vec<Range<u32>> = Vec::new();
        for &i in &points {
            match runs.last_mut() {
                Some(run) if run.end == i && run.len() < PIECE => run.end += 1,
                _ => runs.push(i..i + 1),
            }
        }
        let mut pieces = vec![0];
        let mut size = 0;
        for (k, run) in runs.iter().enumerate() {
            size += run.len();
            if size >= PIECE {
                pieces.push(k + 1);
                size = 0;
            }
        }
        if size > 0 {
            pieces.push(runs.len());
        }
        Self {
            whole,
            points,
            runs,
            pieces,
        }
    }

    /// The zone of all points, of which the process owns n.
    pub(super) fn all(n: usize) -> Self {
        Self::new((0..n as u32).collect(), true)
    }

    pub(super) fn points(&self) -> &[u32] {
        &self.points
    }

    /// Returns whether the process owns no point of the zone; other processes may.
    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the zone as a subset for force operators.
    pub(super) fn on(&self) -> PointSubset<'_> {
        if self.whole {
            PointSubset::All
        } else {
            PointSubset::Set(&self.points)
        }
    }

    /// Calls `work(entries, their range in the arrays)` in parallel for every run and component of a
    /// component-major array.
    pub(super) fn for_each_run(
        &self,
        n: usize,
        out: &mut [f64],
        work: &(dyn Fn(&mut [f64], Range<usize>) + Sync),
    ) {
        for (c, component) in out.chunks_mut(n.max(1)).enumerate() {
            let place = Place {
                first: 0,
                offset: c * n,
            };
            self.split(
                0,
                self.pieces.len().saturating_sub(1),
                place,
                component,
                work,
            );
        }
    }

    fn split(
        &self,
        from: usize,
        to: usize,
        place: Place,
        entries: &mut [f64],
        work: &(dyn Fn(&mut [f64], Range<usize>) + Sync),
    ) {
        if to - from > 1 {
            let middle = from.midpoint(to);
            let first = self.runs[self.pieces[middle]].start as usize;
            let (low, high) = entries.split_at_mut(first - place.first);
            let beyond = Place { first, ..place };
            crate::parallel::join(
                || self.split(from, middle, place, low, work),
                || self.split(middle, to, beyond, high, work),
            );
        } else if to > from {
            for run in &self.runs[self.pieces[from]..self.pieces[to]] {
                let (start, end) = (run.start as usize, run.end as usize);
                work(
                    &mut entries[start - place.first..end - place.first],
                    place.offset + start..place.offset + end,
                );
            }
        }
    }
}

/// Position of a slice: its first point, and the entry of point 0 of its component.
#[derive(Clone, Copy)]
struct Place {
    first: usize,
    offset: usize,
}

/// A linear combination base + Σ factor · array, entry by entry: the form of all stages, predictors and
/// interpolants.
pub(super) struct Sum<'a> {
    terms: [(f64, &'a [f64]); Sum::MOST],
    len: usize,
}

impl<'a> Sum<'a> {
    /// Largest number of terms: the stages of the largest tableau, and the velocity.
    const MOST: usize = 8;

    /// The empty sum.
    pub(super) fn new() -> Self {
        Self {
            terms: [(0.0, &[]); Self::MOST],
            len: 0,
        }
    }

    /// Adds a term; a term with factor zero is left out.
    pub(super) fn plus(mut self, factor: f64, array: &'a [f64]) -> Self {
        if factor != 0.0 {
            self.terms[self.len] = (factor, array);
            self.len += 1;
        }
        self
    }

    /// Adds a term for each factor.
    pub(super) fn plus_all(
        self,
        scale: f64,
        factors: &[f64],
        array: impl Fn(usize) -> &'a [f64],
    ) -> Self {
        factors
            .iter()
            .enumerate()
            .fold(self, |sum, (k, factor)| sum.plus(scale * factor, array(k)))
    }

    /// Computes out = base + sum on the points of a zone.
    pub(super) fn onto(&self, base: &[f64], zone: &Zone, n: usize, out: &mut [f64]) {
        zone.for_each_run(n, out, &|out, range| {
            out.copy_from_slice(&base[range.clone()]);
            self.add_run(out, range);
        });
    }

    /// Computes out = out + sum on the points of a zone.
    pub(super) fn add_to(&self, zone: &Zone, n: usize, out: &mut [f64]) {
        zone.for_each_run(n, out, &|out, range| self.add_run(out, range));
    }

    /// Terms are added from left to right for every number of terms, so that the choice of the loop does not change
    /// a bit.
    #[inline]
    fn add_run(&self, out: &mut [f64], range: Range<usize>) {
        let term = |k: usize| (self.terms[k].0, &self.terms[k].1[range.clone()]);
        match self.len {
            1 => {
                let (a, x) = term(0);
                for (out, x) in out.iter_mut().zip(x) {
                    *out += a * x;
                }
            }
            2 => {
                let ((a, x), (b, y)) = (term(0), term(1));
                for ((out, x), y) in out.iter_mut().zip(x).zip(y) {
                    *out = *out + a * x + b * y;
                }
            }
            3 => {
                let ((a, x), (b, y), (c, z)) = (term(0), term(1), term(2));
                for (((out, x), y), z) in out.iter_mut().zip(x).zip(y).zip(z) {
                    *out = *out + a * x + b * y + c * z;
                }
            }
            4 => {
                let ((a, x), (b, y), (c, z), (d, w)) = (term(0), term(1), term(2), term(3));
                for ((((out, x), y), z), w) in out.iter_mut().zip(x).zip(y).zip(z).zip(w) {
                    *out = *out + a * x + b * y + c * z + d * w;
                }
            }
            _ => {
                for k in 0..self.len {
                    let (a, x) = term(k);
                    for (out, x) in out.iter_mut().zip(x) {
                        *out += a * x;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_cover_a_zone_exactly_once() {
        let n = 5000;
        let points: PointSet = (0..n as u32)
            .filter(|i| i % 7 != 3 && !(2000..2600).contains(i))
            .collect();
        let zone = Zone::new(points.clone(), false);
        let mut seen = vec![0.0; 2 * n];
        zone.for_each_run(n, &mut seen, &|out, range| {
            for (out, entry) in out.iter_mut().zip(range) {
                *out += 1.0 + entry as f64;
            }
        });
        for entry in 0..2 * n {
            let inside = points.binary_search(&((entry % n) as u32)).is_ok();
            assert_eq!(seen[entry], if inside { 1.0 + entry as f64 } else { 0.0 });
        }
        assert!(matches!(Zone::all(7).on(), PointSubset::All));
        assert!(Zone::new(vec![], false).is_empty());
        Zone::new(vec![], false).for_each_run(7, &mut [0.0; 7], &|_, _| panic!("no run"));
    }

    #[test]
    fn sums_of_any_number_of_terms_add_from_left_to_right() {
        let arrays: Vec<Vec<f64>> = (0..6)
            .map(|k| (0..10).map(|i| ((i * i + k) as f64).sin()).collect())
            .collect();
        let zone = Zone::all(10);
        for terms in 0..6 {
            let factors: Vec<f64> = (0..terms).map(|k| 0.3 + k as f64).collect();
            let mut out = vec![0.0; 10];
            Sum::new()
                .plus_all(1.0, &factors, |k| &arrays[k][..])
                .onto(&arrays[5], &zone, 10, &mut out);
            for i in 0..10 {
                let mut expected = arrays[5][i];
                for k in 0..terms {
                    expected += factors[k] * arrays[k][i];
                }
                assert_eq!(out[i], expected);
            }
        }
    }
}
