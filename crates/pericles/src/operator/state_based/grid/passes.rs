//! [`TwoPass`] and [`Breakable`] for linear peridynamic solids on a lattice.

use std::sync::Arc;

use super::force::{LinearSolidGrid, Wanted};
use super::kernels::{force_chunks, square_chunks};
use super::tangent::{dilatation_change_chunks, tangent_chunks};
use crate::domain::Field;
use crate::lanes::LANES;
use crate::material::PairForce;
use crate::neighbourhood::{BondSet, Form, Lattice, Neighbourhood};
use crate::operator::state_based::breaking::heated_limit;
use crate::operator::state_based::kinematics::Kinematics;
use crate::operator::{
    AtPoints, BondView, Breakable, CoarseBreak, CriticalStretches, InstructionSet, PointSubset,
    StencilData, StencilForce, StencilMaterial, StencilSolid, TwoPass,
};
use crate::parallel::for_each_chunk;
use crate::step_end::StepEnd;
use crate::thermal::{Expandable, ThermalExpansion};

/// All points.
const ALL: Wanted<'static> = Wanted {
    on: &PointSubset::All,
    whole: true,
};

impl<L: Kinematics, const D: usize> TwoPass for LinearSolidGrid<L, D> {
    /// The dilatation θ; in heated bodies also the thermal pull.
    fn values_per_point(&self) -> usize {
        1 + usize::from(self.heat.is_some())
    }

    fn values_into(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]) {
        let (dilatations, pulls) = values.split_at_mut(self.cloud.len());
        self.dilatations_into(u, on, dilatations);
        self.thermal_pulls_into(t, on, pulls);
    }

    fn value_changes_into(&self, _t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]) {
        changes.fill(0.0);
        let changes = &mut changes[..self.cloud.len()];
        let set = self.instruction_set;
        self.with_arrays(u, None, ALL, |arrays, _| {
            self.with_arrays(direction, None, ALL, |direction, _| {
                self.sweep::<1>(None, changes, |block, intact, out| {
                    dilatation_change_chunks::<L, D>(set, arrays, direction, block, intact, out);
                });
            });
        });
        for_each_chunk(changes, &|first, changes| {
            let factors = &self.states.dilatation[first..];
            for (change, factor) in changes.iter_mut().zip(factors) {
                *change *= factor;
            }
        });
    }

    fn add_bond_force(&self, _t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let set = self.instruction_set;
        let wanted = Wanted { on, whole: false };
        self.with_arrays(at.u, Some(at.values), wanted, |arrays, lanes| {
            self.sweep::<D>(lanes, out, |block, intact, out| {
                force_chunks::<L, D>(set, arrays, block, intact, out);
            });
        });
    }

    fn add_bond_tangent(&self, _t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]) {
        let set = self.instruction_set;
        self.with_arrays(at.u, Some(at.values), ALL, |arrays, _| {
            self.with_arrays(change.u, Some(change.values), ALL, |direction, _| {
                self.sweep::<D>(None, out, |block, intact, out| {
                    tangent_chunks::<L, D>(set, arrays, direction, block, intact, out);
                });
            });
        });
    }

    fn add_energy_density(&self, t: f64, at: AtPoints<'_>, out: &mut [f64]) {
        let (set, states) = (self.instruction_set, &self.states);
        let mut squares = vec![0.0; self.cloud.len()];
        self.with_arrays(at.u, None, ALL, |arrays, _| {
            self.sweep::<1>(None, &mut squares, |block, intact, out| {
                square_chunks::<L, D>(set, arrays, block, intact, out);
            });
        });
        let stretches = self.stretches(t);
        for_each_chunk(out, &|first, out| {
            for (i, energy) in (first..).zip(out) {
                let (theta, square) = (at.values.owned[i], squares[i]);
                *energy += match (&self.heat, &stretches) {
                    (Some(heat), Some(stretches)) => {
                        heat.energy_density(states, [i, i], stretches[i], [theta, square])
                    }
                    _ => states.energy_density([i, i], theta, square),
                };
            }
        });
    }

    /// The bound of [`LinearSolidForce`](crate::operator::LinearSolidForce).
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let m = self.offsets.len();
        let mut rows = vec![0.0; self.cloud.len()];
        self.bonds
            .for_each_chunk(&mut rows, |first, number, intact, rows| {
                let chunk = &self.layout().chunks()[number];
                for (lane, i) in chunk.points() {
                    let place = chunk.place as usize * LANES + lane;
                    for k in (0..m).filter(|&k| intact[k] >> lane & 1 == 1) {
                        let offset = &self.offsets[k];
                        let j = self.bonds.form().point_beyond(place, k);
                        let springs =
                            self.states.spring::<D>(i, 1.0) + self.states.spring::<D>(j, 1.0);
                        rows[i - first] += offset.weight.abs() * springs;
                    }
                }
            });
        let square = |(i, row): (usize, &f64)| 2.0 * row / density(i);
        let own = rows.iter().enumerate().map(square).fold(0.0, f64::max);
        self.cloud.domain().max(own).sqrt()
    }

    /// With thermal strain the force is affine: it does not vanish at rest.
    fn is_linear(&self) -> bool {
        L::LINEAR && self.heat.is_none()
    }

    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.form().for_each_neighbour(i, visit);
    }

    /// The critical stretch is evaluated in the pass over points.
    fn end_values_into(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        needed: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        let (values, pulls) = values.split_at_mut(self.cloud.len());
        let breaks = self.can_break();
        if breaks {
            self.break_by_stretch(step, u, on, values);
        }
        if !(breaks && matches!(on, PointSubset::All)) {
            self.dilatations_into(u, needed, values);
        }
        self.thermal_pulls_into(step.t, needed, pulls);
    }

    fn thermal(&self) -> Option<&ThermalExpansion> {
        self.heat.as_ref().map(|heat| &heat.expansion)
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn breaking(&self) -> Option<&dyn Breakable> {
        Some(self)
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn dilatation(&self) -> Option<usize> {
        Some(0)
    }

    fn stencil(&self) -> Option<&dyn StencilForce> {
        self.heat.is_none().then_some(self)
    }

    fn stencil_mut(&mut self) -> Option<&mut dyn StencilForce> {
        self.heat.is_none().then_some(self)
    }

    /// Not available for bodies divided among processes: the force of a bond needs the families of both ends.
    fn bonds(&self) -> Option<&dyn BondView> {
        Some(self)
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.form().directed_bonds()
    }

    fn bytes(&self) -> usize {
        self.own_bytes()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.instruction_set
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        if InstructionSet::available().contains(&set) {
            self.instruction_set = set;
        }
    }
}

impl<L: Kinematics, const D: usize> LinearSolidGrid<L, D> {
    fn critical_stretches(&self) -> CriticalStretches {
        let (classes, layout) = (&self.classes, self.layout());
        match (&classes.critical_stretches()[..], classes.strengths()) {
            (&[stretch], []) => CriticalStretches::Uniform(stretch),
            (table, strengths) => CriticalStretches::Pairs {
                material: layout.at_places(|site| classes.number(site) as u8),
                table: table.to_vec(),
                factors: match strengths {
                    [] => Vec::new(),
                    strengths => layout.at_places(|site| strengths[site]),
                },
            },
        }
    }
}

impl<L: Kinematics, const D: usize> StencilForce for LinearSolidGrid<L, D> {
    fn data(&self) -> StencilData<'_> {
        let offsets = self.offsets.iter();
        let solid = StencilSolid {
            weights: offsets.map(|offset| offset.weight).collect(),
            dilatation: &self.states.dilatation,
            pressure: &self.states.pressure[..self.cloud.len()],
            stiffness: &self.states.stiffness[..self.cloud.len()],
            bulk: &self.states.bulk,
        };
        StencilData {
            law: L::STENCIL,
            bonds: &self.bonds,
            material: StencilMaterial::Solid(solid),
            critical: self.critical_stretches(),
        }
    }

    fn bonds_mut(&mut self) -> &mut Neighbourhood<Lattice> {
        &mut self.bonds
    }
}

