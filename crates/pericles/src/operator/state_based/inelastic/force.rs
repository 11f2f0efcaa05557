//! Neighbour-list force kernel of inelastic solids.

use super::super::breaking::Stored;
use super::super::force::LinearSolidForce;
use super::super::kinematics::Kinematics;
use super::super::weight::Weight;
use super::advance::{Advance, advance_rows, sum_rows};
use super::history::History;
use super::kernels::{Points, Reliefs, point_rows};
use super::laws::{Laws, mean_square};
use crate::domain::Field;
use crate::error::{PericlesError, Result};
use crate::kernel::Influence;
use crate::lanes::{Row, dot};
use crate::material::Inelasticity;
use crate::operator::PointSubset;
use crate::operator::pool::{Lent, Pool};
use crate::operator::rows::Rows;
use crate::parallel::{BLOCK, for_each_block, for_each_point};
use crate::step_end::StepEnd;
use rayon::prelude::*;

/// Force density of linear peridynamic solids with viscous or plastic shear ([`Inelasticity`]), on a
/// neighbour list, N/m³.
///
/// The force state of a point is t_ij = (w/m)(A θ r + B (e − e_x)) with the inelastic extension e_x of the
/// directed bond. Viscous, plastic and elastic materials can be combined. Bonds break at their critical
/// stretch. Inelastic extensions are updated at the end of each accepted step. In between, the force at time
/// t and displacement u belongs to a step from the last accepted state to t: stages and static solvers
/// include the viscosity and plasticity of the current step, and the tangent is the derivative of this force.
///
/// Energy dissipated by flow and relaxation is added to that of breaking bonds
/// ([`BondSet::dissipated`](crate::neighbourhood::BondSet::dissipated)). With hardening, all plastic work
/// counts as dissipated.
///
/// For influence functions other than the constant one, the plastic flow of a point is radial but not normal
/// to the yield surface, and the tangent of yielding points is not symmetric.
///
/// Memory in addition to [`LinearSolidForce`]: 20 bytes per directed bond, and 8 bytes per viscous term.
pub struct InelasticSolidForce<L: Kinematics, const D: usize> {
    pub(super) solid: LinearSolidForce<L, D>,
    pub(super) laws: Laws,
    pub(super) history: History,
    /// Influence function, if a material yields.
    pub(super) influence: Option<Weight>,
    states: Pool<Vec<Row>>,
    reliefs: Pool<Vec<f64>>,
}

crate::saved! {
    impl<L: Kinematics, const D: usize> Checkpointed for InelasticSolidForce<L, D> {
        solid, history: part,
        laws, influence: fixed,
        states, reliefs: scratch,
    }
}

impl<L: Kinematics, const D: usize> InelasticSolidForce<L, D> {
    /// Creates the force of a solid with these inelastic laws, one per material. The solid must have the
    /// influence function `influence`, no surface correction, and no failure by bond energy.
    ///
    /// # Errors
    /// A body divided among processes; more than 4.29e9 directed bonds.
    pub fn new(
        solid: LinearSolidForce<L, D>,
        of_material: Vec<Inelasticity>,
        influence: &Influence,
    ) -> Result<Self> {
        if solid.cloud.domain().is_divided() {
            return Err(PericlesError::FormNotUsable {
                form: "list",
                reason: "viscous and plastic materials store the history of both ends of a bond in the same process, but this body is divided among processes",
            });
        }
        let mut laws = Laws {
            terms: of_material
                .iter()
                .map(|law| law.terms().len())
                .fold(0, usize::max),
            of_material,
            strength: Vec::new(),
        };
        let influence = laws
            .yields()
            .then(|| Weight::of_influence(&solid.cloud, solid.bonds.form(), influence));
        if let Some(influence) = &influence {
            laws.strength = strengths(&solid, &laws, influence);
        }
        let n = solid.cloud.len();
        let volumes = (0..n).map(|i| solid.weighted_volume(i));
        let volumes = volumes.map(|m| if m.is_finite() { m } else { 0.0 });
        let history = History::new(solid.bonds.form(), laws.terms, volumes.collect())?;
        let (sites, entries) = (solid.bonds.form().sites().len(), history.inelastic.len());
        Ok(Self {
            solid,
            laws,
            history,
            influence,
            states: Pool::new(1, move || vec![Row::default(); sites]),
            reliefs: Pool::new(0, move || vec![0.0; entries]),
        })
    }

    /// Returns the elastic solid.
    pub fn solid(&self) -> &LinearSolidForce<L, D> {
        &self.solid
    }

    /// Returns the equivalent plastic strain ε_p of each point.
    pub fn plastic_strain(&self) -> &[f64] {
        &self.history.plastic_strain
    }

