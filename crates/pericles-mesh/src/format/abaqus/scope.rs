//! What a part, an instance or the model itself holds.

use std::collections::{BTreeMap, HashMap};

use super::keyword::Name;
use crate::cell::CellKind;

/// A line of one of the files that were read.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Position {
    /// The included file, from 1; 0 of the file itself.
    pub(super) file: u32,
    pub(super) line: u32,
}

/// Elements, with the numbers of their corners in the file.
#[derive(Debug, Clone, Default)]
pub(super) struct Elements {
    pub(super) kinds: Vec<CellKind>,
    pub(super) numbers: Vec<i64>,
    pub(super) corners: Vec<i64>,
    pub(super) positions: Vec<Position>,
}

/// A member of a set.
#[derive(Debug, Clone)]
pub(super) enum Member {
    Number(i64),
    /// First, last and step, which is positive.
    Range(i64, i64, i64),
    /// All members of another set.
    Set(Name),
    /// The nodes of the elements of a set.
    NodesOf(Name),
}

/// A node set or element set.
#[derive(Debug, Clone)]
pub(super) struct SetDefinition {
    pub(super) name: Name,
    pub(super) shown: String,
    /// Made by a program for its own use.
    pub(super) is_internal: bool,
    /// Members, and the instance to which they belong where it is named.
    pub(super) members: Vec<(Option<Name>, Member)>,
}

/// Which face of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FaceLabel {
    /// S1, S2, …
    Number(usize),
    /// The element itself, of shells.
    Itself,
    /// All faces that belong to one element only.
    Free,
}

/// A surface: faces of elements.
#[derive(Debug, Clone)]
pub(super) struct SurfaceDefinition {
    pub(super) shown: String,
    pub(super) faces: Vec<(Member, FaceLabel)>,
}

/// Nodes, elements, sets and surfaces that are numbered together.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope {
    pub(super) nodes: Vec<(i64, [f64; 3], Position)>,
    pub(super) elements: Elements,
    pub(super) node_sets: Vec<SetDefinition>,
    pub(super) element_sets: Vec<SetDefinition>,
    pub(super) surfaces: Vec<SurfaceDefinition>,
    /// Places of the sets, by whether they are of nodes and by name.
    places: HashMap<(bool, Name), usize>,
}

impl Scope {
    /// The set of this name, made if there is none.
    pub(super) fn set(&mut self, of_nodes: bool, word: &str) -> &mut SetDefinition {
        let (name, shown) = Name::of(word);
        self.named(of_nodes, name, shown)
    }

    fn named(&mut self, of_nodes: bool, name: Name, shown: String) -> &mut SetDefinition {
        let sets = match of_nodes {
            true => &mut self.node_sets,
            false => &mut self.element_sets,
        };
        let place = *self
            .places
            .entry((of_nodes, name.clone()))
            .or_insert(sets.len());
        if place == sets.len() {
            sets.push(SetDefinition {
                name,
                shown,
                is_internal: false,
                members: Vec::new(),
            });
        }
        &mut sets[place]
    }

    /// The place of the set of this name.
    pub(super) fn place(&self, of_nodes: bool, name: &Name) -> Option<usize> {
        self.places.get(&(of_nodes, name.clone())).copied()
    }

    /// Adds all of another scope behind what is here.
    pub(super) fn append(&mut self, other: Self) {
        self.nodes.extend(other.nodes);
        self.elements.kinds.extend(other.elements.kinds);
        self.elements.numbers.extend(other.elements.numbers);
        self.elements.corners.extend(other.elements.corners);
        self.elements.positions.extend(other.elements.positions);
        for (of_nodes, sets) in [(true, other.node_sets), (false, other.element_sets)] {
            for set in sets {
                let own = self.named(of_nodes, set.name, set.shown);
                own.is_internal |= set.is_internal;
                own.members.extend(set.members);
            }
        }
        self.surfaces.extend(other.surfaces);
    }
}

/// A copy of a part, moved and turned.
#[derive(Debug, Clone)]
pub(super) struct Instance {
    pub(super) name: Name,
    pub(super) shown: String,
    pub(super) part: Name,
    pub(super) scope: Scope,
    pub(super) translation: [f64; 3],
    /// Two points of the axis and an angle in degrees, applied after the translation.
    pub(super) rotation: Option<([f64; 3], [f64; 3], f64)>,
}

/// All that is read.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// The model itself, or its assembly.
    pub(super) root: Scope,
    pub(super) parts: Vec<(Name, String, Scope)>,
    pub(super) instances: Vec<Instance>,
    /// Names of included files.
    pub(super) files: Vec<String>,
    /// Elements of types that are not used.
    pub(super) left_out: BTreeMap<String, usize>,
}
