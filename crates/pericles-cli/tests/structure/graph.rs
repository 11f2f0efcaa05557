//! The module graph of a crate: which modules use which siblings, and cycles among them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::source::Source;
use crate::syntax::Import;

type Path = Vec<String>;

/// Maximum depth of re-exports that are followed.
const LONGEST_CHAIN: usize = 16;

/// Sibling modules that use one another directly or indirectly.
pub struct Cycle {
    /// The crate and the parent module, such as `pericles::operator`.
    pub parent: String,
    pub modules: BTreeSet<String>,
    /// The imports that form the cycle: module, sibling that it uses, location.
    imports: Vec<(String, String, String)>,
}

impl fmt::Display for Cycle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let modules: Vec<&str> = self.modules.iter().map(String::as_str).collect();
        writeln!(f, "{}: cycle of {}", self.parent, modules.join(", "))?;
        let mut last = None;
        for (user, used, place) in &self.imports {
            if last.replace((user, used)) != Some((user, used)) {
                writeln!(f, "    {user} uses {used}")?;
            }
            writeln!(f, "        {place}")?;
        }
        Ok(())
    }
}

/// The modules of a crate by path.
struct Modules<'a> {
    sources: BTreeMap<&'a [String], &'a Source>,
}

impl<'a> Modules<'a> {
    /// Modules declared outside of tests.
    fn new(sources: &'a [Source]) -> Self {
        let mut modules = Self {
            sources: BTreeMap::new(),
        };
        // A parent comes before its children, which it declares.
        let mut ordered: Vec<&Source> = sources.iter().collect();
        ordered.sort_by_key(|source| source.module.len());
        for source in ordered {
            let declared = match source.module.split_last() {
                None => true,
                Some((name, parent)) => modules
                    .sources
                    .get(parent)
                    .is_some_and(|parent| parent.declares.contains(name)),
            };
            if declared {
                modules.sources.insert(&source.module, source);
            }
        }
        modules
    }

    /// Returns the modules along `path` as written in the module `from`, following re-exports to the module that
    /// defines the item; the last one is the module itself if the path names a module. `None` for a path out of the
    /// crate.
    fn follow(&self, from: &[String], path: &[String], steps: usize) -> Option<Walk> {
        let mut here = from.to_vec();
        let mut walk = Walk {
            through: Vec::new(),
            module: None,
        };
        let mut rest = path;
        loop {
            match rest.first().map(String::as_str) {
                Some("crate") => here.clear(),
                Some("super") => {
                    here.pop();
                }
                Some("self") => {}
                _ => break,
            }
            rest = &rest[1..];
        }
        let is_relative = rest.len() == path.len();
        for (position, name) in rest.iter().enumerate() {
            let Some(next) = self.name_in(&here, name, position + 1 == rest.len(), steps) else {
                // The item is defined here, or the first name belongs to the language or to another crate.
                return (!is_relative || position > 0).then_some(walk);
            };
            walk.through.extend(next.through);
            let Some(module) = next.module else {
                return Some(walk);
            };
            here = module;
        }
        walk.module = Some(here);
        Some(walk)
    }

    /// Resolves `name` in the module `here`: a child, or an import of a `use` declaration.
    fn name_in(&self, here: &[String], name: &str, is_last: bool, steps: usize) -> Option<Walk> {
        let source = self.sources.get(here)?;
        let mut child = here.to_vec();
        child.push(name.to_owned());
        let child = self.sources.contains_key(child.as_slice()).then_some(child);
        let mut named = source
            .imports
            .iter()
            .filter(|import| import.name.as_deref() == Some(name));
        // A module and a function may share a name: at the end of a path it is the function.
        let import = if child.is_some() && !is_last {
            None
        } else {
            named.next()
        };
        if let Some(import) = import
            && steps > 0
            && let Some(walk) = self.follow(here, &import.path, steps - 1)
        {
            return Some(walk);
        }
        if let Some(child) = child {
            return Some(Walk {
                through: vec![child.clone()],
                module: Some(child),
            });
        }
        if steps == 0 {
            return None;
        }
        source
            .imports
            .iter()
            .filter(|import| import.is_glob())
            .find_map(|import| {
                let target = self.follow(here, &import.path, steps - 1)?;
                let found = self.name_in(target.module.as_deref()?, name, is_last, steps - 1)?;
                Some(Walk {
                    through: [target.through, found.through].concat(),
                    module: found.module,
                })
            })
    }

    /// Returns the modules that an import in `source` uses.
    fn used(&self, source: &Source, import: &Import) -> Vec<Path> {
        let follow = |path: &[String]| self.follow(&source.module, path, LONGEST_CHAIN);
        let first = Some(&import.path[0]);
        let declared = source
            .imports
            .iter()
            .find(|other| other.name.as_ref() == first);
        // A path that begins with an imported item adds nothing to the import; one that begins with a module does.
        if let (None, Some(declared)) = (&import.name, declared)
            && (import.path.len() == 1
                || follow(&declared.path).is_none_or(|walk| walk.module.is_none()))
        {
            return Vec::new();
        }
        follow(&import.path).map_or_else(Vec::new, |walk| walk.through)
    }
}

/// The target of a path.
struct Walk {
    through: Vec<Path>,
    module: Option<Path>,
}

/// The uses among the children of a module: user, used module, and locations.
type Uses = BTreeMap<(String, String), BTreeSet<(String, usize, String)>>;

