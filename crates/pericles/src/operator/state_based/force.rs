//! Neighbour-list force kernel of linear peridynamic solids.

use std::sync::Arc;

use super::bond_work::{KEPT, Worked, work_rows};
use super::bonds::{Layout, SolidBonds, pack};
use super::breaking::{BreakRule, States, heated_limit, take_bonds};
use super::heat::Heat;
use super::kernels::{accept_rows, dilatation_rows};
use super::kinematics::Kinematics;
use super::weight::Weight;
use crate::archive::Laid;
use crate::domain::Field;
use crate::family::BondList;
use crate::kernel::Influence;
use crate::lanes::{Row, dot};
use crate::material::{
    BondLimits, Materials, PairForce, SolidSurface, StateConstants, SurfaceFactors,
};
use crate::neighbourhood::{BlockDamage, DamageMeasure, Neighbourhood};
use crate::operator::list::stiffness::Stiffness;
use crate::operator::pool::{Lent, Pool};
use crate::operator::records::Records;
use crate::operator::rows::Rows;
use crate::operator::{InstructionSet, PointSubset};
use crate::parallel::{BLOCK, for_each_block, for_each_point};
use crate::space::PointCloud;
use crate::step_end::StepEnd;

/// Force density of linear peridynamic solids, N/m³, in two passes over a neighbour list:
///
/// θ_i = (D/m_i) Σ_j ω r e, then f_i = Σ_j ω [A_i θ_i/m_i + A_j θ_j/m_j + (B_i/m_i + B_j/m_j) e/r] (r/|y|) y,
/// with the weight ω = w b V_j of influence function, partial volume and volume, and the extension e and
/// direction y of the bond given by [`Kinematics`].
///
/// m_i = Σ_j ω r² is computed once from the initial bonds and does not change when bonds break. Therefore f
/// remains the gradient of Σ W V with W = A θ²/(2 D) + B/(2 m) Σ ω e², and θ vanishes with the bonds.
///
/// Memory: no number per bond for a constant, conical or inverse influence function (see
/// [`BondForce`](crate::operator::BondForce)); 24 bytes per bond for failure by bond energy.
pub struct LinearSolidForce<L: Kinematics, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Neighbourhood<BondList>,
    pub(super) layout: Layout,
    pub(super) weight: Weight,
    /// Factors of the stiffness of bonds near surfaces, with surface correction.
    factor: Option<Stiffness>,
    pub(super) states: States,
    pub(super) classes: Materials<StateConstants>,
    /// Limits of the weakest pair of materials.
    pub(super) weakest: BondLimits,
    /// Influence function, for failure by bond energy.
    pub(super) influence: Option<Weight>,
    /// Values stored for failure by bond energy, [`KEPT`] per group.
    pub(super) work: Vec<f64>,
    /// Thermal strain, if the material expands.
    pub(super) heat: Option<Heat>,
    packed: Pool<Vec<Row>>,
    pub(super) instruction_set: InstructionSet,
    kinematics: std::marker::PhantomData<L>,
}

