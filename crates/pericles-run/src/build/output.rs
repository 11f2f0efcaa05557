//! Field files that a model requests: names that Exodus shortens, numbers of outputs.

use pericles::observe::Schedule;
use pericles_deck::{BuildError, Caution, Fault, FieldBlocks, FieldFormat, ModelWarning, Remark};
use pericles_mesh::results::{MOST_OUTPUTS, name_in_exodus};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::at_path;

const FIELDS: &str = "output.fields";

impl Assembler<'_> {
    /// Warns of names of sets, materials and fields that an Exodus file shortens.
    pub(super) fn check_names(&self, sets: &Sets) -> Option<ModelWarning> {
        let output = &self.model.output.fields;
        if output.schedule == Schedule::Never || !output.formats.contains(&FieldFormat::Exodus) {
            return None;
        }
        let arrays: Vec<String> = output.names.numbers.iter().map(|one| one.name()).collect();
        let sets = sets.iter().map(|(name, _)| name.as_str());
        let materials = self.model.materials.iter().map(|other| other.name.as_str());
        let materials = materials.filter(|_| output.blocks == FieldBlocks::Materials);
        let names = sets
            .chain(materials)
            .chain(arrays.iter().map(String::as_str));
        let long: Vec<&str> = names.filter(|name| name_in_exodus(name) != *name).collect();
        let (first, others) = long.split_first()?;
        let caution = Caution::LongExodusNames {
            name: (*first).to_owned(),
            stored: name_in_exodus(first).to_owned(),
            more: others.len(),
        };
        Some(Remark::new(FIELDS, caution))
    }

    /// Rejects more outputs than a VTKHDF file can hold.
    pub(super) fn check_outputs(&self, dt: f64, steps: u64) -> Result<(), BuildError> {
        let output = &self.model.output.fields;
        if !output.formats.contains(&FieldFormat::Vtkhdf) {
            return Ok(());
        }
        let outputs = output.schedule.most(dt, steps);
        if outputs <= MOST_OUTPUTS as u64 {
            return Ok(());
        }
        let fault = Fault::OutOfRange {
            value: format!("{outputs} outputs"),
            allowed: format!(
                "allowed in a VTKHDF file: at most {MOST_OUTPUTS} outputs; write fewer, or use another format"
            ),
        };
        Err(at_path(FIELDS, fault))
    }
}
