//! Loadings of a homogeneous body.

use super::fan::{Tensor, normalised};
use super::path::Loading;
use crate::vector::cross;

/// Returns a ⊗ b.
fn product(a: [f64; 3], b: [f64; 3]) -> Tensor {
    a.map(|x| b.map(|y| x * y))
}

/// Returns a + f b.
fn sum(a: Tensor, factor: f64, b: Tensor) -> Tensor {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + factor * b[i][j]))
}

/// Returns e ⊗ e for an axis.
fn axis(c: usize) -> Tensor {
    let unit = std::array::from_fn(|k| if k == c { 1.0 } else { 0.0 });
    product(unit, unit)
}

/// Returns the sum of e ⊗ e over the axes from `first` on.
fn axes(first: usize, dimension: usize) -> Tensor {
    (first..dimension).fold([[0.0; 3]; 3], |all, c| sum(all, 1.0, axis(c)))
}

/// Returns tension along a direction; all other stresses vanish.
pub(super) fn uniaxial(along: [f64; 3], dimension: usize) -> Loading {
    let a = normalised(along);
    // The direction across it in the plane, or across it and the axis that is farthest from it.
    let b = match dimension {
        2 => [-a[1], a[0], 0.0],
        _ => {
            let least = (0..3).fold(0, |c, k| if a[k].abs() < a[c].abs() { k } else { c });
            let other: [f64; 3] = std::array::from_fn(|k| if k == least { 1.0 } else { 0.0 });
            normalised(cross(a, other))
        }
    };
    let c = cross(a, b);
    let shear = |a, b| sum(product(a, b), 1.0, product(b, a));
    let free = match dimension {
        1 => Vec::new(),
        2 => vec![product(b, b), shear(a, b)],
        _ => vec![
            product(b, b),
            product(c, c),
            shear(a, b),
            shear(a, c),
            shear(b, c),
        ],
    };
    Loading {
        driven: product(a, a),
        free,
    }
}

/// Returns tension along the first axis of an isotropic body; the strains across it are equal.
pub(super) fn axial(dimension: usize) -> Loading {
    let across = (dimension > 1).then(|| axes(1, dimension));
    Loading {
        driven: axis(0),
        free: across.into_iter().collect(),
    }
}

/// Returns equal tensions along the last two axes.
pub(super) fn equibiaxial(dimension: usize) -> Loading {
    match dimension {
        2 => dilation(2),
        _ => Loading {
            driven: axes(1, 3),
            free: vec![axis(0)],
        },
    }
}

/// Returns a dilation.
pub(super) fn dilation(dimension: usize) -> Loading {
    Loading {
        driven: axes(0, dimension),
        free: Vec::new(),
    }
}

/// Returns pure shear: principal stresses of equal magnitude and opposite sign along the first two axes.
pub(super) fn shear(dimension: usize) -> Loading {
    let mut free = vec![axes(0, 2)];
    if dimension > 2 {
        free.push(axis(2));
    }
    Loading {
        driven: sum(axis(0), -1.0, axis(1)),
        free,
    }
}
