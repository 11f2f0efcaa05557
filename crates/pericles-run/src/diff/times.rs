//! Matching of the states or rows of two results by time.

/// Times closer than this fraction of the shortest output interval are equal. The tolerance covers rounding, for
/// example between a time step that is given and one that is computed.
const TOLERANCE: f64 = 1e-3;

/// Indices of two lists of times.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Matches {
    /// One index of each list.
    pub(super) pairs: Vec<(usize, usize)>,
    /// Indices of the first list without a match in the second, and vice versa.
    pub(super) alone: [Vec<usize>; 2],
}

/// Matches two lists of increasing times.
pub(super) fn matched(a: &[f64], b: &[f64]) -> Matches {
    let near = TOLERANCE * shortest_interval(a).min(shortest_interval(b));
    let mut matches = Matches::default();
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        // Single times have no interval: the tolerance is the rounding of the time itself.
        let near = if near.is_finite() {
            near
        } else {
            1e-9 * a[i].abs().max(b[j].abs())
        };
        if (a[i] - b[j]).abs() <= near {
            matches.pairs.push((i, j));
            i += 1;
            j += 1;
        } else if a[i] < b[j] {
            matches.alone[0].push(i);
            i += 1;
        } else {
            matches.alone[1].push(j);
            j += 1;
        }
    }
    matches.alone[0].extend(i..a.len());
    matches.alone[1].extend(j..b.len());
    matches
}

/// Returns the shortest nonzero interval between successive times, or infinity if there is none.
fn shortest_interval(times: &[f64]) -> f64 {
    let intervals = times.windows(2).map(|pair| pair[1] - pair[0]);
    intervals
        .filter(|interval| *interval > 0.0)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_that_differ_by_rounding_match() {
        // The next number above 70 µs.
        let next = f64::from_bits(70e-6_f64.to_bits() + 1);
        let matches = matched(&[0.0, 35e-6, 70e-6], &[0.0, 35e-6, next]);
        assert_eq!(matches.pairs, [(0, 0), (1, 1), (2, 2)]);
        assert!(matches.alone.iter().all(Vec::is_empty));
        assert_eq!(matched(&[70e-6], &[next]).pairs, [(0, 0)]);
    }

    #[test]
    fn unmatched_times_are_listed_and_the_others_are_paired() {
        let matches = matched(&[0.0, 1.0, 2.0, 3.0], &[0.0, 2.0, 4.0]);
        assert_eq!(matches.pairs, [(0, 0), (2, 1)]);
        assert_eq!(matches.alone, [vec![1, 3], vec![2]]);
        assert_eq!(matched(&[], &[1.0]).alone[1], [0]);
    }
}
