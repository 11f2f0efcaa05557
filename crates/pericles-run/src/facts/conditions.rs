//! Facts of properties that are functions, loads, heat conduction, contact and boundaries.

use pericles::ActivationRange;
use pericles_deck::Model;
use pericles_waves::absorbing::{EndReport, KernelMethod, Side};
use serde_json::json;

use super::list::{Facts, Section};
use crate::build::{Assembly, LoadReport, PropertyRange, shown};
use crate::heat::HeatFacts;
use crate::open_facts::OpenFacts;
use crate::units::{bytes, count, quantity, significant};

impl Facts {
    pub(super) fn properties(&mut self, assembly: &Assembly) {
        let entries = assembly.properties.iter().map(|range| {
            let mut entry = json!({
                "property": range.key,
                "least": range.least,
                "mean": range.mean,
                "most": range.most,
            });
            if let Some(material) = &range.material {
                entry["material"] = json!(material);
            }
            ("property", property(range), entry)
        });
        self.list(Section::Material, "properties", true, entries);
    }

    pub(super) fn loads(&mut self, assembly: &Assembly) {
        /// Largest number of printed loads; `run.json` has all.
        const LOADS: usize = 20;
        let dimension = assembly.cloud.dimension();
        let entries = assembly.loads.iter().enumerate().map(|(k, load)| {
            let entry = json!({
                "set": load.set,
                "points": load.points,
                "area": load.area,
                "force": load.force[..dimension],
                "force_time": load.at,
            });
            let text = match k < LOADS {
                true => resultant(load, assembly),
                false => String::new(),
            };
            ("load", text, entry)
        });
        self.list(Section::Conditions, "loads", true, entries);
        if let Some(more @ 1..) = assembly.loads.len().checked_sub(LOADS) {
            let text = format!("{} more", count(more as u64));
            self.line(Section::Conditions, "loads", text)
                .checked("loads_not_listed", "", more);
        }
    }

    pub(super) fn heat(&mut self, assembly: &Assembly) {
        let Some(heat) = assembly.temperature.as_ref().map(HeatFacts::of) else {
            return;
        };
        let step = heat.step.unwrap_or(assembly.dt);
        let parts = match heat.scheme {
            "explicit" => (step / heat.explicit_limit).ceil().max(1.0),
            _ => 1.0,
        };
        let sub_steps = match parts {
            1.0 => String::new(),
            parts => format!(", about {} sub-steps per step", significant(parts, 3)),
        };
        let text = format!(
            "{}, step {}{sub_steps}; limit of the explicit scheme {}",
            heat.scheme,
            quantity(step, "s"),
            quantity(heat.explicit_limit, "s")
        );
        self.line(Section::Conditions, "heat conduction", text)
            .fact("heat", "", heat)
            .checked("thermal_step", "s", step)
            .checked("thermal_sub_steps", "", parts);
    }

    pub(super) fn activation(&mut self, assembly: &Assembly) {
        let Some(range) = assembly.system.activation_range() else {
            return;
        };
        let ActivationRange {
            points,
            first,
            last,
            never,
        } = range;
        let mut text = format!("{} points", count(points));
        if points > never {
            text += &format!(
                " between {} and {}",
                quantity(first, "s"),
                quantity(last, "s")
            );
        }
        if never > 0 {
            text += &format!(", {} of them never", count(never));
        }
        let line = self.line(Section::Conditions, "activation", text);
        line.fact("activated_points", "", points)
            .fact("never_activated_points", "", never);
        if points > never {
            line.fact("activation_start", "s", first)
                .fact("activation_end", "s", last);
        }
    }

    /// Adds pieces, contact and impactors.
    pub(super) fn contact(&mut self, model: &Model, assembly: &Assembly) {
        let section = Section::Conditions;
        let pieces = model.body.solid().map(|solid| solid.shape.pieces().len());
        if let Some(pieces @ 1..) = pieces {
            self.line(
                section,
                "pieces",
                format!("{pieces}, without bonds between them"),
            )
            .fact("pieces", "", pieces);
        }
        if let Some(contact) = assembly.contact_frequency {
            let lasts = std::f64::consts::PI / contact;
            let steps = lasts / assembly.dt;
            let text = format!(
                "of two points lasts {}, {} steps",
                quantity(lasts, "s"),
                significant(steps, 3)
            );
            self.line(section, "contact", text)
                .fact("contact_frequency", "rad/s", contact)
                .checked("contact_duration", "s", lasts)
                .checked("contact_steps", "", steps);
        }
        let impactors = model.impactors.iter();
        let entries = impactors.map(|one| ("impactor", one.name.clone(), json!(one.name)));
        self.list(section, "impactors", true, entries);
    }

    pub(super) fn boundaries(&mut self, assembly: &Assembly) {
        let section = Section::Boundaries;
        let entries = assembly.ends.iter().map(|(side, report)| {
            let entry = json!({
                "side": side.name(),
                "method": report.method.name(),
                "history": report.history,
                "memory": report.bytes,
                "exponentials": report.exponentials,
                "residual": report.residual,
                "distance": report.distance,
            });
            ("absorbing boundary", absorbing(*side, report), entry)
        });
        self.list(section, "ends", true, entries);
        if let Some(open) = &assembly.open {
            let points = assembly.cloud.domain().whole_points();
            let open = OpenFacts::of(open, points, assembly.cloud.spacing());
            self.line(section, "open boundary", open.line())
                .fact("open", "", &open);
            for waves in &open.reflection {
                self.line(section, "reflection", waves.line());
            }
        }
    }
}

fn property(range: &PropertyRange) -> String {
    let [least, mean, most] =
        [range.least, range.mean, range.most].map(|value| shown(value, range.unit));
    let material = range.material.as_ref();
    let of = material.map_or_else(String::new, |name| format!(" of {name}"));
    let at = match range.is_heated {
        true => ", at the temperatures of the start",
        false => "",
    };
    format!("{}{of}: {least} to {most}, mean {mean}{at}", range.key)
}

fn resultant(load: &LoadReport, assembly: &Assembly) -> String {
    let units = assembly.cloud.body_units();
    let force = load.force[..assembly.cloud.dimension()].iter();
    let force: Vec<String> = force.map(|f| units.quantity(*f, "N")).collect();
    let area = load.area.map_or_else(String::new, |area| {
        format!(" on {} mm²", significant(1e6 * area, 4))
    });
    format!(
        "{}: {} points{area}; total force ({}), largest at t = {}",
        load.set,
        count(load.points as u64),
        force.join(", "),
        quantity(load.at, "s")
    )
}

fn absorbing(side: Side, report: &EndReport) -> String {
    let memory = bytes(report.bytes as u64);
    let mut line = format!("{}: {}, {memory}", side.name(), report.history);
    if report.method.name() != KernelMethod::Discrete.name() {
        line += &format!(", {} kernels", report.method.name());
    }
    if let (Some(count), Some(residual)) = (report.exponentials, report.residual) {
        line += &format!(", {count} terms, error {}", significant(residual, 2));
    }
    if let Some(distance) = report.distance {
        line += &format!(
            ", deviation {} from the exact kernels",
            significant(distance, 2)
        );
    }
    line
}
