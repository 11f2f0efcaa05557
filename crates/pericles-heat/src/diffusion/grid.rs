//! Stencil of conductances, for lattice bodies.

use pericles::archive::Layout;
use pericles::domain::Domain;
use pericles::lanes::{InstructionSet, LANES};
use pericles::operator::pool::Pool;
use pericles::parallel::Cost;
use pericles::space::Sites;
use pericles::{PericlesError, Result};
use rayon::prelude::*;

use super::frame::Frame;
use super::kernels::{Chunk, Stencil, add_chunks};
use super::surface::{SurfaceFactors, Visit, direction};
use super::{Bond, Bonds, DiffusionBody, Interface, with_ghosts};
use crate::calibration::{PairConductivity, cell_volume, for_each_offset};

/// Marks a place without a site.
const NONE: u32 = u32::MAX;

/// Offsets per byte in checkpoints.
const BITS: usize = u8::BITS as usize;

/// Number of chunks that a thread computes at a time.
const TASK: usize = 64;

/// Bonds of a lattice body. The rows along x of the box of all sites are padded to whole chunks of eight nodes, so that
/// a neighbour is a fixed number of places away. Ghosts of other processes have places too; no flow into them is computed.
pub(super) struct GridBonds {
    chunks: Vec<Chunk>,
    /// Point at each place, ghosts after own points, or [`NONE`].
    points: Vec<u32>,
    /// Chunk and lane of each point.
    slots: Vec<(u32, u8)>,
    margin: usize,
    shifts: Vec<isize>,
    vectors: Vec<[f64; 3]>,
    /// κ V V of each offset for unit conductivity.
    weights: Vec<f64>,
    /// Conductivity or its inverse at places, with margins.
    material: Vec<f64>,
    /// Fields of [`SurfaceFactors`] at places, with margins; none if all families are complete.
    surface: Vec<Vec<f64>>,
    /// Coefficients of the tensors for each offset.
    directions: Vec<[f64; 6]>,
    interface: Interface,
    /// Bonds of the family, one byte per chunk and offset.
    family: Vec<u8>,
    intact: Vec<u8>,
    share: f64,
    work: Pool<Vec<f64>>,
    domain: Domain,
}

