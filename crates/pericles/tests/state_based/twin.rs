//! A linear peridynamic solid computed from its definition, bond by bond in scalar arithmetic.

use pericles::family::BondList;
use pericles::kernel::Influence;
use pericles::space::PointCloud;

/// A body; the constants A and B are the same everywhere.
pub struct Twin<'a> {
    pub cloud: &'a PointCloud,
    pub bonds: &'a BondList,
    pub influence: &'a Influence,
    pub horizon: f64,
    pub dilatational: f64,
    pub deviatoric: f64,
    /// Returns whether the bond between two points is unbroken.
    pub intact: &'a dyn Fn(usize, usize) -> bool,
}

/// A bond: length, extension, unit vector along the deformed bond, ω.
struct Bond {
    r: f64,
    extension: f64,
    normal: Vec<f64>,
    weight: f64,
}

impl Twin<'_> {
    fn bond(&self, u: &[f64], i: usize, j: usize) -> Bond {
        let (n, dimension) = (self.cloud.len(), self.cloud.dimension());
        let xi = self.bonds.vector(i, j);
        let y: Vec<f64> = (0..dimension)
            .map(|c| xi[c] + u[c * n + j] - u[c * n + i])
            .collect();
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (r, now) = (length(&xi[..dimension]), length(&y));
        Bond {
            r,
            extension: now - r,
            normal: y.iter().map(|y| y / now).collect(),
            weight: self.influence.alpha_of(xi, self.horizon)
                * self.bonds.volume_factor(i, j)
                * self.cloud.volumes()[j],
        }
    }

    fn family(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let family = self.bonds.family(i);
        let present = family.filter(|&(entry, _)| self.bonds.is_present(entry));
        present.map(|(_, j)| j)
    }

    /// m of a point over all bonds that exist at the start.
    pub fn weighted_volume(&self, i: usize) -> f64 {
        let rest = vec![0.0; self.cloud.dimension() * self.cloud.len()];
        self.family(i)
            .map(|j| self.bond(&rest, i, j))
            .map(|bond| bond.weight * bond.r * bond.r)
            .sum()
    }

    /// θ of every point.
    pub fn dilatations(&self, u: &[f64]) -> Vec<f64> {
        let dilatation = |i: usize| {
            let left = self.family(i).filter(|&j| (self.intact)(i, j));
            let sum: f64 = left
                .map(|j| self.bond(u, i, j))
                .map(|bond| bond.weight * bond.r * bond.extension)
                .sum();
            self.cloud.dimension() as f64 * sum / self.weighted_volume(i)
        };
        (0..self.cloud.len()).map(dilatation).collect()
    }

    /// f_i = Σ ω [t_ij/w + t_ji/w] M
    pub fn force(&self, u: &[f64]) -> Vec<f64> {
        let (n, theta) = (self.cloud.len(), self.dilatations(u));
        let m: Vec<f64> = (0..n).map(|i| self.weighted_volume(i)).collect();
        let mut force = vec![0.0; u.len()];
        for i in 0..n {
            for j in self.family(i).filter(|&j| (self.intact)(i, j)) {
                let bond = self.bond(u, i, j);
                let state = |k: usize| {
                    (self.dilatational * theta[k] * bond.r + self.deviatoric * bond.extension)
                        / m[k]
                };
                let pull = bond.weight * (state(i) + state(j));
                for (c, normal) in bond.normal.iter().enumerate() {
                    force[c * n + i] += pull * normal;
                }
            }
        }
        force
    }

    /// Σ W V
    pub fn energy(&self, u: &[f64]) -> f64 {
        let theta = self.dilatations(u);
        let density = |i: usize| {
            let left = self.family(i).filter(|&j| (self.intact)(i, j));
            let squares: f64 = left
                .map(|j| self.bond(u, i, j))
                .map(|bond| bond.weight * bond.extension * bond.extension)
                .sum();
            let bulk = self.dilatational / self.cloud.dimension() as f64;
            0.5 * bulk * theta[i] * theta[i]
                + 0.5 * self.deviatoric / self.weighted_volume(i) * squares
        };
        let volumes = self.cloud.volumes();
        (0..self.cloud.len()).map(|i| volumes[i] * density(i)).sum()
    }
}
