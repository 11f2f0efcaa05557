//! Neighbour list of conductances, for any body.

use pericles::archive::Layout;
use pericles::family::BondList;
use pericles::lanes::{InstructionSet, LANES};
use pericles::parallel::{PointSubset, for_each_chunk_of, for_each_point};
use pericles::{PericlesError, Result};

use super::surface::{Visit, direction};
use super::{Bond, Bonds, DiffusionBody, with_ghosts};
use crate::calibration::PairConductivity;

/// A neighbour list with the conductance of each entry.
pub(super) struct ListBonds {
    list: BondList,
    /// Conductance of each entry, W/K; zero for padding.
    whole: Vec<f64>,
    /// Present conductance of each entry, W/K.
    present: Vec<f64>,
    /// Intact bonds, one byte per group.
    intact: Vec<u8>,
    share: f64,
}

impl ListBonds {
    pub fn new(body: &DiffusionBody, list: BondList) -> Result<Self> {
        let cloud = list.sites().cloud();
        let n = cloud.len();
        let domain = cloud.domain();
        // The other end of a bond may be a ghost.
        let horizons = body.horizons.as_ref().map(|own| domain.with_ghosts(own));
        let horizons = horizons.as_deref();
        let conductivity = with_ghosts(domain, &body.conductivity);
        // Points have few different horizons.
        let mut values: Vec<f64> = horizons.map_or(vec![body.horizon], <[f64]>::to_vec);
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        let calibrations: Result<Vec<PairConductivity>> = values
            .iter()
            .map(|&horizon| body.calibration(horizon))
            .collect();
        let calibrations = domain.agreed(calibrations)?;
        let of_point = |i: usize| match horizons {
            None => &calibrations[0],
            Some(horizons) => &calibrations[values.partition_point(|h| *h < horizons[i])],
        };
        // κ of a bond for unit conductivity, with the partial volume: the mean of the values of both ends.
        let kappa = |i: usize, site: usize| {
            let (here, j) = (list.site(i), list.sites().point(site));
            let xi = list.vector(here, site);
            match horizons {
                None => list.volume_factor(here, site) * of_point(i).value(xi),
                Some(_) => {
                    let ends = [(i, here, site), (j, site, here)];
                    let of_end = |(point, a, b)| list.end_factor(a, b) * of_point(point).value(xi);
                    0.5 * ends.map(of_end).iter().sum::<f64>()
                }
            }
        };
        // κ V of each entry for unit conductivity.
        let rows = for_each_point(n, &|i| {
            let mut row = vec![0.0; list.groups(i).len() * LANES];
            let first = list.groups(i).start * LANES;
            for (entry, site) in list.family(i) {
                row[entry - first] = kappa(i, site) * list.volume(site);
            }
            row
        });
        let mut whole = rows.concat();
        let for_each_bond = |i: usize, visit: &mut Visit<'_>| {
            for (entry, site) in list.family(i) {
                let xi = list.vector(list.site(i), site);
                visit(list.sites().point(site), xi, whole[entry]);
            }
        };
        let surface = body.surface_factors(&for_each_bond);
        let scales = for_each_point(n, &|i| {
            let scales = list.family(i).map(|(entry, site)| {
                let j = list.sites().point(site);
                let k = body.interface.mean(conductivity.at(i), conductivity.at(j));
                let factor = surface.as_ref().map_or(1.0, |surface| {
                    let xi = list.vector(list.site(i), site);
                    surface.of_bond(i, j, &direction(cloud.dimension(), xi))
                });
                (entry, k * factor * cloud.volumes()[i])
            });
            scales.collect::<Vec<_>>()
        });
        for (entry, scale) in scales.into_iter().flatten() {
            whole[entry] *= scale;
        }
        Ok(Self {
            present: whole.clone(),
            intact: list.geometric().to_vec(),
            whole,
            list,
            share: body.broken_share,
        })
    }

    fn set(&mut self, entry: usize, intact: bool) {
        let bit = 1 << (entry % LANES);
        let byte = &mut self.intact[entry / LANES];
        *byte = if intact { *byte | bit } else { *byte & !bit };
        self.present[entry] = match intact {
            true => self.whole[entry],
            false => self.share * self.whole[entry],
        };
    }
}

impl Bonds for ListBonds {
    fn add_flow(&self, values: &[f64], _set: InstructionSet, out: &mut [f64]) {
        let at_sites = self.list.sites().spread(values);
        for_each_chunk_of(out, self.list.cost(&PointSubset::All), &|first, out| {
            for (k, out) in out.iter_mut().enumerate() {
                let i = first + k;
                let here = values[i];
                let mut sum = [0.0; LANES];
                for group in self.list.groups(i) {
                    let there = self.list.group(group);
                    let conductance = &self.present[group * LANES..(group + 1) * LANES];
                    for lane in 0..LANES {
                        sum[lane] += conductance[lane] * (at_sites[there[lane]] - here);
                    }
                }
                *out += ((sum[0] + sum[4]) + (sum[2] + sum[6]))
                    + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
            }
        });
    }

    fn for_each_bond(&self, i: usize, visit: &mut dyn FnMut(Bond)) {
        for (entry, site) in self.list.family(i) {
            visit(Bond {
                neighbour: self.list.sites().point(site),
                xi: self.list.vector(self.list.site(i), site),
                conductance: self.present[entry],
            });
        }
    }

    fn set_intact(&mut self, i: usize, is_intact: &dyn Fn(usize) -> bool) {
        let family: Vec<_> = self.list.family(i).collect();
        for (entry, site) in family {
            let intact = is_intact(self.list.sites().point(site));
            self.set(entry, intact);
        }
    }

    /// One byte per group: groups do not depend on the division among processes.
    fn intact(&self) -> (Vec<u8>, Layout) {
        let layout = Layout::rows(self.list.start(), self.intact.len());
        (self.intact.clone(), layout)
    }

    fn restore_intact(&mut self, intact: &[u8]) -> Result<()> {
        let family = self.list.geometric();
        let fits =
            intact.len() == family.len() && intact.iter().zip(family).all(|(a, b)| a & !b == 0);
        if !fits {
            let reason = "its conducting bonds are not bonds of the body".into();
            return Err(PericlesError::BadArchive { reason });
        }
        for i in 0..self.list.len() {
            let family: Vec<_> = self.list.family(i).collect();
            for (entry, _) in family {
                self.set(entry, intact[entry / LANES] >> (entry % LANES) & 1 == 1);
            }
        }
        Ok(())
    }

    fn directed_bonds(&self) -> u64 {
        self.list.directed_bonds()
    }

    fn bytes(&self) -> usize {
        self.list.bytes() + 2 * size_of_val(&self.whole[..]) + self.intact.len()
    }
}