impl GridBonds {
    pub fn new(body: &DiffusionBody, calibration: PairConductivity) -> Result<Self> {
        let cloud = &body.cloud;
        let d = cloud.dimension();
        let (cell, volume) = (cloud.spacing(), cell_volume(cloud));
        let reach = body.correction.reach(body.horizon, cell);
        let sites = Sites::new(cloud, reach)?;
        let lattice = sites.places().lattice();
        let lattice = lattice.ok_or(PericlesError::BadArchive {
            reason: "the body has no lattice".into(),
        })?;
        let frame = Frame::new(&sites, lattice);
        let places = frame.places;
        let mut site_at = vec![NONE; places];
        for (site, place) in frame.site_places().enumerate() {
            site_at[place] = site as u32;
        }
        let (mut shifts, mut steps, mut vectors, mut weights) = (vec![], vec![], vec![], vec![]);
        for_each_offset(lattice.spacing, d, reach, &mut |step, xi, r| {
            let weight = calibration.value(xi)
                * body.correction.factor(r, body.horizon, cell)
                * volume
                * volume;
            if weight > 0.0 {
                shifts.push(frame.shift(step));
                steps.push(step);
                vectors.push(xi);
                weights.push(weight);
            }
        });
        if shifts.is_empty() {
            return Err(PericlesError::HorizonTooSmall {
                horizon: body.horizon,
                spacing: cell,
            });
        }
        let farthest = shifts
            .iter()
            .map(|shift| shift.unsigned_abs())
            .max()
            .unwrap_or(0);
        let margin = (farthest + LANES).next_multiple_of(LANES);
        let (chunks, slots) = frame.chunks(&sites);
        let piece = |site: usize| sites.places().piece(site);
        let bits = |chunk: &Chunk, step: [i32; 3]| -> u8 {
            let mut bits = 0;
            for lane in (0..LANES).filter(|lane| chunk.lanes >> lane & 1 == 1) {
                let before = (chunk.lanes & !(0xFF << lane)).count_ones() as usize;
                let here = sites.of_point(chunk.point as usize + before);
                let there = frame.place_beside(here, step);
                let there = there.map_or(NONE, |place| site_at[place]);
                if there != NONE && piece(there as usize) == piece(here) {
                    bits |= 1 << lane;
                }
            }
            bits
        };
        let family: Vec<u8> = chunks
            .par_iter()
            .flat_map_iter(|chunk| {
                steps
                    .iter()
                    .map(|&step| bits(chunk, step))
                    .collect::<Vec<_>>()
            })
            .collect();
        let point = |&site: &u32| match site {
            NONE => NONE,
            site => sites.point(site as usize) as u32,
        };
        let points: Vec<u32> = site_at.iter().map(point).collect();
        drop(site_at);
        let length = places + 2 * margin;
        let mut bonds = Self {
            intact: family.clone(),
            family,
            surface: Vec::new(),
            directions: vectors.iter().map(|&xi| direction(d, xi)).collect(),
            work: Pool::new(1, move || vec![0.0; length]),
            domain: cloud.domain().clone(),
            interface: body.interface,
            share: body.broken_share,
            chunks,
            slots,
            margin,
            shifts,
            vectors,
            weights,
            material: Vec::new(),
            points,
        };
        let conductivity = with_ghosts(cloud.domain(), &body.conductivity);
        bonds.material = bonds.padded(1.0, &|i| match body.interface {
            Interface::Harmonic => 1.0 / conductivity.at(i),
            Interface::Arithmetic => conductivity.at(i),
        });
        let for_each_bond = |i: usize, visit: &mut Visit<'_>| {
            for (_, k, _) in bonds.family_of(i) {
                visit(
                    bonds.other_end(i, k),
                    bonds.vectors[k],
                    bonds.weights[k] / volume,
                );
            }
        };
        let factors = body.surface_factors(&for_each_bond);
        let fields = factors.iter().flat_map(SurfaceFactors::fields);
        let fields = fields.map(|field| bonds.padded(0.0, &|i| field[i]));
        bonds.surface = fields.collect();
        bonds.find_plain();
        frame.agree_on_plain(cloud.domain(), &mut bonds.chunks);
        Ok(bonds)
    }

    /// Returns a field at places with margins, `elsewhere` at places without a site.
    fn padded(&self, elsewhere: f64, of_point: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let mut field = vec![elsewhere; self.points.len() + 2 * self.margin];
        let places = field[self.margin..].iter_mut().zip(&self.points);
        for (value, &point) in places.filter(|(_, point)| **point != NONE) {
            *value = of_point(point as usize);
        }
        field
    }

    /// Marks the chunks whose bonds all have the same conductivity.
    fn find_plain(&mut self) {
        let m = self.shifts.len();
        let (material, margin) = (&self.material, self.margin);
        let incomplete = self.surface.first();
        let is_complete = |place: usize| incomplete.is_none_or(|field| field[place] == 0.0);
        let (family, shifts) = (&self.family, &self.shifts);
        self.chunks
            .par_iter_mut()
            .enumerate()
            .for_each(|(number, chunk)| {
                let at = chunk.place as usize + margin;
                let lanes = (0..LANES).filter(|lane| chunk.lanes >> lane & 1 == 1);
                chunk.is_plain = lanes.into_iter().all(|lane| {
                    let here = material[at + lane];
                    let bonds = shifts.iter().zip(&family[number * m..(number + 1) * m]);
                    let mut present = bonds.filter(|(_, bits)| *bits >> lane & 1 == 1);
                    is_complete(at + lane)
                        && present.all(|(&shift, _)| {
                            material[(at + lane).wrapping_add_signed(shift)] == here
                        })
                });
            });
    }

    /// Returns the entry, the offset and the lane of each bond of the family of a point.
    fn family_of(&self, i: usize) -> impl Iterator<Item = (usize, usize, u8)> + '_ {
        let m = self.shifts.len();
        let (chunk, lane) = self.slots[i];
        let first = chunk as usize * m;
        let family = self.family[first..first + m].iter().enumerate();
        let present = family.filter(move |(_, bits)| **bits >> lane & 1 == 1);
        present.map(move |(k, _)| (first + k, k, lane))
    }

    fn place_of(&self, i: usize) -> usize {
        let (chunk, lane) = self.slots[i];
        self.chunks[chunk as usize].place as usize + usize::from(lane)
    }

    fn other_end(&self, i: usize, k: usize) -> usize {
        self.points[self.place_of(i).wrapping_add_signed(self.shifts[k])] as usize
    }

    /// Adds the flows through the given bonds, times a factor.
    fn add(
        &self,
        values: &[f64],
        (bonds, scale): (&[u8], f64),
        set: InstructionSet,
        out: &mut [f64],
    ) {
        let stencil = Stencil {
            values,
            material: &self.material,
            surface: &self.surface,
            directions: &self.directions,
            interface: self.interface,
            margin: self.margin,
            shifts: &self.shifts,
            weights: &self.weights,
            scale,
        };
        let tasks = self.chunks.len().div_ceil(TASK);
        let least = Cost::bonds((LANES * bonds.len()) as u64).parts_per_task(tasks);
        self.split((&stencil, bonds, set), (0..tasks, least), out);
    }

    fn split(
        &self,
        work: (&Stencil<'_>, &[u8], InstructionSet),
        (tasks, least): (std::ops::Range<usize>, usize),
        out: &mut [f64],
    ) {
        let first = tasks.start * TASK;
        let end = (tasks.end * TASK).min(self.chunks.len());
        if tasks.len() <= least {
            let (stencil, bonds, set) = work;
            let m = self.shifts.len();
            let chunks = &self.chunks[first..end];
            let Some(chunk) = chunks.first() else { return };
            add_chunks(
                set,
                stencil,
                chunks,
                &bonds[first * m..end * m],
                chunk.point as usize,
                out,
            );
            return;
        }
        let middle = tasks.start + tasks.len() / 2;
        let points = (self.chunks[middle * TASK].point - self.chunks[first].point) as usize;
        let (low, high) = out.split_at_mut(points);
        pericles::parallel::join(
            || self.split(work, (tasks.start..middle, least), low),
            || self.split(work, (middle..tasks.end, least), high),
        );
    }

    fn set(&mut self, entry: usize, lane: u8, intact: bool) {
        let byte = &mut self.intact[entry];
        *byte = if intact {
            *byte | 1 << lane
        } else {
            *byte & !(1 << lane)
        };
    }
}

