//! Outputs and computed quantities: `[output]` and `[[probe]]`.

use super::body::Body;
use super::{Code, Source};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::table::{self, Table};
use crate::units::Quantity;

/// Fields of Pericles by names of output variables.
const FIELDS: [(&str, &str); 15] = [
    ("Displacement", "Displacement"),
    ("Displacements", "Displacement"),
    ("Velocity", "Velocity"),
    ("Damage", "Damage"),
    ("Force Density", "Force_Density"),
    ("Force Densities", "Force_Density"),
    ("Volume", "Volume"),
    ("Dilatation", "Dilatation"),
    ("Radius", "Radius"),
    ("Element Id", "Point_Id"),
    ("Stress", "Stress"),
    ("Cauchy Stress", "Stress"),
    ("Strain", "Strain"),
    ("von Mises Stress", "Von_Mises_Stress"),
    ("Equivalent Plastic Strain", "Plastic_Strain"),
];

/// Translates outputs and computed quantities.
pub(crate) fn tables(source: &Source<'_>, body: &Body) -> Result<Vec<Table>, Fault> {
    let root = source.root;
    let outputs: Vec<&Entry> = match source.code {
        Code::PeriLab => root
            .find("Outputs")
            .map_or(Ok(&[][..]), Entry::entries)?
            .iter()
            .collect(),
        Code::Peridigm => {
            let is_output = |entry: &&Entry| entry.key().to_lowercase().starts_with("output");
            root.entries()?.iter().filter(is_output).collect()
        }
    };
    let mut computed = Vec::new();
    if let Some(list) = root.find("Compute Class Parameters") {
        for entry in list.entries()? {
            computed.push(entry.key());
            if let Some(label) = entry.find("Output Label") {
                computed.push(label.text()?);
            }
        }
    }
    let mut tables = Vec::new();
    for output in outputs {
        let kind = output
            .find("Output File Type")
            .map(Entry::text)
            .transpose()?;
        if kind.is_some_and(|kind| is_same(kind, "CSV")) {
            output
                .refuse("history.csv, reactions.csv and probes.csv have the quantities of the run");
        } else if tables.is_empty() {
            tables.push(fields(output, &computed)?);
        } else {
            output.refuse("Pericles writes one series of fields");
        }
    }
    tables.extend(probes(source, body)?);
    Ok(tables)
}

/// The series of fields of an output.
fn fields(output: &Entry, computed: &[&str]) -> Result<Table, Fault> {
    let mut names: Vec<&str> = Vec::new();
    if let Some(variables) = output.find("Output Variables") {
        for variable in variables.entries()? {
            // A variable that is switched off needs no translation.
            if !variable.flag()? {
                continue;
            }
            match FIELDS
                .iter()
                .find(|(name, _)| is_same(name, variable.key()))
            {
                Some((_, field)) if names.contains(field) => {}
                Some((_, field)) => names.push(field),
                None if computed.contains(&variable.key()) => {}
                None => variable.refuse("there is no such field"),
            }
        }
    }
    let schedule = match (
        output.find("Number of Output Steps"),
        output.find("Output Frequency"),
    ) {
        // One number for each of several steps.
        (Some(count), _) => Some(format!("count = {}", count.first_count()?)),
        (None, Some(every)) => Some(format!("every = {}", every.count()?)),
        (None, None) => None,
    };
    let names: Vec<String> = names.into_iter().map(table::text).collect();
    let names = (!names.is_empty()).then(|| format!("names = {}", table::list(names)));
    let keys = [Some("format = \"exodus\"".to_owned()), schedule, names];
    let keys: Vec<String> = keys.into_iter().flatten().collect();
    let table = Table::new("[output]").from(output);
    Ok(table.key("fields", format!("{{ {} }}", keys.join(", "))))
}

/// Probes at points.
fn probes(source: &Source<'_>, body: &Body) -> Result<Vec<Table>, Fault> {
    let Some(list) = source.root.find("Compute Class Parameters") else {
        return Ok(Vec::new());
    };
    let mut tables = Vec::new();
    let mut places: Vec<String> = Vec::new();
    for entry in list.entries()? {
        let class = entry.need(&["Compute Class"])?.text()?;
        if !is_same(class, "Nearest_Point_Data") {
            entry.refuse("quantities of the deck are probes, reactions and [[output.quantity]]");
            continue;
        }
        let axes = &["X", "Y", "Z"][..body.dimension];
        let at: Result<Vec<f64>, Fault> = axes
            .iter()
            .map(|axis| entry.need(&[axis])?.number())
            .collect();
        let at = source.units.numbers(&at?, Quantity::Length);
        if let Some(variable) = entry.find("Variable") {
            variable.text()?;
        }
        if !places.contains(&at) {
            let letters = entry
                .key()
                .chars()
                .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
            let name: String = letters.collect();
            tables.push(
                Table::new("[[probe]]")
                    .from(entry)
                    .key("name", table::text(&name))
                    .key("at", at.clone()),
            );
            places.push(at);
        }
    }
    Ok(tables)
}
