//! Range checks of loads, constraints, boundaries, temperature and damping.

use super::ranges::Check;
use crate::boundary::BoundaryCondition;
use crate::conditions::LoadAmplitude;
use crate::exact::{Exact, KnownSolution, Pulse};
use crate::key_path::KeyPath;
use crate::model::Model;
use crate::set::Depth;
use crate::thermal::{Conduction, ConductionScheme, STORES_NO_HEAT, Thermal, ThermalAmplitude};

/// What a fraction may be.
const FRACTION: &str = "allowed: a number from 0 to 1";

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

    pub(super) fn thermal(&mut self, model: &Model) {
        const ALLOWED: &str = "allowed: a finite number in 1/K";
        let Some(thermal) = &model.thermal else {
            return;
        };
        let key = KeyPath::from("thermal");
        let own = thermal.materials.iter().enumerate();
        let own = own.filter_map(|(k, material)| {
            let key = key.key("material").index(k).key("expansion");
            Some((key, material.expansion?))
        });
        let all = thermal
            .expansion
            .iter()
            .map(|value| (key.key("expansion"), *value));
        for (key, value) in all.chain(own) {
            self.within(value.is_finite(), key, value, ALLOWED);
        }
        if let Some(conduction) = &thermal.conduction {
            self.conduction(&key, thermal, conduction);
        }
        let allowed = "allowed: a finite temperature in K";
        if let Some(reference) = thermal.reference {
            self.within(
                reference.is_finite(),
                key.key("reference"),
                reference,
                allowed,
            );
        }
    }

    fn conduction(&mut self, key: &KeyPath, thermal: &Thermal, conduction: &Conduction) {
        let not_negative = "allowed: zero or a positive number";
        let k = conduction.conductivity;
        self.within(
            k >= 0.0 && k.is_finite(),
            key.key("conductivity"),
            k,
            not_negative,
        );
        self.positive(key.key("specific_heat"), conduction.specific_heat);
        if let Some(step) = conduction.step {
            self.positive(key.key("step"), step);
        }
        let share = conduction.broken_conductance;
        self.within(
            (0.0..=1.0).contains(&share),
            key.key("broken_conductance"),
            share,
            FRACTION,
        );
        let share = conduction.dissipation;
        self.within(
            (0.0..=1.0).contains(&share),
            key.key("dissipation"),
            share,
            FRACTION,
        );
        if conduction.scheme == ConductionScheme::Steady {
            self.within(share <= 0.0, key.key("dissipation"), share, STORES_NO_HEAT);
        }
        for (number, material) in thermal.materials.iter().enumerate() {
            let key = key.key("material").index(number);
            if let Some(k) = material.conductivity {
                self.within(
                    k >= 0.0 && k.is_finite(),
                    key.key("conductivity"),
                    k,
                    not_negative,
                );
            }
            if let Some(c) = material.specific_heat {
                self.positive(key.key("specific_heat"), c);
            }
        }
        for (number, condition) in conduction.conditions.iter().enumerate() {
            let key = key.key("condition").index(number);
            if let Some(area) = condition.area {
                self.positive(key.key("area"), area);
            }
            match condition.amplitude {
                ThermalAmplitude::Convection { coefficient, .. } => {
                    let key = key.key("convection").key("coefficient");
                    self.within(
                        coefficient >= 0.0 && coefficient.is_finite(),
                        key,
                        coefficient,
                        not_negative,
                    );
                }
                ThermalAmplitude::Radiation { emissivity, .. } => {
                    self.within(
                        (0.0..=1.0).contains(&emissivity),
                        key.key("radiation").key("emissivity"),
                        emissivity,
                        FRACTION,
                    );
                }
                _ => {}
            }
        }
    }

    pub(super) fn damping(&mut self, model: &Model) {
        let Some(damping) = model.damping else {
            return;
        };
        let key = KeyPath::from("damping");
        let allowed = "allowed: a finite number that is not negative";
        for (name, value) in [("mass", damping.mass), ("stiffness", damping.stiffness)] {
            let right = value >= 0.0 && value.is_finite();
            self.within(right, key.key(name), value, allowed);
        }
    }

    pub(super) fn boundaries(&mut self, boundaries: &[BoundaryCondition]) {
        for (k, boundary) in boundaries.iter().enumerate() {
            let key = KeyPath::from("boundary").index(k);
            match boundary {
                BoundaryCondition::Absorbing {
                    plan,
                    exterior_extent,
                    ..
                } => {
                    if let Some(tolerance) = plan.tolerance {
                        self.between(key.key("tolerance"), tolerance, [1e-14, 1.0]);
                    }
                    if let Some(depth) = exterior_extent {
                        self.positive(key.key("exterior_extent"), *depth);
                    }
                }
                BoundaryCondition::DampingLayer {
                    thickness,
                    reflection,
                    power,
                    ..
                } => {
                    self.positive(key.key("thickness"), *thickness);
                    self.between(key.key("reflection"), *reflection, [1e-12, 1.0]);
                    let right = (0.0..=10.0).contains(power);
                    let allowed = "allowed: a number from 0 to 10";
                    self.within(right, key.key("power"), power, allowed);
                }
                BoundaryCondition::Open { thickness, .. } => match thickness {
                    Depth::Length(length) => self.positive(key.key("thickness"), *length),
                    Depth::Cells(cells) => self.positive(key.key("cells"), *cells),
                },
            }
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
