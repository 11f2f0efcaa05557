//! Measures at a crack front: arms, their distance and direction, speeds.

/// Splits ascending numbers into groups wherever two neighbours are more than `gap` apart; returns the first and
/// last of each group.
pub(super) fn groups(ascending: &[f64], gap: f64) -> Vec<(f64, f64)> {
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for &x in ascending {
        match groups.last_mut() {
            Some(last) if x - last.1 <= gap => last.1 = x,
            _ => groups.push((x, x)),
        }
    }
    groups
}

/// Largest distance between two neighbouring numbers, which are sorted; zero for fewer than two.
pub(super) fn widest_gap(numbers: &mut [f64]) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(0.0, f64::max)
}

/// Directions (degrees, 0 … 360) in which the points of a crack leave a circle around the origin. Points at most
/// `width` inside the circle are grouped by direction, with more than `gap` (a length along the circle) between
/// groups; each group gives the direction of its outermost point.
pub(super) fn arms(points: &[[f64; 2]], radius: f64, width: f64, gap: f64) -> Vec<f64> {
    let mut rim: Vec<(f64, f64)> = points
        .iter()
        .map(|[x, y]| (y.atan2(*x).to_degrees().rem_euclid(360.0), x.hypot(*y)))
        .filter(|(_, distance)| (radius - width..=radius).contains(distance))
        .collect();
    rim.sort_by(|a, b| a.0.total_cmp(&b.0));
    let gap = (gap / radius).to_degrees();
    // Cuts the circle within a gap, so that no group extends across 360°.
    let turns = |k: usize| {
        let before = rim[(k + rim.len() - 1) % rim.len()].0;
        (rim[k].0 - before).rem_euclid(360.0)
    };
    let Some(cut) = (0..rim.len()).find(|&k| rim.len() == 1 || turns(k) > gap) else {
        // No points, or a full circle without a gap.
        return Vec::new();
    };
    rim.rotate_left(cut);
    let origin = rim[0].0;
    for point in &mut rim {
        point.0 = (point.0 - origin).rem_euclid(360.0);
    }
    let angles: Vec<f64> = rim.iter().map(|point| point.0).collect();
    let mut arms: Vec<f64> = groups(&angles, gap)
        .into_iter()
        .filter_map(|(first, last)| {
            rim.iter()
                .filter(|point| (first..=last).contains(&point.0))
                .max_by(|a, b| a.1.total_cmp(&b.1))
        })
        .map(|outermost| (outermost.0 + origin).rem_euclid(360.0))
        .collect();
    arms.sort_by(f64::total_cmp);
    arms
}

/// Slope of the least-squares line through points (t, x); `None` for fewer than two times.
pub(super) fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64| points.iter().map(pick).sum::<f64>() / n;
    let (t0, x0) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = points.iter().map(|p| (p.0 - t0).powi(2)).sum();
    let common: f64 = points.iter().map(|p| (p.0 - t0) * (p.1 - x0)).sum();
    (spread > 0.0).then(|| common / spread)
}

/// Slope in a window of this length around each point; `(middle of the window, slope)`.
pub(crate) fn slopes(points: &[(f64, f64)], window: f64) -> Vec<(f64, f64)> {
    let tolerance = 1e-6 * window;
    let mut slopes = Vec::new();
    for (first, start) in points.iter().enumerate() {
        let end = start.0 + window;
        let reaches = points.last().is_some_and(|last| last.0 >= end - tolerance);
        let inside = points[first..]
            .iter()
            .take_while(|p| p.0 <= end + tolerance)
            .count();
        if let (true, Some(slope)) = (reaches, slope(&points[first..first + inside])) {
            slopes.push((start.0 + 0.5 * window, slope));
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorted_numbers_are_grouped_by_gaps() {
        assert_eq!(
            groups(&[1.0, 1.5, 2.0, 4.0, 4.5, 9.0], 0.6),
            [(1.0, 2.0), (4.0, 4.5), (9.0, 9.0)]
        );
        assert_eq!(groups(&[], 1.0), []);
        assert_eq!(widest_gap(&mut [5.0, 1.0, 2.0]), 3.0);
        assert_eq!(widest_gap(&mut [5.0]), 0.0);
    }

    /// Points along rays from the origin, with stray points as they occur beside a crack.
    fn star(degrees: &[f64], reach: f64) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for angle in degrees {
            let (sine, cosine) = angle.to_radians().sin_cos();
            for k in 0..((reach / 0.1).round() as u32 + 1) {
                let r = 0.1 * f64::from(k);
                points.push([r * cosine, r * sine]);
                points.push([r * cosine - 0.05 * sine, r * sine + 0.05 * cosine]);
            }
        }
        points
    }

    #[test]
    fn arms_of_a_star_are_found_at_their_angles() {
        let angles = [20.0, 70.0, 200.0, 250.0];
        let found = arms(&star(&angles, 12.0), 10.0, 0.25, 1.0);
        assert_eq!(found.len(), 4);
        for (found, angle) in found.iter().zip(angles) {
            assert!((found - angle).abs() < 0.5, "{found} {angle}");
        }
        assert!(arms(&star(&angles, 12.0), 15.0, 0.25, 1.0).is_empty());
        assert!(arms(&[], 1.0, 0.1, 0.1).is_empty());
    }

    #[test]
    fn arm_across_zero_degrees_is_one_arm() {
        let found = arms(&star(&[-0.1, 180.0], 12.0), 10.0, 0.25, 1.0);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(arms(&[[10.0, 0.0]], 10.0, 0.25, 1.0), [0.0]);
    }

    #[test]
    fn slopes_of_a_parabola_are_its_derivative_at_the_middle() {
        let points: Vec<(f64, f64)> = (0..41)
            .map(|k| 0.5 * f64::from(k))
            .map(|t| (t, 3.0 * t * t - t))
            .collect();
        let slopes = slopes(&points, 4.0);
        assert_eq!(slopes.len(), 33);
        for (t, slope) in slopes {
            assert!((slope - (6.0 * t - 1.0)).abs() < 1e-9, "{t} {slope}");
        }
        assert_eq!(slope(&[(1.0, 2.0)]), None);
        assert_eq!(slope(&[]), None);
    }
}
