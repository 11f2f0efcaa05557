//! The force of a body with a ghost layer.

use std::ops::Range;
use std::sync::Arc;

use super::extrapolation::Extrapolation;
use super::layer::{GhostLayer, breaking};
use crate::archive::{Archive, Checkpointed};
use crate::error::Result;
use crate::family::BondList;
use crate::neighbourhood::BondSet;
use crate::operator::pool::{Lent, Pool};
use crate::operator::{
    Breakable, Capabilities, CoarseBreak, DilatationView, Force, InstructionSet, LinearOperator,
    Linearity, PointSubset,
};
use crate::parallel::for_each_chunk;
use crate::space::PointCloud;

/// The force density of a body whose families are completed by ghost points:
///
/// f_i = F_i + (1/V_i) Σ_g T_gi V_g F_g with the force density F of the body and its ghosts together at the
/// displacements (u, T u).
///
/// Ghosts store no energy in F, so that F is the gradient of the energy of the body's points and f the gradient of
/// E(u). Loads act on the points of the body, near its surface through the extrapolation.
pub struct GhostForce {
    pub(super) inner: Box<dyn Force>,
    /// Force for the energy density at the points of the body, if the density of `inner` is not exact.
    whole: Option<Box<dyn Force>>,
    pub(super) cloud: Arc<PointCloud>,
    pub(super) layer: GhostLayer,
    pub(super) extrapolation: Extrapolation,
    pub(super) numbers: Vec<Option<u32>>,
    /// Work vectors of the body with its ghosts.
    vectors: Pool<Vec<f64>>,
}

impl GhostForce {
    /// Creates the force of a body from the force `inner` of the body with its ghosts, in which ghosts store
    /// no energy. `bonds` are the families of body and ghosts without bonds cut by pre-cracks.
    ///
    /// # Errors
    /// Breakable bonds, points whose neighbours lie on a line or in a plane.
    pub fn new(
        cloud: Arc<PointCloud>,
        layer: GhostLayer,
        bonds: &BondList,
        inner: Box<dyn Force>,
    ) -> Result<Self> {
        if inner.can_break() {
            return Err(breaking());
        }
        let extrapolation = Extrapolation::new(&layer, bonds)?;
        let entries = layer.cloud().len() * cloud.dimension();
        Ok(Self {
            inner,
            whole: None,
            cloud,
            numbers: layer.numbers(),
            layer,
            extrapolation,
            vectors: Pool::new(2, move || vec![0.0; entries]),
        })
    }

    /// Uses the energy densities of another force on the same points.
    pub(super) fn with_energy_densities(self, whole: Box<dyn Force>) -> Self {
        Self {
            whole: Some(whole),
            ..self
        }
    }

