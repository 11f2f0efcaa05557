//! Range checks of loads, constraints, boundaries, temperature and damping.

use crate::declaration::Check;
use crate::exact::{Exact, KnownSolution, Pulse};
use crate::key_path::KeyPath;

impl Check {
    pub(super) fn exact(&mut self, exact: &Exact) {
        let key = KeyPath::from("exact");
        let length = match exact.solution {
            KnownSolution::NonlocalPulse { pulse, length } => {
                self.positive(key.key("width"), pulse.width);
                length
            }
            KnownSolution::LocalPulse(Pulse { width, .. }) => width,
            KnownSolution::StretchedBar { length, .. } | KnownSolution::BarMode { length, .. } => {
                length
            }
        };
        self.positive(key.key("length"), length);
        if let Some(window) = exact.window {
            self.positive(key.key("window"), window);
        }
    }
}
