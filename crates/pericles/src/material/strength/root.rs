//! Root of a decreasing function, and the largest value of a function of one peak.

/// Returns a root of a continuous function that is positive at `low` and negative at `high`, to within `tolerance`.
///
/// ITP method (interpolate, truncate, project; Oliveira and Takahashi 2020): at most one evaluation more than bisection,
/// superlinear for smooth functions.
pub(super) fn root(
    mut value: impl FnMut(f64) -> f64,
    [mut low, mut high]: [f64; 2],
    [mut at_low, mut at_high]: [f64; 2],
    tolerance: f64,
) -> f64 {
    let width = high - low;
    let most = (0.5 * width / tolerance).log2().ceil().max(0.0) + 1.0;
    let mut reach = tolerance * most.exp2();
    while high - low > 2.0 * tolerance {
        let middle = 0.5 * (low + high);
        let radius = (reach - 0.5 * (high - low)).max(0.0);
        let secant = (at_low * high - at_high * low) / (at_low - at_high);
        let side = (middle - secant).signum();
        let shift = 0.2 / width * (high - low).powi(2);
        let truncated = match shift <= (middle - secant).abs() {
            true => secant + side * shift,
            false => middle,
        };
        let place = match (truncated - middle).abs() <= radius {
            true => truncated,
            false => middle - side * radius,
        };
        let found = value(place);
        if found > 0.0 {
            (low, at_low) = (place, found);
        } else if found < 0.0 {
            (high, at_high) = (place, found);
        } else {
            return place;
        }
        reach *= 0.5;
    }
    0.5 * (low + high)
}

/// Returns the largest value of a function in an interval, by golden-section search: of its largest value if the
/// function has one peak, of one of its peaks otherwise.
pub(super) fn peak(mut value: impl FnMut(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    /// Leaves 6e-6 of the interval.
    const STEPS: usize = 25;
    let share = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - share * (high - low), low + share * (high - low)];
    let mut places = inner(low, high);
    let mut values = places.map(&mut value);
    let mut largest = values[0].max(values[1]);
    for _ in 0..STEPS {
        if values[0] > values[1] {
            high = places[1];
            places = [inner(low, high)[0], places[0]];
            values = [value(places[0]), values[0]];
        } else {
            low = places[0];
            places = [places[1], inner(low, high)[1]];
            values = [values[1], value(places[1])];
        }
        largest = largest.max(values[0]).max(values[1]);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_the_tolerance_in_few_evaluations() {
        let mut count = 0;
        let place = root(
            |x: f64| {
                count += 1;
                2.0 - x.exp()
            },
            [0.0, 8.0],
            [1.0, 2.0 - 8f64.exp()],
            1e-12,
        );
        assert!((place - 2f64.ln()).abs() < 2e-12, "{place}");
        // Bisection needs 42.
        assert!(count <= 20, "{count}");
        // Linear interpolation alone converges slowly for a large power.
        let steep = |x: f64| 1.0 - x.powi(20);
        let place = root(steep, [0.0, 4.0], [1.0, steep(4.0)], 1e-10);
        assert!((place - 1.0).abs() < 2e-10, "{place}");
    }

    #[test]
    fn the_peak_of_a_kinked_function_is_found() {
        let value = peak(|x| 1.0 - (x - 0.3).abs() - (x - 0.3).powi(2), [0.0, 1.0]);
        assert!((value - 1.0).abs() < 1e-5, "{value}");
    }
}
