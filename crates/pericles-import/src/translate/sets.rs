//! Node sets and blocks: `[sets]`.

use std::cell::RefCell;
use std::fs;

use super::{Code, Source, names};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::expression::in_si_variables;
use crate::table::{self, Table};

/// The node sets of an input file, and those that the deck uses.
#[derive(Debug)]
pub(crate) struct Sets<'e> {
    known: Vec<Named<'e>>,
    /// The points are elements of a mesh, which has sets of its own.
    is_mesh: bool,
    used: RefCell<Vec<(String, Table)>>,
}

#[derive(Debug)]
struct Named<'e> {
    entry: &'e Entry,
    points: Points,
}

/// The points of a set.
#[derive(Debug)]
enum Points {
    /// Numbers, from zero, in ascending order.
    Listed(Vec<usize>),
    /// A condition on the coordinates.
    Where(String),
    /// None: the file cannot be read, for this reason.
    Missing(String),
}

impl<'e> Sets<'e> {
    pub(crate) fn read(source: &Source<'e>, is_mesh: bool) -> Result<Self, Fault> {
        let listed = match source.code {
            Code::PeriLab => {
                let body = source.root.find("Discretization");
                body.and_then(|body| body.find("Node Sets"))
            }
            Code::Peridigm => source.root.find("Boundary Conditions"),
        };
        let entries = listed.map_or(Ok(&[][..]), Entry::entries)?;
        let mut known = Vec::new();
        for entry in entries.iter().filter(|entry| !entry.is_group()) {
            let points = points(source, entry)?;
            known.push(Named { entry, points });
        }
        let contains_zero = |set: &&Named<'_>| matches!(&set.points, Points::Listed(members) if members.first() == Some(&0));
        let zero = known.iter().find(contains_zero);
        let zero = zero.map(|set| set.entry);
        if let (Some(entry), Code::PeriLab) = (zero, source.code) {
            return Err(entry.fault("the point number 0; points are counted from 1"));
        }
        for set in &mut known {
            match (&mut set.points, zero) {
                // Older versions of Peridigm count from zero.
                (Points::Listed(_), Some(_)) => set.entry.differ(
                    "points are counted from 0, because one of the sets contains the point 0",
                ),
                (Points::Listed(members), None) => members.iter_mut().for_each(|k| *k -= 1),
                (Points::Where(_) | Points::Missing(_), _) => {}
            }
        }
        Ok(Self {
            known,
            is_mesh,
            used: RefCell::new(Vec::new()),
        })
    }

    /// Returns the name in the deck of the set that a condition names. `A + B` is the union of two sets.
    pub(super) fn named(&self, reference: &Entry) -> Result<String, Fault> {
        let text = reference.text()?;
        if is_same(text, "Full Domain") {
            return Ok("all".to_owned());
        }
        let sets = self.parts(text);
        if sets.is_empty() && self.is_mesh {
            return Ok(text.to_owned());
        }
        if sets.len() != text.split('+').count() {
            let known: Vec<&str> = self.known.iter().map(|set| set.entry.key()).collect();
            let known = known.join(", ");
            return Err(
                reference.fault(format!("`{text}` is not a node set; defined are: {known}"))
            );
        }
        let table = Table::new(table::heading("sets", text));
        let table = sets.iter().fold(table, |table, set| table.from(set.entry));
        let table = match (self.members(text), &sets[..]) {
            (Some(members), _) => table.key("points", ranges(&members)),
            (
                None,
                [
                    Named {
                        points: Points::Where(condition),
                        ..
                    },
                ],
            ) => table.key("where", table::text(condition)),
            (None, sets) => {
                let missing = sets.iter().find_map(|set| match &set.points {
                    Points::Missing(reason) => Some(set.entry.fault(reason)),
                    _ => None,
                });
                return Err(missing.unwrap_or_else(|| {
                    reference
                        .fault("a union with a set that is given by a condition is not supported")
                }));
            }
        };
        self.add(text, table);
        Ok(text.to_owned())
    }

