//! Numbers of points.

/// A number per point, stored once where all are equal.
#[derive(Debug, Clone, PartialEq)]
pub enum PointScalar {
    /// The same everywhere.
    Uniform(f64),
    /// One number per point.
    PerPoint(Vec<f64>),
}

impl PointScalar {
    /// The number of point i.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::PerPoint(values) => values[i],
        }
    }
}
