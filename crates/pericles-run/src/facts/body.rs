//! Facts of the body: points, bonds, memory.

use pericles_deck::Model;

use super::list::{Facts, Section};
use crate::build::Assembly;
use crate::units::{bytes, count, quantity, significant};

impl Facts {
    pub(super) fn body(&mut self, model: &Model, assembly: &Assembly) {
        let section = Section::Body;
        let (domain, dimension) = (assembly.cloud.domain(), assembly.cloud.dimension());
        let units = assembly.cloud.body_units();
        let operator = assembly.system.operator();
        let points = domain.whole_points();
        let directed = domain.count(operator.directed_bonds());
        let (spacing, horizon) = (assembly.cloud.spacing(), model.body.horizon());
        let state = model.body.solid().map(|solid| solid.state.name());
        let kind = match state {
            Some(state) => format!("{dimension}D, {state}"),
            None => "surface in 3D".into(),
        };
        let line = self.line(section, "body", kind);
        line.fact("dimension", "", dimension)
            .some("units_per", "", units.per())
            .fact("mass", &units.unit("kg"), assembly.system.mass());
        if let Some(state) = state {
            line.checked("state", "", state);
        }
        self.line(section, "points", count(points as u64))
            .fact("points", "", points);
        let per_point = directed as f64 / points as f64;
        let text = format!(
            "{} ({} directed, {} per point), force kernel: {}",
            count(directed / 2),
            count(directed),
            significant(per_point, 3),
            assembly.form.name()
        );
        self.line(section, "bonds", text)
            .fact("bonds", "", directed / 2)
            .fact("directed_bonds", "", directed)
            .checked("directed_bonds_per_point", "", per_point)
            .fact("operator", "", assembly.form.name())
            .fact("instruction_set", "", operator.instruction_set().name());
        let precut = match assembly.precut_bonds {
            0 => String::new(),
            bonds => count(bonds),
        };
        self.line(section, "pre-cracked bonds", precut).fact(
            "precut_bonds",
            "",
            assembly.precut_bonds,
        );
        let memory = assembly.memory_estimate(model);
        self.line(section, "memory", format!("about {} (peak)", bytes(memory)))
            .fact("memory_estimate", "B", memory);
        let ratio = horizon / spacing;
        let text = format!(
            "{}, {}; ratio {}",
            quantity(spacing, "m"),
            quantity(horizon, "m"),
            significant(ratio, 4)
        );
        self.line(section, "spacing, horizon", text)
            .fact("spacing", "m", spacing)
            .fact("horizon", "m", horizon)
            .checked("horizon_ratio", "", ratio);
    }
}
