//! Plane waves of an influence function in the nonlocal continuum.

use std::f64::consts::PI;
use std::num::NonZeroUsize;

use gauss_quad::GaussLegendre;

use super::bisection::last_before;
use pericles::kernel::{Influence, InfluenceFunction};

/// Plane waves of the nonlocal continuum: the dispersion due to an influence function and a horizon, without a
/// grid.
///
/// In d dimensions ω² of a wave along the unit vector n with polarisation e is
///
/// ω²(k) = (c/ρ) ∫_{|ξ|<δ} α(|ξ|) (1 − cos(k n·ξ)) (e·ξ)²/|ξ|³ dV,
///
/// which is isotropic, with e = n for pressure waves and e ⟂ n for shear waves. Speeds are relative to those of
/// long waves, so the bond constant cancels.
#[derive(Debug, Clone)]
pub struct KernelWaves {
    dimension: usize,
    /// Nodes r (m) and weights w of ∫ α(r) r^d f(r) dr = Σ w f(r) for smooth f.
    radii: Vec<[f64; 2]>,
    horizon: f64,
}

impl KernelWaves {
    /// Creates the waves of a kernel with the given horizon (m) for wavenumbers up to `largest` (rad/m). `None` for
    /// tables per bond class: they belong to a grid and have no continuum.
    pub fn new(
        dimension: usize,
        influence: &Influence,
        horizon: f64,
        largest: f64,
    ) -> Option<Self> {
        /// Range of k r (rad) on which a polynomial through 32 nodes resolves a wave to round-off.
        const PANEL: f64 = 10.0;
        const NODES: NonZeroUsize = NonZeroUsize::new(32).unwrap();
        if matches!(influence.function, InfluenceFunction::Classes(_)) {
            return None;
        }
        let rule = GaussLegendre::new(NODES);
        let pairs = rule.as_node_weight_pairs();
        let panels = (horizon * largest / PANEL).ceil().max(1.0);
        let width = horizon / panels;
        let pieces = influence.smooth_pieces(horizon);
        let mut radii = Vec::new();
        for panel in 0..panels as usize {
            let [start, end] = [panel, panel + 1].map(|k| width * k as f64);
            // Moments of α r^d with the Legendre polynomials of the panel, from the pieces on which α is smooth. The wave is smooth on
            // the whole panel, so that the number of nodes does not depend on the number of pieces.
            let mut moments = vec![0.0; pairs.len()];
            for piece in pieces.windows(2) {
                let (a, b) = (piece[0].max(start), piece[1].min(end));
                if a >= b {
                    continue;
                }
                for (node, weight) in pairs {
                    let r = a + 0.5 * (b - a) * (node + 1.0);
                    let density = influence.alpha(r, horizon) * r.powi(dimension as i32);
                    let share = 0.5 * (b - a) * weight * density;
                    let values = legendre(2.0 * (r - start) / width - 1.0, moments.len());
                    for (moment, value) in moments.iter_mut().zip(values) {
                        *moment += share * value;
                    }
                }
            }
            for (node, weight) in pairs {
                let values = legendre(*node, moments.len());
                let parts = values.zip(&moments).enumerate();
                let sum: f64 = parts
                    .map(|(n, (value, moment))| (n as f64 + 0.5) * value * moment)
                    .sum();
                radii.push([start + 0.5 * width * (node + 1.0), weight * sum]);
            }
        }
        Some(Self {
            dimension,
            radii,
            horizon,
        })
    }

    /// Phase speeds at a wavenumber (rad/m) relative to those of long waves: pressure, then shear (in a bar
    /// pressure only). Zero where ω² is negative.
    pub fn relative_speeds(&self, wavenumber: f64) -> Vec<f64> {
        let cosines = self.cosines(wavenumber * self.horizon);
        let branches = self.dimension.min(2);
        let mut sums = vec![[0.0; 2]; branches];
        for [r, weight] in &self.radii {
            for &(mu, share) in &cosines {
                let phase = wavenumber * r * mu;
                // 1 − cos φ and its long-wave limit φ²/2, over r².
                let limit = 0.5 * (wavenumber * mu).powi(2);
                let values = [2.0 * ((0.5 * phase).sin() / r).powi(2), limit];
                let along = mu * mu;
                // In 3D the two transverse directions share 1 − μ².
                let across = (1.0 - along) / (self.dimension.max(2) - 1) as f64;
                for (sum, polarised) in sums.iter_mut().zip([along, across]) {
                    sum[0] += weight * share * polarised * values[0];
                    sum[1] += weight * share * polarised * values[1];
                }
            }
        }
        let ratio = |[wave, long]: &[f64; 2]| (wave / long).max(0.0).sqrt();
        sums.iter().map(ratio).collect()
    }

