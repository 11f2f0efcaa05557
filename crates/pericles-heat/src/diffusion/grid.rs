//! Stencil of conductances, for lattice bodies.

use pericles::lanes::{InstructionSet, LANES};
use pericles::operator::pool::Pool;
use pericles::parallel::for_each_point;
use pericles::space::Sites;
use pericles::{PericlesError, Result};
use rayon::prelude::*;

use super::kernels::{Chunk, Stencil, add_chunks};
use super::{Bond, Bonds, DiffusionBody, Interface, surface};
use crate::calibration::{PairConductivity, for_each_offset};

/// Marks a place without a site.
const NONE: u32 = u32::MAX;

/// Number of chunks that a thread computes at a time.
const TASK: usize = 64;

/// Bonds of a lattice body. The rows along x of the box of all sites are padded to whole chunks of eight nodes, so that
/// a neighbour is a fixed number of places away.
pub(super) struct GridBonds {
    chunks: Vec<Chunk>,
    /// Point at each place, or [`NONE`].
    points: Vec<u32>,
    /// Chunk and lane of each point.
    slots: Vec<(u32, u8)>,
    margin: usize,
    shifts: Vec<isize>,
    vectors: Vec<[f64; 3]>,
    /// κ V V of each offset for unit conductivity.
    weights: Vec<f64>,
    /// Fields at places, with margins: conductivity or its inverse, half of the surface factor.
    material: Vec<f64>,
    surface: Vec<f64>,
    interface: Interface,
    /// Bonds of the family, one byte per chunk and offset.
    family: Vec<u8>,
    intact: Vec<u8>,
    share: f64,
    work: Pool<Vec<f64>>,
}

