//! Construction of the bonds of a lattice body: geometry, pre-cracks, points without bond failure.

use std::sync::Arc;

use rayon::prelude::*;

use super::layout::GridLayout;
use super::stencil::{BondRule, Stencil};
use crate::error::{PericlesError, Result};
use crate::family::{BondCut, Crack, EndRule, VolumeCorrection};
use crate::lanes::LANES;
use crate::operator::damage::{BlockDamage, bonds_left};
use crate::operator::{BondForm, Feature, Features};
use crate::space::{PointCloud, Sites, check_points};

/// Initial bonds of a lattice body.
pub(in crate::operator) struct LatticeBonds<const D: usize> {
    pub sites: Sites,
    pub layout: GridLayout,
    pub stencil: Stencil<D>,
    /// Intact bonds: one byte per chunk and offset, offsets fastest.
    pub blocks: Vec<BlockDamage>,
    /// All bonds before pre-cracks, as in `blocks`, if points have different horizons or pieces.
    pub geometric: Option<Vec<Vec<u8>>>,
    /// Sites whose bonds never break, one byte per place (in chunks).
    pub held: Option<Vec<u8>>,
    /// Bonds removed by each pre-crack.
    pub cuts: Vec<BondCut>,
    /// Bonds cut by pre-cracks: groups in ascending order with bits of their bonds.
    pub precut: Vec<(u64, u8)>,
}

