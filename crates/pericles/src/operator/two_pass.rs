//! Forces in two passes: a pass over points computes a few values per point, a pass over bonds reads the
//! values of both ends.

use std::sync::Arc;

use super::pool::{Lent, Pool};
use super::{
    BondView, Breakable, Capabilities, DilatationView, Force, InstructionSet, LinearOperator,
    Linearity, LocalForce, PointSubset, StencilForce,
};
use crate::archive::{Archive, Checkpointed};
use crate::domain::{Domain, Field};
use crate::error::Result;
use crate::space::{PointCloud, PointSet};
use crate::step_end::StepEnd;
use crate::thermal::{Expandable, ThermalExpansion};

/// Data read by the pass over bonds at both ends of a bond.
#[derive(Debug, Clone, Copy)]
pub struct AtPoints<'a> {
    /// Displacement, m.
    pub u: Field<'a>,
    /// Result of the pass over points.
    pub values: Field<'a>,
}

/// A force density whose bonds depend on other bonds of their ends, such as that of a state-based material:
/// the dilatation of a point, or a tensor, is a sum over all of its bonds, and the force of a bond depends on
/// the values of both ends.
///
/// [`TwoPassForce`] implements [`Force`]: it runs both passes on the required points and exchanges values
/// between processes.
pub trait TwoPass: Checkpointed + Send + Sync {
    /// Returns the number of values per point.
    fn values_per_point(&self) -> usize;

    /// Pass over points: sets the values (component-major) of the points `on` from the displacements; other
    /// entries are unchanged.
    fn values_into(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]);

    /// Sets the derivatives of all values at `u` in a direction.
    fn value_changes_into(&self, t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]);

    /// Pass over bonds: adds the force density of the points `on`, N/m³.
    fn add_bond_force(&self, t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]);

    /// Adds the derivative of the force density in the direction `change.u`, in which the values change by
    /// `change.values`.
    fn add_bond_tangent(&self, t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]);

    /// Adds the elastic energy density, J/m³.
    fn add_energy_density(&self, t: f64, at: AtPoints<'_>, out: &mut [f64]);

    /// See [`Force::frequency_bound`].
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64;

    /// Returns whether the force is linear in the displacement while no bond breaks.
    fn is_linear(&self) -> bool {
        false
    }

    /// Calls `visit` once for each point other than i that is bonded to own point i; ghosts are counted after the own
    /// points.
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// Ends a step at the displacement `u`: applies the failure criterion to the bonds of the points `on`, at
    /// both ends with the same result, and sets the values of the points `needed` from the remaining bonds. `needed` are the
    /// points `on` and all points bonded to them.
    fn end_values_into(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        needed: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        let _ = on;
        self.values_into(step.t, u, needed, values);
    }

    /// Returns the bonds if they can break.
    fn breaking(&self) -> Option<&dyn Breakable> {
        None
    }

    /// Returns the bonds for modification if they can break.
    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        None
    }

    /// Returns the index of the value that is the dilatation, if there is one.
    fn dilatation(&self) -> Option<usize> {
        None
    }

    /// Returns access to individual bonds, if available.
    fn bonds(&self) -> Option<&dyn BondView> {
        None
    }

    /// Returns the thermal expansion of the material, if any.
    fn thermal(&self) -> Option<&ThermalExpansion> {
        None
    }

    /// Returns the force as data, if it consists of the bonds of a stencil at constant temperature.
    fn stencil(&self) -> Option<&dyn StencilForce> {
        None
    }

    /// Returns [`TwoPass::stencil`] for modification.
    fn stencil_mut(&mut self) -> Option<&mut dyn StencilForce> {
        None
    }

    /// Returns the material for setting a thermal expansion, if supported. This may change the number of
    /// values.
    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        None
    }

    /// Returns the number of family entries in the loops: each bond counts twice.
    fn directed_bonds(&self) -> u64;

    /// Returns the memory use, bytes.
    fn bytes(&self) -> usize;

    /// Returns the instruction set of the loops.
    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::Baseline
    }

    /// See [`Force::use_instruction_set`].
    fn use_instruction_set(&mut self, set: InstructionSet) {
        let _ = set;
    }
}

/// [`Force`] of a [`TwoPass`] force.
pub struct TwoPassForce<F: TwoPass> {
    force: F,
    cloud: Arc<PointCloud>,
    /// Work arrays for the values of own points.
    work: Pool<Vec<f64>>,
}

impl<F: TwoPass> TwoPassForce<F> {
    /// Creates the operator of a force on the points of a body.
    pub fn new(cloud: Arc<PointCloud>, force: F) -> Self {
        let entries = cloud.len() * force.values_per_point();
        Self {
            force,
            cloud,
            work: Pool::new(1, move || vec![0.0; entries]),
        }
    }

    /// Returns the two-pass force.
    pub fn force(&self) -> &F {
        &self.force
    }

    /// Returns the values at `u` of the points `on` and of all points bonded to them: values of own points and
    /// of ghosts.
    fn values(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>) -> (Lent<'_, Vec<f64>>, Vec<f64>) {
        let mut own = self.work.take();
        match on {
            PointSubset::All => self.force.values_into(t, u, on, &mut own),
            part => {
                let needed = self.with_neighbours(part);
                self.force
                    .values_into(t, u, &PointSubset::Set(&needed), &mut own);
            }
        }
        let ghosts = self.cloud.domain().ghosts(&own);
        (own, ghosts)
    }

