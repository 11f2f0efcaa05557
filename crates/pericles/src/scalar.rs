//! Scalars on points.

/// A number per point, stored once if it is the same for all points.
#[derive(Debug, Clone, PartialEq)]
pub enum PointScalar {
    /// The same number for all points.
    Uniform(f64),
    /// One number per point.
    PerPoint(Vec<f64>),
}

impl PointScalar {
    /// Returns the number of point i.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::PerPoint(values) => values[i],
        }
    }
}
