//! Proportional loading.

/// Proportional loading: all loads are multiples of their values at a reference time, whatever the time is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProportionalLoading {
    /// The reference time, s.
    pub reference: f64,
    /// Factors at the start and the end of the step that enters the energy balance next. Forces are evaluated with
    /// the second one.
    pub factors: [f64; 2],
}

crate::saved! {
    impl Entry<Number = f64> for ProportionalLoading { reference, factors }
}

impl ProportionalLoading {
    /// Returns the time and the factor for loads at time t.
    pub(crate) fn of(loading: Option<Self>, t: f64) -> (f64, f64) {
        loading.map_or((t, 1.0), |loading| (loading.reference, loading.factors[1]))
    }
}