crate::saved! {
    impl<L: Kinematics, const D: usize> Checkpointed for LinearSolidForce<L, D> {
        bonds: part,
        work: by(Laid::rows("operator/bond-work", bonds.form().start(), work.len())),
        cloud, layout, weight, factor, states, classes, weakest, influence: fixed,
        instruction_set, kinematics: fixed,
        heat: rebuilt,
        packed: scratch,
    } then |force| {
        force.renew_volumes(None);
        Ok(())
    }
}

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// Creates the force of solids with one influence function on the bonds of a body. Bonds of the points
    /// `no_fail` never break.
    ///
    /// # Panics
    /// If the dimension of the cloud is not D.
    pub fn new(
        cloud: Arc<PointCloud>,
        mut bonds: BondList,
        influence: &Influence,
        classes: Materials<StateConstants>,
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Self {
        assert_eq!(cloud.dimension(), D, "a force of the cloud's dimension");
        let weight = Weight::of_volumes(&cloud, &bonds, influence);
        let volumes = weighted_volumes::<D>(&cloud, &bonds, &weight);
        let sites = bonds.shared_sites();
        let spread = |of_points: &[f64]| sites.spread(of_points).into_owned();
        let states = States::new::<D>(&volumes, &classes, &spread);
        let classes = classes.on_sites(&sites);
        let layout = Layout::new(&sites, &states.stiffness);
        let weakest = classes.weakest();
        let by_energy = weakest.energy.is_finite();
        Self {
            influence: by_energy.then(|| Weight::of_influence(&cloud, &bonds, influence)),
            work: match by_energy {
                true => vec![0.0; KEPT * bonds.present().len()],
                false => Vec::new(),
            },
            heat: None,
            packed: Pool::new(1, move || vec![Row::default(); sites.len()]),
            bonds: {
                bonds.hold(no_fail);
                Neighbourhood::new(bonds, damage)
            },
            cloud,
            layout,
            weight,
            factor: None,
            states,
            classes,
            weakest,
            instruction_set: InstructionSet::detect(),
            kinematics: std::marker::PhantomData,
        }
    }

    /// Adds surface correction. Each bond stores a number, or a byte if there are few distinct values.
    pub fn with_surface(self, surface: SolidSurface, influence: &Influence) -> Self {
        let factors = match surface.factors(self.bonds.form(), influence, &self.classes) {
            SurfaceFactors::None => None,
            factors => Some(Stiffness::of_pairs(self.bonds.form(), &|i, b| {
                let a = self.bonds.form().site(i);
                factors.of_bond(a, b, self.bonds.form().vector(a, b))
            })),
        };
        Self {
            factor: factors,
            ..self
        }
    }

    /// Returns whether bonds near surfaces have factors.
    pub(super) fn is_corrected(&self) -> bool {
        self.factor.is_some()
    }

    /// Returns the families.
    pub fn bonds(&self) -> &Neighbourhood<BondList> {
        &self.bonds
    }

    /// Returns the weighted volume m of a point, m⁵ for a dimensionless influence function; infinite for a
    /// point without bonds.
    pub fn weighted_volume(&self, i: usize) -> f64 {
        D as f64 / self.states.dilatation[i]
    }

    pub(super) fn view(&self) -> SolidBonds<'_> {
        SolidBonds {
            list: self.bonds.form(),
            layout: &self.layout,
            weight: &self.weight,
            factor: self.factor.as_ref(),
        }
    }

    /// Returns rows of displacements.
    pub(super) fn packed(&self, u: Field<'_>) -> Lent<'_, Vec<Row>> {
        let mut rows = self.packed.take();
        pack::<D>(u, self.bonds.form().sites(), |_| 0.0, &mut rows);
        rows
    }

    /// Returns rows of a vector and of p for the given values of the pass over points: dilatations, and
    /// thermal pulls of a heated body.
    pub(super) fn packed_with(&self, u: Field<'_>, values: Field<'_>) -> Lent<'_, Vec<Row>> {
        let (sites, pressure) = (self.bonds.form().sites(), &self.states.pressure);
        match self.heat {
            None => self.packed_beside(u, |site| {
                pressure[site] * values.at::<1>(0, sites.point(site))
            }),
            Some(_) => self.packed_beside(u, |site| {
                let [theta, pull] = [0, 1].map(|c| values.at::<2>(c, sites.point(site)));
                pressure[site] * theta + pull
            }),
        }
    }

    /// Returns rows of a vector followed by a number per site.
    pub(super) fn packed_beside(
        &self,
        u: Field<'_>,
        number: impl Fn(usize) -> f64 + Sync,
    ) -> Lent<'_, Vec<Row>> {
        let mut rows = self.packed.take();
        pack::<D>(u, self.bonds.form().sites(), number, &mut rows);
        rows
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

    /// Sets the dilatations of the points `on`.
    pub(super) fn dilatations_into(&self, u: Field<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let (bonds, factors) = (self.view(), &self.states.dilatation[..]);
        let u = self.packed(u);
        self.sweep::<1>(on, out, |intact, rows, out| {
            let set = self.instruction_set;
            dilatation_rows::<L, D>(set, &bonds, factors, &u, intact, rows, out);
        });
    }

    /// Returns the failure criterion for the points `on`; `velocity` contains the mean velocities over the
    /// step, if needed.
    pub(super) fn rule<'a>(
        &'a self,
        step: &'a StepEnd<'a>,
        velocity: Option<Field<'a>>,
        on: &PointSubset<'_>,
    ) -> BreakRule<'a> {
        BreakRule {
            threshold: L::Measure::threshold(self.weakest.stretch),
            energy: self.weakest.energy,
            classes: &self.classes,
            breakable: self.bonds.form().breakable(),
            states: &self.states,
            volumes: self.cloud.volumes(),
            step,
            velocity,
            note_events: !matches!(on, PointSubset::All),
            stretches: None,
        }
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
        let n = self.cloud.len();
        let broken = self.broken_by_blocks();
        let stretches = self.stretches(step.t);
        let mut blocks = self.bonds.take_blocks();
        let bonds = self.view();
        let moved = step.ghost_velocities(self.cloud.domain());
        let mut rule = self.rule(step, step.velocities(&moved), on);
        if let Some(stretches) = &stretches {
            let coldest = stretches.iter().copied().fold(f64::INFINITY, f64::min);
            let limit = heated_limit(self.weakest.stretch, coldest);
            rule.threshold = L::Measure::threshold(limit);
            rule.stretches = Some(stretches);
        }
        let u = self.packed(u);
        for_each_block(
            [dilatations],
            &mut blocks,
            self.bonds.form().cost(on),
            &|first, mut out, block| {
                let len = n.min(first + BLOCK) - first;
                if let Some(wanted) = Rows::of_block(on, first, len) {
                    accept_rows::<L, D>(
                        self.instruction_set,
                        &bonds,
                        &rule,
                        &u,
                        &mut block.intact,
                        &wanted,
                        &mut out,
                        &mut block.tally,
                    );
                }
            },
        );
        self.clear_other_ends(&rule, &u, &mut blocks);
        drop(u);
        self.bonds.put_blocks(blocks);
        self.renew_volumes(broken);
    }

    /// Updates the work of the bonds of the points `on`, breaks bonds whose energy exceeds their limit, and
    /// sets the dilatations of points that lost bonds. `dilatations` must contain the values of all points on
    /// which the bonds depend.
    pub(super) fn break_by_energy(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        dilatations: &mut [f64],
    ) {
        let Some(influence) = &self.influence else {
            return;
        };
        let n = self.cloud.len();
        let (mut blocks, mut work) = (self.bonds.take_blocks(), std::mem::take(&mut self.work));
        let ghosts = self.cloud.domain().ghosts(dilatations);
        // These rows contain the dilatations before failure; the values of points that lose bonds change.
        let u = self.packed_with(u, Field::new(dilatations, &ghosts));
        let moved = step.ghost_velocities(self.cloud.domain());
        let rule = self.rule(step, step.velocities(&moved), on);
        let worked = Worked {
            bonds: self.view(),
            influence,
        };
        for_each_block(
            [dilatations],
            &mut with_work(&mut blocks, &mut work),
            self.bonds.form().cost(on),
            &|first, mut out, (block, kept)| {
                let len = n.min(first + BLOCK) - first;
                if let Some(wanted) = Rows::of_block(on, first, len) {
                    work_rows::<L, D>(
                        self.instruction_set,
                        &worked,
                        &rule,
                        &u,
                        block,
                        kept,
                        &wanted,
                        &mut out,
                    );
                }
            },
        );
        self.clear_other_ends(&rule, &u, &mut blocks);
        drop(u);
        self.bonds.put_blocks(blocks);
        self.work = work;
    }

    /// Breaks the other end of bonds that broke in a sweep over a subset of points, and records the energy
    /// dissipated there.
    pub(super) fn clear_other_ends(
        &self,
        rule: &BreakRule<'_>,
        u: &Records,
        blocks: &mut [BlockDamage],
    ) {
        if !rule.note_events {
            return;
        }
        let bonds = self.view();
        let rule = BreakRule {
            note_events: false,
            ..*rule
        };
        for end in self.bonds.other_ends(blocks) {
            let (j, place) = (end.point, end.place);
            let BlockDamage { intact, tally } = &mut blocks[place.block];
            let groups = self.bonds.form().groups_in_block(j);
            let group = place.group - groups.start;
            let intact = &mut intact[groups];
            let mut broken = vec![0; intact.len()];
            broken[group] = intact[group] & 1 << place.lane;
            take_bonds::<L, D>(&bonds, &rule, u, j, intact, &broken, tally);
        }
    }

    /// Returns the memory use of the arrays of the loops without the list, bytes.
    pub(super) fn own_bytes(&self) -> usize {
        let rows = size_of::<Row>() * self.cloud.len();
        let states = self.states.bytes();
        let influence = self.influence.as_ref().map_or(0, Weight::bytes);
        let factor = self.factor.as_ref().map_or(0, Stiffness::bytes);
        let work = size_of_val(&self.work[..]);
        rows + states + factor + self.layout.bytes() + self.weight.bytes() + influence + work
    }
}

