//! Functions of |ξ| that represent tables of coefficients.

use crate::DispersionError;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use pericles::kernel::{ClassTable, InfluenceFunction};
use pericles::{Result, positive};

/// Influence function printed by Alebrahim et al. (2022, eq. 50) for N = 3: a₀ + Σ a_j cos(1.1 j |ξ|/D) on a grid
/// of the given spacing D, m. Its digits are rounded, so its modulus is 1.9 % below that of α ≡ 1 (lattice sum
/// 0.9813); `calibration = "lattice"` corrects this.
pub fn influence_alebrahim(spacing: f64) -> InfluenceFunction {
    InfluenceFunction::Cosines {
        wavenumber: 1.1 / spacing,
        coefficients: vec![2.3, 2.0, -0.39, -0.48, 0.28, 0.14, -0.15, -0.02, 0.05],
    }
}

/// Piecewise linear interpolation of a table, constant below its first class.
pub fn polygon(table: &ClassTable) -> InfluenceFunction {
    InfluenceFunction::Tabulated {
        table: table.chord().to_vec(),
    }
}

/// Fits a₀ + Σ a_j cos(j w r) with `terms` cosines to the piecewise linear interpolation of a table, by least
/// squares over (0, horizon).
///
/// # Errors
/// A wavenumber or horizon that is not positive, or too many terms for the samples to determine them.
pub fn fit_cosines(
    table: &ClassTable,
    horizon: f64,
    wavenumber: f64,
    terms: usize,
) -> Result<InfluenceFunction> {
    positive("the horizon", horizon)?;
    positive("the wavenumber of the cosines", wavenumber)?;
    let periods = (wavenumber * horizon * terms as f64 / TAU).ceil().min(1e3);
    let samples = 200 + 20 * periods as usize;
    let place = |k: usize| horizon * (k as f64 + 0.5) / samples as f64;
    let polygon = pericles::kernel::Influence {
        function: polygon(table),
        acts_on: pericles::kernel::ActsOn::Stretch,
    };
    let matrix = DMatrix::from_fn(samples, terms + 1, |k, j| {
        (j as f64 * wavenumber * place(k)).cos()
    });
    let values = DVector::from_fn(samples, |k, _| polygon.alpha(place(k), horizon));
    let svd = matrix.svd(true, true);
    let rank = svd.rank(1e-10 * svd.singular_values.max());
    let solved = svd.solve(&values, 0.0);
    match solved {
        Ok(coefficients) if rank == terms + 1 => Ok(InfluenceFunction::Cosines {
            wavenumber,
            coefficients: coefficients.iter().copied().collect(),
        }),
        _ => Err(DispersionError::Undetermined {
            rank,
            unknowns: terms + 1,
        }
        .into()),
    }
}
