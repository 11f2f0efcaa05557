//! Construction of the bonds of a lattice body: geometry, pre-cracks, points without bond failure.

use std::sync::Arc;

use rayon::prelude::*;

use super::Lattice;
use super::layout::GridLayout;
use super::stencil::Stencil;
use crate::error::{PericlesError, Result};
use crate::family::{BondCut, Crack, EndRule, VolumeCorrection};
use crate::lanes::LANES;
use crate::space::{PointCloud, Sites, check_points};

/// The reason why other points have no stencil.
pub(crate) const NO_LATTICE: &str = "the points do not lie on a regular grid; use bonds = \"list\"";

impl Lattice {
    /// Creates the bonds within a horizon without those cut by cracks; bonds of the points `no_fail` never break. If
    /// `horizons` gives a horizon for each point, none larger than the first argument, a bond exists within the larger
    /// horizon of its ends. Points of different pieces have no bonds.
    ///
    /// # Errors
    /// A cloud without a lattice, a horizon without neighbours, an invalid crack, points `no_fail` that do not exist in the
    /// cloud.
    pub fn new(
        cloud: &Arc<PointCloud>,
        (horizon, horizons): (f64, Option<&[f64]>),
        correction: VolumeCorrection,
        cracks: &[(Crack, EndRule)],
        no_fail: &[u32],
    ) -> Result<Self> {
        let Some(lattice) = cloud.lattice() else {
            let form = "grid";
            let reason = NO_LATTICE;
            return Err(PericlesError::FormNotUsable { form, reason });
        };
        check_points("the points whose bonds never break", no_fail, cloud.len())?;
        let spacing = cloud.spacing();
        // A process may have no points.
        let volume = cloud.volumes().first().copied().unwrap_or(0.0);
        let volume = cloud.domain().max(volume);
        let longest = correction.reach(horizon, spacing);
        let mut sites = Sites::new(cloud, longest)?;
        let lattice = sites.places().lattice().unwrap_or(lattice);
        let layout = GridLayout::new(&sites, lattice);
        let stencil = Stencil::new(lattice, layout.strides(), longest, &|r| {
            correction.factor(r, horizon, spacing) * volume
        });
        let mut bits = geometric_bits(&layout, &stencil);
        let of_site = horizons.map(|horizons| sites.spread(horizons));
        let geometric = (of_site.is_some() || cloud.has_pieces()).then(|| {
            let places = sites.places();
            let reach = |a: usize, b: usize| match &of_site {
                _ if places.piece(a) != places.piece(b) => 0.0,
                Some(of_site) => correction.reach(of_site[a].max(of_site[b]), spacing),
                None => longest,
            };
            keep_within(&sites, &layout, &stencil, &reach, &mut bits);
            bits.clone()
        });
        drop(of_site);
        if cloud.domain().all(count(&bits) == 0) {
            return Err(PericlesError::HorizonTooSmall { horizon, spacing });
        }
        let cuts = cracks
            .iter()
            .map(|crack| cut(&sites, &layout, &stencil, crack, &mut bits))
            .collect::<Result<Vec<_>>>()?;
        let precut = if cuts.iter().any(|cut| !cut.points.is_empty()) {
            precut_bonds(&layout, &stencil, &bits, geometric.as_deref())
        } else {
            Vec::new()
        };
        // Forces need positions for output and tangents only.
        sites.release_places();
        Ok(Self {
            directed_bonds: count(&bits),
            held: held_sites(cloud, &layout, no_fail),
            sites,
            layout: Arc::new(layout),
            stencil,
            geometric,
            cuts,
            precut,
        })
    }
}

/// Returns the number of set bits.
fn count(bits: &[Vec<u8>]) -> u64 {
    let bytes = bits.iter().flatten();
    bytes.map(|byte| u64::from(byte.count_ones())).sum()
}

/// Returns the sites whose bonds never break, one byte per place (in chunks); `None` if there are no such
/// points.
fn held_sites(cloud: &PointCloud, layout: &GridLayout, no_fail: &[u32]) -> Option<Vec<u8>> {
    let domain = cloud.domain();
    if domain.all(no_fail.is_empty()) {
        return None;
    }
    let mut held = vec![false; cloud.len()];
    for &i in no_fail {
        held[i as usize] = true;
    }
    let held = domain.marks_with_ghosts(&held);
    Some(layout.marked(|point| held[point]))
}

/// Returns all bonds of the geometric families.
fn geometric_bits(layout: &GridLayout, stencil: &Stencil) -> Vec<Vec<u8>> {
    (0..layout.blocks())
        .into_par_iter()
        .map(|block| {
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            let mut intact = Vec::with_capacity(chunks.len() * stencil.len());
            for chunk in chunks {
                let bits = |&cell: &[i32; 3]| layout.neighbours(chunk, cell);
                intact.extend(stencil.cells().iter().map(bits));
            }
            intact
        })
        .collect()
}