impl<L: Kinematics, const D: usize> Breakable for LinearSolidGrid<L, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.bonds
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.bonds
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.bonds.take_coarse_parts()
    }

    fn can_break(&self) -> bool {
        self.weakest.stretch.is_finite()
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if !self.can_break() {
            return;
        }
        let (bonds, layout) = (self.bonds.form(), self.layout());
        let ghosts = self.cloud.domain().ghosts(u);
        let u = Field::new(u, &ghosts);
        let stretches = self.thermal().map(ThermalExpansion::latest);
        let over = |place: usize, i: usize, k: usize| {
            let there = place.wrapping_add_signed(self.offsets[k].shift);
            let [a, b] = [place, there].map(|place| layout.site_at(place));
            let j = layout.point_at(there);
            let thermal = |stretches: &Arc<Vec<f64>>| 0.5 * (stretches[i] + stretches[j]);
            let thermal = stretches.as_ref().map_or(0.0, thermal);
            let limit = fraction * self.classes.limits(a, b).stretch;
            let threshold = L::Measure::threshold(heated_limit(limit, thermal));
            let eta = u.difference::<D>([i, j]);
            let (measure, square) = L::Measure::stretch_measure(self.offsets[k].xi, eta);
            measure > threshold * square
        };
        let mut found: Vec<f64> = marks
            .iter()
            .map(|&mark| f64::from(u8::from(mark)))
            .collect();
        self.bonds
            .for_each_chunk(&mut found, |first, number, intact, found| {
                let chunk = &layout.chunks()[number];
                if chunk.points().all(|(_, i)| found[i - first] > 0.0) {
                    return;
                }
                for k in 0..self.offsets.len() {
                    let bits = intact[k] & bonds.breakable(chunk, k);
                    for (lane, i) in chunk.points() {
                        let place = chunk.place as usize * LANES + lane;
                        if bits >> lane & 1 == 1 && found[i - first] == 0.0 && over(place, i, k) {
                            found[i - first] = 1.0;
                        }
                    }
                }
            });
        for (mark, found) in marks.iter_mut().zip(found) {
            *mark = found > 0.0;
        }
    }
}