    /// Returns the accumulated plastic multiplier of each point, m⁵/Pa for a dimensionless influence
    /// function. The change of the plastic extensions is the change of the multiplier times the deviatoric
    /// force state divided by w.
    pub fn multiplier(&self) -> &[f64] {
        &self.history.multiplier
    }

    /// Returns √(2 ψ₀) of a point, the norm of the deviatoric force state at first yield; infinite if the
    /// point does not yield.
    pub fn strength(&self, i: usize) -> f64 {
        self.laws.strength.get(i).copied().unwrap_or(f64::INFINITY)
    }

    /// Returns the inelastic stretch e_x/r of an entry.
    pub fn inelastic_stretch(&self, entry: usize) -> f64 {
        self.history.inelastic[entry]
    }

    pub(super) fn points(&self, t: f64) -> Points<'_> {
        Points {
            laws: &self.laws,
            classes: &self.solid.classes,
            states: &self.solid.states,
            history: &self.history,
            influence: self.influence.as_ref(),
            t,
        }
    }

    /// Returns R of all entries at time t; `None` if they are those at the end of the last step.
    pub(super) fn reliefs_at(&self, t: f64) -> Option<Lent<'_, Vec<f64>>> {
        if self.laws.terms == 0 || self.history.time.iter().all(|&time| time >= t) {
            return None;
        }
        let mut reliefs = self.reliefs.take();
        let Self { solid, laws, .. } = self;
        self.history
            .reliefs_into(t, solid.bonds.form(), laws, &solid.classes, &mut reliefs);
        Some(reliefs)
    }

    /// Returns the data of the loops over bonds, with rows of S and G.
    pub(super) fn reliefs<'a>(
        &'a self,
        at_time: &'a Option<Lent<'_, Vec<f64>>>,
        states: &'a [Row],
    ) -> Reliefs<'a> {
        Reliefs {
            of_entries: match at_time {
                Some(reliefs) => reliefs,
                None => &self.history.inelastic,
            },
            opposite: &self.history.opposite,
            states,
        }
    }

    /// Returns rows of S and G, or of their changes, from the values of points.
    pub(super) fn state_rows(&self, values: Field<'_>, changes: bool) -> Lent<'_, Vec<Row>> {
        let mut rows = self.states.take();
        let sites = self.solid.bonds.form().sites();
        let row = |site: usize| {
            let stiffness = values.at::<3>(2, sites.point(site));
            let law = &self.laws.of_material[self.solid.classes.of_point(site)];
            let factor = match law {
                Inelasticity::Elastic => 0.0,
                Inelasticity::Plastic(_) => stiffness,
                Inelasticity::Viscous(_) if changes => 0.0,
                Inelasticity::Viscous(_) => self.solid.states.stiffness[site],
            };
            Row([stiffness, factor, 0.0, 0.0])
        };
        rows.par_chunks_mut(8 * BLOCK)
            .enumerate()
            .for_each(|(part, rows)| {
                for (site, out) in (8 * BLOCK * part..).zip(rows) {
                    *out = row(site);
                }
            });
        rows
    }

    /// Returns rows of a vector and of P, or of its change.
    pub(super) fn packed_with(&self, u: Field<'_>, values: Field<'_>) -> Lent<'_, Vec<Row>> {
        let sites = self.solid.bonds.form().sites();
        self.solid
            .packed_beside(u, |site| values.at::<3>(1, sites.point(site)))
    }

    /// Sets P and S of the points `on`; the dilatation is the first of the values.
    pub(super) fn states_into(
        &self,
        t: f64,
        u: Field<'_>,
        on: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        let (bonds, points) = (self.solid.view(), self.points(t));
        let u = self.solid.packed(u);
        self.solid.sweep::<3>(on, values, |intact, rows, out| {
            let set = self.solid.instruction_set;
            point_rows::<L, D>(set, &bonds, &points, &u, intact, rows, out);
        });
    }

    /// Updates the inelastic stretches of the points `on` to the end of a step.
    pub(super) fn advance(&mut self, step: &StepEnd<'_>, u: Field<'_>, on: &PointSubset<'_>) {
        let mut blocks = self.solid.bonds.take_blocks();
        let mut history = std::mem::take(&mut self.history);
        let (bonds, set) = (self.solid.view(), self.solid.instruction_set);
        let (n, rule) = (self.solid.cloud.len(), self.rule(step));
        let u = self.solid.packed(u);
        let (points, mut parts) = history.split(self.solid.bonds.form().start(), &mut blocks);
        for_each_block(
            points,
            &mut parts,
            self.solid.bonds.form().cost(on),
            &|first, mut out, part| {
                let len = n.min(first + BLOCK) - first;
                if let Some(wanted) = Rows::of_block(on, first, len) {
                    advance_rows::<L, D>(set, &bonds, &rule, &u, part, &wanted, &mut out);
                }
            },
        );
        drop(u);
        self.solid.bonds.put_blocks(blocks);
        self.history = history;
    }

    /// Updates the sums over bonds in all blocks in which the number of broken bonds differs from `before`.
    pub(super) fn renew_sums(&mut self, step: &StepEnd<'_>, u: Field<'_>, before: &[u64]) {
        let mut blocks = self.solid.bonds.take_blocks();
        let mut history = std::mem::take(&mut self.history);
        let (bonds, set) = (self.solid.view(), self.solid.instruction_set);
        let (n, rule) = (self.solid.cloud.len(), self.rule(step));
        let u = self.solid.packed(u);
        let start = self.solid.bonds.form().start();
        let ([_, volumes, ..], mut parts) = history.split(start, &mut blocks);
        for_each_block(
            [volumes],
            &mut parts,
            self.solid.bonds.form().cost(&PointSubset::All),
            &|first, mut out, part| {
                let len = n.min(first + BLOCK) - first;
                if let Some(rows) = Rows::of_block(&PointSubset::All, first, len)
                    && part.damage.tally.broken.get() != before[first / BLOCK]
                {
                    sum_rows::<D>(set, &bonds, &rule, &u, part, &rows, &mut out);
                }
            },
        );
        drop(u);
        self.solid.bonds.put_blocks(blocks);
        self.history = history;
    }

    /// Returns the data of the end of a step read by the loops, without the arrays that they modify.
    fn rule(&self, step: &StepEnd<'_>) -> Advance<'_> {
        Advance {
            laws: &self.laws,
            classes: &self.solid.classes,
            states: &self.solid.states,
            volumes: self.solid.cloud.volumes(),
            influence: self.influence.as_ref(),
            terms: self.laws.terms,
            t: step.t,
            starts: step.is_start(),
        }
    }

    /// Breaks bonds of the points `on` and sets the dilatations of the points `needed`.
    pub(super) fn break_bonds(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        [on, needed]: [&PointSubset<'_>; 2],
        dilatations: &mut [f64],
    ) {
        if !self.solid.weakest.stretch.is_finite() {
            return self.solid.dilatations_into(u, needed, dilatations);
        }
        let before = self.solid.bonds.broken_by_blocks();
        self.breaking_solid(|solid, stored| {
            solid.break_by_stretch(step, u, on, dilatations, Some(stored));
        });
        if !matches!(on, PointSubset::All) {
            self.solid.dilatations_into(u, needed, dilatations);
        }
        if self.solid.bonds.broken_by_blocks() != before {
            self.renew_sums(step, u, &before);
        }
    }

    /// Calls `break_bonds` with the elastic solid and the stored energy of its bonds.
    pub(super) fn breaking_solid<T>(
        &mut self,
        break_bonds: impl FnOnce(&mut LinearSolidForce<L, D>, Stored<'_>) -> T,
    ) -> T {
        let Self {
            solid,
            history,
            laws,
            ..
        } = self;
        let material: Vec<u8> = (0..solid.cloud.len())
            .map(|i| solid.classes.of_point(solid.bonds.form().site(i)) as u8)
            .collect();
        let stored = |i: usize, entry: usize| {
            history.stored(&laws.of_material[usize::from(material[i])], entry)
        };
        break_bonds(solid, &stored)
    }

    /// Returns the memory use without the elastic solid, bytes.
    pub(super) fn own_bytes(&self) -> usize {
        let influence = self.influence.as_ref().map_or(0, Weight::bytes);
        let strength = size_of_val(&self.laws.strength[..]);
        let states = size_of::<Row>() * self.solid.bonds.form().sites().len();
        self.history.bytes() + influence + strength + states
    }
}

/// Returns √(2 ψ₀) of each point.
fn strengths<L: Kinematics, const D: usize>(
    solid: &LinearSolidForce<L, D>,
    laws: &Laws,
    influence: &Weight,
) -> Vec<f64> {
    let (bonds, list) = (solid.view(), solid.bonds.form());
    for_each_point(solid.cloud.len(), &|i| {
        let a = list.site(i);
        let law = &laws.of_material[solid.classes.of_point(a)];
        let (Inelasticity::Plastic(law), true) = (law, solid.states.dilatation[i] > 0.0) else {
            return f64::INFINITY;
        };
        let family = list.family(i).filter(|&(entry, _)| list.is_present(entry));
        let square: f64 = family
            .map(|(entry, b)| {
                let xi = bonds.vector::<D>(a, b);
                let square = dot(xi, xi);
                let w = influence.of_entry(entry, square.sqrt(), 1.0, [0.0; 2]);
                bonds.weight_of(entry, [a, b], xi) * w * square
            })
            .sum();
        law.stress * (mean_square(D) * square).sqrt() / solid.weighted_volume(i)
    })
}
