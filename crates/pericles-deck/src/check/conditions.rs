//! Range checks of loads, constraints, boundaries, temperature and damping.

use crate::conditions::LoadAmplitude;
use crate::declaration::Check;
use crate::exact::{Exact, KnownSolution, Pulse};
use crate::key_path::KeyPath;
use crate::model::Model;

impl Check {
    pub(super) fn conditions(&mut self, model: &Model) {
        for (k, initial) in model.initial.iter().enumerate() {
            if let Some(random) = initial.random_velocity {
                let key = KeyPath::from("initial").index(k).key("random_velocity");
                self.positive(key.key("radius"), random.radius);
            }
        }
        for (k, motion) in model.constraints.iter().enumerate() {
            let key = KeyPath::from("constraint").index(k);
            if let Some(until) = motion.until {
                self.positive(key.key("until"), until);
            }
        }
        for (k, load) in model.loads.iter().enumerate() {
            let key = KeyPath::from("load").index(k);
            if let LoadAmplitude::Traction {
                area: Some(area), ..
            } = load.amplitude
            {
                self.positive(key.key("area"), area);
            }
            let [from, until] = load.window();
            let allowed = "allowed: a time later than `from`";
            self.within(from < until, key.key("until"), until, allowed);
        }
    }

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
