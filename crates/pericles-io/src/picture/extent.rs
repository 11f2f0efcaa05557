//! Range of the values of a picture or a series of pictures.

/// Range of values for a colour bar.
///
/// Outliers, such as the stresses of a few points at supports, do not determine the range. It ends at the percentiles 0.5 and
/// 99.5 if the full range is 2 to 20 times as wide, and at the percentiles 0.1 and 99.9 if it is more than 20 times as wide,
/// where more percentiles would hide a localised field such as a pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    low: f64,
    high: f64,
    /// Largest magnitude of the quantity that the values are a part of, such as the norm of the vector of a component.
    size: f64,
}

/// Fewer values have no outliers.
const FEW: usize = 1000;
/// Shares of the values beyond each end that may be outliers, and the factors by which outliers widen the range.
const OUTLIERS: [(f64, std::ops::Range<f64>); 2] = [(5e-3, 2.0..20.0), (1e-3, 1.5..f64::INFINITY)];
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
            let last = finite.len() - 1;
            let inner = OUTLIERS.into_iter().find_map(|(share, factors)| {
                let skipped = (share * finite.len() as f64) as usize;
                let mut nth = |k: usize| *finite.select_nth_unstable_by(k, f64::total_cmp).1;
                let (below, above) = (nth(skipped), nth(last - skipped));
                let is_outlying =
                    above > below && factors.contains(&((high - low) / (above - below)));
                is_outlying.then_some((below, above))
            });
            (low, high) = inner.unwrap_or((low, high));
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
        // Half a per cent of large stresses at supports.
        for value in &mut values[..40] {
            *value = 10.0;
        }
        values[17] = 9.0;
        let [low, high] = Extent::of(&values, 0.0).ends();
        assert!(
            (low - 0.009).abs() < 1e-3 && (high - 0.999).abs() < 2e-3,
            "{low} {high}"
        );
        // A pulse in few points.
        let pulse = (0..10_000).map(|k| {
            if k < 40 {
                f64::from(k)
            } else {
                1e-9 * f64::from(k % 7)
            }
        });
        assert_eq!(
            Extent::of(&pulse.collect::<Vec<f64>>(), 0.0).ends(),
            [0.0, 39.0]
        );
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