    /// Returns the largest wavenumber (rad/m, at most `end`) up to which all phase speeds are within a tolerance of
    /// those of long waves.
    pub fn resolved(&self, tolerance: f64, end: f64) -> f64 {
        const STEPS: usize = 200;
        let off = |k: f64| {
            let mut speeds = self.relative_speeds(k).into_iter();
            speeds.any(|speed| (speed - 1.0).abs() > tolerance)
        };
        last_before(end, STEPS, off)
    }

    /// Nodes and weights in μ, the cosine between bond and wave vector, over half of all directions; exact to
    /// round-off up to `phase` = k δ.
    fn cosines(&self, phase: f64) -> Vec<(f64, f64)> {
        let count = 16 + (0.75 * phase) as usize;
        match self.dimension {
            1 => vec![(1.0, 1.0)],
            2 => {
                // Midpoint rule for a periodic function.
                let step = 0.5 * PI / count as f64;
                let nodes = (0..count).map(|i| (((i as f64 + 0.5) * step).cos(), step));
                nodes.collect()
            }
            _ => {
                let rule =
                    GaussLegendre::new(NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN));
                let pairs = rule.as_node_weight_pairs().iter();
                pairs
                    .map(|(node, weight)| (0.5 * (node + 1.0), 0.5 * weight))
                    .collect()
            }
        }
    }
}

/// Returns the values of the first Legendre polynomials at x.
fn legendre(x: f64, count: usize) -> impl Iterator<Item = f64> {
    let mut next = (1.0, x);
    (0..count).map(move |n| {
        let (value, after) = next;
        let m = n as f64 + 1.0;
        next = (after, ((2.0 * m + 1.0) * x * after - m * value) / (m + 1.0));
        value
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::kernel::ActsOn;

    fn waves(dimension: usize, function: InfluenceFunction) -> KernelWaves {
        let influence = Influence {
            function,
            acts_on: ActsOn::Stretch,
        };
        KernelWaves::new(dimension, &influence, 2.0, 30.0).unwrap()
    }

    #[test]
    fn bar_speeds_equal_closed_forms() {
        // α = r/δ: ω² ∝ ∫ (1 − cos kr) dr = δ − sin(kδ)/k; for long waves k²δ³/6.
        let bar = waves(1, InfluenceFunction::Power { exponent: 1.0 });
        for k in [0.1, 1.0, 7.0, 30.0] {
            let exact = (2.0 - f64::sin(2.0 * k) / k) / (k * k * 8.0 / 6.0);
            let found = bar.relative_speeds(k)[0];
            assert!((found / exact.sqrt() - 1.0).abs() < 1e-11, "{k} {found}");
        }
    }

    #[test]
    fn speeds_of_plates_and_blocks_equal_lattice_sums() {
        // Long waves have relative speed one.
        for dimension in [2, 3] {
            let body = waves(dimension, InfluenceFunction::Constant);
            let [pressure, shear] = body.relative_speeds(1e-3)[..] else {
                panic!("two branches")
            };
            assert!((pressure - 1.0).abs() < 1e-6 && (shear - 1.0).abs() < 1e-6);
        }
        // The same integral as a lattice with many points within the horizon.
        let fine = crate::BondLattice::new(&[0.02; 2], 2.0, |_, _, _| 1.0).unwrap();
        let plate = waves(2, InfluenceFunction::Constant);
        for k in [0.5, 2.0, 5.0] {
            let speeds = |k: f64| {
                let modes = fine.modes([k, 0.0, 0.0]);
                [modes[1].omega() / k, modes[0].omega() / k]
            };
            let (at, long) = (speeds(k), speeds(1e-3));
            let found = plate.relative_speeds(k);
            for branch in 0..2 {
                let expected = at[branch] / long[branch];
                assert!(
                    (found[branch] - expected).abs() < 2e-3,
                    "{k} {found:?} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_number_of_rows_of_a_table_changes_neither_speeds_nor_their_cost() {
        let table = |rows: usize| {
            let row = |k: usize| 2.0 * k as f64 / (rows - 1) as f64;
            let table = (0..rows).map(|k| (row(k), row(k))).collect();
            InfluenceFunction::Tabulated { table }
        };
        for dimension in 1..=3 {
            let [few, many] = [2, 4001].map(|rows| waves(dimension, table(rows)));
            assert_eq!(few.radii.len(), many.radii.len());
            for k in [0.1, 3.0, 30.0] {
                let pairs = few
                    .relative_speeds(k)
                    .into_iter()
                    .zip(many.relative_speeds(k));
                for (a, b) in pairs {
                    assert!((a / b - 1.0).abs() < 1e-12, "{dimension} {k}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn tables_per_bond_class_have_no_continuum_waves() {
        let table = pericles::kernel::ClassTable::new(1, 1.0, &[([1, 0, 0], 1.0)]).unwrap();
        let influence = Influence {
            function: InfluenceFunction::Classes(table),
            acts_on: ActsOn::Stretch,
        };
        assert!(KernelWaves::new(1, &influence, 1.0, 3.0).is_none());
    }
}