    /// Returns the known sets of a name, or of a union.
    fn parts(&self, name: &str) -> Vec<&Named<'e>> {
        let find = |word| self.known.iter().find(|set| is_same(set.entry.key(), word));
        name.split('+').filter_map(find).collect()
    }

    /// Returns the points of a set, in ascending order; `None` if a condition gives them.
    pub(super) fn members(&self, name: &str) -> Option<Vec<usize>> {
        let lists = self.parts(name).into_iter().map(|set| match &set.points {
            Points::Listed(members) => Some(members),
            Points::Where(_) | Points::Missing(_) => None,
        });
        let lists: Option<Vec<_>> = lists.collect();
        let mut members: Vec<usize> = lists?.into_iter().flatten().copied().collect();
        members.sort_unstable();
        members.dedup();
        Some(members)
    }

    /// Returns whether two sets have common points, or may have some.
    pub(super) fn may_overlap(&self, a: &str, b: &str) -> bool {
        match (self.members(a), self.members(b)) {
            (Some(a), Some(b)) if !a.is_empty() && !b.is_empty() => {
                b.iter().any(|k| a.binary_search(k).is_ok())
            }
            _ => true,
        }
    }

    /// Adds the set of a block, whose name ends with its number.
    pub(super) fn use_block(&self, name: &str, origin: &Entry) {
        // A mesh has sets for its blocks.
        if self.is_mesh {
            return;
        }
        let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
        let table = Table::new(table::heading("sets", name)).from(origin);
        match digits.parse::<u32>() {
            Ok(number) => self.add(name, table.key("block", number.to_string())),
            Err(_) => origin.differ(format!(
                "the name `{name}` contains no block number: define the set `{name}`"
            )),
        }
    }

    fn add(&self, name: &str, table: Table) {
        let mut used = self.used.borrow_mut();
        if !used.iter().any(|(known, _)| known == name) {
            used.push((name.to_owned(), table));
        }
    }

    pub(crate) fn tables(self) -> Vec<Table> {
        self.used
            .into_inner()
            .into_iter()
            .map(|(_, table)| table)
            .collect()
    }
}

/// Returns the points of a set, with numbers as given.
fn points(source: &Source<'_>, entry: &Entry) -> Result<Points, Fault> {
    let text = entry.text()?;
    if text.contains(['<', '>']) {
        let condition = in_si_variables(text, 0.0, &source.units);
        return Ok(Points::Where(condition));
    }
    let is_list = text
        .chars()
        .all(|c| c.is_ascii_digit() || c.is_whitespace() || ",:-".contains(c));
    let file;
    let text = if is_list {
        text
    } else {
        match fs::read_to_string(source.folder.join(text)) {
            Ok(content) => {
                file = content;
                &file
            }
            Err(reason) => {
                let reason = format!("the file cannot be read: {reason}");
                entry.refuse(&*reason);
                return Ok(Points::Missing(reason));
            }
        }
    };
    /// Larger numbers of points are beyond the memory of a machine.
    const LARGEST: usize = 1_000_000_000;
    let mut members = Vec::new();
    for line in text.lines() {
        // Lines that begin with a letter or a sign are headers and comments.
        if line.trim_start().starts_with(|c: char| !c.is_ascii_digit()) {
            continue;
        }
        for word in names(line) {
            let (first, last) = word.split_once(':').unwrap_or((word, word));
            match (first.parse::<usize>(), last.parse::<usize>()) {
                (Ok(first), Ok(last)) if last < LARGEST => members.extend(first..=last),
                _ => return Err(entry.fault(format!("`{word}` is not a point number"))),
            }
        }
    }
    members.sort_unstable();
    members.dedup();
    Ok(Points::Listed(members))
}

/// Returns a list of points with ranges, such as `[0, "3-7"]`.
fn ranges(members: &[usize]) -> String {
    let runs = members.chunk_by(|a, b| a + 1 == *b);
    table::list(runs.map(|run| match run {
        [first, .., last] => table::text(&format!("{first}-{last}")),
        _ => run[0].to_string(),
    }))
}
