//! Heat from energy that the body dissipates.

use pericles::{Archive, Result, Values};

use crate::error::HeatError;

/// The share of dissipated energy that becomes heat, and when it does.
///
/// The energy of a step of the body is known at its end, when the field has already been evaluated there. Its heat is
/// therefore pending, point by point, and enters the values that forces read at a constant rate over a time as long as
/// that step. These values stay continuous in time, so that the balance of mechanical energy needs no rule of its own.
/// Content, output and heat balance contain pending heat at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dissipation {
    /// Share of the dissipated energy, above 0 and at most 1.
    pub share: f64,
    /// Heat since the start, J.
    pub heat: f64,
    /// End of the last step of the body, s.
    last: f64,
    /// Time until which the pending heat has entered the values, s.
    due: f64,
}

const STATE: &str = "temperature/dissipation";

impl Dissipation {
    /// Returns the state at the time t; `None` for the share 0.
    pub fn new(share: f64, t: f64) -> Result<Option<Self>> {
        if !(0.0..=1.0).contains(&share) {
            return Err(HeatError::Share { share }.into());
        }
        let state = Self {
            share,
            heat: 0.0,
            last: t,
            due: t,
        };
        Ok((share > 0.0).then_some(state))
    }

    /// Returns the part of the heat pending at the time `from` that enters the values until `to`.
    pub fn part(&self, [from, to]: [f64; 2]) -> f64 {
        if self.due <= to {
            1.0
        } else {
            (to - from) / (self.due - from)
        }
    }

    /// Adds the heat (J) of a step of the body that ends at the time t.
    pub fn add(&mut self, t: f64, heat: f64) {
        self.heat += heat;
        self.due = t + (t - self.last);
        self.last = t;
    }

    pub fn save(&self, archive: &mut Archive) {
        let Self {
            share: _,
            heat,
            last,
            due,
        } = *self;
        archive.put(STATE, Values::F64(vec![heat, last, due]));
    }

    pub fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut state = [0.0; 3];
        archive.f64_into(STATE, &mut state)?;
        [self.heat, self.last, self.due] = state;
        Ok(())
    }
}
