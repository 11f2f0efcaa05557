//! The wanted points of a range.

use std::ops::Range;

use pericles::operator::On;

/// What a range and a set of points have in common.
fn common<'a>(set: &'a [u32], range: &Range<usize>) -> &'a [u32] {
    let from = set.partition_point(|&i| (i as usize) < range.start);
    let to = set.partition_point(|&i| (i as usize) < range.end);
    &set[from..to]
}

fn overlap(wanted: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let start = wanted.start.max(range.start);
    start..wanted.end.min(range.end).max(start)
}

/// How many points of a range are wanted.
pub(super) fn count_wanted(on: &On<'_>, range: Range<usize>) -> usize {
    match on {
        On::All => range.len(),
        On::Range(wanted) => overlap(wanted, &range).len(),
        On::Set(set) => common(set, &range).len(),
    }
}

/// Visits the wanted points of a range as ranges, ascending.
pub(super) fn for_each_wanted(
    on: &On<'_>,
    range: Range<usize>,
    mut visit: impl FnMut(Range<usize>),
) {
    match on {
        On::All => visit(range),
        On::Range(wanted) => visit(overlap(wanted, &range)),
        On::Set(set) => {
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
    fn subsets() {
        let visited = |on: On<'_>, range: Range<usize>| {
            let mut seen = vec![];
            for_each_wanted(&on, range.clone(), |points| seen.extend(points));
            assert_eq!(seen.len(), count_wanted(&on, range));
            seen
        };
        assert_eq!(visited(On::All, 2..4), [2, 3]);
        assert_eq!(visited(On::Range(0..3), 2..4), [2]);
        assert_eq!(visited(On::Range(5..9), 2..4), [0usize; 0]);
        assert_eq!(visited(On::Set(&[1, 3, 7]), 2..8), [3, 7]);
    }
}
