//! Range checks of `[time]`, `[output]` and `[checkpoint]`.

use pericles::observe::{Field, Schedule};

use crate::component::Variables;
use crate::declaration::{Check, DeckKeys, DeckValue};
use crate::key_path::KeyPath;
use crate::output::Output;
use crate::scheme::{FineRegion, FineStep, Scheme};
use crate::set::SetNames;
use crate::time::{Time, TimeStep};

impl Check {
    pub(super) fn time(&mut self, time: &Time) {
        let key = KeyPath::from("time");
        self.positive(key.key("end"), time.end);
        match time.step {
            TimeStep::Auto { safety } => {
                let right = safety > 0.0 && safety <= 1.0;
                let allowed = "allowed: a number above 0 and at most 1";
                self.within(right, key.key("safety"), safety, allowed);
            }
            TimeStep::Fixed(dt) => self.positive(key.key("dt"), dt),
            TimeStep::Equal(count) => self.count(key.key("load_steps"), count),
        }
        match &time.scheme {
            Scheme::RungeKutta3 { alpha } => self.alpha(&key, *alpha),
            Scheme::MultiTimeStep3 { alpha, fine, .. } => {
                self.alpha(&key, *alpha);
                self.fine(&key, fine);
            }
            Scheme::MultiTimeStep4 { fine, .. } | Scheme::Respa { fine } => self.fine(&key, fine),
            Scheme::DormandPrince { tolerance } | Scheme::DiscreteGradient { tolerance } => {
                self.between(key.key("tolerance"), *tolerance, [0.0, 1.0]);
            }
            Scheme::Newmark(options) => {
                options.check_keys(&key, (), self);
            }
            Scheme::Relaxation(options) => {
                options.check_keys(&key, Some(options.damping), self);
            }
            Scheme::Static(options) => {
                self.between(key.key("tolerance"), options.tolerance, [0.0, 1.0]);
                self.count(key.key("newton_steps"), options.newton_steps);
                if let Some(control) = &options.control {
                    let right = control.rate != 0.0 && control.rate.is_finite();
                    let key = key.key("control").key("rate");
                    self.within(right, key, control.rate, "allowed: a speed other than 0");
                }
            }
            Scheme::VelocityVerlet
            | Scheme::Thermal
            | Scheme::RungeKutta4
            | Scheme::Implicit { .. }
            | Scheme::Trigonometric(_) => {}
        }
        time.stop_when
            .check(key.key("stop_when"), &SetNames::any(), self);
    }

    fn alpha(&mut self, key: &KeyPath, alpha: f64) {
        let right = alpha != 0.0 && alpha.is_finite();
        self.within(right, key.key("alpha"), alpha, "allowed: any number but 0");
    }

    fn fine(&mut self, key: &KeyPath, fine: &FineStep) {
        self.count(key.key("ratio"), fine.ratio);
        if let FineRegion::Adaptive(follow) = &fine.region {
            let key = key.key("adaptive");
            self.count(key.key("every"), follow.every);
            self.count(key.key("layers"), follow.layers);
            self.between(key.key("threshold"), follow.threshold, [0.0, 1.0]);
        }
    }

    pub(super) fn output(&mut self, output: &Output, dimension: usize) {
        let key = KeyPath::from("output");
        self.schedule(&key.key("fields"), output.fields);
        self.schedule(&key.key("history"), output.history);
        self.schedule(&key.key("fragments"), output.fragments.schedule);
        if let Some(cracks) = output.cracks {
            self.schedule(&key.key("cracks"), cracks.schedule);
        }
        for (field, component) in &output.extremes {
            self.component(
                key.key("history").key("extremes"),
                *field,
                *component,
                dimension,
            );
        }
        if let Some(rate) = output.energy_bound {
            self.positive(key.key("energy_bound"), rate);
        }
        let scope = Variables {
            dimension: Some(dimension),
            time: true,
        };
        output.pictures.check(key.key("picture"), scope, self);
        output.profiles.check(key.key("profile"), scope, self);
        output.quantities.check(key.key("quantity"), scope, self);
    }

    /// Requires a component of a field to exist.
    fn component(
        &mut self,
        key: KeyPath,
        field: Field,
        component: Option<usize>,
        dimension: usize,
    ) {
        if let Some(component) = component {
            let known = field.components(dimension).len();
            let allowed = format!("allowed: a component below {known}");
            self.within(component < known, key, component, &allowed);
        }
    }

    fn schedule(&mut self, key: &KeyPath, schedule: Schedule) {
        schedule.check_keys(key, schedule, self);
    }
}
