//! Bond breaking on a surface.

use rayon::prelude::*;

use super::bonds::SurfaceBonds;
use super::law::SurfaceLaw;
use pericles::lanes::{F64x8, Real};
use pericles::neighbourhood::{CoarseBreak, PointDissipation, turns_around};
use pericles::operator::PointSubset;
use pericles::operator::records::Records;
use pericles::parallel::BLOCK;
use pericles::{Archive, BreakingBond, StepEnd, Values};
use pericles::{PericlesError, Result};

/// Broken bonds and the limits of the intact ones. A broken bond has weight zero.
pub(super) struct Breaking {
    /// (s d)² of every entry, m².
    pub limits: Vec<f64>,
    /// Broken entries, both directions of each bond, with their original weights.
    pub broken: Vec<(usize, f64)>,
    /// Dissipated energy, J.
    pub dissipated: f64,
    /// Its terms by points, half for each end of a bond.
    pub of_points: PointDissipation,
    /// Bonds broken in steps too coarse to resolve them, since the list was last taken.
    pub coarse: Vec<CoarseBreak>,
}

/// End of a step, as needed for breaking.
pub(super) struct Step<'a> {
    pub end: &'a StepEnd<'a>,
    pub areas: &'a [f64],
    pub reference: &'a Records,
    /// Marks of the points whose bonds are decided; `None` means all.
    pub partners: Option<&'a [bool]>,
}

/// Difference of a component-major field on n points: value at j minus value at i.
fn difference(field: &[f64], n: usize, i: usize, j: usize) -> [f64; 3] {
    std::array::from_fn(|c| field[c * n + j] - field[c * n + i])
}

/// Returns true if the bond of an entry is intact and |η|² exceeds a limit.
fn is_over(bonds: &SurfaceBonds, entry: usize, u: &[f64], [i, j]: [usize; 2], limit: f64) -> bool {
    let eta = difference(u, bonds.len(), i, j);
    eta.iter().map(|x| x * x).sum::<f64>() > limit && bonds.weights()[entry] != 0.0
}

impl Breaking {
    /// Marks the points with an intact bond stretched beyond a given fraction of its critical stretch.
    pub fn mark_endangered(
        &self,
        bonds: &SurfaceBonds,
        u: &[f64],
        fraction: f64,
        marks: &mut [bool],
    ) {
        let part = fraction * fraction;
        let near = |i: usize| {
            bonds
                .row(i)
                .any(|(entry, j)| is_over(bonds, entry, u, [i, j], part * self.limits[entry]))
        };
        marks
            .par_iter_mut()
            .enumerate()
            .with_min_len(BLOCK)
            .for_each(|(i, mark)| *mark = *mark || near(i));
    }

    /// Breaks the overstretched bonds of the points in `on`. Both ends of a bond compute the same |η|, bit for
    /// bit.
    pub fn decide<L: SurfaceLaw>(
        &mut self,
        law: L,
        bonds: &mut SurfaceBonds,
        step: &Step<'_>,
        on: &PointSubset<'_>,
    ) {
        let n = bonds.len();
        let over = |i: usize| {
            let (bonds, limits) = (&*bonds, &self.limits);
            let counts = |j: usize| step.partners.is_none_or(|marks| marks[j]);
            let over = move |&(entry, j): &(usize, usize)| {
                counts(j) && is_over(bonds, entry, step.end.u, [i, j], limits[entry])
            };
            let rows = bonds.row(i).filter(over);
            rows.map(move |(entry, j)| (i, entry, j))
        };
        let found: Vec<(usize, usize, usize)> = match on {
            PointSubset::All => (0..n)
                .into_par_iter()
                .with_min_len(BLOCK)
                .flat_map_iter(over)
                .collect(),
            PointSubset::Range(range) => range.clone().flat_map(over).collect(),
            PointSubset::Set(set) => set.iter().flat_map(|&i| over(i as usize)).collect(),
        };
        for (i, entry, j) in found {
            let weight = bonds.weights()[entry];
            if weight == 0.0 {
                continue;
            }
            let lanes = |x: [f64; 3]| x.map(F64x8::splat);
            let xi = if L::CHORD {
                std::array::from_fn(|c| step.reference[j][c] - step.reference[i][c])
            } else {
                [0.0; 3]
            };
            let eta = difference(step.end.u, n, i, j);
            // The elongation of a chord at critical |η| depends on the direction of η, so its energy there is
            // unknown.
            let critical = (!L::CHORD).then(|| {
                let square: f64 = eta.iter().map(|x| x * x).sum();
                let part = (self.limits[entry] / square).sqrt();
                law.energy(lanes(xi), lanes(eta.map(|x| part * x))).0[0]
            });
            let bond = BreakingBond {
                ends: [i, j],
                velocity: step.end.relative_velocity([i, j]),
                force: law.force(lanes(xi), lanes(eta)).map(|force| force.0[0]),
                energy: law.energy(lanes(xi), lanes(eta)).0[0],
                critical,
                weight: step.areas[i] * weight,
            };
            let (dissipated, coarse) =
                CoarseBreak::dissipated(step.end, &bond, |moved: [f64; 3]| {
                    let before = std::array::from_fn(|c| eta[c] - moved[c]);
                    let force = law.force(lanes(xi), lanes(before)).map(|force| force.0[0]);
                    let energy = law.energy(lanes(xi), lanes(before)).0[0];
                    turns_around(&xi, &before, &eta).then_some((force, energy))
                });
            self.dissipated += dissipated;
            for end in bond.ends {
                self.of_points.add(end, 0.5 * dissipated);
            }
            self.coarse.extend(coarse);
            self.cut(bonds, entry);
            let back = bonds.row(j).find(|&(_, other)| other == i);
            if let Some((back, _)) = back {
                self.cut(bonds, back);
            }
        }
    }

    fn cut(&mut self, bonds: &mut SurfaceBonds, entry: usize) {
        let weight = std::mem::take(&mut bonds.weights_mut()[entry]);
        self.broken.push((entry, weight));
    }

    pub fn save(&self, archive: &mut Archive) {
        let Self {
            broken,
            dissipated,
            limits: _,
            // Empty between steps.
            of_points: _,
            // Handled in every step; not saved.
            coarse: _,
        } = self;
        let entries = broken.iter().map(|&(entry, _)| entry as u64);
        archive.put("operator/broken", Values::U64(entries.collect()));
        archive.put("operator/dissipated", Values::F64(vec![*dissipated]));
    }

    pub fn restore(&mut self, bonds: &mut SurfaceBonds, archive: &Archive) -> Result<()> {
        let entries = archive.u64s("operator/broken")?;
        archive.f64_into(
            "operator/dissipated",
            std::slice::from_mut(&mut self.dissipated),
        )?;
        self.of_points.clear();
        // In reverse order: for an entry listed twice, the first weight is the original one.
        for (entry, weight) in self.broken.drain(..).rev() {
            bonds.weights_mut()[entry] = weight;
        }
        for &entry in entries {
            if entry as usize >= self.limits.len() {
                return Err(PericlesError::BadArchive {
                    reason: format!(
                        "it breaks bond {entry}, the model has {}",
                        self.limits.len()
                    ),
                });
            }
            self.cut(bonds, entry as usize);
        }
        Ok(())
    }
}
