//! Gauss–Legendre quadrature.

/// Positive nodes and weights of the 32-node rule on [−1, 1] (zeros of the Legendre polynomial P₃₂, correctly
/// rounded).
const RULE: [(f64, f64); 16] = [
    (0.9972638618494816, 0.007018610009470096),
    (0.9856115115452684, 0.01627439473090567),
    (0.9647622555875064, 0.02539206530926206),
    (0.9349060759377397, 0.03427386291302143),
    (0.8963211557660521, 0.04283589802222668),
    (0.84936761373257, 0.050998059262376175),
    (0.7944837959679424, 0.058684093478535544),
    (0.7321821187402897, 0.06582222277636185),
    (0.6630442669302152, 0.0723457941088485),
    (0.5877157572407623, 0.07819389578707031),
    (0.5068999089322294, 0.08331192422694675),
    (0.42135127613063533, 0.08765209300440381),
    (0.33186860228212767, 0.09117387869576389),
    (0.23928736225213706, 0.09384439908080457),
    (0.1444719615827965, 0.09563872007927486),
    (0.04830766568773832, 0.0965400885147278),
];

/// Returns ∫ₐᵇ f(x) dx with 32 nodes, exact to round-off for polynomials up to degree 63.
pub(super) fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (half, middle) = (0.5 * (b - a), 0.5 * (b + a));
    let pairs = RULE.iter();
    half * pairs
        .map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x)))
        .sum::<f64>()
}

/// Positive nodes and weights of the 4-node rule on [−1, 1].
const SHORT: [(f64, f64); 2] = [
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
];

/// Returns the integral over pieces with the given ends, on each of which the function is smooth. On pieces that are short
/// compared with the whole and with their distance from its beginning, four nodes are exact to round-off: the number of
/// evaluations for tables of many rows is small.
pub(super) fn piecewise(ends: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    const SHORTER: f64 = 1.0 / 64.0;
    const AWAY: f64 = 4.0;
    let (Some(&start), Some(&end)) = (ends.first(), ends.last()) else {
        return 0.0;
    };
    let piece = |ends: &[f64]| {
        let (a, b) = (ends[0], ends[1]);
        let width = b - a;
        if width > SHORTER * (end - start) || a - start < AWAY * width {
            return integral(a, b, &f);
        }
        let (half, middle) = (0.5 * width, 0.5 * (b + a));
        let pairs = SHORT.iter();
        let sum: f64 = pairs
            .map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x)))
            .sum();
        half * sum
    };
    ends.windows(2).map(piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_pieces_do_not_change_an_integral() {
        let ends: Vec<f64> = (0..=4000).map(|k| f64::from(k) * 5e-4).collect();
        let g = |x: f64| (3.0 * x).cos() / (0.2 + x);
        let whole = integral(0.0, 0.5, g) + integral(0.5, 2.0, g);
        assert!((piecewise(&ends, g) / whole - 1.0).abs() < 1e-13);
    }

    #[test]
    fn powers_up_to_the_degree_of_the_rule_are_exact() {
        for power in 0..64 {
            let exact = 2f64.powi(power + 1) / f64::from(power + 1);
            let error = integral(0.0, 2.0, |x| x.powi(power)) / exact - 1.0;
            assert!(error.abs() < 1e-14, "{power}: {error:e}");
        }
        // Degree 64, zero at all nodes and positive elsewhere.
        let beyond = |x: f64| {
            RULE.iter()
                .map(move |(node, _)| (x * x - node * node).powi(2))
        };
        assert_eq!(integral(-1.0, 1.0, |x| beyond(x).product()), 0.0);
    }
}