/// Removes bonds longer than the reach of their two sites.
fn keep_within(
    sites: &Sites,
    layout: &GridLayout,
    stencil: &Stencil,
    reach: &(dyn Fn(usize, usize) -> f64 + Sync),
    bits: &mut [Vec<u8>],
) {
    let m = stencil.len();
    bits.par_iter_mut().enumerate().for_each(|(block, bits)| {
        let chunks = &layout.chunks()[layout.chunks_of(block)];
        for (chunk, intact) in chunks.iter().zip(bits.chunks_mut(m)) {
            for (lane, i) in chunk.points() {
                let here = sites.of_point(i);
                let place = chunk.place as usize * LANES + lane;
                for (k, &shift) in stencil.shifts().iter().enumerate() {
                    if intact[k] >> lane & 1 == 1 {
                        let there = layout.site_at(place.wrapping_add_signed(shift));
                        if stencil.lengths()[k] > reach(here, there) {
                            intact[k] &= !(1 << lane);
                        }
                    }
                }
            }
        }
    });
}

/// Removes the bonds that intersect a crack.
///
/// # Errors
/// A crack without extent or of another dimension than the cloud.
fn cut(
    sites: &Sites,
    layout: &GridLayout,
    stencil: &Stencil,
    (crack, rule): &(Crack, EndRule),
    bits: &mut [Vec<u8>],
) -> Result<BondCut> {
    let dimension = sites.cloud().dimension();
    if crack.dimension() != dimension {
        return Err(PericlesError::WrongDimension {
            what: "this crack",
            needed: ["1", "2", "3"][crack.dimension() - 1],
            dimension,
        });
    }
    let spacing = sites.cloud().spacing();
    let cutter = crack.cutter(*rule, 1e-9 * spacing)?;
    let longest = stencil.lengths().iter().copied().fold(0.0, f64::max);
    let near = longest + 1e-6 * spacing;
    let removed: Vec<Vec<(u32, u64)>> = bits
        .par_iter_mut()
        .enumerate()
        .map(|(block, bits)| {
            let mut removed = Vec::new();
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            for (chunk, intact) in chunks.iter().zip(bits.chunks_mut(stencil.len())) {
                for (lane, i) in chunk.points() {
                    let here = sites.of_point(i);
                    let place = chunk.place as usize * LANES + lane;
                    // The crack has images beyond periodic faces.
                    let alone = sites.are_points();
                    if alone && crack.distance(sites.places().point(here)) > near {
                        continue;
                    }
                    let mut count = 0;
                    for (mask, &shift) in intact.iter_mut().zip(stencil.shifts()) {
                        if *mask >> lane & 1 == 0 {
                            continue;
                        }
                        let there = layout.site_at(place.wrapping_add_signed(shift));
                        if cutter.cuts_bond(sites, here, there) {
                            *mask &= !(1 << lane);
                            count += 1;
                        }
                    }
                    if count > 0 {
                        removed.push((i as u32, count));
                    }
                }
            }
            removed
        })
        .collect();
    let directed = removed.iter().flatten().map(|&(_, count)| count).sum();
    let mut cut = BondCut {
        bonds: sites.cloud().domain().count(directed) / 2,
        points: removed.iter().flatten().map(|&(i, _)| i).collect(),
    };
    cut.points.sort_unstable();
    Ok(cut)
}

/// Returns the groups (chunk · offsets + offset) with bonds cut by cracks in ascending order, with these
/// bonds.
fn precut_bonds(
    layout: &GridLayout,
    stencil: &Stencil,
    bits: &[Vec<u8>],
    geometric: Option<&[Vec<u8>]>,
) -> Vec<(u64, u8)> {
    let m = stencil.len();
    let lost: Vec<Vec<(u64, u8)>> = bits
        .par_iter()
        .enumerate()
        .map(|(block, bits)| {
            let mut lost = Vec::new();
            for (k, number) in layout.chunks_of(block).enumerate() {
                let chunk = &layout.chunks()[number];
                for (offset, &cell) in stencil.cells().iter().enumerate() {
                    let family = match geometric {
                        None => layout.neighbours(chunk, cell),
                        Some(geometric) => geometric[block][k * m + offset],
                    };
                    let cut = family & !bits[k * m + offset];
                    if cut != 0 {
                        lost.push(((number * m + offset) as u64, cut));
                    }
                }
            }
            lost
        })
        .collect();
    lost.concat()
}
