//! Resolution of nested sets to their members.

use std::collections::HashMap;

use super::keyword::Name;
use super::scope::{Member, Scope};
use crate::fault::Fault;
use crate::raw::Cells;
use crate::scan::Numbering;

/// Maximum depth of nested sets.
const DEPTH: usize = 32;

/// A scope with its position in the mesh.
pub(super) struct Placed {
    /// The instance; `None` for the model itself.
    pub(super) name: Option<Name>,
    /// Prefix of the names of its sets.
    pub(super) prefix: String,
    pub(super) scope: Scope,
    pub(super) nodes: Numbering,
    pub(super) elements: Numbering,
}

/// Identifies a set by scope, whether it is a node set, and its index in the scope.
type SetKey = (usize, bool, usize);

pub(super) struct Resolver<'a> {
    pub(super) placed: &'a [Placed],
    pub(super) cells: &'a Cells,
    known: HashMap<SetKey, Vec<u32>>,
}

impl<'a> Resolver<'a> {
    pub(super) fn new(placed: &'a [Placed], cells: &'a Cells) -> Self {
        Self {
            placed,
            cells,
            known: HashMap::new(),
        }
    }

    /// Returns the members of a set, ascending: numbers of nodes or cells of the whole mesh.
    pub(super) fn set(&mut self, key: SetKey, depth: usize) -> Result<Vec<u32>, Fault> {
        if let Some(members) = self.known.get(&key) {
            return Ok(members.clone());
        }
        let (scope, of_nodes, place) = key;
        let placed = self.placed;
        let definition = &sets_of(&placed[scope].scope, of_nodes)[place];
        if depth > DEPTH {
            return Err(Fault::of_file(format!(
                "the set {:?} refers to itself or nests sets deeper than {DEPTH} levels",
                definition.shown
            )));
        }
        let mut members = Vec::new();
        for (instance, member) in &definition.members {
            let scope = match instance {
                None => scope,
                Some(instance) => match self.scope_of(instance) {
                    Some(scope) => scope,
                    None => {
                        return Err(Fault::of_file(format!(
                            "the set {:?} refers to an instance that is not defined",
                            definition.shown
                        )));
                    }
                },
            };
            let own = self.member(scope, of_nodes, member, depth)?;
            let Some(own) = own else {
                return Err(undefined("set", &definition.shown, member));
            };
            members.extend(own);
        }
        members.sort_unstable();
        members.dedup();
        self.known.insert(key, members.clone());
        Ok(members)
    }

    fn scope_of(&self, instance: &Name) -> Option<usize> {
        let mut scopes = self.placed.iter();
        scopes.position(|placed| placed.name.as_ref() == Some(instance))
    }

    /// Returns the nodes or cells of a set member; `None` for a name that is not defined. Numbers that do not exist are
    /// ignored.
    pub(super) fn member(
        &mut self,
        scope: usize,
        of_nodes: bool,
        member: &Member,
        depth: usize,
    ) -> Result<Option<Vec<u32>>, Fault> {
        let placed = &self.placed[scope];
        let numbering = if of_nodes {
            &placed.nodes
        } else {
            &placed.elements
        };
        match member {
            Member::Number(number) => Ok(Some(numbering.get(*number).into_iter().collect())),
            Member::Range(first, last, step) => {
                Ok(Some(in_range(placed, of_nodes, *first, *last, *step)))
            }
            Member::Set(name) => match self.find(scope, of_nodes, name) {
                Some(key) => self.set(key, depth + 1).map(Some),
                None => {
                    let Some((instance, number)) = name.numbered() else {
                        return Ok(None);
                    };
                    let Some(scope) = self.scope_of(&instance) else {
                        return Ok(None);
                    };
                    self.member(scope, of_nodes, &Member::Number(number), depth)
                }
            },
            Member::NodesOf(name) => {
                let Some(key) = self.find(scope, false, name) else {
                    return Ok(None);
                };
                let cells = self.set(key, depth + 1)?;
                let corners = cells.iter().flat_map(|&c| self.cells.corners(c as usize));
                let mut nodes: Vec<u32> = corners.copied().collect();
                nodes.sort_unstable();
                nodes.dedup();
                Ok(Some(nodes))
            }
        }
    }

    /// Finds the set of this name in a scope, or `instance.set` in another one.
    fn find(&self, scope: usize, of_nodes: bool, name: &Name) -> Option<SetKey> {
        let place = |scope: usize, name| self.placed[scope].scope.place(of_nodes, name);
        if let Some(place) = place(scope, name) {
            return Some((scope, of_nodes, place));
        }
        let (instance, set) = name.parts()?;
        let scope = self.scope_of(&instance)?;
        Some((scope, of_nodes, place(scope, &set)?))
    }
}

/// Creates the error for a member that is not defined.
pub(super) fn undefined(what: &str, shown: &str, member: &Member) -> Fault {
    let name = match member {
        Member::Set(name) | Member::NodesOf(name) => name.key(),
        Member::Number(_) | Member::Range(..) => "a number",
    };
    Fault::of_file(format!(
        "the {what} {shown:?} refers to {name}, which is not defined; allowed: numbers, names of sets, and INSTANCE.SET or INSTANCE.NUMBER"
    ))
}

fn sets_of(scope: &Scope, of_nodes: bool) -> &[super::scope::SetDefinition] {
    match of_nodes {
        true => &scope.node_sets,
        false => &scope.element_sets,
    }
}

/// Returns the existing numbers among first, first + step, … up to last.
fn in_range(placed: &Placed, of_nodes: bool, first: i64, last: i64, step: i64) -> Vec<u32> {
    let (numbering, count) = match of_nodes {
        true => (&placed.nodes, placed.scope.nodes.len()),
        false => (&placed.elements, placed.scope.elements.numbers.len()),
    };
    let width = last.saturating_sub(first);
    if width < 0 {
        return Vec::new();
    }
    if (width / step) as usize <= 2 * count + 16 {
        let numbers = (0..=width / step).filter_map(|k| first.checked_add(k * step));
        return numbers.filter_map(|number| numbering.get(number)).collect();
    }
    // If the range is much longer than the list, the list is searched instead.
    let within = |number: &i64| {
        (first..=last).contains(number) && (*number as i128 - first as i128) % step as i128 == 0
    };
    let places = |number: i64| numbering.get(number);
    match of_nodes {
        true => {
            let numbers = placed.scope.nodes.iter().map(|&(number, ..)| number);
            numbers.filter(within).filter_map(places).collect()
        }
        false => {
            let numbers = placed.scope.elements.numbers.iter().copied();
            numbers.filter(within).filter_map(places).collect()
        }
    }
}
