//! Stencil force kernel for lattice bodies.

use std::sync::{Arc, Mutex};

use super::arrays::Grid;
use super::block::{ChunkBlock, Partners};
use super::breaking::GridBreaking;
use super::factors::{Factors, OfBond};
use super::kernels::{accept_chunks, accept_chunks_in_floats};
use super::lattice;
use super::numbers::GridNumber;
use super::offsets::{in_floats, offsets};
use super::padded::Padded;
use super::thresholds::PlaceThresholds;
use super::working::Working;
use crate::domain::Field;
use crate::error::Result;
use crate::family::{BondCut, Crack, EndRule};
use crate::material::{BondConstants, BondMaterial, MaterialPairs};
use crate::neighbourhood::{
    BlockDamage, Chunk, DamageMeasure, Form, GridLayout, Lattice, Neighbourhood, Stencil, Tally,
};
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Force, InstructionSet, PointSubset};
use crate::parallel::{Cost, components_mut, for_each_part};
use crate::space::{PointCloud, Sites};
use crate::step_end::StepEnd;
use crate::thermal::ThermalExpansion;

/// Force density f(x_i) = Σ_j c α κ V_j s n on a lattice, N/m³: the force of
/// [`BondForce`](crate::operator::BondForce), several times faster.
///
/// All nodes share one stencil. Eight nodes of a row along x are computed together, without roots and
/// divisions for small strains (see [`VectorLaw`]). Holes, boundaries, pre-cracks and damage are one byte per
/// eight nodes and offset. The force on a point depends on its neighbours only, not on threads or on other
/// requested points.
///
/// Memory: per point one byte per eight bonds, a copy of the displacement, and 4 bytes; rows are padded to a
/// multiple of eight nodes.
///
/// ```
/// use std::sync::Arc;
/// use pericles::family::VolumeCorrection;
/// use pericles::kernel::Influence;
/// use pericles::material::*;
/// use pericles::operator::{DamageMeasure, Force, GridForce, PointSubset};
/// use pericles::space::{Grid, Shape};
///
/// # fn main() -> pericles::Result<()> {
/// let bar = Grid {
///     shape: Shape::Box { origin: [0.0; 3], size: vec![1.0] },
///     spacing: 0.01,
///     section: 1e-4,
///     holes: vec![],
/// };
/// let cloud = Arc::new(bar.points()?);
/// let steel = BondMaterial {
///     law: PairLaw::Linear,
///     density: 7850.0,
///     modulus: Modulus { value: ElasticModulus::Young(210e9), calibration: Calibration::Continuum },
///     horizon: 0.03,
///     influence: Influence::default(),
///     volume_correction: VolumeCorrection::Extended,
///     fracture: Fracture::Unbreakable,
/// };
/// let constants = steel.constants(&cloud, StressState::Uniaxial)?;
/// let operator =
///     GridForce::<LinearBond, 1>::new(cloud.clone(), &steel, &constants, &[], &[], DamageMeasure::default())?;
/// // A uniform strain causes no force in the interior.
/// let u: Vec<f64> = cloud.axis(0).iter().map(|x| 1e-3 * x).collect();
/// let mut force = vec![0.0; cloud.len()];
/// operator.add_force(0.0, &u, PointSubset::All, &mut force);
/// assert!(force[50].abs() < 1e-9 * force[0]);
/// # Ok(())
/// # }
/// ```
pub struct GridForce<L: VectorLaw, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Neighbourhood<Lattice>,
    pub(super) critical_stretch: f64,
    /// Critical stretches by the materials of the ends of a bond; the common value is then the smallest of
    /// them.
    pub(super) pairs: Option<PlaceThresholds>,
    /// Thermal expansion, if the material expands.
    pub(super) expansion: Option<ThermalExpansion>,
    pub(super) doubles: Working<f64, D>,
    /// Work arrays for forces and bond failure in single precision; everything else uses double precision.
    pub(super) floats: Option<Working<f32, D>>,
    /// A second vector in padded rows, allocated by the first tangent.
    pub(super) direction: Mutex<Option<Padded<f64, D>>>,
    pub(super) instruction_set: InstructionSet,
    pub(super) law: std::marker::PhantomData<L>,
}

