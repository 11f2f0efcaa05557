//! `[sets.NAME]`: named sets of points and references to them.

use pericles::space::{PointCloud, PointSet, Region};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::declaration::DeckValue;
use crate::expression::{Condition, VARIABLES};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{Depth, Frame};

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

/// Set of points, given by a region, a condition, blocks, numbers of points, or the distance from faces of a mesh. Element
/// groups, face sets and node sets of a mesh are sets under their own names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive, scope = Frame)]
pub enum Members {
    /// Points in a region.
    Region(
        #[serde(with = "crate::form")]
        #[deck(flatten)]
        Region,
    ),
    /// Condition on x, y, z (m) and block, such as "x > 0.01 && (x - 0.02)^2 + y^2 <= 1e-6 || block == 2".
    Where(#[deck(with = condition)] Condition),
    /// Block number, or list of numbers. Points of grids are in block 1; listed points carry their block; mesh elements have
    /// the number of their group, counted from 1 in the order that `pericles mesh` prints, or 0 without a group.
    #[deck(key = "block")]
    Blocks(#[deck(with = blocks)] Vec<u32>),
    /// Numbers of points, in the order of the points file or of the field files, counted from 0 as ParaView does: a number, or
    /// a list of numbers and ranges such as [0, 7, "20-35"].
    #[deck(key = "points")]
    Numbers(#[deck(with = numbers)] Vec<[u32; 2]>),
    /// Mesh: points within a distance of the faces of a face set, for supports and loads that act on a layer of horizon
    /// thickness.
    #[deck(allow_if(
        scope.mesh || scope.dimension.is_none(),
        "`near_faces` requires shape = \"mesh\"; other bodies have regions such as `layer`"
    ))]
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
            Self::Numbers(ranges) => those(&|i| {
                let number = cloud.user_number(i) as u32;
                ranges
                    .iter()
                    .any(|[first, last]| (*first..=*last).contains(&number))
            }),
            Self::NearFaces(_) => return None,
        })
    }

    /// Returns the largest point number, if the points are given by numbers.
    pub fn largest_number(&self) -> Option<u32> {
        match self {
            Self::Numbers(ranges) => ranges.iter().map(|[_, last]| *last).max(),
            _ => None,
        }
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
        let members = Members::read(&item, frame);
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

fn condition(item: &Item<'_>, frame: Frame) -> Option<Condition> {
    let text = item.text()?;
    let mut variables = VARIABLES[..frame.dimension.unwrap_or(3)].to_vec();
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

/// Reads a whole number; `allowed` describes the key.
fn whole(item: &Item<'_>, allowed: &str) -> Option<u32> {
    let number = item.within(Quantity::Number, allowed, |number| {
        number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)
    })?;
    Some(number as u32)
}

/// Reads a block number or a list of block numbers.
fn blocks<S>(item: &Item<'_>, _: S) -> Option<Vec<u32>> {
    let allowed = "a whole number of at least 0, or a list of such numbers";
    let block = |item: &Item<'_>| whole(item, allowed);
    if !item.is_list() {
        return Some(vec![block(item)?]);
    }
    let items = item.list("a list of block numbers")?;
    let numbers: Vec<Option<u32>> = items.iter().map(block).collect();
    numbers.into_iter().collect()
}

/// Reads point numbers, or ranges of them: first and last numbers.
fn numbers<S>(item: &Item<'_>, _: S) -> Option<Vec<[u32; 2]>> {
    let range = |item: &Item<'_>| {
        let allowed = "a whole number of at least 0, or a range such as \"20-35\"";
        let Some(text) = item.word() else {
            return whole(item, allowed).map(|number| [number; 2]);
        };
        let ends = text.split_once('-').and_then(|(first, last)| {
            let ends = [first.trim().parse().ok()?, last.trim().parse().ok()?];
            (ends[0] <= ends[1]).then_some(ends)
        });
        if ends.is_none() {
            item.out_of_range(allowed);
        }
        item.record(text);
        ends
    };
    if !item.is_list() {
        return Some(vec![range(item)?]);
    }
    let items = item.list("a list of point numbers and ranges")?;
    let ranges: Vec<Option<[u32; 2]>> = items.iter().map(range).collect();
    ranges.into_iter().collect()
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
