//! Absorbing ends of a model.

use pericles::System;
use pericles::boundary::absorbing::history::{
    BlockedHistory, DirectHistory, ExponentialHistory, History,
};
use pericles::boundary::absorbing::{
    AbsorbingEnd, AbsorbingError, ExponentialKernels, OuterLayer, Side, cached_kernels,
};
use pericles::cache::Cache;
use pericles::time::{Integrator, State};

use super::Sets;
use super::step::Steps;
use crate::boundary::{BoundaryCondition, HistoryForm};
use crate::deck::Deck;
use crate::error::DeckError;
use crate::reader::Path;

/// An end to be made once the step is known.
pub(super) struct End {
    path: Path,
    layer: OuterLayer,
    history: HistoryForm,
}

impl Deck {
    /// The outer layers that the exterior continues.
    pub(super) fn ends(
        &self,
        system: &System,
        state: &State,
        sets: &Sets,
        integrator: &dyn Integrator,
    ) -> Result<Vec<End>, DeckError> {
        if self.boundaries.is_empty() {
            return Ok(Vec::new());
        }
        let no_fail = self.union_of(sets, &self.material.no_fail)?;
        let mut ends = Vec::new();
        let mut sides: Vec<Side> = Vec::new();
        for (k, boundary) in self.boundaries.iter().enumerate() {
            let path = Path::from("boundary").index(k);
            let BoundaryCondition::Absorbing { side, history } = *boundary;
            let refuse = |error| self.at_path(&path, pericles::PericlesError::from(error).into());
            if sides.contains(&side) {
                let side = side.name();
                return Err(refuse(AbsorbingError::Twice { side }));
            }
            let (scheme, needed) = (integrator.name(), AbsorbingEnd::SCHEME);
            if scheme != needed {
                let error = AbsorbingError::Scheme { scheme, needed };
                return Err(self.at("time.scheme", error.into()));
            }
            sides.push(side);
            let layer = OuterLayer::of(system, side, state, &no_fail).map_err(refuse)?;
            ends.push(End {
                path,
                layer,
                history,
            });
        }
        Ok(ends)
    }

    /// Makes the ends for the run's steps.
    pub(super) fn add_ends(
        &self,
        system: &mut System,
        ends: Vec<End>,
        steps: &Steps,
        cache: &dyn Cache,
    ) -> Result<(), DeckError> {
        for end in ends {
            let path = end.path;
            let refuse = |error| self.at_path(&path, pericles::PericlesError::from(error).into());
            let stencil = end.layer.stencil.clone();
            let count = steps.count as usize;
            let kernels = || cached_kernels(&stencil, steps.dt, count, cache);
            let history: Box<dyn History> = match end.history {
                HistoryForm::Blocked => Box::new(BlockedHistory::new(kernels())),
                HistoryForm::Direct => Box::new(DirectHistory::new(kernels())),
                HistoryForm::Exponentials { tolerance } => {
                    let fit = ExponentialKernels::fit(&stencil, steps.dt, count, tolerance);
                    Box::new(ExponentialHistory::new(fit.map_err(refuse)?))
                }
            };
            let end = AbsorbingEnd::new(end.layer, history, steps.dt).map_err(refuse)?;
            system.add_boundary(Box::new(end));
        }
        Ok(())
    }
}

/// The highest frequency of the lattices beyond the ends, 1/s; 0 without ends.
pub(super) fn exterior_frequency(ends: &[End]) -> f64 {
    ends.iter()
        .map(|end| end.layer.stencil.highest_frequency())
        .fold(0.0, f64::max)
}