impl<L: VectorLaw, const D: usize> GridForce<L, D> {
    /// Creates the operator of a material on a lattice body with pre-cracks; bonds of the points `no_fail`
    /// never break.
    ///
    /// # Errors
    /// A cloud without a lattice or of another dimension, a horizon without neighbours, an invalid crack,
    /// points `no_fail` that do not exist in the cloud.
    pub fn new(
        cloud: Arc<PointCloud>,
        material: &BondMaterial,
        constants: &BondConstants,
        cracks: &[(Crack, EndRule)],
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Result<Self> {
        let stiffness =
            |xi| constants.micromodulus * material.influence.alpha_of(xi, material.horizon);
        let horizons = (material.horizon, None);
        let correction = material.volume_correction;
        let bonds = lattice::<D>(&cloud, horizons, correction, cracks, no_fail)?;
        let bonds = Neighbourhood::new(bonds, damage);
        Ok(Self::of(bonds, &stiffness, constants.critical_stretch))
    }

    /// Creates the operator of bonds with the stiffness c α as a function of ξ, m.
    pub(in crate::operator) fn of(
        bonds: Neighbourhood<Lattice>,
        stiffness: &dyn Fn([f64; 3]) -> f64,
        critical_stretch: f64,
    ) -> Self {
        let stencil = bonds.form().stencil();
        Self {
            doubles: Working::new(
                offsets(stencil, stiffness),
                1.0,
                stencil.farthest_shift(),
                stencil.radius(),
            ),
            floats: None,
            direction: Mutex::new(None),
            cloud: Arc::clone(bonds.form().cloud()),
            bonds,
            critical_stretch,
            pairs: None,
            expansion: None,
            instruction_set: InstructionSet::detect(),
            law: std::marker::PhantomData,
        }
    }

    /// Selects another instruction set for the loops; for tests and benchmarks.
    pub fn with_instruction_set(mut self, set: InstructionSet) -> Self {
        self.use_instruction_set(set);
        self
    }

    /// Computes forces and bond failure in single precision: half the memory of the work array and about
    /// twice the speed, with an error of 1e-6 to 1e-4 of the largest force (see [`Force::rounding`]).
    /// Displacements are rounded relative to the displacement of one point, in units of the spacing. States, energies and
    /// tangents use double precision. Bond failure follows from the rounded displacements, at both ends of a
    /// bond identically.
    pub fn in_floats(mut self) -> Self {
        let spacing = self.cloud.spacing();
        let lattice = self.cloud.lattice();
        let sides = lattice.map_or([1.0; 3], |lattice| lattice.spacing.map(|dx| dx / spacing));
        let stencil = self.stencil();
        self.floats = Some(Working::new(
            in_floats(stencil, self.doubles.offsets(), sides),
            spacing,
            stencil.farthest_shift(),
            stencil.radius(),
        ));
        self.round_factors();
        self
    }

    /// Multiplies the stiffness of bonds by a factor of the sites of both ends, the first of which belongs to
    /// an own point, and of the vector ξ of the bond, m. It must be the same from both ends.
    pub(in crate::operator) fn with_factors(mut self, of: &OfBond<'_>) -> Self {
        let factors = Factors::new(&self.bonds, of);
        self.doubles = self.doubles.with_factors(Some(factors));
        self.round_factors();
        self
    }

    fn round_factors(&mut self) {
        let factors = self.doubles.factors().map(Factors::in_floats);
        self.floats = self
            .floats
            .take()
            .map(|floats| floats.with_factors(factors));
    }

    /// Sets critical stretches that depend on the materials of both ends of a bond.
    pub(in crate::operator) fn with_critical_stretches(mut self, classes: &MaterialPairs) -> Self {
        self.critical_stretch = classes.smallest_critical_stretch();
        self.pairs = (!classes.has_one_critical_stretch()).then(|| {
            let on_sites = classes.on_sites(self.sites());
            PlaceThresholds::new::<L>(&on_sites, self.bonds.form())
        });
        self
    }

    /// Returns the stiffness of the bond of an offset and lane of a chunk, N/m³.
    pub(super) fn stiffness_of(&self, chunk: usize, offset: usize, lane: usize) -> f64 {
        let factors = self.doubles.factors();
        let factor = factors.map_or(1.0, |factors| factors.of_bond(chunk, offset, lane));
        self.doubles.offsets()[offset].stiffness * factor
    }

    /// Returns the stiffness of the stiffest bond of an offset, N/m³.
    pub(super) fn largest_stiffness(&self, offset: usize) -> f64 {
        let largest = (self.doubles.factors()).map_or(1.0, |factors| factors.largest(offset));
        self.doubles.offsets()[offset].stiffness * largest
    }

    /// Returns the bonds.
    pub fn bonds(&self) -> &Neighbourhood<Lattice> {
        &self.bonds
    }

    /// Returns the sites: end points of bonds.
    pub fn sites(&self) -> &Sites {
        self.bonds.form().sites()
    }

    /// Returns points and their places.
    pub(super) fn layout(&self) -> &GridLayout {
        self.bonds.form().layout()
    }

    /// Returns the family of a node.
    pub(super) fn stencil(&self) -> &Stencil {
        self.bonds.form().stencil()
    }

    /// Returns the bonds removed by each pre-crack.
    pub fn cuts(&self) -> &[BondCut] {
        self.bonds.form().cuts()
    }

    /// Returns a block of chunks with its requested points; `None` if there are none.
    pub(super) fn chunk_block<'a>(
        &'a self,
        lanes: Option<&'a [u8]>,
        block: usize,
    ) -> Option<ChunkBlock<'a>> {
        ChunkBlock::of(self.layout(), lanes, block)
    }

    /// Returns the cost of a loop over the bonds of a subset of the points.
    fn cost(&self, on: &PointSubset<'_>) -> Cost {
        self.bonds.form().cost(on)
    }

    /// Runs a read-only loop over all blocks at displacement u and the thermal stretches of own points and ghosts.
    pub(super) fn sweep<N: GridNumber, const C: usize>(
        &self,
        working: &Working<N, D>,
        (u, stretches): (&[f64], Option<Arc<Vec<f64>>>),
        on: &PointSubset<'_>,
        out: &mut [f64],
        chunks: impl Fn(&Grid<'_, N, D>, &ChunkBlock<'_>, &[u8], &mut [&mut [f64]; C]) + Sync,
    ) {
        let ghosts = self.cloud.domain().ghosts(u);
        let heat = stretches.as_ref().map(|stretches| self.field_of(stretches));
        let values = (Field::new(u, &ghosts), heat);
        working.with(self.layout(), values, on, |grid, lanes| {
            self.bonds
                .for_each_block::<C>(self.cost(on), out, |block, intact, out| {
                    if let Some(chunk_block) = self.chunk_block(lanes, block) {
                        chunks(grid, &chunk_block, intact, out);
                    }
                });
        });
    }

    /// Breaks over-stretched bonds of the requested points and adds the force density of the intact bonds.
    pub(super) fn decide(
        &mut self,
        step: &StepEnd<'_>,
        on: &PointSubset<'_>,
        partners: Option<&Partners>,
        out: &mut [f64],
    ) {
        let whole = matches!(on, PointSubset::All) && partners.is_none();
        let stretches = self.stretches(step.t);
        let mut blocks = self.bonds.take_blocks();
        let set = self.instruction_set;
        let domain = self.cloud.domain();
        let (ghosts, moved) = (domain.ghosts(step.u), step.ghost_velocities(domain));
        let rule = GridBreaking {
            threshold: L::threshold(self.critical_stretch),
            critical_stretch: self.critical_stretch,
            pairs: self.pairs.as_ref(),
            volume: self.cloud.volumes().first().copied().unwrap_or(0.0),
            breakable: &|chunk: &Chunk, offset: usize| self.bonds.form().breakable(chunk, offset),
            point_at: &|place| self.layout().point_at(place),
            step,
            velocity: step.velocities(&moved),
            note_events: !whole,
        };
        let heat = stretches.as_ref().map(|stretches| self.field_of(stretches));
        let u = (Field::new(step.u, &ghosts), heat);
        match &self.floats {
            Some(working) => working.with(self.layout(), u, on, |grid, lanes| {
                self.decide_blocks(
                    (on, lanes),
                    partners,
                    &mut blocks,
                    out,
                    |block, intact, out, tally| {
                        accept_chunks_in_floats::<L, D>(
                            set, grid, &rule, block, intact, out, tally,
                        );
                    },
                );
            }),
            None => self.doubles.with(self.layout(), u, on, |grid, lanes| {
                self.decide_blocks(
                    (on, lanes),
                    partners,
                    &mut blocks,
                    out,
                    |block, intact, out, tally| {
                        accept_chunks::<L, D>(set, grid, &rule, block, intact, out, tally);
                    },
                );
            }),
        }
        self.bonds.put_blocks(blocks);
        if !whole {
            self.bonds.break_other_ends();
        }
    }

    /// Applies the failure criterion in all blocks, only to bonds to partners if given.
    fn decide_blocks(
        &self,
        (on, lanes): (&PointSubset<'_>, Option<&[u8]>),
        partners: Option<&Partners>,
        blocks: &mut [BlockDamage],
        out: &mut [f64],
        accept: impl Fn(&ChunkBlock<'_>, &mut [u8], &mut [&mut [f64]; D], &mut Tally) + Sync,
    ) {
        for_each_part(
            components_mut::<D>(out, self.cloud.len()),
            blocks,
            self.cost(on),
            &|block| self.layout().first_point(block),
            &|block, mut out, state| {
                let Some(chunk_block) = self.chunk_block(lanes, block) else {
                    return;
                };
                match partners {
                    None => accept(&chunk_block, &mut state.intact, &mut out, &mut state.tally),
                    Some(partners) => {
                        let before = self.bonds_to(partners, &chunk_block, &state.intact);
                        let mut after = before.clone();
                        accept(&chunk_block, &mut after, &mut out, &mut state.tally);
                        for (intact, (before, after)) in
                            state.intact.iter_mut().zip(before.iter().zip(&after))
                        {
                            *intact &= !(before & !after);
                        }
                    }
                }
            },
        );
    }
}