    /// Returns the displacements of the body with its ghosts, m.
    pub(super) fn extended(&self, u: &[f64]) -> Lent<'_, Vec<f64>> {
        let (n, m) = (self.cloud.len(), self.layer.cloud().len());
        let mut all = self.vectors.take();
        for (of_body, out) in u.chunks(n).zip(all.chunks_mut(m)) {
            for (&place, u) in self.layer.body().iter().zip(of_body) {
                out[place as usize] = *u;
            }
            for (g, &place) in self.layer.ghosts().iter().enumerate() {
                let row = self.extrapolation.row(g).iter();
                out[place as usize] = row.map(|&(j, weight)| weight * of_body[j as usize]).sum();
            }
        }
        all
    }

    /// Returns a component of the force density on a point of the body from that on the body with its ghosts.
    fn returned(&self, force: &[f64], i: usize) -> f64 {
        let volumes = self.layer.cloud().volumes();
        let own = self.layer.body()[i] as usize;
        let ghosts: f64 = self
            .extrapolation
            .column(i)
            .iter()
            .map(|&(g, weight)| {
                let place = self.layer.ghosts()[g as usize] as usize;
                weight * volumes[place] * force[place]
            })
            .sum();
        force[own] + ghosts / self.cloud.volumes()[i]
    }

    /// Adds the force density on the body for the points `on`.
    fn add_returned(&self, force: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        let (n, m) = (self.cloud.len(), self.layer.cloud().len());
        for (force, out) in force.chunks(m).zip(out.chunks_mut(n)) {
            match on {
                PointSubset::All => for_each_chunk(out, &|first, chunk| {
                    for (k, out) in chunk.iter_mut().enumerate() {
                        *out += self.returned(force, first + k);
                    }
                }),
                part => part.for_each(n, |i| out[i] += self.returned(force, i)),
            }
        }
    }

    /// Sets `out` to a derivative of the force density on the body; `of_all` computes it on the body with its ghosts.
    fn derivative_into(
        &self,
        [u, direction]: [&[f64]; 2],
        out: &mut [f64],
        of_all: impl Fn(&[f64], &[f64], &mut [f64]),
    ) {
        let (all, direction) = (self.extended(u), self.extended(direction));
        let mut change = self.vectors.take();
        of_all(&all, &direction, &mut change);
        out.fill(0.0);
        self.add_returned(&change, &PointSubset::All, out);
    }

    /// Copies the values at the places of the points of the body.
    fn restrict(&self, all: &[f64], out: &mut [f64]) {
        for (&place, out) in self.layer.body().iter().zip(out) {
            *out = all[place as usize];
        }
    }

    /// Returns a vector with one value per place.
    fn at_places(&self) -> Vec<f64> {
        vec![0.0; self.layer.cloud().len()]
    }
}

impl Force for GhostForce {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let all = self.extended(u);
        let mut force = self.vectors.take();
        force.fill(0.0);
        self.inner.add_force(t, &all, PointSubset::All, &mut force);
        self.add_returned(&force, &on, out);
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let mut density = self.at_places();
        let force = self.whole.as_ref().unwrap_or(&self.inner);
        force.add_energy_density(t, &self.extended(u), &mut density);
        for (&place, out) in self.layer.body().iter().zip(out) {
            *out += density[place as usize];
        }
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        self.inner.energy(t, &self.extended(u))
    }

    /// ω² of the body with its ghosts and their masses, times the largest 1 + Σ_g m_g R_g |T_gj|/m_j with
    /// R_g = Σ_j |T_gj|, which bounds the kinetic energy of body and ghosts relative to that of the body.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let densities: Vec<f64> = (0..self.cloud.len()).map(density).collect();
        let of_ghost = |g: usize| match self.extrapolation.nearest(g) {
            Some(p) => densities[p as usize],
            None => densities[0],
        };
        let mut at_places = self.at_places();
        for (&place, density) in self.layer.body().iter().zip(&densities) {
            at_places[place as usize] = *density;
        }
        let ghosts = self.layer.ghosts();
        for (g, &place) in ghosts.iter().enumerate() {
            at_places[place as usize] = of_ghost(g);
        }
        let volumes = self.layer.cloud().volumes();
        let mass = |place: u32| at_places[place as usize] * volumes[place as usize];
        let sizes: Vec<f64> = (0..ghosts.len())
            .map(|g| {
                let row = self.extrapolation.row(g).iter();
                mass(ghosts[g]) * row.map(|(_, weight)| weight.abs()).sum::<f64>()
            })
            .collect();
        let largest = (0..densities.len())
            .map(|i| {
                let column = self.extrapolation.column(i).iter();
                let of_ghosts: f64 = column.map(|&(g, w)| sizes[g as usize] * w.abs()).sum();
                1.0 + of_ghosts / mass(self.layer.body()[i])
            })
            .fold(1.0, f64::max);
        self.inner.frequency_bound(&|place| at_places[place]) * largest.sqrt()
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.derivative_into([u, direction], out, |u, direction, change| {
            self.inner.tangent_into(t, u, direction, change);
        });
    }

    fn secant_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.derivative_into([u, direction], out, |u, direction, change| {
            self.inner.secant_into(t, u, direction, change);
        });
    }

    fn capabilities(&self) -> Capabilities<'_> {
        let inner = self.inner.capabilities();
        let local = inner.local.is_some();
        Capabilities {
            linear: match inner.linear {
                Linearity::Exact(_) => Linearity::Exact(self),
                Linearity::Rounded => Linearity::Rounded,
                Linearity::Nonlinear => Linearity::Nonlinear,
            },
            breaking: inner.breaking.map(|_| self as &dyn Breakable),
            local: local.then_some(self),
            bonds: (local && inner.bonds.is_some()).then_some(self),
            dilatation: inner.dilatation.map(|_| self as &dyn DilatationView),
            single_precision: inner.single_precision,
            path_dependent: inner.path_dependent,
            ..Capabilities::default()
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        self.inner.capabilities().breaking?;
        Some(self)
    }

    fn rounding(&self, u: &[f64]) -> Option<f64> {
        self.inner.rounding(&self.extended(u))
    }

    fn directed_bonds(&self) -> u64 {
        self.inner.directed_bonds()
    }

    fn bytes(&self) -> usize {
        let whole = self.whole.as_ref().map_or(0, |force| force.bytes());
        let vectors = 3 * self.dimension() * self.layer.cloud().len() * size_of::<f64>();
        self.inner.bytes() + whole + self.extrapolation.bytes() + vectors
    }

    fn values_between_passes(&self) -> usize {
        self.inner.values_between_passes()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.inner.instruction_set()
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        self.inner.use_instruction_set(set);
        if let Some(whole) = &mut self.whole {
            whole.use_instruction_set(set);
        }
    }
}

