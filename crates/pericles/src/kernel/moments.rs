//! Moments of influence functions.

use super::influence::{cosines, interpolate};
use super::quadrature::piecewise;
use super::{Influence, InfluenceFunction};

impl Influence {
    /// Returns the moment m_q = ∫₀^δ α(r) r^q dr: by closed form for powers, by Gauss–Legendre quadrature (exact to
    /// round-off) for Gaussians, cosines and the pieces of a table. A class table is replaced by its piecewise
    /// linear function.
    pub fn moment(&self, q: f64, horizon: f64) -> f64 {
        // ∫₀^δ r^p dr
        let power = |p: f64| horizon.powf(p + 1.0) / (p + 1.0);
        let q = q + self.shift();
        match &self.function {
            InfluenceFunction::Constant => power(q),
            InfluenceFunction::Conical => power(q) - power(q + 1.0) / horizon,
            InfluenceFunction::Inverse => power(q - 1.0),
            InfluenceFunction::Power { exponent } => power(q + exponent) / horizon.powf(*exponent),
            InfluenceFunction::Gaussian { length, cutoff } => {
                let end = cutoff.unwrap_or(horizon).min(horizon);
                // Beyond 7 lengths the integrand is below round-off; one piece per length keeps the quadrature
                // exact.
                let end = end.min(7.0 * length + 7.0 * length * q.max(0.0).sqrt());
                let pieces = (end / length).ceil().max(1.0) as usize;
                piecewise(&equal_pieces(end, pieces), |r| {
                    (-(r / length).powi(2)).exp() * r.powf(q)
                })
            }
            InfluenceFunction::Tabulated { table } => polygon(table, q, horizon),
            InfluenceFunction::Classes(table) => polygon(table.chord(), q, horizon),
            InfluenceFunction::Cosines {
                wavenumber,
                coefficients,
            } => {
                let breaks = equal_pieces(horizon, self.cosine_waves(horizon).ceil() as usize);
                piecewise(&breaks, |r| {
                    cosines(coefficients, wavenumber * r) * r.powf(q)
                })
            }
        }
    }
}

impl Influence {
    /// Returns the ends of pieces of 0 … horizon on which α is smooth, so that quadratures with many nodes are
    /// exact to round-off.
    pub fn smooth_pieces(&self, horizon: f64) -> Vec<f64> {
        match &self.function {
            InfluenceFunction::Gaussian { length, cutoff } => {
                // Beyond seven lengths α is negligible.
                let end = cutoff.unwrap_or(horizon).min(horizon).min(7.0 * length);
                equal_pieces(end, (end / length).ceil().max(1.0) as usize)
            }
            InfluenceFunction::Tabulated { table } => {
                let mut breaks = vec![0.0];
                let inside = table.iter().map(|(r, _)| *r);
                breaks.extend(inside.filter(|r| *r > 0.0 && *r < horizon));
                breaks.push(horizon);
                breaks
            }
            InfluenceFunction::Cosines { .. } => {
                equal_pieces(horizon, self.cosine_waves(horizon).ceil() as usize)
            }
            InfluenceFunction::Power { .. } => {
                // Halved towards a root or pole at zero.
                let halvings = (0..=40).rev().map(|k| horizon * 0.5f64.powi(k));
                std::iter::once(0.0).chain(halvings).collect()
            }
            _ => vec![0.0, horizon],
        }
    }
}

/// Returns ∫₀^horizon of a piecewise linear table times r^q.
fn polygon(table: &[(f64, f64)], q: f64, horizon: f64) -> f64 {
    let mut breaks = vec![0.0];
    let inside = table.iter().map(|(r, _)| *r);
    breaks.extend(inside.filter(|r| *r > 0.0 && *r < horizon));
    breaks.push(horizon);
    piecewise(&breaks, |r| interpolate(table, r) * r.powf(q))
}

fn equal_pieces(end: f64, pieces: usize) -> Vec<f64> {
    (0..=pieces)
        .map(|k| end * k as f64 / pieces as f64)
        .collect()
}
