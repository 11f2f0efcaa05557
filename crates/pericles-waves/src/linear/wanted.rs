//! Requested points of a range.

use std::ops::Range;

use pericles::operator::PointSubset;

/// Intersection of a range with a set of points.
fn common<'a>(set: &'a [u32], range: &Range<usize>) -> &'a [u32] {
    let from = set.partition_point(|&i| (i as usize) < range.start);
    let to = set.partition_point(|&i| (i as usize) < range.end);
    &set[from..to]
}

fn overlap(wanted: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let start = wanted.start.max(range.start);
    start..wanted.end.min(range.end).max(start)
}

/// Number of requested points in a range.
pub(super) fn count_wanted(on: &PointSubset<'_>, range: Range<usize>) -> usize {
    match on {
        PointSubset::All => range.len(),
        PointSubset::Range(wanted) => overlap(wanted, &range).len(),
        PointSubset::Set(set) => common(set, &range).len(),
    }
}

/// Visits the requested points of a range as ascending sub-ranges.
pub(super) fn for_each_wanted(
    on: &PointSubset<'_>,
    range: Range<usize>,
    mut visit: impl FnMut(Range<usize>),
) {
    match on {
        PointSubset::All => visit(range),
        PointSubset::Range(wanted) => visit(overlap(wanted, &range)),
        PointSubset::Set(set) => {
            for &i in common(set, &range) {
                visit(i as usize..i as usize + 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requested_points_of_ranges_and_sets_are_visited() {
        let visited = |on: PointSubset<'_>, range: Range<usize>| {
            let mut seen = vec![];
            for_each_wanted(&on, range.clone(), |points| seen.extend(points));
            assert_eq!(seen.len(), count_wanted(&on, range));
            seen
        };
        assert_eq!(visited(PointSubset::All, 2..4), [2, 3]);
        assert_eq!(visited(PointSubset::Range(0..3), 2..4), [2]);
        assert_eq!(visited(PointSubset::Range(5..9), 2..4), [0usize; 0]);
        assert_eq!(visited(PointSubset::Set(&[1, 3, 7]), 2..8), [3, 7]);
    }
}
