//! Content of a part, an instance or the model.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::keyword::Name;
use crate::cell::CellKind;

/// A line in one of the files.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Position {
    /// The included file, from 1; 0 for the main file.
    pub(super) file: u32,
    pub(super) line: u32,
}

/// Elements with corners by node numbers of the file.
#[derive(Debug, Clone, Default)]
pub(super) struct Elements {
    pub(super) kinds: Vec<CellKind>,
    pub(super) numbers: Vec<i64>,
    pub(super) corners: Vec<i64>,
    pub(super) positions: Vec<Position>,
}

/// Member of a set.
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
    /// Whether it is internal, created by a program.
    pub(super) is_internal: bool,
    /// Members, each with the instance it belongs to if that is specified.
    pub(super) members: Vec<(Option<Name>, Member)>,
}

/// Specification of an element face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FaceLabel {
    /// S1, S2, …
    Number(usize),
    /// The element itself, for shells.
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

/// Nodes, elements, sets and surfaces with a common numbering.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope {
    pub(super) nodes: Vec<(i64, [f64; 3], Position)>,
    pub(super) elements: Elements,
    pub(super) node_sets: Vec<SetDefinition>,
    pub(super) element_sets: Vec<SetDefinition>,
    pub(super) surfaces: Vec<SurfaceDefinition>,
    /// Indices of the sets, by whether they are node sets and by name.
    places: HashMap<(bool, Name), usize>,
}

impl Scope {
    /// Returns the set of this name, created if it does not exist.
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

    /// Returns the index of the set of this name.
    pub(super) fn place(&self, of_nodes: bool, name: &Name) -> Option<usize> {
        self.places.get(&(of_nodes, name.clone())).copied()
    }

    /// Removes the nodes and elements that another scope defines again.
    pub(super) fn replace(&mut self, other: &Self) {
        let nodes: HashSet<i64> = other.nodes.iter().map(|(number, ..)| *number).collect();
        self.nodes.retain(|(number, ..)| !nodes.contains(number));
        let again: HashSet<i64> = other.elements.numbers.iter().copied().collect();
        if self
            .elements
            .numbers
            .iter()
            .all(|number| !again.contains(number))
        {
            return;
        }
        let old = std::mem::take(&mut self.elements);
        let mut corners = old.corners.into_iter();
        for (place, kind) in old.kinds.into_iter().enumerate() {
            let own: Vec<i64> = corners.by_ref().take(kind.corners()).collect();
            if !again.contains(&old.numbers[place]) {
                self.elements.kinds.push(kind);
                self.elements.numbers.push(old.numbers[place]);
                self.elements.corners.extend(own);
                self.elements.positions.push(old.positions[place]);
            }
        }
    }

    /// Appends the content of another scope.
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

/// A translated and rotated copy of a part.
#[derive(Debug, Clone)]
pub(super) struct Instance {
    pub(super) name: Name,
    pub(super) shown: String,
    /// The part; an instance with a mesh of its own needs none.
    pub(super) part: Option<Name>,
    pub(super) scope: Scope,
    pub(super) translation: [f64; 3],
    /// Two points of the axis and an angle in degrees; the rotation follows the translation.
    pub(super) rotation: Option<([f64; 3], [f64; 3], f64)>,
}

/// Everything read from the files.
#[derive(Debug, Default)]
pub(super) struct Model {
    /// Content of the model or its assembly.
    pub(super) root: Scope,
    pub(super) parts: Vec<(Name, String, Scope)>,
    pub(super) instances: Vec<Instance>,
    /// Names of included files.
    pub(super) files: Vec<String>,
    /// Number of elements of unsupported types.
    pub(super) left_out: BTreeMap<String, usize>,
}
