//! What the grid does to the waves that loads, motions and initial values send out.

use pericles::analysis::{BondLattice, Carried, space_content, time_content};
use pericles::boundary::{MotionKind, TimeFunction};

use super::Model;
use crate::caution::Caution;
use crate::component::Component;
use crate::conditions::LoadAmplitude;
use crate::deck::Deck;
use crate::finding::Warning;
use crate::reader::Path;

/// Deviation of the phase velocity from which waves count as distorted.
const TOLERANCE: f64 = 0.05;

/// Share of the energy from which a warning is due.
const SHARE: f64 = 0.05;

impl Deck {
    /// The bonds of a point inside the body: what plane waves know of it.
    ///
    /// # Errors
    /// A body whose points lie on no regular grid.
    pub fn bond_lattice(&self, model: &Model) -> pericles::Result<BondLattice> {
        let (material, constants) = (&self.material.bonds, &model.constants);
        match &self.body.rectangular {
            Some(spacing) => {
                BondLattice::of_material(spacing, self.body.grid.section, material, constants)
            }
            None => BondLattice::of_body(&model.cloud, material, constants),
        }
    }

    /// Warns of loads, motions and initial values whose waves the grid distorts. Bodies that lie on no grid, or are of several materials, are not judged.
    pub fn judge_waves(&self, model: &Model) -> Vec<Warning> {
        if !self.material.parts.is_empty() {
            return Vec::new();
        }
        let Ok(lattice) = self.bond_lattice(model) else {
            return Vec::new();
        };
        let carried = Carried::of(&lattice, TOLERANCE);
        let mut warnings = Vec::new();
        let mut judge = |path: &Path, what: &'static str, share: f64| {
            if share > SHARE {
                let caution = Caution::ShortWaves {
                    what,
                    share,
                    tolerance: TOLERANCE,
                    period: std::f64::consts::TAU / carried.frequency,
                    length: std::f64::consts::TAU / carried.wavenumber,
                };
                warnings.push(self.finding(path, caution));
            }
        };
        let state = &model.state;
        for (what, field, strain) in [
            ("initial displacement", &state.u, true),
            ("initial velocity", &state.v, false),
        ] {
            let share = space_content(&model.cloud, field, carried.wavenumber, strain);
            judge(&"initial".into(), what, share.unwrap_or(0.0));
        }
        let end = model.steps as f64 * model.dt;
        let in_time = |g: &dyn Fn(f64) -> f64, start: f64| {
            let start = start.clamp(0.0, end);
            time_content(|t| g(start + t), end - start, carried.frequency)
        };
        for (k, load) in self.loads.iter().enumerate() {
            let (LoadAmplitude::BodyForce(field)
            | LoadAmplitude::Traction {
                traction: field, ..
            }) = &load.amplitude;
            let [from, until] = load.window;
            let g = |t: f64| {
                let acts = (from..=until).contains(&t);
                f64::from(u8::from(acts)) * load.function.value(t) * course(field, t)
            };
            judge(&Path::from("load").index(k), "load", in_time(&g, from));
        }
        for (k, motion) in self.prescribe.iter().enumerate() {
            // A motion sends out its velocity.
            if !motion.moves() {
                continue;
            }
            let mut amplitudes = motion.amplitude.iter().flatten();
            let varies = amplitudes.any(Component::depends_on_time);
            let constant = motion.function == TimeFunction::Constant && !varies;
            if constant && motion.kind == MotionKind::Displacement {
                continue;
            }
            let field = motion
                .amplitude
                .each_ref()
                .map(|entry| entry.clone().unwrap_or(Component::Number(0.0)));
            let displacement = motion.kind == MotionKind::Displacement;
            let step = end * 1e-6;
            let g = |t: f64| match (displacement, varies) {
                (true, false) => motion.function.derivative(t),
                (false, false) => motion.function.value(t),
                (true, true) => {
                    (course(&field, t + step) - course(&field, t - step)) / (2.0 * step)
                }
                (false, true) => course(&field, t),
            };
            judge(
                &Path::from("prescribe").index(k),
                "prescribed motion",
                in_time(&g, 0.0),
            );
        }
        warnings
    }
}

/// How a field goes over time, at the origin; 1 where it does not change.
fn course(field: &[Component; 3], t: f64) -> f64 {
    field
        .iter()
        .find(|entry| entry.depends_on_time())
        .map_or(1.0, |entry| entry.value([0.0; 3], t))
}
