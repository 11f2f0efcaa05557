//! Neighbour-list force kernel for any body.

use std::sync::Arc;

use super::arrays::Bonds;
use super::breaking::BreakRule;
use super::heat::Heat;
use super::kernels::accept_rows;
use super::packed::{Packed, Reach};
use super::stiffness::{Formula, Stiffness};
use crate::domain::Field;
use crate::error::{PericlesError, Result};
use crate::family::BondList;
use crate::lanes::Row;
use crate::material::{BondConstants, BondMaterial, MaterialPairs};
use crate::neighbourhood::{DamageMeasure, Neighbourhood};
use crate::operator::fast_law::VectorLaw;
use crate::operator::pool::Pool;
use crate::operator::records::Records;
use crate::operator::rows::Rows;
use crate::operator::thresholds::PairThresholds;
use crate::operator::{Breaking, Force, InstructionSet, PointSubset};
use crate::parallel::{BLOCK, components_mut, for_each_block};
use crate::space::{PointCloud, Sites, check_length, check_points};
use crate::step_end::StepEnd;

/// Force density f(x_i) = Σ_j c α κ V_j s n over the bonds of a neighbour list, N/m³.
///
/// The loop gathers over the bonds of each point in parallel blocks; each bond is computed at both ends. ξ,
/// |ξ|, partial volumes and influence functions of first degree are computed from positions, without roots
/// and divisions (see [`VectorLaw`]). Other bonds of lattices store one byte, an index into a table of
/// stiffnesses, and only bonds that all differ store a number.
///
/// Memory: 2.5 bytes and three bits per family entry, with rows padded to eight; one or eight more bytes if
/// the stiffness is stored; 64 bytes per point.
pub struct BondForce<L: VectorLaw, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Neighbourhood<BondList>,
    /// Coordinates and volumes, see [`Bonds`].
    reference: Vec<Row>,
    unit: [f64; 3],
    stiffness: Stiffness,
    pub(super) critical_stretch: f64,
    /// Critical stretches by the materials of the ends of a bond; the common value is then the smallest of
    /// them.
    pub(super) pairs: Option<PairThresholds>,
    /// Thermal stretches, if the material expands.
    pub(super) heat: Option<Heat>,
    reach: Reach,
    packed: Pool<Packed>,
    pub(super) instruction_set: InstructionSet,
    law: std::marker::PhantomData<L>,
}

crate::saved! {
    impl<L: VectorLaw, const D: usize> Checkpointed for BondForce<L, D> {
        bonds: part,
        cloud, reference, unit, stiffness, critical_stretch, pairs: fixed,
        heat, reach, instruction_set, law: fixed,
        packed: scratch,
    }
}

impl<L: VectorLaw, const D: usize> BondForce<L, D> {
    /// Creates the operator of a material on a body.
    ///
    /// # Errors
    /// As for the other constructors: a cloud whose dimension is not D, bonds of another cloud, points
    /// without bond failure that do not exist in the cloud.
    pub fn new(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        material: &BondMaterial,
        constants: &BondConstants,
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Result<Self> {
        let breaking = Breaking {
            critical_stretch: constants.critical_stretch,
            no_fail,
        };
        let formula = bonds.uniform_horizon().and_then(|horizon| {
            let (c, influence) = (constants.micromodulus, &material.influence);
            Formula::new(&cloud, bonds.correction(), horizon, c, influence)
        });
        if let Some(formula) = formula.filter(|_| bonds.uniform_horizon() == Some(material.horizon))
        {
            return Self::build(cloud, bonds, Stiffness::Formula(formula), breaking, damage);
        }
        let stiffness =
            |xi| constants.micromodulus * material.influence.alpha_of(xi, material.horizon);
        Self::with_stiffness(cloud, bonds, &stiffness, breaking, damage)
    }

    /// Creates an operator with the stiffness c α as a function of the reference vector ξ, m; missing
    /// components are zero. It must be the same for ξ and −ξ.
    pub fn with_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_bond: &(dyn Fn([f64; 3]) -> f64 + Sync),
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        let of_pair = |_, _, xi| stiffness_of_bond(xi);
        Self::with_pair_stiffness(cloud, bonds, &of_pair, breaking, damage)
    }

