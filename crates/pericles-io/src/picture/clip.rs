//! Clipping of lines to a rectangle, in pixels: curves may exceed the chart by more than the single precision
//! of the rasteriser resolves.

use super::frame::Area;

pub(super) fn inside((x, y): (f64, f64), area: Area) -> bool {
    x >= area.left - 0.5 && x <= area.right + 0.5 && y >= area.top - 0.5 && y <= area.bottom + 0.5
}

/// Returns the pieces of a line inside an area, without repeated points.
pub(super) fn clipped(line: &[(f64, f64)], area: Area) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    if let [only] = line {
        return if inside(*only, area) {
            vec![vec![*only]]
        } else {
            pieces
        };
    }
    for pair in line.windows(2) {
        let Some((from, to)) = clipped_segment(pair[0], pair[1], area) else {
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

/// Returns the part of a segment inside an area (Y.-D. Liang, B. Barsky, ACM Transactions on Graphics 3, 1984).
fn clipped_segment(a: (f64, f64), b: (f64, f64), area: Area) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (speed, room) in [
        (-dx, a.0 - area.left),
        (dx, area.right - a.0),
        (-dy, a.1 - area.top),
        (dy, area.bottom - a.1),
    ] {
        if speed == 0.0 && room < 0.0 {
            return None;
        }
        if speed < 0.0 {
            enter = enter.max(room / speed);
        } else if speed > 0.0 {
            leave = leave.min(room / speed);
        }
    }
    // end points inside are kept exactly, so that the next segment starts at the same point
    let at = |s: f64, end| {
        if s == 0.0 || s == 1.0 {
            end
        } else {
            (a.0 + s * dx, a.1 + s * dy)
        }
    };
    (enter <= leave).then(|| (at(enter, a), at(leave, b)))
}

/// Returns the length of a line inside an area; a single point counts as one.
pub(super) fn length_inside(line: &[(f64, f64)], area: Area) -> f64 {
    if let [only] = line {
        return if inside(*only, area) { 1.0 } else { 0.0 };
    }
    line.windows(2)
        .filter_map(|pair| clipped_segment(pair[0], pair[1], area))
        .map(|(a, b)| (b.0 - a.0).hypot(b.1 - a.1) + 1e-3)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Area = Area {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
    };

    #[test]
    fn lines_are_clipped_where_they_cross_the_border() {
        let zigzag = [
            (-5.0, 5.0),
            (5.0, 5.0),
            (5.0, 15.0),
            (8.0, 15.0),
            (8.0, 2.0),
        ];
        let expected = vec![
            vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)],
            vec![(8.0, 10.0), (8.0, 2.0)],
        ];
        assert_eq!(clipped(&zigzag, AREA), expected);
        assert_eq!(length_inside(&zigzag, AREA).round(), 18.0);
        assert!(clipped(&[(-1.0, 5.0), (-1.0, 9.0)], AREA).is_empty());
        // passes beside the corner
        assert!(clipped(&[(-5.0, 5.0), (5.0, -6.0)], AREA).is_empty());
        assert_eq!(clipped(&[(5.0, 5.0)], AREA), vec![vec![(5.0, 5.0)]]);
        assert!(clipped(&[], AREA).is_empty());
    }
}
