//! Vectors and matrices of three dimensions.

pub(crate) use pericles::vector::{cross, dot, minus, norm, plus, scaled};

/// A vector.
pub(crate) type V3 = [f64; 3];
/// A matrix by rows.
pub(crate) type M3 = [[f64; 3]; 3];

/// The unit matrix.
pub(crate) const UNIT: M3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// M a
#[inline]
pub(crate) fn times(m: &M3, a: V3) -> V3 {
    m.map(|row| dot(row, a))
}

/// Mᵀ a
#[inline]
pub(crate) fn transposed_times(m: &M3, a: V3) -> V3 {
    std::array::from_fn(|c| m[0][c] * a[0] + m[1][c] * a[1] + m[2][c] * a[2])
}

/// A B
pub(crate) fn product(a: &M3, b: &M3) -> M3 {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| a[r][k] * b[k][c]).sum()))
}

/// The rotation by an angle (radians) about a coordinate axis.
pub(crate) fn rotation_about(axis: usize, angle: f64) -> M3 {
    let (sin, cos) = angle.sin_cos();
    let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    let mut m = UNIT;
    m[b][b] = cos;
    m[c][c] = cos;
    m[b][c] = -sin;
    m[c][b] = sin;
    m
}