impl Bonds for GridBonds {
    fn add_flow(&self, values: &[f64], set: InstructionSet, out: &mut [f64]) {
        let values = self.domain.with_ghosts(values);
        let mut padded = self.work.take();
        let (margin, points) = (self.margin, &self.points);
        padded[margin..margin + points.len()]
            .par_chunks_mut(8 * TASK * LANES)
            .zip(points.par_chunks(8 * TASK * LANES))
            .for_each(|(padded, points)| {
                for (padded, &point) in padded.iter_mut().zip(points) {
                    if point != NONE {
                        *padded = values[point as usize];
                    }
                }
            });
        self.add(&padded, (&self.intact, 1.0 - self.share), set, out);
        if self.share > 0.0 {
            self.add(&padded, (&self.family, self.share), set, out);
        }
    }

    fn for_each_bond(&self, i: usize, visit: &mut dyn FnMut(Bond)) {
        let here = self.margin + self.place_of(i);
        for (entry, k, lane) in self.family_of(i) {
            let there = here.wrapping_add_signed(self.shifts[k]);
            let both = self.material[here] + self.material[there];
            let mean = match self.interface {
                Interface::Harmonic => 2.0 / both,
                Interface::Arithmetic => 0.5 * both,
            };
            let factor = match &self.surface[..] {
                [] => 1.0,
                [incomplete, excess @ ..] => {
                    let terms = excess.iter().zip(&self.directions[k]);
                    let excess: f64 = terms
                        .map(|(field, c)| c * (field[here] + field[there]))
                        .sum();
                    1.0 + incomplete[here] * incomplete[there] * excess
                }
            };
            let whole = mean * factor * self.weights[k];
            let is_intact = self.intact[entry] >> lane & 1 == 1;
            visit(Bond {
                neighbour: self.other_end(i, k),
                xi: self.vectors[k],
                conductance: if is_intact { whole } else { self.share * whole },
            });
        }
    }

    fn set_intact(&mut self, i: usize, is_intact: &dyn Fn(usize) -> bool) {
        let family: Vec<_> = self.family_of(i).collect();
        for (entry, k, lane) in family {
            let intact = is_intact(self.other_end(i, k));
            self.set(entry, lane, intact);
        }
    }

    /// One bit per point and offset: unlike chunks, points and offsets do not depend on the division among processes.
    fn intact(&self) -> (Vec<u8>, Layout) {
        let (n, m) = (self.slots.len(), self.shifts.len());
        let mut bits = vec![0u8; m.div_ceil(BITS) * n];
        let of_offsets = bits.par_chunks_mut(n.max(1)).enumerate();
        of_offsets.for_each(|(byte, bits)| {
            let offsets = byte * BITS..((byte + 1) * BITS).min(m);
            let of_points = bits.par_iter_mut().zip(&self.slots);
            of_points.for_each(|(bits, &(chunk, lane))| {
                for (bit, k) in offsets.clone().enumerate() {
                    *bits |= (self.intact[chunk as usize * m + k] >> lane & 1) << bit;
                }
            });
        });
        (bits, Layout::Points)
    }

    fn restore_intact(&mut self, bits: &[u8]) -> Result<()> {
        let (n, m) = (self.slots.len(), self.shifts.len());
        let mut intact = vec![0u8; self.family.len()];
        let has_length = bits.len() == m.div_ceil(BITS) * n;
        if has_length {
            for (i, &(chunk, lane)) in self.slots.iter().enumerate() {
                for k in 0..m {
                    let bit = bits[k / BITS * n + i] >> (k % BITS) & 1;
                    intact[chunk as usize * m + k] |= bit << lane;
                }
            }
        }
        if !has_length || intact.iter().zip(&self.family).any(|(a, b)| a & !b != 0) {
            let reason = "its conducting bonds are not bonds of the body".into();
            return Err(PericlesError::BadArchive { reason });
        }
        self.intact = intact;
        Ok(())
    }

    fn directed_bonds(&self) -> u64 {
        self.family
            .iter()
            .map(|bits| u64::from(bits.count_ones()))
            .sum()
    }

    fn bytes(&self) -> usize {
        let fields = (2 + self.surface.len()) * size_of_val(&self.material[..])
            + size_of_val(&self.points[..]);
        fields
            + 2 * self.family.len()
            + size_of_val(&self.slots[..])
            + size_of_val(&self.chunks[..])
    }
}
