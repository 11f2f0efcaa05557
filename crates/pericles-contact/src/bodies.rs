//! Data of the points that may touch.

use std::sync::Arc;

use pericles::operator::Force;
use pericles::space::PointCloud;
use pericles::{PointScalar, Result};

use crate::error::ContactError;
use crate::law::{ContactLaw, ContactStiffness, PairLaw, micromodulus};
use crate::vector::V3;

/// Numbers of the pieces and materials of the points.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactBodies {
    /// Number of the piece of each point; points of different pieces are never bonded.
    pub piece: Vec<u32>,
    /// Young's modulus, Pa.
    pub young: PointScalar,
    /// Horizon, m.
    pub horizon: PointScalar,
    /// Density, kg/m³.
    pub density: PointScalar,
}

impl ContactBodies {
    /// One piece of one material.
    pub fn uniform(points: usize, young: f64, horizon: f64, density: f64) -> Self {
        Self {
            piece: vec![0; points],
            young: PointScalar::Uniform(young),
            horizon: PointScalar::Uniform(horizon),
            density: PointScalar::Uniform(density),
        }
    }

    /// Checks lengths and signs for a body of `points` points.
    ///
    /// # Errors
    /// Lists of another length; numbers that are not positive.
    pub(crate) fn check(&self, points: usize) -> Result<()> {
        if self.piece.len() != points {
            return Err(ContactError::Length {
                what: "the pieces of the points",
                given: self.piece.len(),
                needed: points,
            }
            .into());
        }
        for (what, numbers) in [
            ("Young's modulus of the points", &self.young),
            ("the horizons of the points", &self.horizon),
            ("the densities of the points", &self.density),
        ] {
            check_numbers(what, numbers, points)?;
        }
        Ok(())
    }
}

/// Checks that numbers are positive and one per point.
fn check_numbers(what: &'static str, numbers: &PointScalar, points: usize) -> Result<()> {
    let values = match numbers {
        PointScalar::Uniform(value) => std::slice::from_ref(value),
        PointScalar::PerPoint(values) if values.len() == points => &values[..],
        PointScalar::PerPoint(values) => {
            return Err(ContactError::Length {
                what,
                given: values.len(),
                needed: points,
            }
            .into());
        }
    };
    for &value in values {
        pericles::positive(what, value)?;
    }
    Ok(())
}

/// Sizes, stiffnesses and masses of the points in contact.
#[derive(Debug, Clone)]
pub(crate) struct Touching {
    pub(crate) cloud: Arc<PointCloud>,
    pub(crate) law: ContactLaw,
    pub(crate) bodies: ContactBodies,
    /// Size h of the cell of each point, m.
    pub(crate) size: Vec<f64>,
    /// Stiffness k_i of each point, N/m; for [`PairLaw::Emu`] 15 c/δ, N/m⁷.
    pub(crate) stiffness: Vec<f64>,
}

impl Touching {
    /// Checks the points and prepares their data. All processes must call it together.
    pub(crate) fn new(
        cloud: Arc<PointCloud>,
        law: ContactLaw,
        bodies: ContactBodies,
    ) -> Result<Self> {
        let checked = law.check().and_then(|()| bodies.check(cloud.len()));
        cloud.domain().agreed(checked)?;
        let n = cloud.len();
        let stiffness = |i: usize| {
            let (young, horizon) = (bodies.young.at(i), bodies.horizon.at(i));
            match (law.law, law.stiffness) {
                (PairLaw::Emu, _) => {
                    15.0 * micromodulus(cloud.dimension(), young, horizon, cloud.section())
                        / horizon
                }
                (_, ContactStiffness::Relative(factor)) => {
                    factor * young * cloud.volumes()[i] / (horizon * horizon)
                }
                (_, ContactStiffness::Absolute(value)) => value,
            }
        };
        Ok(Self {
            size: (0..n).map(|i| cloud.cell_size(i)).collect(),
            stiffness: (0..n).map(stiffness).collect(),
            cloud,
            law,
            bodies,
        })
    }

    /// Sets the sizes of the points, m.
    ///
    /// # Errors
    /// Sizes that are not positive, or not one per point.
    pub(crate) fn set_sizes(&mut self, sizes: &PointScalar) -> Result<()> {
        let points = self.cloud.len();
        check_numbers("the sizes of the points", sizes, points)?;
        self.size = (0..points).map(|i| sizes.at(i)).collect();
        Ok(())
    }

    /// Checks that contact is possible on a body with these internal forces.
    ///
    /// # Errors
    /// [`ContactError::NotPossible`]: forces of another body, periodic faces.
    pub(crate) fn check_forces(&self, forces: &dyn Force) -> Result<()> {
        let cloud = &self.cloud;
        let reason = if forces.points() != cloud.len() || forces.dimension() != cloud.dimension() {
            "it was made for a body with other points"
        } else if cloud.is_periodic() {
            "the body has periodic faces, and points beyond a face touch at their images; use free surfaces"
        } else {
            return Ok(());
        };
        Err(ContactError::NotPossible { reason }.into())
    }

    /// Position of a point at displacement u, m.
    #[inline]
    pub(crate) fn place(&self, u: &[f64], i: usize) -> V3 {
        let (n, x) = (self.cloud.len(), self.cloud.positions());
        let mut place = [0.0; 3];
        for c in 0..self.cloud.dimension() {
            place[c] = x[c * n + i] + u[c * n + i];
        }
        place
    }

    /// Mass of a point, kg.
    #[inline]
    pub(crate) fn mass(&self, i: usize) -> f64 {
        self.bodies.density.at(i) * self.cloud.volumes()[i]
    }

    /// Stiffness of a pair, N/m.
    #[inline]
    pub(crate) fn pair_stiffness(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.stiffness[i], self.stiffness[j]);
        let mean = 2.0 * a * b / (a + b);
        match self.law.law {
            PairLaw::Emu => mean * (self.cloud.volumes()[i] * self.cloud.volumes()[j]),
            _ => mean,
        }
    }

    /// Stiffness of the contact of a point with a rigid body, N/m: twice that of the point, as for a pair of the point
    /// and its mirror image, whose overlap is twice as large.
    #[inline]
    pub(crate) fn wall_stiffness(&self, i: usize) -> f64 {
        let volume = self.cloud.volumes()[i];
        match self.law.law {
            PairLaw::Emu => 2.0 * self.stiffness[i] * volume * volume,
            _ => 2.0 * self.stiffness[i],
        }
    }
}