impl<const D: usize> LatticeBonds<D> {
    /// Creates the bonds within a horizon without those cut by cracks. The stencil stores `stiffness` times
    /// κ V of the neighbour for each vector ξ. If `horizons` gives a horizon for each point, none larger than
    /// the first argument, a bond exists within the larger horizon of its ends. Points of different pieces have
    /// no bonds.
    ///
    /// # Errors
    /// A cloud without a lattice or of another dimension, a horizon without neighbours, an invalid crack,
    /// points `no_fail` that do not exist in the cloud.
    pub fn new(
        cloud: &Arc<PointCloud>,
        (horizon, horizons): (f64, Option<&[f64]>),
        correction: VolumeCorrection,
        stiffness: &dyn Fn([f64; 3]) -> f64,
        cracks: &[(Crack, EndRule)],
        no_fail: &[u32],
    ) -> Result<Self> {
        let no_lattice = cloud.lattice().is_none();
        BondForm::Grid.check(Features::default().with(Feature::NoLattice, no_lattice))?;
        let lattice = match cloud.lattice() {
            Some(lattice) if cloud.dimension() == D => lattice,
            _ => {
                return Err(PericlesError::WrongDimension {
                    what: "this stencil kernel",
                    needed: ["1", "2", "3"][D - 1],
                    dimension: cloud.dimension(),
                });
            }
        };
        check_points("the points whose bonds never break", no_fail, cloud.len())?;
        let spacing = cloud.spacing();
        // A process may have no points.
        let volume = cloud.volumes().first().copied().unwrap_or(0.0);
        let volume = cloud.domain().max(volume);
        let rule = BondRule {
            reach: correction.reach(horizon, spacing),
            volume: &|r| correction.factor(r, horizon, spacing) * volume,
            stiffness,
        };
        let mut sites = Sites::new(cloud, rule.reach)?;
        let lattice = sites.places().lattice().unwrap_or(lattice);
        let layout = GridLayout::new(&sites, lattice);
        let stencil = Stencil::<D>::new(lattice, layout.strides(), &rule);
        let mut blocks = geometric_blocks(&layout, &stencil);
        let of_site = horizons.map(|horizons| sites.spread(horizons));
        let geometric = (of_site.is_some() || cloud.has_pieces()).then(|| {
            let places = sites.places();
            let reach = |a: usize, b: usize| match &of_site {
                _ if places.piece(a) != places.piece(b) => 0.0,
                Some(of_site) => correction.reach(of_site[a].max(of_site[b]), spacing),
                None => rule.reach,
            };
            keep_within(&sites, &layout, &stencil, &reach, &mut blocks);
            blocks.iter().map(|block| block.intact.clone()).collect()
        });
        drop(of_site);
        if cloud.domain().all(bonds_left(&blocks) == 0) {
            return Err(PericlesError::HorizonTooSmall { horizon, spacing });
        }
        let cuts = cracks
            .iter()
            .map(|crack| cut(&sites, &layout, &stencil, crack, &mut blocks))
            .collect::<Result<Vec<_>>>()?;
        let precut = if cuts.iter().any(|cut| !cut.points.is_empty()) {
            precut_bonds(&layout, &stencil, &blocks, geometric.as_deref())
        } else {
            Vec::new()
        };
        // The kernel needs positions for output and tangents only.
        sites.release_places();
        Ok(Self {
            held: held_sites(cloud, &layout, no_fail),
            sites,
            layout,
            stencil,
            blocks,
            geometric,
            cuts,
            precut,
        })
    }
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
fn geometric_blocks<const D: usize>(layout: &GridLayout, stencil: &Stencil<D>) -> Vec<BlockDamage> {
    (0..layout.blocks())
        .into_par_iter()
        .map(|block| {
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            let mut intact = Vec::with_capacity(chunks.len() * stencil.len());
            for chunk in chunks {
                let bits = |&cell: &[i32; 3]| layout.neighbours(chunk, cell);
                intact.extend(stencil.cells().iter().map(bits));
            }
            BlockDamage::new(intact)
        })
        .collect()
}

/// Removes bonds longer than the reach of their two sites.
fn keep_within<const D: usize>(
    sites: &Sites,
    layout: &GridLayout,
    stencil: &Stencil<D>,
    reach: &(dyn Fn(usize, usize) -> f64 + Sync),
    blocks: &mut [BlockDamage],
) {
    let m = stencil.len();
    blocks
        .par_iter_mut()
        .enumerate()
        .for_each(|(block, state)| {
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            for (chunk, intact) in chunks.iter().zip(state.intact.chunks_mut(m)) {
                for (lane, i) in chunk.points() {
                    let here = sites.of_point(i);
                    let place = chunk.place as usize * LANES + lane;
                    for (k, offset) in stencil.offsets().iter().enumerate() {
                        if intact[k] >> lane & 1 == 1 {
                            let there = layout.site_at(place.wrapping_add_signed(offset.shift));
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
fn cut<const D: usize>(
    sites: &Sites,
    layout: &GridLayout,
    stencil: &Stencil<D>,
    (crack, rule): &(Crack, EndRule),
    blocks: &mut [BlockDamage],
) -> Result<BondCut> {
    if crack.dimension() != D {
        return Err(PericlesError::WrongDimension {
            what: "this crack",
            needed: ["1", "2", "3"][crack.dimension() - 1],
            dimension: D,
        });
    }
    let spacing = sites.cloud().spacing();
    let cutter = crack.cutter(*rule, 1e-9 * spacing)?;
    let longest = stencil.lengths().iter().copied().fold(0.0, f64::max);
    let near = longest + 1e-6 * spacing;
    let removed: Vec<Vec<(u32, u64)>> = blocks
        .par_iter_mut()
        .enumerate()
        .map(|(block, state)| {
            let mut removed = Vec::new();
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            for (chunk, intact) in chunks.iter().zip(state.intact.chunks_mut(stencil.len())) {
                for (lane, i) in chunk.points() {
                    let here = sites.of_point(i);
                    let place = chunk.place as usize * LANES + lane;
                    // The crack has images beyond periodic faces.
                    let alone = sites.are_points();
                    if alone && crack.distance(sites.places().point(here)) > near {
                        continue;
                    }
                    let mut count = 0;
                    for (mask, offset) in intact.iter_mut().zip(stencil.offsets()) {
                        if *mask >> lane & 1 == 0 {
                            continue;
                        }
                        let there = layout.site_at(place.wrapping_add_signed(offset.shift));
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
fn precut_bonds<const D: usize>(
    layout: &GridLayout,
    stencil: &Stencil<D>,
    blocks: &[BlockDamage],
    geometric: Option<&[Vec<u8>]>,
) -> Vec<(u64, u8)> {
    let m = stencil.len();
    let lost: Vec<Vec<(u64, u8)>> = blocks
        .par_iter()
        .enumerate()
        .map(|(block, state)| {
            let mut lost = Vec::new();
            for (k, number) in layout.chunks_of(block).enumerate() {
                let chunk = &layout.chunks()[number];
                for (offset, &cell) in stencil.cells().iter().enumerate() {
                    let family = match geometric {
                        None => layout.neighbours(chunk, cell),
                        Some(geometric) => geometric[block][k * m + offset],
                    };
                    let bits = family & !state.intact[k * m + offset];
                    if bits != 0 {
                        lost.push(((number * m + offset) as u64, bits));
                    }
                }
            }
            lost
        })
        .collect();
    lost.concat()
}