    fn with_neighbours(&self, on: &PointSubset<'_>) -> PointSet {
        with_neighbours(self.cloud.domain(), on, &|i, visit| {
            self.force.neighbours(i, visit);
        })
    }
}

/// Calls its second argument for the points that are bonded to an own point; ghosts are counted after the own points.
pub type Neighbours<'a> = dyn Fn(usize, &mut dyn FnMut(usize)) + 'a;

/// Returns the own points that are in `on`, or bonded to a point that is in `on` of its process. All processes must call
/// it together.
pub fn with_neighbours(
    domain: &Domain,
    on: &PointSubset<'_>,
    neighbours: &Neighbours<'_>,
) -> PointSet {
    let n = domain.owned_points();
    let mut marks = vec![false; n + domain.ghost_points()];
    on.for_each(n, |i| {
        marks[i] = true;
        neighbours(i, &mut |j| marks[j] = true);
    });
    domain.merge_ghost_marks(&mut marks);
    let marked = |i: &u32| marks[*i as usize];
    (0..n as u32).filter(marked).collect()
}

impl<F: TwoPass> Force for TwoPassForce<F> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let u = Field::new(u, &ghosts);
        let (own, ghosts) = self.values(t, u, &on);
        let values = Field::new(&own, &ghosts);
        self.force
            .add_bond_force(t, AtPoints { u, values }, &on, out);
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let u = Field::new(u, &ghosts);
        let (own, ghosts) = self.values(t, u, &PointSubset::All);
        let values = Field::new(&own, &ghosts);
        self.force
            .add_energy_density(t, AtPoints { u, values }, out);
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        let volumes = self.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.cloud.domain().sum(self.points(), energy)
    }

    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        self.force.frequency_bound(density)
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let domain = self.cloud.domain();
        let (ghosts, direction_ghosts) = (domain.ghosts(u), domain.ghosts(direction));
        let u = Field::new(u, &ghosts);
        let direction = Field::new(direction, &direction_ghosts);
        let (own, ghosts) = self.values(t, u, &PointSubset::All);
        let values = Field::new(&own, &ghosts);
        let mut changes = self.work.take();
        self.force.value_changes_into(t, u, direction, &mut changes);
        let ghosts = domain.ghosts(&changes);
        let change = AtPoints {
            u: direction,
            values: Field::new(&changes, &ghosts),
        };
        self.force
            .add_bond_tangent(t, AtPoints { u, values }, change, out);
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        let domain = self.cloud.domain();
        let ghosts = domain.ghosts(step.u);
        let u = Field::new(step.u, &ghosts);
        let part;
        let needed = match &on {
            PointSubset::All => PointSubset::All,
            on => {
                part = self.with_neighbours(on);
                PointSubset::Set(&part)
            }
        };
        let mut own = self.work.take();
        self.force.end_values_into(step, u, &on, &needed, &mut own);
        let ghosts = domain.ghosts(&own);
        let values = Field::new(&own, &ghosts);
        self.force
            .add_bond_force(step.t, AtPoints { u, values }, &on, out);
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: match self.force.is_linear() {
                true => Linearity::Exact(self),
                false => Linearity::Nonlinear,
            },
            breaking: self.force.breaking(),
            local: Some(self),
            // The force of a bond depends on all bonds of its ends.
            split: None,
            bonds: self.force.bonds(),
            dilatation: self.force.dilatation().map(|_| self as &dyn DilatationView),
            thermal: self.force.thermal(),
            stencil: self.force.stencil(),
            ..Capabilities::default()
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        self.force.breaking_mut()
    }

    fn stencil_mut(&mut self) -> Option<&mut dyn StencilForce> {
        self.force.stencil_mut()
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        self.force.expandable_mut()?;
        Some(self)
    }

    fn directed_bonds(&self) -> u64 {
        self.force.directed_bonds()
    }

    fn bytes(&self) -> usize {
        let values = 2 * self.points() * self.force.values_per_point();
        self.force.bytes() + values * size_of::<f64>()
    }

    fn values_between_passes(&self) -> usize {
        self.force.values_per_point()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.force.instruction_set()
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        self.force.use_instruction_set(set);
    }
}

impl<F: TwoPass> Expandable for TwoPassForce<F> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        if let Some(material) = self.force.expandable_mut() {
            material.expand(expansion)?;
        }
        let entries = self.cloud.len() * self.force.values_per_point();
        self.work = Pool::new(1, move || vec![0.0; entries]);
        Ok(())
    }
}

impl<F: TwoPass> DilatationView for TwoPassForce<F> {
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let Some(number) = self.force.dilatation() else {
            out.fill(f64::NAN);
            return;
        };
        let ghosts = self.cloud.domain().ghosts(u);
        let mut own = self.work.take();
        self.force
            .values_into(t, Field::new(u, &ghosts), &PointSubset::All, &mut own);
        let n = self.cloud.len();
        out.copy_from_slice(&own[number * n..(number + 1) * n]);
    }
}

impl<F: TwoPass> LocalForce for TwoPassForce<F> {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.force.neighbours(i, visit);
    }

    /// The values of a neighbour depend on its neighbours.
    fn range_in_bonds(&self) -> u32 {
        2
    }
}

impl<F: TwoPass> LinearOperator for TwoPassForce<F> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }
}

impl<F: TwoPass> Checkpointed for TwoPassForce<F> {
    fn save(&self, archive: &mut Archive) {
        self.force.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.force.restore(archive)
    }
}
