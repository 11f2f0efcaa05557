//! What an evaluation works on, in one kind of numbers.

use std::sync::{Mutex, PoisonError, TryLockError};

use super::arrays::Grid;
use super::factors::Factors;
use super::layout::GridLayout;
use super::numbers::GridNumber;
use super::padded::{Frame, Padded};
use super::stencil::Offset;
use super::wanted::WantedPoints;
use crate::domain::Field;
use crate::operator::On;

/// The stencil and the work arrays in doubles or in floats.
pub(super) struct Working<N, const D: usize> {
    offsets: Vec<Offset<N, D>>,
    /// The stiffness of bonds over the stencil's, where it depends on their ends.
    factors: Option<Factors<N>>,
    /// The length that is one in these numbers, m.
    unit: f64,
    /// The farthest a neighbour's place is from a node's.
    farthest: usize,
    /// The farthest a neighbour is along each axis, in spacings.
    radius: [usize; 3],
    /// Made by the first evaluation, locked for the length of one.
    scratch: Mutex<Option<Scratch<N, D>>>,
}

/// Work arrays of one evaluation.
struct Scratch<N, const D: usize> {
    padded: Padded<N, D>,
    wanted: WantedPoints,
}

impl<N: GridNumber, const D: usize> Working<N, D> {
    /// Work arrays for a stencil whose neighbours are at most `farthest` places and, along each axis, `radius` spacings away.
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

    /// The same for bonds whose stiffness depends on their ends.
    pub fn with_factors(self, factors: Option<Factors<N>>) -> Self {
        Self { factors, ..self }
    }

    /// The stiffness of bonds over the stencil's, where it depends on their ends.
    pub fn factors(&self) -> Option<&Factors<N>> {
        self.factors.as_ref()
    }

    /// Copies to padded rows what the wanted points need of u and hands it on, with the wanted lanes of each chunk or none if all points are wanted.
    pub fn with<R>(
        &self,
        layout: &GridLayout,
        u: Field<'_>,
        on: &On<'_>,
        work: impl FnOnce(&Grid<'_, N, D>, Option<&[u8]>) -> R,
    ) -> R {
        // Another evaluation may run at the same time, on this very thread if it waits for others to finish their part.
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
        let Scratch { padded, wanted } = scratch.get_or_insert_with(|| Scratch {
            padded: Padded::new(layout, self.farthest),
            wanted: WantedPoints::new(layout),
        });
        let frame = Frame::of(u, self.unit);
        let lanes = match on {
            On::All => {
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
        work(&self.grid(padded), lanes)
    }

    /// Another vector in padded rows, as the loops see it.
    pub fn grid<'a>(&'a self, padded: &'a Padded<N, D>) -> Grid<'a, N, D> {
        Grid {
            offsets: &self.offsets,
            factors: self.factors.as_ref(),
            u: padded.components(),
            margin: padded.margin(),
            unit: self.unit,
        }
    }

    /// Room for another vector.
    pub fn room(&self, layout: &GridLayout) -> Padded<N, D> {
        Padded::new(layout, self.farthest)
    }

    /// Memory of the work arrays, bytes.
    pub fn bytes(&self, layout: &GridLayout) -> usize {
        Padded::<N, D>::bytes_for(layout, self.farthest)
            + WantedPoints::bytes_for(layout)
            + self.factors.as_ref().map_or(0, Factors::bytes)
    }
}
