//! Stencil and work arrays of an evaluation for one number type.

use std::sync::{Mutex, PoisonError, TryLockError};

use super::arrays::Grid;
use super::factors::Factors;
use super::numbers::GridNumber;
use super::offsets::Offset;
use super::padded::{Frame, Padded};
use super::wanted::WantedPoints;
use crate::domain::Field;
use crate::neighbourhood::GridLayout;
use crate::operator::PointSubset;

/// The stencil and the work arrays in doubles or in floats.
pub(super) struct Working<N, const D: usize> {
    offsets: Vec<Offset<N, D>>,
    /// Stiffness of bonds relative to the stencil, if it depends on their ends.
    factors: Option<Factors<N>>,
    /// Unit of length, m.
    unit: f64,
    /// Largest distance of a neighbour, in places.
    farthest: usize,
    /// Largest distance of a neighbour along each axis, in spacings.
    radius: [usize; 3],
    /// Allocated by the first evaluation, locked during each one.
    scratch: Mutex<Option<Scratch<N, D>>>,
}

/// Work arrays of one evaluation.
struct Scratch<N, const D: usize> {
    padded: Padded<N, D>,
    /// Thermal stretches, allocated if the material expands.
    heat: Option<Padded<N, 1>>,
    wanted: WantedPoints,
}

impl<N: GridNumber, const D: usize> Working<N, D> {
    /// Creates work arrays for a stencil whose neighbours are at most `farthest` places and, along each axis,
    /// `radius` spacings away.
    pub fn new(offsets: Vec<Offset<N, D>>, unit: f64, farthest: usize, radius: [usize; 3]) -> Self {
        Self {
            offsets,
            factors: None,
            unit,
            farthest,
            radius,
            scratch: Mutex::new(None),
        }
    }

    /// Sets the factors of bonds whose stiffness depends on their ends.
    pub fn with_factors(self, factors: Option<Factors<N>>) -> Self {
        Self { factors, ..self }
    }

    /// Returns the bonds of the stencil.
    pub fn offsets(&self) -> &[Offset<N, D>] {
        &self.offsets
    }

    /// Returns the stiffness of bonds relative to the stencil, if it depends on their ends.
    pub fn factors(&self) -> Option<&Factors<N>> {
        self.factors.as_ref()
    }

    /// Copies the values of u, and the thermal stretches if the material expands, for the requested points and their
    /// neighbours to padded rows and passes them on, with the requested lanes of each chunk (`None` if all points are
    /// requested).
    pub fn with<R>(
        &self,
        layout: &GridLayout,
        (u, heat): (Field<'_>, Option<Field<'_>>),
        on: &PointSubset<'_>,
        work: impl FnOnce(&Grid<'_, N, D>, Option<&[u8]>) -> R,
    ) -> R {
        // Another evaluation may run at the same time, even on this thread while it waits for other threads.
        let mut own = None;
        let mut locked;
        let scratch = match self.scratch.try_lock() {
            Ok(guard) => {
                locked = guard;
                &mut *locked
            }
            Err(TryLockError::Poisoned(poisoned)) => {
                locked = PoisonError::into_inner(poisoned);
                &mut *locked
            }
            Err(TryLockError::WouldBlock) => &mut own,
        };
        let Scratch {
            padded,
            heat: stretches,
            wanted,
        } = scratch.get_or_insert_with(|| Scratch {
            padded: Padded::new(layout, self.farthest),
            heat: None,
            wanted: WantedPoints::new(layout),
        });
        let frame = Frame::of(u, self.unit);
        let lanes = match on {
            PointSubset::All => {
                padded.fill(layout, u, &frame);
                None
            }
            _ => {
                wanted.set(layout, on, self.radius);
                if layout.is_of_points() {
                    padded.fill_around(layout, u, &frame, wanted);
                } else {
                    padded.fill(layout, u, &frame);
                }
                Some(wanted.lanes())
            }
        };
        let heat = heat.map(|heat| {
            let rows = stretches.get_or_insert_with(|| Padded::new(layout, self.farthest));
            rows.fill(layout, heat, &Frame::of(heat, 1.0));
            &*rows
        });
        let grid = Grid {
            heat: heat.map(|rows| rows.components()[0]),
            ..self.grid(padded)
        };
        work(&grid, lanes)
    }

    /// Returns the arrays of the loops for another vector in padded rows.
    pub fn grid<'a>(&'a self, padded: &'a Padded<N, D>) -> Grid<'a, N, D> {
        Grid {
            offsets: &self.offsets,
            factors: self.factors.as_ref(),
            u: padded.components(),
            heat: None,
            margin: padded.margin(),
            unit: self.unit,
        }
    }

    /// Allocates padded rows for another vector.
    pub fn room(&self, layout: &GridLayout) -> Padded<N, D> {
        Padded::new(layout, self.farthest)
    }

    /// Returns the memory use of the work arrays, bytes.
    pub fn bytes(&self, layout: &GridLayout) -> usize {
        Padded::<N, D>::bytes_for(layout, self.farthest)
            + WantedPoints::bytes_for(layout)
            + self.factors.as_ref().map_or(0, Factors::bytes)
    }
}
