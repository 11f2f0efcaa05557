//! Vectors and matrices of lattices in up to three dimensions.

/// Vector of a lattice; components beyond its dimension are zero.
pub type Vector = [f64; 3];

/// Symmetric matrix; rows and columns beyond the dimension are zero.
pub type SquareMatrix = [[f64; 3]; 3];

/// Inner product.
#[inline]
pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Normalises a vector.
#[inline]
pub(super) fn unit(a: Vector) -> Vector {
    let norm = dot(a, a).sqrt();
    a.map(|x| x / norm)
}
