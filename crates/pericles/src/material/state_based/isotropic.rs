//! Shear stiffness of square and cubic lattices: their anisotropy, and the influence function that makes them
//! isotropic.

use crate::error::{PericlesError, Result};
use crate::family::VolumeCorrection;
use crate::kernel::{Influence, InfluenceFunction};
use crate::material::lattice::{Cells, for_each_offset};

/// Both shear stiffnesses of an interior point of a square or cubic lattice, relative to the shear modulus G.
///
/// The dilatational stiffness is exact on every lattice, and so is the mean deviatoric stiffness, (3 G_axes +
/// 2 G_diagonals)/5 = G in three dimensions and (G_axes + G_diagonals)/2 = G in two. The remaining error is
/// the cubic anisotropy of the lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeShear {
    /// Stiffness against shear along the axes, for example ε_xy, over G.
    pub axes: f64,
    /// Stiffness against shear along the diagonals, for example ε_xx = −ε_yy, over G.
    pub diagonals: f64,
}

/// Sums over the bonds of an interior point.
struct Sums {
    /// Σ w b r²
    weighted_volume: f64,
    /// Σ w b ξ_x² ξ_y²/r², averaged over pairs of axes.
    axes: f64,
    /// ¼ Σ w b (ξ_x² − ξ_y²)²/r², averaged over pairs of axes.
    diagonals: f64,
}

impl LatticeShear {
    /// Returns the stiffnesses for an influence function on a lattice whose cells have these sides (m);
    /// `None` for bars and for cells that are not square or cubic.
    pub fn of(
        sides: &[f64],
        influence: &Influence,
        horizon: f64,
        correction: VolumeCorrection,
    ) -> Option<Self> {
        let cells = Cells::new(sides);
        let dimension = sides.len();
        if dimension == 1 || !cells.is_cubic() {
            return None;
        }
        let weight = |xi: [f64; 3]| influence.alpha_of(xi, horizon);
        let sums = sums(cells, horizon, correction, weight);
        let factor = (dimension * (dimension + 2)) as f64 / sums.weighted_volume;
        Some(Self {
            axes: factor * sums.axes,
            diagonals: factor * sums.diagonals,
        })
    }

    /// Returns the larger relative deviation from G.
    pub fn anisotropy(&self) -> f64 {
        (self.axes - 1.0).abs().max((self.diagonals - 1.0).abs())
    }
}

fn sums(
    cells: Cells<'_>,
    horizon: f64,
    correction: VolumeCorrection,
    weight: impl Fn([f64; 3]) -> f64,
) -> Sums {
    let pairs = match cells.sides().len() {
        3 => vec![[0, 1], [1, 2], [2, 0]],
        _ => vec![[0, 1]],
    };
    let share = 1.0 / pairs.len() as f64;
    let mut sums = Sums {
        weighted_volume: 0.0,
        axes: 0.0,
        diagonals: 0.0,
    };
    for_each_offset(cells, horizon, correction, |_, xi, r| {
        let weight = correction.factor(r, horizon, cells.size()) * weight(xi);
        sums.weighted_volume += weight * r * r;
        let squares = xi.map(|x| x * x / r);
        for [a, b] in &pairs {
            let difference = squares[*a] - squares[*b];
            sums.axes += share * weight * squares[*a] * squares[*b];
            sums.diagonals += share * weight * 0.25 * difference * difference;
        }
    });
    sums
}

/// Influence function w = 1 − c r/δ whose constant c makes a lattice isotropic: the shear stiffness is G
/// along axes and diagonals.
///
/// The cubic part of the stiffness is proportional to Σ w b h over the bonds of a point, with h = (Σ_a ξ_a⁴ −
/// 3 r⁴/(D + 2))/r² and the partial volume b, so that c = Σ b h/Σ b h r/δ. It depends only on the ratio of
/// horizon and spacing and on the volume correction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsotropicInfluence {
    coefficient: f64,
    horizon: f64,
    /// Smallest weight of the bonds of the lattice.
    least: f64,
}

impl IsotropicInfluence {
    /// Returns the function for a lattice whose cells have these sides, m.
    ///
    /// # Errors
    /// Bars; cells that are not square or cubic; horizons so short that no such function exists.
    pub fn of_lattice(sides: &[f64], horizon: f64, correction: VolumeCorrection) -> Result<Self> {
        let reject = |reason: &str| {
            Err(PericlesError::BadInfluence {
                reason: reason.into(),
            })
        };
        let cells = Cells::new(sides);
        let dimension = sides.len();
        if dimension == 1 {
            return reject(
                "an isotropic function requires a body in two or three dimensions, because a bar has no shear",
            );
        }
        if !cells.is_cubic() {
            return reject(
                "an isotropic function requires square or cubic cells; use equal spacings or another function",
            );
        }
        let (mut constant, mut slope, mut longest) = (0.0, 0.0, 0.0f64);
        for_each_offset(cells, horizon, correction, |_, xi, r| {
            let fourth: f64 = xi.iter().map(|x| x.powi(4)).sum();
            let h = (fourth - 3.0 * r.powi(4) / (dimension + 2) as f64) / (r * r);
            let weighted = correction.factor(r, horizon, cells.size()) * h;
            constant += weighted;
            // Bonds to cells with centres beyond the horizon have the value at the horizon.
            slope += weighted * r.min(horizon) / horizon;
            longest = longest.max(r.min(horizon));
        });
        let coefficient = constant / slope;
        let least = 1.0 - coefficient * longest / horizon;
        let shape = Self {
            coefficient,
            horizon,
            least,
        };
        let weight = |xi: [f64; 3]| shape.influence().alpha_of(xi, horizon);
        if !coefficient.is_finite()
            || sums(cells, horizon, correction, weight).weighted_volume <= 0.0
        {
            return reject(
                "no linear function makes this lattice isotropic; use a horizon of two spacings or more, or another function",
            );
        }
        Ok(shape)
    }

    /// Returns the constant c.
    pub fn coefficient(&self) -> f64 {
        self.coefficient
    }

    /// Returns whether some bonds of the lattice have a negative weight. Such bonds store negative energy and
    /// must not break.
    pub fn is_signed(&self) -> bool {
        self.least < 0.0
    }

    /// Returns the influence function.
    pub fn influence(&self) -> Influence {
        Influence {
            function: InfluenceFunction::Tabulated {
                table: vec![(0.0, 1.0), (self.horizon, 1.0 - self.coefficient)],
            },
            ..Influence::default()
        }
    }
}
