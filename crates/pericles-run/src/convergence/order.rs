//! Observed orders of convergence.

/// Returns the order p with which the last results (h, f), the coarsest first, approach a limit: f(h) = f* + C h^p.
///
/// With a known limit p = ln(e₁/e₂)/ln(h₁/h₂) of the last two results; without one p solves (f₁ − f₂)/(f₂ − f₃) =
/// (h₁^p − h₂^p)/(h₂^p − h₃^p) of the last three. `None` if there are too few or they do not converge.
pub(super) fn observed_order(results: &[(f64, f64)], limit: Option<f64>) -> Option<f64> {
    match (limit, results) {
        (Some(limit), [.., (h1, f1), (h2, f2)]) => {
            let (e1, e2) = ((f1 - limit).abs(), (f2 - limit).abs());
            let order = (e1 / e2).ln() / (h1 / h2).ln();
            order.is_finite().then_some(order)
        }
        (None, [.., first, second, third]) => of_three([*first, *second, *third]),
        _ => None,
    }
}

fn of_three([(h1, f1), (h2, f2), (h3, f3)]: [(f64, f64); 3]) -> Option<f64> {
    /// Search interval of p.
    const RANGE: (f64, f64) = (0.01, 20.0);
    let wanted = (f1 - f2) / (f2 - f3);
    // Relative to the middle spacing, so that high powers do not overflow. The quotient increases with p.
    let quotient = |p: f64| ((h1 / h2).powf(p) - 1.0) / (1.0 - (h3 / h2).powf(p));
    let (mut low, mut high) = RANGE;
    if !(quotient(low)..=quotient(high)).contains(&wanted) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if quotient(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_recovered_for_any_spacings() {
        for p in [0.5, 1.0, 2.0, 3.7] {
            let results = [0.4, 0.2, 0.15, 0.05].map(|h: f64| (h, 7.0 - 2.0 * h.powf(p)));
            let free = observed_order(&results, None).unwrap();
            let known = observed_order(&results, Some(7.0)).unwrap();
            assert!(
                (free - p).abs() < 1e-6 && (known - p).abs() < 1e-6,
                "{p}: {free} {known}"
            );
        }
    }

    #[test]
    fn diverging_results_have_no_order() {
        assert_eq!(observed_order(&[(1.0, 1.0), (0.5, 2.0)], None), None);
        assert_eq!(observed_order(&[(1.0, 1.0)], Some(0.0)), None);
        let apart = [(1.0, 1.0), (0.5, 2.0), (0.25, 1.0)];
        assert_eq!(observed_order(&apart, None), None);
        assert_eq!(
            observed_order(&[(1.0, 1.0), (0.5, 1.0), (0.25, 1.0)], None),
            None
        );
    }
}
