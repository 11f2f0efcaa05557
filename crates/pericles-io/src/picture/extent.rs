//! Range of the values of a picture or a series of pictures.

/// Range of values for a colour bar.
///
/// Outliers do not determine the range: it ends at the percentiles 0.1 and 99.9 if the full range is more than 1.5 times as wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    low: f64,
    high: f64,
    /// Largest magnitude of the quantity that the values are a part of, such as the norm of the vector of a component.
    size: f64,
}

/// Fewer values have no outliers.
const FEW: usize = 1000;
/// Share of the values beyond each end that may be outliers.
const OUTLIERS: f64 = 1e-3;
/// Outliers must widen the range by this factor to be excluded.
const WIDER: f64 = 1.5;
/// Values below this share of the quantity are round-off.
const ROUND_OFF: f64 = 1e-10;
/// A field has both signs if the smaller side is at least this share of the larger one.
const SIGNED: f64 = 0.05;

impl Extent {
    /// Returns the range of the finite values, part of a quantity of the given largest magnitude.
    pub fn of(values: &[f64], size: f64) -> Self {
        let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        let (mut low, mut high) = finite
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
                (low.min(x), high.max(x))
            });
        if finite.len() >= FEW {
            let skipped = (OUTLIERS * finite.len() as f64) as usize;
            let last = finite.len() - 1;
            let (_, below, _) = finite.select_nth_unstable_by(skipped, f64::total_cmp);
            let below = *below;
            let (_, above, _) = finite.select_nth_unstable_by(last - skipped, f64::total_cmp);
            let above = *above;
            if above > below && high - low > WIDER * (above - below) {
                (low, high) = (below, above);
            }
        }
        let size = size.max(low.abs()).max(high.abs());
        Self {
            low,
            high,
            size: if size.is_finite() { size } else { 0.0 },
        }
    }

    /// Returns low end, high end and size, for checkpoints.
    pub(crate) fn parts(self) -> [f64; 3] {
        [self.low, self.high, self.size]
    }

    /// Restores an extent from its parts.
    pub(crate) fn from_parts([low, high, size]: [f64; 3]) -> Self {
        Self { low, high, size }
    }

    /// Returns the largest magnitude of the quantity.
    pub fn size(self) -> f64 {
        self.size
    }

    /// Returns the range of two pictures of a series.
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            size: self.size.max(other.size),
        }
    }

    /// Returns the ends of the colour bar: symmetric about zero for fields of both signs. Values that are round-off of the
    /// quantity are shown as zero.
    pub fn ends(self) -> [f64; 2] {
        let largest = self.low.abs().max(self.high.abs());
        if largest <= ROUND_OFF * self.size {
            return [-self.size, self.size];
        }
        match is_signed(self.low, self.high) {
            true => [-largest, largest],
            false => [self.low, self.high],
        }
    }
}

/// Returns whether a range has both signs to a considerable extent.
pub(super) fn is_signed(low: f64, high: f64) -> bool {
    low < 0.0 && high > 0.0 && (-low).min(high) >= SIGNED * (-low).max(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_do_not_determine_the_range() {
        let mut values: Vec<f64> = (0..10_000).map(|k| f64::from(k) / 1e4).collect();
        assert_eq!(Extent::of(&values, 0.0).ends(), [0.0, 0.9999]);
        values[17] = 100.0;
        let [low, high] = Extent::of(&values, 0.0).ends();
        assert!((low - 0.001).abs() < 2e-4 && (high - 0.999).abs() < 2e-4);
        // Few values are all shown.
        assert_eq!(Extent::of(&[1.0, 2.0, 50.0], 0.0).ends(), [1.0, 50.0]);
    }

    #[test]
    fn fields_of_both_signs_are_symmetric_and_round_off_is_zero() {
        assert_eq!(Extent::of(&[-1.0, 3.0, f64::NAN], 3.0).ends(), [-3.0, 3.0]);
        assert_eq!(Extent::of(&[-0.01, 3.0], 3.0).ends(), [-0.01, 3.0]);
        assert_eq!(Extent::of(&[-1e-17, 2e-17], 1e-3).ends(), [-1e-3, 1e-3]);
        let series = Extent::of(&[-1.0, 0.5], 1.0).union(Extent::of(&[0.0, 4.0], 4.0));
        assert_eq!(series.ends(), [-4.0, 4.0]);
    }
}
