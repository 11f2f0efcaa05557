//! `[sets.NAME]`: named sets of points and references to them.

use pericles::space::{PointCloud, PointSet, Region};
use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::declaration::DeckValue;
use crate::expression::{Condition, VARIABLES};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Depth, Frame};
use crate::vocabulary::SELECTIONS;

/// Name of the set of all points, which always exists.
pub const ALL: &str = "all";

/// A named set of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedSet {
    /// Name.
    pub name: String,
    /// Its points.
    pub members: Members,
}

/// Selection of the points of a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Members {
    /// Points in a region.
    Region(#[serde(with = "crate::form")] Region),
    /// Points that satisfy a condition on x, y, z and block.
    Where(Condition),
    /// Points of some blocks.
    Blocks(Vec<u32>),
    /// Points near the faces of a face set of a mesh.
    NearFaces(NearFaces),
}

/// Mesh: points within a distance of the faces of a face set, for supports and loads that act on a layer of horizon
/// thickness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct NearFaces {
    /// Name of the face set of the mesh.
    pub faces: String,
    /// Largest distance.
    #[deck(flatten)]
    pub depth: Depth,
}

impl Members {
    /// Returns the points of a cloud; none for points near faces of a mesh, which are not part of a cloud.
    pub fn of(&self, cloud: &PointCloud) -> Option<PointSet> {
        let those = |belongs: &dyn Fn(usize) -> bool| {
            let all = 0..cloud.len() as u32;
            all.filter(|&i| belongs(i as usize)).collect()
        };
        Some(match self {
            Self::Region(region) => cloud.select(region),
            Self::Where(condition) => those(&|i| condition.holds(cloud.point(i), cloud.block(i))),
            Self::Blocks(blocks) => those(&|i| blocks.contains(&cloud.block(i))),
            Self::NearFaces(_) => return None,
        })
    }

    /// Returns the region, if it is one.
    pub fn region(&self) -> Option<&Region> {
        match self {
            Self::Region(region) => Some(region),
            _ => None,
        }
    }
}

/// Defined set names, including sets that could not be read.
pub(crate) struct SetNames {
    names: Vec<String>,
    /// Whether a mesh may define further names.
    open: bool,
}

impl SetNames {
    /// Returns names that are all defined.
    pub(crate) fn any() -> Self {
        Self {
            names: Vec::new(),
            open: true,
        }
    }

    /// Reads a defined set name.
    pub(crate) fn reference(&self, item: &Item<'_>) -> Option<String> {
        let name = item.text()?;
        if self.open || self.names.contains(&name) {
            return Some(name);
        }
        item.unknown_word("set", &name, self.names.iter().map(String::as_str));
        None
    }

    /// Reports an undefined set name that is part of the text of the item.
    pub(crate) fn check(&self, item: &Item<'_>, name: &str) -> Option<()> {
        if self.open || self.names.iter().any(|known| known == name) {
            return Some(());
        }
        item.unknown_word("set", name, self.names.iter().map(String::as_str));
        None
    }

    /// Reads a list of defined set names; a single name may omit the brackets.
    pub(crate) fn references(&self, item: &Item<'_>) -> Option<Vec<String>> {
        if item.word().is_some() {
            return Some(vec![self.reference(item)?]);
        }
        let names: Vec<Option<String>> = item
            .list("a list of set names")?
            .iter()
            .map(|name| self.reference(name))
            .collect();
        names.into_iter().collect()
    }
}

/// Reads `[sets]`; references may also name the `further` sets: pieces of the body, and sets that the program adds.
pub(crate) fn read(
    table: Option<Table<'_>>,
    frame: Frame,
    further: &[String],
) -> (Option<Vec<NamedSet>>, SetNames) {
    let mut names = SetNames {
        names: [&[ALL.into()], further].concat(),
        open: frame.mesh,
    };
    let mut sets = Some(Vec::new());
    for (name, place, item) in table.iter().flat_map(|table| table.named("set")) {
        if let Some(fault) = bad_name(name) {
            table
                .iter()
                .for_each(|table| table.report_at(place, fault()));
            sets = None;
        }
        names.names.push(name.into());
        let members = item.table().and_then(|table| members(table, frame));
        match (members, &mut sets) {
            (Some(members), Some(sets)) => sets.push(NamedSet {
                name: name.into(),
                members,
            }),
            _ => sets = None,
        }
    }
    (sets, names)
}

/// Reads a table with exactly one key: a kind of region, `where`, `block` or `near_faces`.
fn members(table: Table<'_>, frame: Frame) -> Option<Members> {
    let found = table.exactly_one(SELECTIONS);
    table.finish();
    let (kind, item) = found?;
    match kind {
        "where" => condition(&item, frame.dimension).map(Members::Where),
        "block" => blocks(&item).map(Members::Blocks),
        "near_faces" => near_faces(&item, frame),
        kind => region::of_kind(kind, &item, frame).map(Members::Region),
    }
}

/// A distance from the faces of a mesh.
fn near_faces(item: &Item<'_>, frame: Frame) -> Option<Members> {
    if frame.dimension.is_some() && !frame.mesh {
        item.out_of_range(
            "another kind of set, such as `layer`; `near_faces` requires shape = \"mesh\"",
        );
        return None;
    }
    NearFaces::read(item, ()).map(Members::NearFaces)
}

fn condition(item: &Item<'_>, dimension: Option<usize>) -> Option<Condition> {
    let text = item.text()?;
    let mut variables = VARIABLES[..dimension.unwrap_or(3)].to_vec();
    variables.push("block");
    let read = Condition::parse(&text, &variables);
    read.map_err(|malformed| {
        let reason = malformed.reason;
        item.report(Fault::BadCondition {
            text,
            reason,
            allowed: Condition::ALLOWED,
        });
    })
    .ok()
}

/// Reads a block number or a list of block numbers.
pub(crate) fn blocks(item: &Item<'_>) -> Option<Vec<u32>> {
    let block = |item: &Item<'_>| {
        let allowed = "a whole number of at least 0, or a list of such numbers";
        let number = item.within(Quantity::Number, allowed, |number| {
            number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)
        })?;
        Some(number as u32)
    };
    if !item.is_list() {
        return Some(vec![block(item)?]);
    }
    let items = item.list("a list of block numbers")?;
    let numbers: Vec<Option<u32>> = items.iter().map(block).collect();
    numbers.into_iter().collect()
}

/// Returns the fault of an invalid name of a set or probe; such names become part of column names.
pub(crate) fn bad_name(name: &str) -> Option<impl Fn() -> Fault + use<>> {
    let reason = if name == ALL {
        "it is reserved for the set of all points"
    } else if name.is_empty() {
        "it is empty"
    } else if name.contains(|c: char| c.is_control() || matches!(c, ',' | ';' | '"' | '\'')) {
        "it contains a comma, a semicolon, a quotation mark or a control character"
    } else {
        return None;
    };
    let name = name.to_owned();
    Some(move || Fault::BadName {
        name: name.clone(),
        reason,
        allowed: "allowed: any other text, such as \"left_edge\"",
    })
}
