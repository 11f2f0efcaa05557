//! [`Force`] of state-based materials.

use pericles::domain::Field;
use pericles::operator::{
    Breakable, Capabilities, DilatationView, Force, InstructionSet, Inversion, LocalForce,
    LostYield, PointSubset, StressView,
};
use pericles::parallel::for_each_chunk_of;
use pericles::space::check_length;
use pericles::{Expandable, Pointwise, Result, StepEnd, ThermalExpansion, YieldFactor, positive};

use super::{Solid, SolidForce};

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Adds the force density of the points `on`, and returns the first of them whose volume is not positive.
    fn add_forces(
        &self,
        t: f64,
        u: Field<'_>,
        on: &PointSubset<'_>,
        out: &mut [f64],
    ) -> Option<(usize, f64)> {
        let (heat, rows) = (self.heat_at(t), self.packed(u));
        let states = self.states_of_ends(t, &heat, &rows, on);
        self.add_bonds(on, &rows, &states, None, out);
        let mut inverted = None;
        on.for_each(self.cloud.len(), |i| {
            let dilatation = states.dilatation[i];
            if S::NEEDS_POSITIVE_VOLUME && dilatation <= -1.0 && inverted.is_none() {
                inverted = Some((i, dilatation));
            }
        });
        inverted
    }
}

impl<S: Solid<D>, const D: usize> Force for SolidForce<S, D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(u);
        self.add_forces(t, Field::new(u, &ghosts), &on, out);
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let (heat, rows) = (self.heat_of_energy(t), self.packed(Field::new(u, &ghosts)));
        let cost = self.bonds.list().cost(&PointSubset::All);
        for_each_chunk_of(out, cost, &|first, out| {
            for (i, energy) in (first..).zip(out) {
                *energy += self.energy_of(i, t, &heat, &rows);
            }
        });
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        let volumes = self.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.cloud.domain().sum(self.points(), energy)
    }

    /// Bounds the undeformed body by springs ω (k_i + k_j) V_i of [`Solid::stiffness`], to which Gershgorin's theorem
    /// applies.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let stiffness = |i: usize| {
            let shape = self.shapes[i].as_ref();
            let stiffness = shape.map_or(0.0, |shape| self.material(i).stiffness(shape));
            self.stiffness_of(i) * stiffness
        };
        let springs: Vec<f64> = (0..self.cloud.len()).map(stiffness).collect();
        let springs = self.bonds.list().sites().spread(&springs);
        let rows = self.undisplaced();
        let mut largest: f64 = 0.0;
        for i in 0..self.cloud.len() {
            let (family, mut row) = (self.family(i, &rows), 0.0);
            let here = springs[family.site()];
            family.for_each(|bond| row += bond.weight.abs() * (here + springs[bond.site]));
            largest = largest.max(2.0 * row / density(i));
        }
        self.cloud.domain().max(largest).sqrt()
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let domain = self.cloud.domain();
        let (ghosts, direction_ghosts) = (domain.ghosts(u), domain.ghosts(direction));
        let rows = self.packed(Field::new(u, &ghosts));
        let moved = self.packed(Field::new(direction, &direction_ghosts));
        let (heat, all) = (self.heat_at(t), PointSubset::All);
        let states = self.states(t, &heat, &rows, None, &all);
        let changes = self.states(t, &heat, &rows, Some(&moved), &all);
        self.add_bonds(&all, &rows, &states, Some((&moved, &changes)), out);
    }

    /// Bonds break first; the stored numbers are advanced with the remaining bonds.
    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(step.u);
        let u = Field::new(step.u, &ghosts);
        if self.can_lose_bonds() {
            self.break_bonds(step, u, &on);
        }
        if !self.material_history().is_empty() || self.materials.criteria().vary() {
            self.advance(step, u, &on);
        }
        self.inverted = self.add_forces(step.t, u, &on, out);
    }

    fn capabilities(&self) -> Capabilities<'_> {
        let mut materials = self.materials.all().iter();
        let starts = vec![0.0; self.history_size.per_point];
        let yields = materials.any(|material| material.plastic_strain(&starts).is_some());
        Capabilities {
            breaking: Some(self),
            local: Some(self),
            bonds: Some(self),
            dilatation: Some(self),
            stress: S::HAS_STRESS.then_some(self as &dyn StressView),
            plastic: yields.then_some(self),
            path_dependent: !self.material_history().is_empty(),
            thermal: self.expansion.as_ref(),
            ..Capabilities::default()
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn pointwise_mut(&mut self) -> Option<&mut dyn Pointwise> {
        Some(self)
    }

    fn lost_yield(&self) -> Option<LostYield> {
        let (point, ratio) = self.yields.as_ref()?.lost()?;
        Some(LostYield { point, ratio })
    }

    fn inversion(&self) -> Option<Inversion> {
        self.inverted.map(|(point, dilatation)| Inversion {
            point,
            volume_ratio: 1.0 + dilatation,
        })
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.list().directed_bonds()
    }

    fn bytes(&self) -> usize {
        let sites = self.bonds.list().sites().len();
        let rows = sites * (1 + S::VALUES.div_ceil(4)) * size_of::<[f64; 4]>();
        self.bonds.bytes()
            + size_of_val(&self.shapes[..])
            + size_of_val(&self.undamaged[..])
            + size_of_val(self.opposite.of_entry())
            + self.history.bytes()
            + rows
            + (self.cloud.len() * (S::VALUES + 1) + self.opposite.places()) * size_of::<f64>()
    }

    fn values_between_passes(&self) -> usize {
        S::VALUES + self.opposite.width()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.set
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        if InstructionSet::available().contains(&set) {
            self.set = set;
        }
    }
}

impl<S: Solid<D>, const D: usize> LocalForce for SolidForce<S, D> {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.list().for_each_neighbour(i, visit);
    }

    /// The values of a neighbour depend on its neighbours.
    fn range_in_bonds(&self) -> u32 {
        2
    }
}

impl<S: Solid<D>, const D: usize> DilatationView for SolidForce<S, D> {
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let rows = self.packed(Field::new(u, &ghosts));
        let states = self.states(t, &self.heat_at(t), &rows, None, &PointSubset::All);
        out.copy_from_slice(&states.dilatation);
    }
}

impl<S: Solid<D>, const D: usize> Expandable for SolidForce<S, D> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        self.expansion = Some(expansion);
        Ok(())
    }
}

impl<S: Solid<D>, const D: usize> Pointwise for SolidForce<S, D> {
    fn set_stiffness(&mut self, factors: Vec<f64>) -> Result<()> {
        check_length(
            "the factors of the stiffness",
            factors.len(),
            self.cloud.len(),
        )?;
        for factor in &factors {
            positive("the factor of the stiffness of a point", *factor)?;
        }
        self.stiffness = factors;
        Ok(())
    }

    fn set_yield(&mut self, factor: YieldFactor) -> Result<()> {
        check_length(
            "the factors of the yield stress",
            factor.points(),
            self.cloud.len(),
        )?;
        self.yields = Some(factor);
        Ok(())
    }
}
