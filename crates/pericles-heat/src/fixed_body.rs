//! Time integrator of a body that does not move.

use pericles::time::{Integrator, State};
use pericles::{Interrupt, Need, Requirement, Result, System};

/// Keeps displacements constant, so that only secondary fields change with time: heat conduction without mechanics.
/// No force is evaluated.
#[derive(Debug, Clone, Copy, Default)]
pub struct FixedBody;

impl FixedBody {
    /// Requirements on a system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement {
            need: Need::NoBoundaries,
            reason: "the body does not move; leave the boundary out",
        },
        Requirement {
            need: Need::NoInteractions,
            reason: "the body does not move; leave contact and impactors out",
        },
    ];
}

impl Integrator for FixedBody {
    fn name(&self) -> &'static str {
        "thermal"
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn order(&self) -> u32 {
        1
    }

    fn stability_limit(&self) -> Option<f64> {
        None
    }

    fn is_static(&self) -> bool {
        true
    }

    fn start(&mut self, _system: &mut System, state: &mut State) {
        state.v.fill(0.0);
        state.a.fill(0.0);
    }

    fn step(
        &mut self,
        _system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        interrupt.poll()?;
        state.t = t_next;
        state.step += 1;
        Ok(())
    }
}

pericles::saved! {
    impl Checkpointed for FixedBody {}
}