/// Returns the cycles among sibling modules of the crate `name`.
pub fn cycles(name: &str, sources: &[Source]) -> Vec<Cycle> {
    let modules = Modules::new(sources);
    let mut uses: BTreeMap<Path, Uses> = BTreeMap::new();
    for (user, source) in &modules.sources {
        for import in &source.imports {
            for used in modules.used(source, import) {
                let common = user.iter().zip(&used).take_while(|(a, b)| a == b).count();
                if common < user.len() && common < used.len() {
                    let pair = (user[common].clone(), used[common].clone());
                    let place = (source.file.clone(), import.line, import.path.join("::"));
                    uses.entry(user[..common].to_vec())
                        .or_default()
                        .entry(pair)
                        .or_default()
                        .insert(place);
                }
            }
        }
    }
    uses.iter()
        .flat_map(|(parent, uses)| {
            let parent = [&[name.to_owned()], parent.as_slice()].concat().join("::");
            components(uses).into_iter().map(move |modules| Cycle {
                parent: parent.clone(),
                imports: places(uses, &modules),
                modules,
            })
        })
        .collect()
}

fn places(uses: &Uses, modules: &BTreeSet<String>) -> Vec<(String, String, String)> {
    let inner = uses
        .iter()
        .filter(|((user, used), _)| modules.contains(user) && modules.contains(used));
    inner
        .flat_map(|((user, used), places)| {
            places.iter().map(move |(file, line, path)| {
                (user.clone(), used.clone(), format!("{file}:{line} {path}"))
            })
        })
        .collect()
}

/// Returns the strongly connected components of more than one module.
fn components(uses: &Uses) -> Vec<BTreeSet<String>> {
    let nodes: BTreeSet<&String> = uses.keys().map(|(user, _)| user).collect();
    let reached: BTreeMap<&String, BTreeSet<String>> = nodes
        .iter()
        .map(|&node| (node, reached_from(uses, node)))
        .collect();
    let mut found: Vec<BTreeSet<String>> = Vec::new();
    for node in nodes {
        let mutual = |other: &&String| reached.get(other).is_some_and(|back| back.contains(node));
        let component: BTreeSet<String> = reached[node].iter().filter(mutual).cloned().collect();
        if !component.is_empty() && !found.contains(&component) {
            found.push(component);
        }
    }
    found
}

fn reached_from(uses: &Uses, start: &str) -> BTreeSet<String> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start.to_owned()];
    while let Some(node) = open.pop() {
        for (_, used) in uses.keys().filter(|(user, _)| *user == node) {
            if reached.insert(used.clone()) {
                open.push(used.clone());
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the cycles of a crate given as names and texts of files, one line each.
    fn cycles_of(files: &[(&str, &str)]) -> Vec<String> {
        let sources: Vec<Source> = files
            .iter()
            .map(|(file, text)| Source::new(file, text))
            .collect();
        let line = |cycle: &Cycle| {
            format!(
                "{}: {}",
                cycle.parent,
                cycle.modules.iter().cloned().collect::<Vec<_>>().join(" ")
            )
        };
        cycles("x", &sources).iter().map(line).collect()
    }

    #[test]
    fn a_cycle_is_found_with_its_imports() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c; mod d;"),
            ("a.rs", "use crate::b::B;"),
            ("b.rs", "fn f() { super::c::g() }"),
            ("c.rs", "use super::a;"),
            ("d.rs", "use super::a;"),
        ];
        assert_eq!(cycles_of(&files), ["x: a b c"]);
        let sources: Vec<Source> = files
            .iter()
            .map(|(file, text)| Source::new(file, text))
            .collect();
        let text = cycles("x", &sources)[0].to_string();
        assert!(
            text.contains("b uses c\n        b.rs:1 super::c::g"),
            "{text}"
        );
    }

    #[test]
    fn a_re_export_is_followed() {
        let files = [
            ("lib.rs", "mod a; mod b; pub use b::C;"),
            ("a.rs", "use super::C;"),
            ("b/mod.rs", "mod c; pub use c::C;"),
            ("b/c.rs", "use crate::a::A;"),
        ];
        assert_eq!(cycles_of(&files), ["x: a b"]);
    }

    #[test]
    fn a_module_imported_by_name_and_a_glob_are_followed() {
        let named = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use super::b; fn f() { b::C }"),
            ("b.rs", "pub use super::c::C;"),
            ("c.rs", "use super::a::A;"),
        ];
        assert_eq!(cycles_of(&named), ["x: a b c"]);
        let glob = [
            ("lib.rs", "mod a; mod b; use b::B;"),
            ("a.rs", "use super::*; type C = B;"),
            ("b.rs", "use super::a::A;"),
        ];
        assert_eq!(cycles_of(&glob), ["x: a b"]);
    }

    #[test]
    fn parents_children_tests_and_comments_form_no_cycle() {
        let files = [
            ("lib.rs", "mod a; mod b; fn f() { a::f() }"),
            ("a/mod.rs", "mod c; mod d; pub use c::C; use crate::f;"),
            ("a/c.rs", "use super::f; use crate::b::B;"),
            ("a/d.rs", "use super::C;"),
            (
                "b.rs",
                "// use crate::a::C;\n#[cfg(test)]\nmod tests { use crate::a::C; }",
            ),
        ];
        assert!(cycles_of(&files).is_empty());
    }
}
