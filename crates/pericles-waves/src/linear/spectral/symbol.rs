//! Symbol of the linear bond-based operator.

use std::f64::consts::PI;

use gauss_quad::GaussLegendre;

use super::cosine_integral::cin;
use crate::function::bessel_into;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::{PericlesError, Result};

/// M_p(k) and M_s(k) of an isotropic linear bond-based medium, N/m⁴: ρω² of pressure and shear waves of wavenumber
/// k.
///
/// With z = kr, A the area of the bar and t the thickness of the plate:
///
/// | | M_p | M_s |
/// |---|---|---|
/// | 1D | 2Ac ∫ α/r (1 − cos z) dr | – |
/// | 2D | 2πct ∫ α [½ − J₀ + J₁/z] dr | 2πct ∫ α [½ − J₁/z] dr |
/// | 3D | 4πc ∫ α r [⅓ − sin z/z − 2 cos z/z² + 2 sin z/z³] dr | 4πc ∫ α r [⅓ + cos z/z² − sin z/z³] dr |
///
/// over 0 … δ. In one dimension closed forms are used if the micromodulus C = cα/r is Gaussian (horizon of at least
/// six lengths), constant, conical or inverse; all other cases use Gauss–Legendre quadrature, exact to some 1e-14
/// of the largest value.
#[derive(Debug, Clone)]
pub struct Symbol {
    dimension: usize,
    /// c times area or thickness.
    factor: f64,
    influence: Influence,
    horizon: f64,
    rule: GaussLegendre,
    pieces: Vec<f64>,
}

/// One-dimensional micromoduli whose symbol has a closed form.
enum Closed {
    Gaussian(f64),
    Constant,
    Conical,
    Inverse,
}

impl Symbol {
    /// Creates the symbol of bonds c α; `section` is the area of the bar, the thickness of the plate, or 1.
    ///
    /// # Errors
    /// An influence function that belongs to a grid or is not usable in this dimension.
    pub fn new(
        dimension: usize,
        section: f64,
        micromodulus: f64,
        influence: &Influence,
        horizon: f64,
    ) -> Result<Self> {
        if matches!(influence.function, InfluenceFunction::Classes(_)) {
            return Err(PericlesError::BadInfluence {
                reason: "a table per bond class belongs to a grid and has no integral over the horizon; use bonds = \
                    \"convolution\""
                    .into(),
            });
        }
        influence.check(dimension, horizon)?;
        const NODES: std::num::NonZeroUsize = std::num::NonZeroUsize::new(32).unwrap();
        Ok(Self {
            dimension,
            factor: micromodulus * section,
            influence: influence.clone(),
            horizon,
            rule: GaussLegendre::new(NODES),
            pieces: influence.smooth_pieces(horizon),
        })
    }

    fn closed(&self) -> Option<Closed> {
        let displacement = self.influence.acts_on == ActsOn::Displacement;
        match &self.influence.function {
            InfluenceFunction::Gaussian { length, cutoff } if displacement => {
                /// Number of lengths beyond which e^(−r²/l²) is below 1e-16.
                const ALL: f64 = 6.1;
                let end = cutoff.unwrap_or(self.horizon);
                (end >= ALL * length).then_some(Closed::Gaussian(*length))
            }
            InfluenceFunction::Constant if displacement => Some(Closed::Constant),
            InfluenceFunction::Conical if displacement => Some(Closed::Conical),
            InfluenceFunction::Inverse if displacement => Some(Closed::Inverse),
            InfluenceFunction::Constant => Some(Closed::Inverse),
            _ => None,
        }
    }

    /// Returns M_p and M_s at wavenumber k ≥ 0; in one dimension both are M_p.
    pub fn at(&self, k: f64) -> [f64; 2] {
        if k == 0.0 {
            return [0.0; 2];
        }
        if self.dimension == 1
            && let Some(form) = self.closed()
        {
            let value = self.factor * closed_form(&form, k, self.horizon);
            return [value; 2];
        }
        self.integral(k)
    }

    /// As [`Symbol::at`], by quadrature.
    fn integral(&self, k: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        self.nodes(k, |r, weighed| {
            let [p, s] = angular(self.dimension, k * r);
            let radial = match self.dimension {
                1 => weighed / r,
                2 => weighed,
                _ => weighed * r,
            };
            sums[0] += radial * p;
            sums[1] += radial * s;
        });
        sums.map(|sum| self.factor * sum)
    }

    /// Computes c A ∫ g(r, α) dr over 0 … δ for a g that is proportional to α and oscillates with kr.
    pub(super) fn radial(&self, k: f64, g: impl Fn(f64, f64) -> f64) -> f64 {
        let mut sum = 0.0;
        self.nodes(k, |r, weighed| sum += g(r, weighed));
        self.factor * sum
    }

    /// Calls `visit(r, weight · α)` for the nodes of a quadrature of integrands that oscillate with kr.
    fn nodes(&self, k: f64, mut visit: impl FnMut(f64, f64)) {
        /// Range of kr in one panel: 32 nodes integrate twenty radians of a wave to round-off.
        const RADIANS: f64 = 20.0;
        for piece in self.pieces.windows(2) {
            let parts = (k * (piece[1] - piece[0]) / RADIANS).ceil().max(1.0);
            let width = (piece[1] - piece[0]) / parts;
            for part in 0..parts as usize {
                let from = piece[0] + part as f64 * width;
                for (node, weight) in self.rule.as_node_weight_pairs() {
                    let r = from + 0.5 * width * (1.0 + node);
                    let alpha = self.influence.alpha(r, self.horizon);
                    visit(r, 0.5 * width * weight * alpha);
                }
            }
        }
    }
}

