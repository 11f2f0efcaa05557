//! Stencil force kernel of linear peridynamic solids.

use std::sync::Arc;

use super::arrays::{Arrays, SolidOffset, solid_offsets};
use super::breaking::{ChunkBonds, StencilRule, take_bonds};
use super::kernels::{accept_chunks, dilatation_chunks};
use crate::domain::Field;
use crate::error::Result;
use crate::family::{BondCut, Crack, EndRule, VolumeCorrection};
use crate::kernel::Influence;
use crate::lanes::LANES;
use crate::material::{BondLimits, Materials, PairForce, StateConstants};
use crate::neighbourhood::{
    BlockDamage, BondPlace, DamageMeasure, Form, GridLayout, Lattice, Neighbourhood,
};
use crate::operator::grid::block::ChunkBlock;
use crate::operator::grid::lattice;
use crate::operator::grid::padded::{Frame, Padded};
use crate::operator::grid::wanted::WantedPoints;
use crate::operator::pool::Pool;
use crate::operator::state_based::breaking::States;
use crate::operator::state_based::heat::Heat;
use crate::operator::state_based::kinematics::Kinematics;
use crate::operator::{InstructionSet, PointSubset};
use crate::parallel::{for_each_chunk, for_each_part};
use crate::space::PointCloud;
use crate::step_end::StepEnd;

/// Force density of linear peridynamic solids on a lattice, N/m³: the force of
/// [`LinearSolidForce`](crate::operator::LinearSolidForce), several times faster.
///
/// All nodes share one stencil, as in [`GridForce`](crate::operator::GridForce): both passes compute eight
/// nodes of a row along x together, without roots and divisions for small strains. The influence function and
/// the partial volume are constants of an offset. A/m and B/m are stored per point, so that materials may
/// differ between points.
///
/// Memory: per point one byte per eight bonds, copies of the displacement and of p = A θ/m, and five numbers;
/// rows are padded to a multiple of eight nodes.
pub struct LinearSolidGrid<L: Kinematics, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Neighbourhood<Lattice>,
    pub(super) offsets: Vec<SolidOffset<D>>,
    /// Factors of points, ghosts after own points.
    pub(super) states: States,
    /// s = B/m in padded rows.
    stiffness: Padded<f64, 1>,
    /// Limits of bonds as a function of both sites.
    pub(super) classes: Materials<StateConstants>,
    /// Limits of the weakest pair of materials.
    pub(super) weakest: BondLimits,
    /// Thermal strain, if the material expands.
    pub(super) heat: Option<Heat>,
    work: Pool<Work<D>>,
    pub(super) instruction_set: InstructionSet,
    kinematics: std::marker::PhantomData<L>,
}

crate::saved! {
    impl<L: Kinematics, const D: usize> Checkpointed for LinearSolidGrid<L, D> {
        bonds: part,
        cloud, offsets, states, stiffness, classes, weakest, instruction_set, kinematics: fixed,
        heat: rebuilt,
        work: scratch,
    } then |force| {
        force.renew_volumes(None);
        Ok(())
    }
}

/// Work arrays of one evaluation.
struct Work<const D: usize> {
    u: Padded<f64, D>,
    pressure: Padded<f64, 1>,
    /// p of all points, ghosts after own points.
    of_points: Vec<f64>,
    wanted: WantedPoints,
}

/// Points for which an evaluation needs padded rows.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    /// Requested points.
    pub on: &'a PointSubset<'a>,
    /// Whether rows beyond the neighbours of these points are needed.
    pub whole: bool,
}

