//! [`Force`] for lattice bodies.

use std::sync::PoisonError;

use super::factors::Factors;
use super::force::GridForce;
use super::kernels::{energy_chunks, force_chunks, force_chunks_in_floats, tangent_chunks};
use super::padded::Frame;
use super::thresholds::PlaceThresholds;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::neighbourhood::{Form, Lattice, Neighbourhood};
use crate::operator::fast_law::VectorLaw;
use crate::operator::{
    Breakable, Capabilities, CriticalStretches, Force, InstructionSet, LatticeSpring,
    LatticeSprings, LinearOperator, Linearity, PointSubset, SplitForce, StencilData, StencilForce,
    StencilLaw, StencilMaterial,
};
use crate::step_end::StepEnd;
use crate::thermal::Expandable;

impl<L: VectorLaw, const D: usize> Force for GridForce<L, D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        match &self.floats {
            Some(floats) => {
                self.sweep::<f32, D>(floats, (u, None), &on, out, |grid, block, intact, out| {
                    force_chunks_in_floats::<L, D>(self.instruction_set, grid, block, intact, out);
                })
            }
            None => self.add_force_in_doubles(t, u, &on, out),
        }
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.sweep::<f64, 1>(
            &self.doubles,
            (u, self.stretches(t)),
            &PointSubset::All,
            out,
            |grid, block, intact, out| {
                energy_chunks::<L, D>(self.instruction_set, grid, block, intact, out);
            },
        );
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        let volumes = self.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.cloud.domain().sum(self.points(), energy)
    }

    /// ω² ≤ max_i (2/ρ_i) Σ_j k_ij/|ξ| by Gershgorin discs of D×D blocks.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let (lengths, m) = (self.stencil().lengths(), self.stencil().len());
        let mut rows = vec![0.0; self.points()];
        self.bonds
            .for_each_counted::<1>(&mut rows, |first, bond, [rows]| {
                if bond.intact {
                    let (group, lane) = (bond.entry / LANES, bond.entry % LANES);
                    let (chunk, offset) = (group / m, group % m);
                    let stiffness = self.stiffness_of(chunk, offset, lane).abs();
                    rows[bond.point - first] += stiffness / lengths[offset];
                }
            });
        let square = |(i, row): (usize, &f64)| 2.0 * row / density(i);
        let own = rows.iter().enumerate().map(square).fold(0.0, f64::max);
        self.cloud.domain().max(own).sqrt()
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        if self.can_break() {
            self.decide(step, &on, None, out);
        } else {
            self.add_force(step.t, step.u, on, out);
        }
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let spare = || {
            self.direction
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let idle = spare().take();
        let mut padded = idle.unwrap_or_else(|| self.doubles.room(self.layout()));
        let ghosts = self.cloud.domain().ghosts(direction);
        let direction = Field::new(direction, &ghosts);
        padded.fill(self.layout(), direction, &Frame::of(direction, 1.0));
        let direction = self.doubles.grid(&padded);
        out.fill(0.0);
        self.sweep::<f64, D>(
            &self.doubles,
            (u, self.stretches(t)),
            &PointSubset::All,
            out,
            |grid, block, intact, out| {
                tangent_chunks::<L, D>(self.instruction_set, grid, &direction, block, intact, out);
            },
        );
        *spare() = Some(padded);
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.form().directed_bonds()
    }

    fn bytes(&self) -> usize {
        let working = match &self.floats {
            Some(floats) => floats.bytes(self.layout()),
            None => self.doubles.bytes(self.layout()),
        };
        self.bonds.bytes_of_bits()
            + self.bonds.form().bytes()
            + working
            + self.pairs.as_ref().map_or(0, PlaceThresholds::bytes)
    }

    fn instruction_set(&self) -> InstructionSet {
        self.instruction_set
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        if InstructionSet::available().contains(&set) {
            self.instruction_set = set;
        }
    }

    fn lattice_springs(&self) -> Option<LatticeSprings> {
        let (cells, lengths) = (self.stencil().cells(), self.stencil().lengths());
        let lattice = self.cloud.lattice();
        if !lattice.is_some_and(|lattice| lattice.is_cubic(D)) {
            return None;
        }
        // Of the whole body; infinite stiffnesses are rejected below.
        let finite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        let mut stiffest: Vec<f64> = (0..self.stencil().len())
            .map(|k| finite(self.largest_stiffness(k)))
            .collect();
        self.cloud.domain().max_each(&mut stiffest);
        let spring = |k: usize| LatticeSpring {
            offset: cells[k],
            stiffness: stiffest[k] / lengths[k],
        };
        LatticeSprings::new(D, (0..self.stencil().len()).map(spring))
    }

    fn rounding(&self, u: &[f64]) -> Option<f64> {
        self.floats.as_ref()?;
        let (mut rounded, mut exact) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        self.add_force(0.0, u, PointSubset::All, &mut rounded);
        self.add_force_in_doubles(0.0, u, &PointSubset::All, &mut exact);
        let largest = |of: &dyn Fn(usize) -> f64| (0..u.len()).map(of).fold(0.0, f64::max);
        let difference = largest(&|k| (rounded[k] - exact[k]).abs());
        let scale = largest(&|k| exact[k].abs());
        Some(if difference > 0.0 {
            difference / scale
        } else {
            0.0
        })
    }

    fn capabilities(&self) -> Capabilities<'_> {
        let in_doubles = self.floats.is_none();
        Capabilities {
            // With thermal strain the force is affine: it does not vanish at rest.
            linear: match (L::LINEAR && self.expansion.is_none(), in_doubles) {
                (true, true) => Linearity::Exact(self),
                (true, false) => Linearity::Rounded,
                (false, _) => Linearity::Nonlinear,
            },
            breaking: Some(self),
            local: in_doubles.then_some(self),
            split: in_doubles.then_some(self),
            bonds: Some(self),
            single_precision: !in_doubles,
            dilatation: None,
            stress: None,
            plastic: None,
            path_dependent: false,
            stencil: (L::STENCIL.is_some() && self.expansion.is_none()).then_some(self),
            thermal: self.expansion.as_ref(),
        }
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        self.floats.is_none().then_some(self)
    }

    fn stencil_mut(&mut self) -> Option<&mut dyn StencilForce> {
        self.capabilities().stencil?;
        Some(self)
    }
}

