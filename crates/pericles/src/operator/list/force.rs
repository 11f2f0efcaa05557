//! The force operator of a bond list: any body, any family.

use std::sync::Arc;

use super::arrays::Bonds;
use super::breaking::BreakRule;
use super::heat::Heat;
use super::kernels::accept_rows;
use super::other_ends::other_ends;
use super::packed::{Packed, Reach};
use super::stiffness::{Formula, Stiffness};
use crate::domain::Field;
use crate::error::{PericlesError, Result};
use crate::family::BondList;
use crate::lanes::LANES;
use crate::lanes::Row;
use crate::material::{BondConstants, BondMaterial, PairClasses};
use crate::operator::damage::{BlockDamage, Breaking, DamageMeasure};
use crate::operator::fast_law::FastLaw;
use crate::operator::pool::Pool;
use crate::operator::records::Records;
use crate::operator::rows::Rows;
use crate::operator::thresholds::PairThresholds;
use crate::operator::{Force, InstructionSet, On};
use crate::parallel::{BLOCK, components_mut, for_each_block};
use crate::space::{PointCloud, check_length, check_points};
use crate::step_end::StepEnd;

/// f(x_i) = Σ_j c α κ V_j s n over the bonds of a list: force density, N/m³.
///
/// A gather per point over [`BondList`], in parallel blocks; every bond is computed at both ends. ξ, |ξ|, partial volumes and influence functions of first degree are
/// computed from the points' positions, without roots and divisions (see [`FastLaw`]); other bonds of lattices keep a byte each that names their stiffness, and only bonds that are all
/// different keep a number.
///
/// Memory: 2.5 bytes per family entry and three bits, rows padded to eight; a byte or eight more where the stiffness is kept; 64 bytes per point.
pub struct BondForce<L: FastLaw, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: BondList,
    /// Coordinates and volumes, see [`Bonds`].
    reference: Vec<Row>,
    unit: [f64; 3],
    stiffness: Stiffness,
    pub(super) breakable: Option<Vec<u8>>,
    pub(super) critical_stretch: f64,
    /// Critical stretches by the materials of a bond's ends, in place of the one, which is then the smallest.
    pub(super) pairs: Option<PairThresholds>,
    pub(super) damage: DamageMeasure,
    pub(super) blocks: Vec<BlockDamage>,
    /// Thermal stretches, if the body is heated.
    pub(super) heat: Option<Heat>,
    reach: Reach,
    packed: Pool<Packed>,
    pub(super) instruction_set: InstructionSet,
    law: std::marker::PhantomData<L>,
}

crate::saved! {
    impl<L: FastLaw, const D: usize> Saved for BondForce<L, D> {
        blocks: under("operator"),
        cloud, bonds, reference, unit, stiffness, breakable, critical_stretch, pairs, damage: fixed,
        heat, reach, instruction_set, law: fixed,
        packed: scratch,
    }
}

impl<L: FastLaw, const D: usize> BondForce<L, D> {
    /// The operator of a material on a body.
    ///
    /// # Errors
    /// As of the other constructors: a cloud of another dimension than D, bonds of another cloud, points whose bonds never break that the cloud does not have.
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

    /// An operator whose bonds have the stiffness c α given as a function of their reference vector ξ, m; missing components are zero.
    /// It must be the same for ξ and −ξ.
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

    /// An operator whose bonds have the stiffness c α(i, j, ξ) given for each pair of points and the vector ξ from one to the other; it must be the same from both
    /// ends. Ghosts are counted behind own points.
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

