//! Functionals that a tuning method forms of the residuals on a contour.

use super::method::Method;
use super::model::ScalingModel;
use super::samples::{Place, Sample, places};

/// Quadrature places with their residuals and the functionals F_m = Σ_i weights[m][i] R(place i).
pub(super) struct Functionals {
    pub samples: Vec<Sample>,
    pub weights: Vec<Vec<f64>>,
}

/// Quadrature of the integrals.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Quadrature {
    /// Gauss nodes on whole segments: exact to round-off for smooth integrands.
    Smooth,
    /// Many short panels, for absolute values with kinks.
    Kinks,
}

impl Functionals {
    /// Creates the functionals of a method; `count` of them if the method divides the contour.
    pub fn new(model: &ScalingModel, method: Method, quadrature: Quadrature) -> Self {
        let contour = model.contour();
        let length = contour.length();
        let bar = model.state().dimension() == 1;
        let unknowns = model.classes().len();
        let (equations, _) = model.equations();
        let count = unknowns.saturating_sub(equations.nrows());
        if method == Method::PointCollocation {
            // In 1D the last point is the zone border; a closed contour ends where it begins, so its end is
            // redundant.
            let parts = if bar { count } else { count + 1 };
            let places = (1..=count).map(|m| {
                let (segment, distance) = contour.locate(m as f64 * length / parts as f64);
                model.sample(contour.segments[segment].at(distance), segment)
            });
            let weights = (0..count)
                .map(|m| (0..count).map(|i| f64::from(u8::from(i == m))).collect())
                .collect();
            return Self {
                samples: places.collect(),
                weights,
            };
        }
        let borders: Vec<f64> = match method {
            Method::Subdomain => (1..count)
                .map(|m| m as f64 * length / count as f64)
                .collect(),
            _ => Vec::new(),
        };
        // Integrands are polynomials of cos(i k), i up to twice the horizon ratio.
        let nodes = |least: usize| least.max(48 + (4.0 * model.horizon_ratio()) as usize);
        let places = match quadrature {
            Quadrature::Smooth => places(contour, &borders, |_| 1, nodes(96)),
            Quadrature::Kinks => {
                let share = |piece: f64| (1200.0 * piece / length).ceil() as usize;
                places(contour, &borders, share, 4)
            }
        };
        let along = |m: usize, place: &Place| -> f64 {
            match method {
                Method::Subdomain => {
                    let part = (place.abscissa / length * count as f64) as usize;
                    f64::from(u8::from(part.min(count - 1) == m))
                }
                // In 1D the weights are 1, b₁ … b_{N−2}; in the literal reading of the paper b₁ … b_{N−1}.
                Method::Galerkin if bar && m == 0 => 1.0,
                Method::Galerkin if bar => model.trace(m - 1, place.k),
                Method::Galerkin | Method::LiteralGalerkin => model.trace(m, place.k),
                Method::PointCollocation | Method::LeastSquares | Method::Absolute => 1.0,
            }
        };
        let count = match method {
            Method::LeastSquares | Method::Absolute => 1,
            _ => count,
        };
        let weights = (0..count)
            .map(|m| places.iter().map(|p| p.weight * along(m, p)).collect())
            .collect();
        Self {
            samples: places
                .iter()
                .map(|p| model.sample(p.k, p.segment))
                .collect(),
            weights,
        }
    }
}
