//! Boundary and initial conditions: `[[constraint]]`, `[[initial]]` and `[[load]]`.

use super::body::Body;
use super::sets::Sets;
use super::solver::Solver;
use super::{Code, Source};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::expression::Amount;
use crate::table::{self, Table};
use crate::units::Quantity;

/// What a condition prescribes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Displacement,
    Velocity,
    InitialDisplacement,
    InitialVelocity,
    /// Force per volume.
    ForceDensity,
    /// Force on each point.
    Force,
}

impl Kind {
    fn quantity(self) -> Quantity {
        match self {
            Self::Displacement | Self::InitialDisplacement => Quantity::Length,
            Self::Velocity | Self::InitialVelocity => Quantity::Velocity,
            Self::Force | Self::ForceDensity => Quantity::ForceDensity,
        }
    }
}

/// Conditions of Peridigm by `Type`.
const PERIDIGM: [(&str, Kind); 4] = [
    ("Prescribed Displacement", Kind::Displacement),
    ("Initial Displacement", Kind::InitialDisplacement),
    ("Initial Velocity", Kind::InitialVelocity),
    ("Body Force", Kind::ForceDensity),
];

/// Conditions of PeriLab by `Variable`, with the kind of initial conditions.
const PERILAB: [(&str, Kind, Option<Kind>); 7] = [
    (
        "Displacements",
        Kind::Displacement,
        Some(Kind::InitialDisplacement),
    ),
    (
        "Displacement",
        Kind::Displacement,
        Some(Kind::InitialDisplacement),
    ),
    ("Velocity", Kind::Velocity, Some(Kind::InitialVelocity)),
    ("Forces", Kind::Force, None),
    ("External Forces", Kind::Force, None),
    ("Force Densities", Kind::ForceDensity, None),
    ("External Force Densities", Kind::ForceDensity, None),
];

/// Initial values of a set, which one table of the deck contains.
struct Initial {
    set: String,
    /// Components of the displacement and of the velocity.
    components: [[Option<String>; 3]; 2],
    table: Table,
}

/// Translates all conditions.
pub(crate) fn tables(
    source: &Source<'_>,
    body: &Body,
    sets: &Sets<'_>,
    solver: &Solver<'_>,
) -> Result<Vec<Table>, Fault> {
    let Some(list) = source.root.find("Boundary Conditions") else {
        return Ok(Vec::new());
    };
    let mut tables = Vec::new();
    let mut initial: Vec<Initial> = Vec::new();
    for entry in list.entries()?.iter().filter(|entry| entry.is_group()) {
        if !solver.includes(entry)? {
            entry.refuse("the condition belongs to another step");
            continue;
        }
        let Some(kind) = kind(source.code, entry)? else {
            continue;
        };
        let coordinate = entry.need(&["Coordinate"])?;
        let axis = ["x", "y", "z"]
            .iter()
            .position(|axis| is_same(axis, coordinate.text().unwrap_or_default()));
        let Some(axis) = axis else {
            return Err(coordinate.fault("allowed: x, y or z"));
        };
        if axis >= body.dimension {
            entry.refuse(format!("the body has {} dimensions", body.dimension));
            continue;
        }
        let value = entry.need(&["Value"])?;
        let amount = match Amount::read(value.text()?, solver.start, &source.units) {
            Ok(amount) => amount,
            Err(reason) => {
                entry.refuse(format!("`{}`: {reason}", value.text()?));
                continue;
            }
        };
        let set = sets.named(entry.need(&["Node Set"])?)?;
        let amount = if kind == Kind::Force {
            let members = if set == "all" {
                None
            } else {
                sets.members(&set)
            };
            let Some(volume) = body.common_volume(members.as_deref()) else {
                entry.refuse("a force on each point is a load per volume only if the volumes of the points are known and equal");
                continue;
            };
            amount.over(volume)
        } else {
            amount
        };
        let component = amount.toml(&source.units, kind.quantity());
        // Static schemes ramp constant values up, unless a constant function is given.
        let steady =
            (solver.is_static && amount.is_steady()).then(|| "{ kind = \"constant\" }".to_owned());
        let vector = |fill: &str| {
            table::list((0..body.dimension).map(|c| {
                if c == axis {
                    component.clone()
                } else {
                    fill.to_owned()
                }
            }))
        };
        let table = |heading: &str, key, fill: &str| {
            let table = Table::new(heading)
                .from(entry)
                .key("set", table::text(&set));
            table
                .key(key, vector(fill))
                .maybe("function", steady.clone())
        };
        match kind {
            Kind::Displacement => tables.push(table("[[constraint]]", "displacement", "\"free\"")),
            Kind::Velocity => tables.push(table("[[constraint]]", "velocity", "\"free\"")),
            Kind::Force | Kind::ForceDensity => tables.push(table("[[load]]", "body_force", "0")),
            Kind::InitialDisplacement | Kind::InitialVelocity => {
                let which = usize::from(kind == Kind::InitialVelocity);
                let at = initial.iter().position(|known| known.set == set);
                let at = at.unwrap_or_else(|| {
                    let overlaps = |known: &Initial| sets.may_overlap(&known.set, &set);
                    if initial.iter().any(overlaps) {
                        entry.differ("where sets of initial conditions overlap, the last table of the deck counts for all components");
                    }
                    initial.push(Initial {
                        table: Table::new("[[initial]]"),
                        set,
                        components: Default::default(),
                    });
                    initial.len() - 1
                });
                let known = &mut initial[at];
                known.components[which][axis] = Some(component.clone());
                known.table = std::mem::replace(&mut known.table, Table::new("")).from(entry);
            }
        }
    }
    tables.extend(initial.into_iter().map(|initial| {
        let keys = ["displacement", "velocity"]
            .into_iter()
            .zip(initial.components);
        let vectors = keys
            .filter(|(_, components)| components.iter().any(Option::is_some))
            .map(|(key, components)| {
                let components = components.into_iter().take(body.dimension);
                (
                    key,
                    table::list(
                        components.map(|component| component.unwrap_or_else(|| "0".to_owned())),
                    ),
                )
            });
        initial
            .table
            .key("set", table::text(&initial.set))
            .keys(vectors.collect::<Vec<_>>())
    }));
    Ok(tables)
}

/// Returns what a condition prescribes; `None` for a condition without counterpart, which is recorded.
fn kind(code: Code, entry: &Entry) -> Result<Option<Kind>, Fault> {
    let found = match code {
        Code::Peridigm => {
            let name = entry.need(&["Type"])?.text()?;
            PERIDIGM
                .iter()
                .find(|(known, _)| is_same(known, name))
                .map(|(_, kind)| *kind)
        }
        Code::PeriLab => {
            // Older versions name the variable in `Type`.
            let name = entry.need(&["Variable", "Type"])?.text()?;
            let is_initial = match entry.find("Type") {
                Some(given) => is_same(given.text()?, "Initial"),
                None => false,
            };
            let found = PERILAB.iter().find(|(known, ..)| is_same(known, name));
            found.and_then(|(_, kind, initial)| if is_initial { *initial } else { Some(*kind) })
        }
    };
    if found.is_none() {
        entry.refuse("conditions of this kind have no counterpart, or belong to [thermal]");
    }
    Ok(found)
}