impl<L: VectorLaw, const D: usize> StencilForce for GridForce<L, D> {
    fn data(&self) -> StencilData<'_> {
        let offsets = self.doubles.offsets().iter();
        StencilData {
            law: L::STENCIL.unwrap_or(StencilLaw::BondStretch),
            bonds: &self.bonds,
            material: StencilMaterial::Bonds {
                stiffness: offsets.map(|offset| offset.stiffness).collect(),
                factors: self.doubles.factors().map(Factors::data),
            },
            critical: match &self.pairs {
                None => CriticalStretches::Uniform(self.critical_stretch),
                Some(pairs) => pairs.data(),
            },
        }
    }

    fn bonds_mut(&mut self) -> &mut Neighbourhood<Lattice> {
        &mut self.bonds
    }
}

impl<L: VectorLaw, const D: usize> GridForce<L, D> {
    fn add_force_in_doubles(&self, t: f64, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        let u = (u, self.stretches(t));
        self.sweep::<f64, D>(&self.doubles, u, on, out, |grid, block, intact, out| {
            force_chunks::<L, D>(self.instruction_set, grid, block, intact, out);
        });
    }
}

impl<L: VectorLaw, const D: usize> LinearOperator for GridForce<L, D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }

    fn half_bandwidth(&self) -> Option<usize> {
        let is_band = D == 1 && self.layout().is_of_points();
        is_band.then(|| self.stencil().farthest(0))
    }
}

crate::saved! {
    impl<L: VectorLaw, const D: usize> Checkpointed for GridForce<L, D> {
        bonds: part,
        cloud, critical_stretch, pairs, expansion, instruction_set, law: fixed,
        doubles, floats, direction: scratch,
    }
}
