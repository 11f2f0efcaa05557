//! Thermal strain of linear peridynamic solids on a lattice, as on a list.

use std::sync::Arc;

use super::force::LinearSolidGrid;
use crate::error::Result;
use crate::operator::PointSubset;
use crate::operator::state_based::breaking::heated_limit;
use crate::operator::state_based::heat::Heat;
use crate::operator::state_based::kinematics::Kinematics;
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: Kinematics, const D: usize> LinearSolidGrid<L, D> {
    /// Returns τ of own points and ghosts at time t, if the body is heated.
    pub(super) fn stretches(&self, t: f64) -> Option<Arc<Vec<f64>>> {
        Some(self.heat.as_ref()?.expansion.stretches(t))
    }

    /// Returns the smallest stretch at which a bond breaks at these thermal stretches.
    pub(super) fn coldest_limit(&self, stretches: Option<&Vec<f64>>) -> f64 {
        let limit = self.weakest.stretch;
        stretches.map_or(limit, |stretches| {
            heated_limit(
                limit,
                stretches.iter().copied().fold(f64::INFINITY, f64::min),
            )
        })
    }

    /// Sets the thermal pulls of the points `on` of a heated body; no effect for other bodies.
    pub(super) fn thermal_pulls_into(&self, t: f64, on: &PointSubset<'_>, pulls: &mut [f64]) {
        if let Some(heat) = &self.heat {
            on.for_each(pulls.len(), |i| pulls[i] = 0.0);
            heat.add_pulls(t, &self.states, |i| i, on, pulls);
        }
    }

    /// Returns the number of broken directed bonds per block, for heated bodies only.
    pub(super) fn broken_by_blocks(&self) -> Option<Vec<u64>> {
        self.heat.as_ref()?;
        Some(self.bonds.broken_by_blocks())
    }

    /// Updates Σ ω r² over the intact bonds in all blocks in which the number of broken bonds differs from `before`; in
    /// all blocks if `None`.
    pub(super) fn renew_volumes(&mut self, before: Option<Vec<u64>>) {
        let Some(mut heat) = self.heat.take() else {
            return;
        };
        let now = self.bonds.broken_by_blocks();
        if before.as_ref() != Some(&now) {
            heat.volume.resize(self.cloud.len(), 0.0);
            let (bonds, layout) = (&self.bonds, self.layout());
            bonds.for_each_chunk(&mut heat.volume, |first, number, intact, volumes| {
                let block = layout.block_of(number);
                if before
                    .as_ref()
                    .is_some_and(|before| before[block] == now[block])
                {
                    return;
                }
                for (lane, i) in layout.chunks()[number].points() {
                    let left = self.offsets.iter().zip(intact);
                    let left = left.filter(|(_, bits)| **bits >> lane & 1 == 1);
                    volumes[i - first] = left.map(|(offset, _)| offset.weighted_square).sum();
                }
            });
        }
        self.heat = Some(heat);
    }
}

impl<L: Kinematics, const D: usize> Expandable for LinearSolidGrid<L, D> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        self.heat = Some(Heat {
            expansion,
            volume: Vec::new(),
        });
        self.renew_volumes(None);
        Ok(())
    }
}