impl LinearOperator for GhostForce {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }
}

impl DilatationView for GhostForce {
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let mut all = self.at_places();
        if let Some(view) = self.inner.capabilities().dilatation {
            view.dilatation_into(t, &self.extended(u), &mut all);
        }
        self.restrict(&all, out);
    }
}

/// Pre-cracks remove bonds, but no bond breaks.
impl Breakable for GhostForce {
    fn bonds(&self) -> &dyn BondSet {
        self
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        self
    }

    fn can_break(&self) -> bool {
        false
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        Vec::new()
    }

    fn mark_endangered(&self, _u: &[f64], _fraction: f64, _marks: &mut [bool]) {}
}

/// The bonds of the body; bonds to ghosts count in the damage only.
impl BondSet for GhostForce {
    fn broken_bonds(&self) -> u64 {
        0
    }

    fn dissipated(&self) -> f64 {
        0.0
    }

    /// Does nothing: without broken bonds there is nothing to correct.
    fn dissipate(&mut self, _i: usize, _energy: f64) {}

    fn follow_dissipation(&mut self) {}

    fn take_dissipated(&mut self, _out: &mut [f64]) {}

    fn damage_into(&self, out: &mut [f64]) {
        let mut all = self.at_places();
        if let Some(breaking) = self.inner.capabilities().breaking {
            breaking.damage_into(&mut all);
        }
        self.restrict(&all, out);
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        if let Some(breaking) = self.inner.capabilities().breaking {
            breaking.bonds().for_each_intact(&mut |a, b| {
                if let (Some(i), Some(j)) = (self.numbers[a], self.numbers[b]) {
                    visit(i as usize, j as usize);
                }
            });
        }
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        if let Some(breaking) = self.inner.capabilities().breaking {
            let place = self.layer.body()[i] as usize;
            breaking.bonds().for_each_intact_of(place, &mut |there| {
                if let Some(j) = self.numbers[there] {
                    visit(j as usize);
                }
            });
        }
    }

    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        visit(0..self.points(), 0);
    }
}

impl Checkpointed for GhostForce {
    fn save(&self, archive: &mut Archive) {
        self.inner.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.inner.restore(archive)
    }
}