    /// Creates an operator with the stiffness c α(i, j, ξ) as a function of both points and the vector ξ from
    /// i to j; it must be the same from both ends. Ghosts are numbered after own points.
    pub fn with_pair_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_pair: &(dyn Fn(usize, usize, [f64; 3]) -> f64 + Sync),
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        let weighted = |bonds: &BondList, a: usize, b: usize| {
            let [i, j] = [a, b].map(|site| bonds.sites().point(site));
            stiffness_of_pair(i, j, bonds.vector(a, b)) * bonds.volume_factor(a, b)
        };
        Self::with_weighted_stiffness(cloud, bonds, &weighted, breaking, damage)
    }

    /// Creates an operator with the stiffness c α κ(a, b), including partial volumes, as a function of both
    /// sites; it must be the same from both ends.
    pub fn with_weighted_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_pair: &(dyn Fn(&BondList, usize, usize) -> f64 + Sync),
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        check_length(
            "the families of the neighbour list",
            bonds.len(),
            cloud.len(),
        )?;
        let stiffness = Stiffness::of_pairs(&bonds, &|i, b| {
            stiffness_of_pair(&bonds, bonds.site(i), b) * bonds.volume(b)
        });
        Self::build(cloud, bonds, stiffness, breaking, damage)
    }

    fn build(
        cloud: Arc<PointCloud>,
        mut bonds: BondList,
        stiffness: Stiffness,
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        let n = cloud.len();
        if cloud.dimension() != D {
            return Err(PericlesError::WrongDimension {
                what: "this neighbour list",
                needed: ["1", "2", "3"][D - 1],
                dimension: cloud.dimension(),
            });
        }
        check_length("the families of the neighbour list", bonds.len(), n)?;
        check_points("the points whose bonds never break", breaking.no_fail, n)?;
        let (reference, unit) = reference_rows(bonds.sites().places());
        let cells = bonds.shared_sites();
        let make = move || {
            let places = cells.places();
            Packed::new((0..places.len()).map(|site| places.cell_size(site)))
        };
        Ok(Self {
            reach: Reach::new(&bonds),
            packed: Pool::new(1, make),
            bonds: {
                bonds.hold(breaking.no_fail);
                Neighbourhood::new(bonds, damage)
            },
            cloud,
            reference,
            unit,
            stiffness,
            critical_stretch: breaking.critical_stretch,
            pairs: None,
            heat: None,
            instruction_set: InstructionSet::detect(),
            law: std::marker::PhantomData,
        })
    }

    /// Sets critical stretches that depend on the materials of both ends of a bond.
    ///
    /// # Errors
    /// A number of materials that is not the number of points.
    pub fn with_critical_stretches(self, classes: MaterialPairs) -> Result<Self> {
        check_length(
            "the materials of the points",
            classes.of_point().len(),
            self.cloud.len(),
        )?;
        Ok(Self {
            critical_stretch: classes.smallest_critical_stretch(),
            pairs: Some(PairThresholds::of::<L>(
                classes.on_sites(self.bonds.form().sites()),
            )),
            ..self
        })
    }

    /// Selects another instruction set for the loops; for tests and benchmarks.
    pub fn with_instruction_set(mut self, set: InstructionSet) -> Self {
        self.use_instruction_set(set);
        self
    }

    /// Returns the families.
    pub fn bonds(&self) -> &Neighbourhood<BondList> {
        &self.bonds
    }

    /// Returns the end points of bonds.
    pub(in crate::operator) fn sites(&self) -> &Sites {
        self.bonds.form().sites()
    }

    pub(super) fn view(&self) -> Bonds<'_> {
        Bonds::new(&self.bonds, &self.reference, self.unit, &self.stiffness)
    }

    /// Calls `work` with a vector packed for the requested points and their neighbours.
    pub(super) fn with_packed(
        &self,
        owned: &[f64],
        on: &PointSubset<'_>,
        work: impl FnOnce(&Records),
    ) {
        let ghosts = self.cloud.domain().ghosts(owned);
        let mut packed = self.packed.take();
        let field = Field::new(owned, &ghosts);
        work(packed.fill::<D>(field, on, self.bonds.form().sites(), &self.reach));
    }

    /// Runs a read-only loop over all blocks.
    pub(super) fn sweep<const C: usize>(
        &self,
        on: &PointSubset<'_>,
        out: &mut [f64],
        rows: impl Fn(&[u8], &Rows<'_>, &mut [&mut [f64]; C]) + Sync,
    ) {
        let bonds = &self.bonds;
        bonds.for_each_block::<C>(bonds.form().cost(on), out, |block, intact, out| {
            if let Some(wanted) = Rows::of_block(on, block * BLOCK, out[0].len()) {
                rows(intact, &wanted, out);
            }
        });
    }

    /// Applies the failure criterion to the bonds of the requested points, only those to `partners` if given,
    /// and adds the force of the intact bonds.
    pub(super) fn decide(
        &mut self,
        step: &StepEnd<'_>,
        on: &PointSubset<'_>,
        partners: Option<&[bool]>,
        out: &mut [f64],
    ) {
        let n = self.cloud.len();
        let whole = matches!(on, PointSubset::All) && partners.is_none();
        let mut blocks = self.bonds.take_blocks();
        let partners = partners.map(|marks| self.bonds.form().sites().spread_marks(marks));
        let heat = self.heat_at(step.t);
        let bonds = self.view().leading_to(partners.as_deref());
        let bonds = bonds.heated(heat.as_deref().map(Vec::as_slice));
        let moved = step.ghost_velocities(self.cloud.domain());
        let rule = BreakRule {
            threshold: L::threshold(self.critical_stretch),
            critical_stretch: self.critical_stretch,
            pairs: self.pairs.as_ref(),
            breakable: self.bonds.form().breakable(),
            volumes: self.cloud.volumes(),
            step,
            velocity: step.velocities(&moved),
            note_events: !whole,
        };
        self.with_packed(step.u, on, |u| {
            for_each_block(
                components_mut::<D>(out, n),
                &mut blocks,
                self.bonds.form().cost(on),
                &|first, mut out, block| {
                    let len = n.min(first + BLOCK) - first;
                    if let Some(wanted) = Rows::of_block(on, first, len) {
                        accept_rows::<L, D>(
                            self.instruction_set,
                            &bonds,
                            &rule,
                            u,
                            &mut block.intact,
                            &wanted,
                            &mut out,
                            &mut block.tally,
                        );
                    }
                },
            );
        });
        drop(heat);
        self.bonds.put_blocks(blocks);
        if !whole {
            self.bonds.break_other_ends();
        }
    }

    /// Returns the stiffness c α κ V of an entry from point i to site b.
    pub(super) fn stiffness_of(&self, entry: usize, i: usize, b: usize) -> f64 {
        let ends = [self.bonds.form().site(i), b];
        let cells = ends.map(|site| self.bonds.form().sites().places().cell_size(site));
        self.view().stiffness_of::<D>(entry, ends, cells)
    }

    /// Returns the memory use of the arrays of the loops without the list, bytes.
    pub(super) fn own_bytes(&self) -> usize {
        let rows = 2 * size_of_val(&self.reference[..]);
        rows + self.stiffness.bytes() + self.reach.bytes()
    }
}

/// Returns the coordinates followed by the volumes of the points, and the length of one unit along each axis.
/// Integer coordinates make bonds of equal offset bitwise identical.
fn reference_rows(cloud: &PointCloud) -> (Vec<Row>, [f64; 3]) {
    let row = |i: usize| {
        let [x, y, z] = match cloud.lattice() {
            Some(lattice) => lattice.coordinates(lattice.node[i]).map(f64::from),
            None => cloud.point(i),
        };
        Row([x, y, z, cloud.volumes()[i]])
    };
    let unit = cloud.lattice().map_or([1.0; 3], |lattice| lattice.spacing);
    ((0..cloud.len()).map(row).collect(), unit)
}
