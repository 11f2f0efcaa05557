//! Outer layer of the body at an absorbing boundary.

use super::{AbsorbingError, LatticeStencil};
use pericles::System;
use pericles::operator::PointSubset;
use pericles::space::PointCloud;
use pericles::sum::max_norm;
use pericles::time::State;

/// End of a bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// −x.
    Left,
    /// +x.
    Right,
}

impl Side {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "-x",
            Self::Right => "+x",
        }
    }

    /// Index of the point at a depth below the end, for a bar of n points.
    fn point(self, n: usize, depth: usize) -> usize {
        match self {
            Self::Left => depth,
            Self::Right => n - 1 - depth,
        }
    }
}

/// The outermost K points of a bar on one side, verified: the exterior continues their bonds.
#[derive(Debug, Clone)]
pub struct OuterLayer {
    /// Side of the bar.
    pub side: Side,
    /// Points from the end inwards.
    pub points: Vec<usize>,
    /// Mass of a point, ρ V, kg.
    pub mass: f64,
    /// Lattice that continues the body.
    pub stencil: LatticeStencil,
    /// Largest initial displacement or velocity in the layer relative to that of the body. The exterior starts from
    /// rest, so this is the relative error of the boundary; zero if the field beyond is given.
    pub neglected: f64,
}

/// Relative difference (to the largest weight) below which bond weights are considered equal.
const TOLERANCE: f64 = 1e-11;
/// Fraction of its largest value that the initial field may have where the known field ends. It is taken as zero
/// beyond, which causes an error of about this size.
pub(super) const NEGLIGIBLE: f64 = 1e-6;

impl OuterLayer {
    /// Creates the outer layer of a body from its initial state and the ascending list of points whose bonds never
    /// break. The lattice beyond is derived from the bonds of the outermost point.
    ///
    /// # Errors
    /// Every property that the exterior cannot continue ([`AbsorbingError`]).
    pub fn of(
        system: &System,
        side: Side,
        start: &State,
        no_fail: &[u32],
    ) -> Result<Self, AbsorbingError> {
        let mut layer = Self::with_motion_beyond(system, side, no_fail)?;
        for field in [&start.u, &start.v] {
            let share = layer.share_of(field, system.cloud())?;
            layer.neglected = layer.neglected.max(share);
        }
        Ok(layer)
    }

    /// As [`OuterLayer::of`], for a body whose initial field extends beyond the end; [`super::FreeWave`] must then
    /// describe it.
    ///
    /// # Errors
    /// As [`OuterLayer::of`], except for the field.
    pub fn with_motion_beyond(
        system: &System,
        side: Side,
        no_fail: &[u32],
    ) -> Result<Self, AbsorbingError> {
        let cloud = system.cloud();
        check_bar(cloud)?;
        let n = cloud.len();
        let number = |i: usize| cloud.user_number(i);
        let mass = |i: usize| system.density().at(i) * cloud.volumes()[i];
        let bonds = Bonds::new(system);
        let outermost = side.point(n, 0);
        let row = bonds.of(outermost);
        let strongest = max_norm(&row);
        // A weight that vanishes at the horizon, as for the conical function, may appear as round-off.
        let is_bond = |k: &usize| row[side.point(n, *k)].abs() > TOLERANCE * strongest;
        let reach = (1..n).rev().find(is_bond);
        let reach = reach.unwrap_or(0);
        if n < 2 * reach {
            return Err(AbsorbingError::LayerTooThin {
                side: side.name(),
                points: n,
                needed: reach,
            });
        }
        let weights: Vec<f64> = (1..=reach).map(|k| row[side.point(n, k)]).collect();
        let stencil = LatticeStencil::new(&weights)?;
        let points: Vec<usize> = (0..reach).map(|depth| side.point(n, depth)).collect();
        let scale = max_norm(&weights);
        for (p, &i) in points.iter().enumerate() {
            let found = mass(i);
            let expected = mass(outermost);
            if (found - expected).abs() > TOLERANCE * expected {
                return Err(AbsorbingError::LayerMass {
                    side: side.name(),
                    point: number(i),
                    found,
                    expected,
                });
            }
            let row = bonds.of(i);
            // Bonds within the layer; bonds to the body behind it are not restricted.
            for (q, &j) in points.iter().enumerate().filter(|&(q, _)| q != p) {
                let expected = weights[p.abs_diff(q) - 1];
                if (row[j] - expected).abs() > TOLERANCE * scale {
                    return Err(AbsorbingError::LayerBond {
                        side: side.name(),
                        from: number(i),
                        to: number(j),
                        found: row[j],
                        expected,
                        needed: reach,
                    });
                }
            }
        }
        let layer = Self {
            side,
            mass: mass(outermost),
            points,
            stencil,
            neglected: 0.0,
        };
        layer.check_lasting(system, no_fail)?;
        layer.check_linear(&bonds)?;
        layer.check_free(system)?;
        Ok(layer)
    }

    /// Prefix of the arrays in checkpoints.
    pub(super) fn name(&self) -> String {
        format!("absorbing/{}", self.side.name())
    }