fn closed_form(form: &Closed, k: f64, horizon: f64) -> f64 {
    let z = k * horizon;
    match form {
        // √π l (1 − e^(−k²l²/4))
        Closed::Gaussian(length) => -PI.sqrt() * length * (-0.25 * (k * length).powi(2)).exp_m1(),
        // 2 (δ − sin(kδ)/k); by series for small z, where the difference loses digits.
        Closed::Constant => 2.0 * horizon * one_less_sinc(z),
        // 2 (δ/2 − (1 − cos kδ)/(k²δ)) = δ (1 − sinc²(kδ/2))
        Closed::Conical => {
            let rest = one_less_sinc(0.5 * z);
            horizon * rest * (2.0 - rest)
        }
        Closed::Inverse => 2.0 * cin(z),
    }
}

/// 1 − sin z/z
fn one_less_sinc(z: f64) -> f64 {
    if z < 1.0 {
        let (mut term, mut sum) = (-1.0, 0.0);
        for n in 1..12 {
            let two_n = 2.0 * f64::from(n);
            term *= -z * z / (two_n * (two_n + 1.0));
            sum += term;
        }
        sum
    } else {
        1.0 - z.sin() / z
    }
}

/// ∫ n_a² (1 − cos(z n·k̂)) over directions n, longitudinal and transverse.
fn angular(dimension: usize, z: f64) -> [f64; 2] {
    match dimension {
        1 => {
            let value = 4.0 * (0.5 * z).sin().powi(2);
            [value; 2]
        }
        2 => {
            let mut bessel = [0.0; 2];
            bessel_into(z, &mut bessel);
            let [j0, j1] = bessel;
            let ratio = if z > 1e-8 { j1 / z } else { 0.5 };
            [PI - 2.0 * PI * (j0 - ratio), PI - 2.0 * PI * ratio]
        }
        _ => {
            // ∫ (1 − cos zμ) dμ and ∫ μ² (1 − cos zμ) dμ over −1 … 1
            let (all, square) = if z < 2.0 {
                let (mut term, mut all, mut square) = (-1.0, 0.0, 0.0);
                for n in 1..16 {
                    let two_n = 2.0 * f64::from(n);
                    term *= -z * z / (two_n * (two_n - 1.0));
                    all += term * 2.0 / (two_n + 1.0);
                    square += term * 2.0 / (two_n + 3.0);
                }
                (all, square)
            } else {
                let (sine, cosine) = z.sin_cos();
                let all = 2.0 - 2.0 * sine / z;
                let wave = sine / z + 2.0 * cosine / (z * z) - 2.0 * sine / z.powi(3);
                (all, 2.0 / 3.0 - 2.0 * wave)
            };
            [2.0 * PI * square, PI * (all - square)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn influence(function: InfluenceFunction, acts_on: ActsOn) -> Influence {
        Influence { function, acts_on }
    }

    #[test]
    fn closed_forms_equal_the_quadrature() {
        let gaussian = InfluenceFunction::Gaussian {
            length: 0.1,
            cutoff: None,
        };
        let cases = [
            influence(gaussian, ActsOn::Displacement),
            influence(InfluenceFunction::Constant, ActsOn::Displacement),
            influence(InfluenceFunction::Conical, ActsOn::Displacement),
            influence(InfluenceFunction::Inverse, ActsOn::Displacement),
            influence(InfluenceFunction::Constant, ActsOn::Stretch),
        ];
        for case in cases {
            let symbol = Symbol::new(1, 2.0, 1.5, &case, 0.7).unwrap();
            assert!(symbol.closed().is_some());
            let largest = symbol.at(1e3)[0];
            for k in [1e-3, 0.5, 3.0, 20.0, 150.0, 1e3] {
                let (closed, sum) = (symbol.at(k)[0], symbol.integral(k)[0]);
                let error = (closed - sum).abs() / largest;
                // kδ = 700 is accurate to 1e-13, and both sides sum several such terms.
                assert!(error < 1e-14, "{case:?} {k}: {closed} {sum}");
            }
        }
    }

    #[test]
    fn long_waves_have_the_speeds_of_the_elastic_medium() {
        // ω² ρ/k² = c ∫ α r^D dr × ½ ∫ n_x² n_a² over directions: c m₃ × (3π/8, π/8) and (2π/5, 2π/15).
        let constant = Influence::default();
        for (dimension, parts) in [
            (1, [1.0, 1.0]),
            (2, [3.0 * PI / 8.0, PI / 8.0]),
            (3, [2.0 * PI / 5.0, 2.0 * PI / 15.0]),
        ] {
            let symbol = Symbol::new(dimension, 1.0, 2.0, &constant, 0.5).unwrap();
            let k = 1e-2;
            let moment = constant.moment(dimension as f64, 0.5);
            for (value, part) in symbol.at(k).iter().zip(parts) {
                let modulus = value / (k * k);
                assert!(
                    (modulus / (2.0 * moment * part) - 1.0).abs() < 1e-5,
                    "{dimension}"
                );
            }
        }
    }
}