    /// An operator whose bonds have the stiffness c α κ(a, b), partial volumes included, given for each pair of sites; it must be the same from both ends.
    pub fn with_weighted_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_pair: &(dyn Fn(&BondList, usize, usize) -> f64 + Sync),
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        check_length("the families of the bond list", bonds.len(), cloud.len())?;
        let stiffness = Stiffness::of_pairs(&bonds, &|i, b| {
            stiffness_of_pair(&bonds, bonds.site(i), b) * bonds.volume(b)
        });
        Self::build(cloud, bonds, stiffness, breaking, damage)
    }

    fn build(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness: Stiffness,
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Result<Self> {
        let n = cloud.len();
        if cloud.dimension() != D {
            return Err(PericlesError::WrongDimension {
                what: "this list of bonds",
                needed: ["1", "2", "3"][D - 1],
                dimension: cloud.dimension(),
            });
        }
        check_length("the families of the bond list", bonds.len(), n)?;
        check_points("the points whose bonds never break", breaking.no_fail, n)?;
        let (reference, unit) = reference_rows(bonds.sites().places());
        let blocks = (0..n.div_ceil(BLOCK))
            .map(|block| {
                let (from, to) = (block * BLOCK, ((block + 1) * BLOCK).min(n));
                let groups = bonds.start()[from]..bonds.start()[to];
                BlockDamage::new(bonds.present()[groups].to_vec())
            })
            .collect();
        let cells = bonds.shared_sites();
        let make = move || {
            let places = cells.places();
            Packed::new((0..places.len()).map(|site| places.cell_size(site)))
        };
        Ok(Self {
            reach: Reach::new(&bonds),
            packed: Pool::new(1, make),
            breakable: bonds.breakable(breaking.no_fail),
            cloud,
            bonds,
            reference,
            unit,
            stiffness,
            critical_stretch: breaking.critical_stretch,
            pairs: None,
            damage,
            blocks,
            heat: None,
            instruction_set: InstructionSet::detect(),
            law: std::marker::PhantomData,
        })
    }

    /// The same with critical stretches that depend on the materials of a bond's ends.
    ///
    /// # Errors
    /// Materials that are not one for each point.
    pub fn with_critical_stretches(self, classes: PairClasses) -> Result<Self> {
        check_length(
            "the materials of the points",
            classes.of_point().len(),
            self.cloud.len(),
        )?;
        Ok(Self {
            critical_stretch: classes.smallest_critical_stretch(),
            pairs: Some(PairThresholds::of::<L>(
                classes.on_sites(self.bonds.sites()),
            )),
            ..self
        })
    }

    /// Runs the loops with another instruction set; for tests and benchmarks.
    pub fn with_instruction_set(mut self, set: InstructionSet) -> Self {
        self.use_instruction_set(set);
        self
    }

    /// The families.
    pub fn bonds(&self) -> &BondList {
        &self.bonds
    }

    /// Whether an entry's bond is still there.
    pub fn is_intact(&self, i: usize, entry: usize) -> bool {
        let block = i / BLOCK;
        let group = entry / LANES - self.bonds.start()[block * BLOCK];
        self.blocks[block].intact[group] >> (entry % LANES) & 1 == 1
    }

    pub(super) fn view(&self) -> Bonds<'_> {
        Bonds::new(&self.bonds, &self.reference, self.unit, &self.stiffness)
    }

    /// Calls `work` with a vector on points packed as far as the wanted points need it.
    pub(super) fn with_packed(&self, owned: &[f64], on: &On<'_>, work: impl FnOnce(&Records)) {
        let ghosts = self.cloud.domain().ghosts(owned);
        let mut packed = self.packed.take();
        let field = Field::new(owned, &ghosts);
        work(packed.fill::<D>(field, on, self.bonds.sites(), &self.reach));
    }

    /// Runs a read-only loop over all blocks.
    pub(super) fn sweep<const C: usize>(
        &self,
        on: &On<'_>,
        out: &mut [f64],
        rows: impl Fn(&[u8], &Rows<'_>, &mut [&mut [f64]; C]) + Sync,
    ) {
        let n = self.cloud.len();
        // A vector of nothing: the blocks' state is only read, and no memory is taken.
        let mut nothing = vec![(); self.blocks.len()];
        for_each_block(
            components_mut::<C>(out, n),
            &mut nothing,
            &|first, mut out, ()| {
                if let Some(wanted) = Rows::of_block(on, first, out[0].len()) {
                    rows(&self.blocks[first / BLOCK].intact, &wanted, &mut out);
                }
            },
        );
    }

    /// Decides breaking of the wanted points' bonds, those that lead to `partners` if there are any, and adds the force of those that are left.
    pub(super) fn decide(
        &mut self,
        step: &StepEnd<'_>,
        on: &On<'_>,
        partners: Option<&[bool]>,
        out: &mut [f64],
    ) {
        let n = self.cloud.len();
        let whole = matches!(on, On::All) && partners.is_none();
        let mut blocks = std::mem::take(&mut self.blocks);
        let partners = partners.map(|marks| self.bonds.sites().spread_marks(marks));
        let heat = self.heat_at(step.t);
        let bonds = self.view().leading_to(partners.as_deref());
        let bonds = bonds.heated(heat.as_deref().map(Vec::as_slice));
        let moved = step.ghost_velocities(self.cloud.domain());
        let rule = BreakRule {
            threshold: L::threshold(self.critical_stretch),
            critical_stretch: self.critical_stretch,
            pairs: self.pairs.as_ref(),
            breakable: self.breakable.as_deref(),
            volumes: self.cloud.volumes(),
            step,
            velocity: step.velocities(&moved),
            note_events: !whole,
        };
        self.with_packed(step.u, on, |u| {
            for_each_block(
                components_mut::<D>(out, n),
                &mut blocks,
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
        self.blocks = blocks;
        if !whole {
            self.tell_the_other_ends();
        }
    }

    /// Clears the second copy of bonds that broke in a sweep over some of the points only, and books its half of the energy.
    fn tell_the_other_ends(&mut self) {
        for (j, back, dissipated) in other_ends(&self.bonds, &mut self.blocks) {
            let block = j / BLOCK;
            let group = back / LANES - self.bonds.start()[block * BLOCK];
            self.blocks[block].break_other_end(group, back % LANES, dissipated);
        }
    }

    /// Stiffness c α κ V of an entry of point i that leads to site b.
    pub(super) fn stiffness_of(&self, entry: usize, i: usize, b: usize) -> f64 {
        let ends = [self.bonds.site(i), b];
        let cells = ends.map(|site| self.bonds.sites().places().cell_size(site));
        self.view().stiffness_of::<D>(entry, ends, cells)
    }

    /// Memory of what the loops read beside the list, bytes.
    pub(super) fn own_bytes(&self) -> usize {
        let rows = 2 * size_of_val(&self.reference[..]);
        rows + self.stiffness.bytes() + self.reach.bytes()
    }
}

/// Coordinates with the points' volumes behind them, and the length of one unit along each axis. Integer coordinates make bonds of equal offset equal to the last bit.
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
