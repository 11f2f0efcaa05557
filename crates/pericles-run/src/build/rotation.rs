//! Rotations of pieces and impactors.

use pericles_deck::Rotation;

/// A matrix by rows.
pub(super) type Matrix = [[f64; 3]; 3];

pub(super) const UNIT: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Returns a rotation that maps the z axis to a direction.
pub(super) fn upright(direction: [f64; 3]) -> Matrix {
    let length = direction.iter().map(|a| a * a).sum::<f64>().sqrt();
    let [x, y, z] = direction.map(|entry| entry / length);
    let across = x.hypot(y);
    if across == 0.0 {
        // About x, by half a turn for −z.
        return [[1.0, 0.0, 0.0], [0.0, z, 0.0], [0.0, 0.0, z]];
    }
    Rotation {
        angle: across.atan2(z),
        axis: [-y, x, 0.0],
        centre: None,
    }
    .matrix()
}

/// Returns the product of a matrix and a vector.
pub(super) fn times(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Returns the product of two matrices.
pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| a[r][k] * b[k][c]).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_anticlockwise_and_keep_lengths() {
        let quarter = Rotation {
            angle: std::f64::consts::FRAC_PI_2,
            axis: [0.0, 0.0, 2.0],
            centre: None,
        };
        let turned = times(&quarter.matrix(), [1.0, 0.0, 3.0]);
        let expected = [0.0, 1.0, 3.0];
        assert!((0..3).all(|c| (turned[c] - expected[c]).abs() < 1e-15));
        for direction in [
            [1.0, 2.0, -2.0],
            [0.0, 0.0, -3.0],
            [0.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0],
        ] {
            let rotation = upright(direction);
            let mapped = times(&rotation, [0.0, 0.0, 1.0]);
            let length = direction.iter().map(|a| a * a).sum::<f64>().sqrt();
            for c in 0..3 {
                assert!((mapped[c] - direction[c] / length).abs() < 1e-15);
            }
            // Orthogonal and right-handed.
            let square = product(
                &rotation,
                &std::array::from_fn(|r| rotation.map(|row| row[r])),
            );
            for r in 0..3 {
                for c in 0..3 {
                    assert!((square[r][c] - UNIT[r][c]).abs() < 1e-15);
                }
            }
            let [a, b, c] = rotation;
            let det = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            assert!((det - 1.0).abs() < 1e-15);
        }
    }
}