/// Returns the blocks with their stored values of bonds.
fn with_work<'a>(
    blocks: &'a mut [BlockDamage],
    mut work: &'a mut [f64],
) -> Vec<(&'a mut BlockDamage, &'a mut [f64])> {
    let mut parts = Vec::with_capacity(blocks.len());
    for block in blocks {
        let (own, rest) = work.split_at_mut(KEPT * block.intact.len());
        parts.push((block, own));
        work = rest;
    }
    parts
}

/// Returns m = Σ ω r² of each point over its existing bonds.
fn weighted_volumes<const D: usize>(
    cloud: &PointCloud,
    bonds: &BondList,
    weight: &Weight,
) -> Vec<f64> {
    let nothing = vec![0.0; bonds.sites().len()];
    let layout = Layout::new(bonds.sites(), &nothing);
    let view = SolidBonds {
        list: bonds,
        layout: &layout,
        weight,
        factor: None,
    };
    for_each_point(cloud.len(), &|i| {
        let family = bonds
            .family(i)
            .filter(|&(entry, _)| bonds.is_present(entry));
        family
            .map(|(entry, b)| {
                let a = bonds.site(i);
                let xi = view.vector::<D>(a, b);
                view.weight_of(entry, [a, b], xi) * dot(xi, xi)
            })
            .sum()
    })
}