    /// Computes the accelerations of the points, displaced by `own`, by their bonds to the ghosts 0, −1 … beyond.
    pub(super) fn pull_into(&self, own: &[f64], ghosts: &[f64], pull: &mut [f64]) {
        for (p, (pull, own)) in pull.iter_mut().zip(own).enumerate() {
            // A point p + 1 spacings from ghost 0 reaches ghosts 0 … K − p − 1.
            let bonds = self.stencil.weights()[p..].iter().zip(ghosts);
            *pull = bonds.map(|(a, ghost)| a * (ghost - own)).sum();
        }
    }

    /// Checks that no bond of the layer can break.
    fn check_lasting(&self, system: &System, no_fail: &[u32]) -> Result<(), AbsorbingError> {
        let held = |i: &usize| no_fail.binary_search(&(*i as u32)).is_ok();
        if system.operator().can_break() && !self.points.iter().all(held) {
            return Err(AbsorbingError::LayerBreakable {
                side: self.side.name(),
                needed: self.points.len(),
            });
        }
        Ok(())
    }

    /// Checks that the force of a displaced layer equals that of its tangent.
    fn check_linear(&self, bonds: &Bonds<'_>) -> Result<(), AbsorbingError> {
        let operator = bonds.system.operator();
        let mut u = bonds.rest.clone();
        let spacing = bonds.system.cloud().spacing();
        for (p, &i) in self.points.iter().enumerate() {
            // Small enough that bonds keep their direction.
            u[i] = spacing * (0.2 - 0.05 * (p % 5) as f64);
        }
        let mut tangent = bonds.rest.clone();
        operator.tangent_into(0.0, &bonds.rest, &u, &mut tangent);
        let mut force = bonds.rest.clone();
        operator.add_force(0.0, &u, PointSubset::All, &mut force);
        let scale = max_norm(&tangent);
        let differs = |&i: &usize| (force[i] - tangent[i]).abs() > 1e-9 * scale;
        match self.points.iter().find(|i| differs(i)) {
            None => Ok(()),
            Some(&point) => Err(AbsorbingError::NotLinear {
                side: self.side.name(),
                point: bonds.system.cloud().user_number(point),
            }),
        }
    }

    /// Checks that no load and no prescribed motion act on the layer.
    fn check_free(&self, system: &System) -> Result<(), AbsorbingError> {
        let loads = system.loads().iter().map(|load| ("a load", &load.points));
        let motions = system.motions().iter();
        let motions = motions.map(|motion| ("a prescribed motion", &motion.points));
        for (what, points) in loads.chain(motions) {
            let inside = |&i: &usize| points.binary_search(&(i as u32)).is_ok();
            if let Some(&point) = self.points.iter().find(|i| inside(i)) {
                return Err(AbsorbingError::LayerActedOn {
                    side: self.side.name(),
                    what,
                    point: system.cloud().user_number(point),
                    needed: self.points.len(),
                });
            }
        }
        Ok(())
    }

    /// Returns the largest value of a field in the layer relative to its largest value in the body.
    fn share_of(&self, field: &[f64], cloud: &PointCloud) -> Result<f64, AbsorbingError> {
        let largest = max_norm(field);
        let outer = self.points.iter().copied();
        let worst = outer.max_by(|&i, &j| field[i].abs().total_cmp(&field[j].abs()));
        let Some((point, found)) = worst.map(|i| (i, field[i].abs())) else {
            return Ok(0.0);
        };
        if found > NEGLIGIBLE * largest {
            return Err(AbsorbingError::NotAtRest {
                side: self.side.name(),
                point: cloud.user_number(point),
                found,
                largest,
            });
        }
        Ok(if found > 0.0 { found / largest } else { 0.0 })
    }
}

fn check_bar(cloud: &PointCloud) -> Result<(), AbsorbingError> {
    let dimension = cloud.dimension();
    if dimension != 1 {
        return Err(AbsorbingError::NotABar { dimension });
    }
    if cloud.is_periodic() {
        return Err(AbsorbingError::Periodic);
    }
    let gap = |i: &usize| {
        let apart = cloud.axis(0)[i + 1] - cloud.axis(0)[*i];
        (apart - cloud.spacing()).abs() > 1e-6 * cloud.spacing()
    };
    match (0..cloud.len() - 1).find(gap) {
        Some(point) => Err(AbsorbingError::NotRegular {
            point: cloud.user_number(point),
        }),
        None => Ok(()),
    }
}

/// Bonds of a body's points, derived from its tangent at rest.
struct Bonds<'a> {
    system: &'a System,
    rest: Vec<f64>,
}

impl<'a> Bonds<'a> {
    fn new(system: &'a System) -> Self {
        let rest = vec![0.0; system.points()];
        Self { system, rest }
    }

    /// Returns k/ρ of the bonds from point i to every other point, 1/s².
    fn of(&self, i: usize) -> Vec<f64> {
        let mut unit = self.rest.clone();
        unit[i] = 1.0;
        let mut row = self.rest.clone();
        let operator = self.system.operator();
        operator.tangent_into(0.0, &self.rest, &unit, &mut row);
        for (j, entry) in row.iter_mut().enumerate() {
            *entry /= self.system.density().at(j);
        }
        row
    }
}