impl GridBonds {
    pub fn new(body: &DiffusionBody, calibration: PairConductivity) -> Result<Self> {
        let cloud = &body.cloud;
        let (n, d) = (cloud.len(), cloud.dimension());
        let (cell, volume) = (cloud.spacing(), cloud.volumes()[0]);
        let reach = body.correction.reach(body.horizon, cell);
        let sites = Sites::new(cloud, reach)?;
        let lattice = sites.places().lattice().or(cloud.lattice());
        let lattice = lattice.ok_or(PericlesError::BadArchive {
            reason: "the body has no lattice".into(),
        })?;
        let at: Vec<[i32; 3]> = lattice
            .node
            .iter()
            .map(|&node| lattice.coordinates(node))
            .collect();
        let low: [i32; 3] = std::array::from_fn(|c| at.iter().map(|x| x[c]).min().unwrap_or(0));
        let high: [i32; 3] = std::array::from_fn(|c| at.iter().map(|x| x[c]).max().unwrap_or(0));
        let side = |c: usize| (high[c] - low[c]) as usize + 1;
        let mut row = side(0).next_multiple_of(LANES);
        // Rows at distances of a multiple of 1024 numbers would compete for the same cache lines.
        if row.is_multiple_of(128) {
            row += LANES;
        }
        let strides = [1, row as isize, (row * side(1)) as isize];
        let place = |x: [i32; 3]| -> usize {
            (0..3)
                .map(|c| (x[c] - low[c]) as usize * strides[c] as usize)
                .sum()
        };
        let places = row * side(1) * side(2);
        let mut points = vec![NONE; places];
        for (site, x) in at.iter().enumerate() {
            points[place(*x)] = sites.point(site) as u32;
        }
        let (mut shifts, mut steps, mut vectors, mut weights) = (vec![], vec![], vec![], vec![]);
        for_each_offset(lattice.spacing, d, reach, &mut |step, xi, r| {
            let weight = calibration.value(xi)
                * body.correction.factor(r, body.horizon, cell)
                * volume
                * volume;
            if weight > 0.0 {
                shifts.push((0..3).map(|c| step[c] as isize * strides[c]).sum::<isize>());
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
        let own: Vec<[i32; 3]> = (0..n).map(|i| at[sites.of_point(i)]).collect();
        let (chunks, slots) = chunks(&own, low, strides);
        let bits = |chunk: &Chunk, step: [i32; 3]| -> u8 {
            let mut bits = 0;
            for lane in (0..LANES).filter(|lane| chunk.lanes >> lane & 1 == 1) {
                let before = (chunk.lanes & !(0xFF << lane)).count_ones() as usize;
                let here = own[chunk.point as usize + before];
                let there: [i32; 3] = std::array::from_fn(|c| here[c] + step[c]);
                let inside = (0..3).all(|c| (low[c]..=high[c]).contains(&there[c]));
                let other = |point: u32| {
                    point != NONE
                        && cloud.piece(point as usize) == cloud.piece(chunk.point as usize + before)
                };
                if inside && other(points[place(there)]) {
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
        let padded = |of_point: &dyn Fn(usize) -> f64| {
            let mut field = vec![1.0; places + 2 * margin];
            for (place, &point) in points
                .iter()
                .enumerate()
                .filter(|(_, point)| **point != NONE)
            {
                field[margin + place] = of_point(point as usize);
            }
            field
        };
        let material = padded(&|i| match body.interface {
            Interface::Harmonic => 1.0 / body.conductivity.at(i),
            Interface::Arithmetic => body.conductivity.at(i),
        });
        let length = places + 2 * margin;
        let mut bonds = Self {
            intact: family.clone(),
            family,
            surface: Vec::new(),
            work: Pool::new(1, move || vec![0.0; length]),
            interface: body.interface,
            share: body.broken_share,
            chunks,
            slots,
            margin,
            shifts,
            vectors,
            weights,
            material,
            points,
        };
        let moments = for_each_point(n, &|i| {
            let family = bonds.family_of(i);
            let terms = family.map(|(_, k, _)| {
                let square: f64 = bonds.vectors[k].iter().map(|x| x * x).sum();
                bonds.weights[k] / volume * square
            });
            terms.sum::<f64>()
        });
        let factors = match body.surface_correction {
            true => surface::factors(cloud, &moments),
            false => vec![1.0; n],
        };
        let mut surface = vec![0.5; length];
        for (place, &point) in bonds
            .points
            .iter()
            .enumerate()
            .filter(|(_, point)| **point != NONE)
        {
            surface[margin + place] = 0.5 * factors[point as usize];
        }
        bonds.surface = surface;
        bonds.find_plain();
        Ok(bonds)
    }

    /// Marks the chunks whose bonds all have the same conductivity.
    fn find_plain(&mut self) {
        let m = self.shifts.len();
        let (material, surface, margin) = (&self.material, &self.surface, self.margin);
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
                    surface[at + lane] == 0.5
                        && present.all(|(&shift, _)| {
                            let there = (at + lane).wrapping_add_signed(shift);
                            material[there] == here && surface[there] == 0.5
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
            interface: self.interface,
            margin: self.margin,
            shifts: &self.shifts,
            weights: &self.weights,
            scale,
        };
        self.split(
            (&stencil, bonds, set),
            0..self.chunks.len().div_ceil(TASK),
            out,
        );
    }

    fn split(
        &self,
        work: (&Stencil<'_>, &[u8], InstructionSet),
        tasks: std::ops::Range<usize>,
        out: &mut [f64],
    ) {
        let first = tasks.start * TASK;
        let end = (tasks.end * TASK).min(self.chunks.len());
        if tasks.len() <= 1 {
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
        rayon::join(
            || self.split(work, tasks.start..middle, low),
            || self.split(work, middle..tasks.end, high),
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

/// Returns the chunks of the points, whose coordinates ascend with x fastest, and the chunk and lane of each point.
fn chunks(own: &[[i32; 3]], low: [i32; 3], strides: [isize; 3]) -> (Vec<Chunk>, Vec<(u32, u8)>) {
    let mut chunks: Vec<Chunk> = Vec::new();
    let mut slots = Vec::with_capacity(own.len());
    for (i, x) in own.iter().enumerate() {
        let place: usize = (0..3)
            .map(|c| (x[c] - low[c]) as usize * strides[c] as usize)
            .sum();
        let (first, lane) = (place / LANES * LANES, place % LANES);
        if chunks
            .last()
            .is_none_or(|chunk| chunk.place as usize != first)
        {
            chunks.push(Chunk {
                place: first as u32,
                point: i as u32,
                lanes: 0,
                is_plain: false,
            });
        }
        let number = chunks.len() - 1;
        chunks[number].lanes |= 1 << lane;
        slots.push((number as u32, lane as u8));
    }
    (chunks, slots)
}

impl Bonds for GridBonds {
    fn add_flow(&self, values: &[f64], set: InstructionSet, out: &mut [f64]) {
        let mut padded = self.work.take();
        let (margin, points) = (self.margin, &self.points);
        padded[margin..margin + points.len()]
            .par_chunks_mut(TASK * LANES)
            .zip(points.par_chunks(TASK * LANES))
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
            let whole = mean * (self.surface[here] + self.surface[there]) * self.weights[k];
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

    fn intact(&self) -> &[u8] {
        &self.intact
    }

    fn restore_intact(&mut self, intact: &[u8]) -> Result<()> {
        let fits = intact.len() == self.family.len()
            && intact.iter().zip(&self.family).all(|(a, b)| a & !b == 0);
        if !fits {
            let reason = "its conducting bonds are not bonds of the body".into();
            return Err(PericlesError::BadArchive { reason });
        }
        self.intact.copy_from_slice(intact);
        Ok(())
    }

    fn directed_bonds(&self) -> u64 {
        self.family
            .iter()
            .map(|bits| u64::from(bits.count_ones()))
            .sum()
    }

    fn bytes(&self) -> usize {
        let fields = 3 * size_of_val(&self.material[..]) + size_of_val(&self.points[..]);
        fields
            + 2 * self.family.len()
            + size_of_val(&self.slots[..])
            + size_of_val(&self.chunks[..])
    }
}