impl<L: Kinematics, const D: usize> LinearSolidGrid<L, D> {
    /// Creates the force of solids with one influence function on the points of a lattice with pre-cracks,
    /// and returns the bonds removed by each crack. Bonds of the points `no_fail` never break; other bonds
    /// break by stretch only.
    ///
    /// # Errors
    /// A cloud without a lattice or of another dimension, a horizon without neighbours, an invalid crack,
    /// points `no_fail` that do not exist in the cloud.
    pub fn new(
        cloud: &Arc<PointCloud>,
        (influence, horizon): (&Influence, f64),
        correction: VolumeCorrection,
        classes: &Materials<StateConstants>,
        cracks: &[(Crack, EndRule)],
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Result<(Self, Vec<BondCut>)> {
        let weight = |xi| influence.alpha_of(xi, horizon);
        let lattice = lattice::<D>(cloud, (horizon, None), correction, cracks, no_fail)?;
        let cuts = lattice.cuts().to_vec();
        let bonds = Neighbourhood::new(lattice, damage);
        let (layout, stencil) = (bonds.form().layout(), bonds.form().stencil());
        let offsets = solid_offsets(stencil, &weight);
        let mut volumes = vec![0.0; cloud.len()];
        bonds.for_each_counted::<1>(&mut volumes, |first, bond, [volumes]| {
            if bond.intact {
                let offset = &offsets[bond.entry / LANES % offsets.len()];
                volumes[bond.point - first] += offset.weighted_square;
            }
        });
        let domain = cloud.domain();
        let spread = |of_points: &[f64]| domain.with_ghosts(of_points).into_owned();
        let states = States::new::<D>(&volumes, classes, &spread);
        let farthest = stencil.farthest_shift();
        let mut stiffness = Padded::new(layout, farthest);
        let (own, ghosts) = states.stiffness.split_at(cloud.len());
        let own = Field::new(own, ghosts);
        stiffness.fill(layout, own, &Frame::of(own, 1.0));
        let (shared, points) = (Arc::clone(layout), cloud.len() + domain.ghost_points());
        let work = Pool::new(0, move || Work {
            u: Padded::new(&shared, farthest),
            pressure: Padded::new(&shared, farthest),
            of_points: vec![0.0; points],
            wanted: WantedPoints::new(&shared),
        });
        let force = Self {
            cloud: cloud.clone(),
            classes: classes.clone().on_sites(bonds.form().sites()),
            weakest: classes.weakest(),
            instruction_set: InstructionSet::detect(),
            kinematics: std::marker::PhantomData,
            bonds,
            offsets,
            states,
            stiffness,
            heat: None,
            work,
        };
        Ok((force, cuts))
    }

    /// Returns the weighted volume m of a point, m⁵ for a dimensionless influence function; infinite for a
    /// point without bonds.
    pub fn weighted_volume(&self, i: usize) -> f64 {
        D as f64 / self.states.dilatation[i]
    }

    /// Returns the bonds.
    pub fn bonds(&self) -> &Neighbourhood<Lattice> {
        &self.bonds
    }

    /// Returns points and their places.
    pub(super) fn layout(&self) -> &GridLayout {
        self.bonds.form().layout()
    }

    /// Copies a vector and p for the given values of the pass over points (dilatations, and thermal pulls of a heated
    /// body) to padded rows and passes them on, with the requested lanes of each chunk (`None` if all points are
    /// requested).
    pub(super) fn with_arrays<R>(
        &self,
        u: Field<'_>,
        values: Option<Field<'_>>,
        Wanted { on, whole }: Wanted<'_>,
        work: impl FnOnce(&Arrays<'_, D>, Option<&[u8]>) -> R,
    ) -> R {
        let mut lent = self.work.take();
        let Work {
            u: rows,
            pressure,
            of_points,
            wanted,
        } = &mut *lent;
        let layout = self.layout();
        let all = matches!(on, PointSubset::All);
        if !all {
            wanted.set(layout, on, self.bonds.form().stencil().radius());
        }
        let around = (!all && !whole && layout.is_of_points()).then_some(&*wanted);
        let frame = Frame::of(u, 1.0);
        match around {
            None => rows.fill(layout, u, &frame),
            Some(wanted) => rows.fill_around(layout, u, &frame, wanted),
        }
        if let Some(values) = values {
            self.pressures_into(values, of_points);
            let (own, ghosts) = of_points.split_at(self.cloud.len());
            let of_points = Field::new(own, ghosts);
            let frame = Frame::of(of_points, 1.0);
            match around {
                None => pressure.fill(layout, of_points, &frame),
                Some(wanted) => {
                    pressure.fill_around(layout, of_points, &frame, wanted);
                }
            }
        }
        let [pressure] = pressure.components();
        let [stiffness] = self.stiffness.components();
        let arrays = Arrays {
            offsets: &self.offsets,
            u: rows.components(),
            pressure,
            stiffness,
            margin: rows.margin(),
        };
        work(&arrays, (!all).then(|| wanted.lanes()))
    }

    /// Sets p = A θ/m with the thermal pull of all points, ghosts after own points.
    fn pressures_into(&self, values: Field<'_>, out: &mut [f64]) {
        let n = self.cloud.len();
        let (own, ghosts) = out.split_at_mut(n);
        for_each_chunk(own, &|first, pressures| {
            let of = first..first + pressures.len();
            let factors = &self.states.pressure[of.clone()];
            let pairs = factors.iter().zip(&values.owned[of]);
            for (pressure, (factor, theta)) in pressures.iter_mut().zip(pairs) {
                *pressure = factor * theta;
            }
        });
        for (g, pressure) in ghosts.iter_mut().enumerate() {
            *pressure = self.states.pressure[n + g] * values.ghosts[g];
        }
        if self.heat.is_some() {
            let pulls = [&values.owned[n..], &values.ghosts[ghosts.len()..]];
            for (pressures, pulls) in [own, ghosts].into_iter().zip(pulls) {
                for_each_chunk(pressures, &|first, pressures| {
                    let pulls = &pulls[first..first + pressures.len()];
                    for (pressure, pull) in pressures.iter_mut().zip(pulls) {
                        *pressure += pull;
                    }
                });
            }
        }
    }

    /// Runs a read-only loop over the blocks with requested points.
    pub(super) fn sweep<const C: usize>(
        &self,
        lanes: Option<&[u8]>,
        out: &mut [f64],
        chunks: impl Fn(&ChunkBlock<'_>, &[u8], &mut [&mut [f64]; C]) + Sync,
    ) {
        let bonds = &self.bonds;
        let cost = bonds.form().cost(&PointSubset::All);
        bonds.for_each_block::<C>(cost, out, |block, intact, out| {
            if let Some(chunk_block) = ChunkBlock::of(self.layout(), lanes, block) {
                chunks(&chunk_block, intact, out);
            }
        });
    }

    /// Sets the dilatations of the points `on`.
    pub(super) fn dilatations_into(&self, u: Field<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let (set, factors) = (self.instruction_set, &self.states.dilatation[..]);
        let wanted = Wanted { on, whole: false };
        self.with_arrays(u, None, wanted, |arrays, lanes| {
            self.sweep::<1>(lanes, out, |block, intact, out| {
                dilatation_chunks::<L, D>(set, arrays, factors, block, intact, out);
            });
        });
    }

    /// Breaks bonds of the points `on` that exceed their critical stretch and sets the dilatations of these
    /// points.
    pub(super) fn break_by_stretch(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        dilatations: &mut [f64],
    ) {
        let broken = self.broken_by_blocks();
        let stretches = self.stretches(step.t);
        let mut blocks = self.bonds.take_blocks();
        let (set, whole) = (self.instruction_set, !matches!(on, PointSubset::All));
        let moved = step.ghost_velocities(self.cloud.domain());
        let rule = StencilRule {
            threshold: L::Measure::threshold(self.coldest_limit(stretches.as_deref())),
            stretches: stretches.as_ref().map(|stretches| &stretches[..]),
            classes: &self.classes,
            bonds: self.bonds.form(),
            states: &self.states,
            volumes: self.cloud.volumes(),
            step,
            velocity: step.velocities(&moved),
            note_events: whole,
        };
        self.with_arrays(u, None, Wanted { on, whole }, |arrays, lanes| {
            for_each_part(
                [dilatations],
                &mut blocks,
                self.bonds.form().cost(on),
                &|block| self.layout().first_point(block),
                &|block, mut out, state: &mut BlockDamage| {
                    if let Some(block) = ChunkBlock::of(self.layout(), lanes, block) {
                        let BlockDamage { intact, tally } = state;
                        accept_chunks::<L, D>(set, arrays, &rule, &block, intact, &mut out, tally);
                    }
                },
            );
            if whole {
                self.clear_other_ends(&rule, arrays, &mut blocks);
            }
        });
        self.bonds.put_blocks(blocks);
        self.renew_volumes(broken);
    }

    /// Breaks the other end of bonds that broke in a sweep over a subset of points, and records the energy
    /// dissipated there.
    fn clear_other_ends(
        &self,
        rule: &StencilRule<'_>,
        arrays: &Arrays<'_, D>,
        blocks: &mut [BlockDamage],
    ) {
        let (m, layout) = (self.offsets.len(), self.layout());
        let rule = StencilRule {
            note_events: false,
            ..*rule
        };
        for end in self.bonds.other_ends(blocks) {
            let BondPlace { block, group, lane } = end.place;
            let BlockDamage { intact, tally } = &mut blocks[block];
            let (chunk, offset) = (group / m, group % m);
            let intact = &mut intact[chunk * m..(chunk + 1) * m];
            let mut broken = vec![0; m];
            broken[offset] = intact[offset] & 1 << lane;
            let number = layout.chunks_of(block).start + chunk;
            let bonds = ChunkBonds {
                chunk: &layout.chunks()[number],
                lanes: 1 << lane,
                number,
            };
            take_bonds::<L, D>(arrays, &rule, bonds, intact, &broken, tally);
        }
    }

    /// Returns the memory use, bytes.
    pub(super) fn own_bytes(&self) -> usize {
        let (layout, farthest) = (self.layout(), self.bonds.form().stencil().farthest_shift());
        let rows = Padded::<f64, D>::bytes_for(layout, farthest)
            + 2 * Padded::<f64, 1>::bytes_for(layout, farthest);
        let points = size_of::<f64>() * (self.cloud.len() + self.cloud.domain().ghost_points());
        self.bonds.bytes_of_bits()
            + self.bonds.form().bytes()
            + rows
            + points
            + WantedPoints::bytes_for(layout)
            + self.states.bytes()
    }
}
