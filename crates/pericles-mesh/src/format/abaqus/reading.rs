//! Line-by-line reading of the supported keywords.

use super::super::Include;
use super::keyword::{Keyword, Name, real, whole, words};
use super::members::{member, members, push_number};
use super::scope::{FaceLabel, Instance, Member, Model, Position, Scope, SurfaceDefinition};
use super::types::{ElementType, element_type};
use crate::fault::Fault;

/// Maximum depth of included files.
const DEPTH: usize = 8;

/// Maximum number of values of an element: 27 nodes of a hexahedron, and more than any type has.
const MOST_NUMBERS: usize = 64;

/// Keywords that generate nodes or elements.
const GENERATORS: [&str; 7] = [
    "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SUBMODEL",
];

/// Level of a keyword.
#[derive(Debug, Clone, Copy, Default)]
enum Level {
    #[default]
    Model,
    Part(usize),
    Instance(usize),
}

/// Meaning of data lines.
#[derive(Debug, Default)]
enum Section {
    #[default]
    Ignored,
    Nodes {
        set: Option<String>,
    },
    Elements {
        element: Option<ElementType>,
        name: String,
        set: Option<String>,
        /// Numbers of an element that continues in the next line, and the line of the first.
        pending: Vec<i64>,
        begin: u32,
    },
    Set {
        of_nodes: bool,
        name: String,
        instance: Option<Name>,
        generate: bool,
    },
    Surface,
    NodeSurface {
        name: String,
    },
    Placement {
        lines: usize,
    },
}

#[derive(Debug, Default)]
pub(super) struct Reading {
    pub(super) model: Model,
    level: Level,
    section: Section,
    /// The included file being read, from 1.
    file: u32,
    has_ended: bool,
}

impl Reading {
    /// Reads a file and the files it includes.
    pub(super) fn read(
        &mut self,
        content: &[u8],
        include: &Include<'_>,
        depth: usize,
    ) -> Result<(), Fault> {
        let mut lines = (1..).zip(content.split(|&byte| byte == b'\n'));
        while let Some((line, bytes)) = lines.next() {
            if self.has_ended {
                break;
            }
            let Ok(text) = std::str::from_utf8(bytes) else {
                if bytes.starts_with(b"*") || !matches!(self.section, Section::Ignored) {
                    return Err(Fault::at_line(line, "the line is not UTF-8 text"));
                }
                continue;
            };
            let text = text.trim();
            if text.is_empty() || text.starts_with("**") {
                continue;
            }
            let Some(keyword) = text.strip_prefix('*') else {
                self.data(text, line)?;
                continue;
            };
            let mut keyword = keyword.to_owned();
            while keyword.ends_with(',') {
                let Some((_, more)) = lines.next() else { break };
                let more = String::from_utf8_lossy(more);
                if !more.starts_with("**") {
                    keyword.push_str(more.trim());
                }
            }
            self.finish_section(line)?;
            let keyword = Keyword::of(&keyword);
            self.keyword(&keyword, line)?;
            let file = match keyword.key.as_str() {
                "INCLUDE" => Some(keyword.needed("INPUT", line)?),
                "NODE" | "ELEMENT" => keyword.value("INPUT"),
                _ => None,
            };
            if let Some(file) = file {
                let file = Name::of(file).1;
                self.include(&file, line, include, depth)?;
            }
        }
        self.finish_section(content.split(|&byte| byte == b'\n').count())
    }

    fn include(
        &mut self,
        name: &str,
        line: usize,
        include: &Include<'_>,
        depth: usize,
    ) -> Result<(), Fault> {
        if depth >= DEPTH {
            let reason =
                format!("{name} exceeds the include depth; allowed: at most {DEPTH} nested files");
            return Err(Fault::at_line(line, reason));
        }
        let content = include(name).map_err(|reason| Fault::at_line(line, reason))?;
        self.model.files.push(name.to_owned());
        let outer = std::mem::replace(&mut self.file, self.model.files.len() as u32);
        self.read(&content, include, depth + 1)
            .map_err(|fault| Fault {
                included: fault.included.or_else(|| Some(name.to_owned())),
                ..fault
            })?;
        self.file = outer;
        Ok(())
    }

    fn scope(&mut self) -> &mut Scope {
        match self.level {
            Level::Model => &mut self.model.root,
            Level::Part(part) => &mut self.model.parts[part].2,
            Level::Instance(instance) => &mut self.model.instances[instance].scope,
        }
    }

    fn keyword(&mut self, keyword: &Keyword, line: usize) -> Result<(), Fault> {
        let fault = |reason: String| Err(Fault::at_line(line, reason));
        let owned = |name: &str| keyword.value(name).map(str::to_owned);
        self.section = Section::Ignored;
        match keyword.key.as_str() {
            "STEP" => self.has_ended = true,
            "PART" => {
                let (name, shown) = Name::of(keyword.needed("NAME", line)?);
                self.level = Level::Part(self.model.parts.len());
                self.model.parts.push((name, shown, Scope::default()));
            }
            "INSTANCE" => self.begin_instance(keyword, line)?,
            "END PART" | "END INSTANCE" | "ASSEMBLY" | "END ASSEMBLY" => self.level = Level::Model,
            "NODE" => {
                if let Some(system) = keyword
                    .value("SYSTEM")
                    .filter(|s| !s.eq_ignore_ascii_case("R"))
                {
                    return fault(format!(
                        "the nodes are given in the coordinate system {system}; allowed: R (rectangular). Write the mesh in rectangular coordinates"
                    ));
                }
                let set = owned("NSET");
                if let Some(set) = &set {
                    self.scope().set(true, set);
                }
                self.section = Section::Nodes { set };
            }
            "ELEMENT" => {
                let name = keyword.needed("TYPE", line)?.to_ascii_uppercase();
                let set = owned("ELSET");
                if let Some(set) = &set {
                    // Also of elements that are left out.
                    self.scope().set(false, set);
                }
                self.section = Section::Elements {
                    element: element_type(&name),
                    name,
                    set,
                    pending: Vec::new(),
                    begin: 0,
                };
            }
            "NSET" | "ELSET" => self.begin_set(keyword, line)?,
            "SURFACE" => {
                let name = keyword.needed("NAME", line)?.to_owned();
                let kind = keyword.value("TYPE").unwrap_or("ELEMENT").to_uppercase();
                match kind.as_str() {
                    "ELEMENT" => {
                        let (_, shown) = Name::of(&name);
                        let faces = Vec::new();
                        let surface = SurfaceDefinition { shown, faces };
                        self.scope().surfaces.push(surface);
                        self.section = Section::Surface;
                    }
                    "NODE" => self.section = Section::NodeSurface { name },
                    // Analytical surfaces, sections and similar keywords.
                    _ => {}
                }
            }
            "SYSTEM" => {
                return fault(
                    "*SYSTEM gives the following nodes in a local coordinate system, which is not supported; write all nodes in global coordinates"
                        .into(),
                );
            }
            key if GENERATORS.contains(&key) => {
                return fault(format!(
                    "*{key} generates nodes or elements, which is not supported; write the complete mesh, for example from Abaqus/CAE"
                ));
            }
            _ => {}
        }
        Ok(())
    }

    fn begin_instance(&mut self, keyword: &Keyword, line: usize) -> Result<(), Fault> {
        if keyword.has("LIBRARY") {
            let reason = "instances from a library are not supported; allowed: instances of parts in this file";
            return Err(Fault::at_line(line, reason));
        }
        let (name, shown) = Name::of(keyword.needed("NAME", line)?);
        let part = keyword.value("PART").map(|part| Name::of(part).0);
        self.level = Level::Instance(self.model.instances.len());
        self.model.instances.push(Instance {
            name,
            shown,
            part,
            scope: Scope::default(),
            translation: [0.0; 3],
            rotation: None,
        });
        self.section = Section::Placement { lines: 0 };
        Ok(())
    }

    fn begin_set(&mut self, keyword: &Keyword, line: usize) -> Result<(), Fault> {
        let of_nodes = keyword.key == "NSET";
        let name = keyword.needed(&keyword.key, line)?.to_owned();
        let instance = keyword.value("INSTANCE").map(|word| Name::of(word).0);
        let set = self.scope().set(of_nodes, &name);
        set.is_internal |= keyword.has("INTERNAL");
        if let Some(elements) = keyword.value("ELSET").filter(|_| of_nodes) {
            let member = Member::NodesOf(Name::of(elements).0);
            set.members.push((instance.clone(), member));
        }
        self.section = Section::Set {
            of_nodes,
            name,
            instance,
            generate: keyword.has("GENERATE"),
        };
        Ok(())
    }

    fn data(&mut self, text: &str, line: usize) -> Result<(), Fault> {
        let position = Position {
            file: self.file,
            line: u32::try_from(line).unwrap_or(u32::MAX),
        };
        let mut section = std::mem::take(&mut self.section);
        let result = match &mut section {
            Section::Ignored => Ok(()),
            Section::Nodes { set } => self.node(text, position, set.as_deref()),
            Section::Elements { .. } => self.element_line(text, position, &mut section),
            Section::Set {
                of_nodes,
                name,
                instance,
                generate,
            } => {
                let members = members(text, line, *generate)?;
                let set = self.scope().set(*of_nodes, name);
                let members = members.into_iter().map(|m| (instance.clone(), m));
                set.members.extend(members);
                Ok(())
            }
            Section::Surface => self.surface_line(text, line),
            Section::NodeSurface { name } => {
                if let Some(word) = words(text).next() {
                    let member = member(word);
                    self.scope().set(true, name).members.push((None, member));
                }
                Ok(())
            }
            Section::Placement { lines } => {
                *lines += 1;
                let lines = *lines;
                self.placement(text, line, lines)
            }
        };
        self.section = section;
        result
    }

    fn node(&mut self, text: &str, position: Position, set: Option<&str>) -> Result<(), Fault> {
        let line = position.line as usize;
        let mut words = words(text);
        let number = whole(words.next().unwrap_or_default(), line)?;
        let mut x = [0.0; 3];
        for (x, word) in x.iter_mut().zip(words) {
            if !word.is_empty() {
                *x = real(word, line)?;
            }
        }
        let scope = self.scope();
        scope.nodes.push((number, x, position));
        if let Some(set) = set {
            let members = &mut scope.set(true, set).members;
            push_number(members, number);
        }
        Ok(())
    }

    /// Reads a line of an element, which continues until its nodes are complete, or while longer lines end
    /// with a comma.
    fn element_line(
        &mut self,
        text: &str,
        position: Position,
        section: &mut Section,
    ) -> Result<(), Fault> {
        let Section::Elements {
            element,
            name,
            set,
            pending,
            begin,
        } = section
        else {
            return Ok(());
        };
        let line = position.line as usize;
        let goes_on = text.ends_with(',');
        let Some(element) = *element else {
            // Marks an element of an unknown type that continues.
            let continues = std::mem::replace(begin, u32::from(goes_on)) == 1;
            if !continues {
                *self.model.left_out.entry(name.clone()).or_default() += 1;
            }
            return Ok(());
        };
        if pending.is_empty() {
            *begin = position.line;
        }
        for word in words(text) {
            pending.push(whole(word, line)?);
        }
        let needed = 1 + element.nodes;
        if pending.len() > MOST_NUMBERS {
            let reason = format!("the element has more than {} nodes", MOST_NUMBERS - 1);
            return Err(Fault::at_line(line, reason));
        }
        if pending.len() < needed || (pending.len() > needed && goes_on) {
            return Ok(());
        }
        let begin = Position {
            line: *begin,
            ..position
        };
        let corners = &pending[1..=element.kind.corners()];
        let scope = self.scope();
        scope.elements.kinds.push(element.kind);
        scope.elements.numbers.push(pending[0]);
        scope.elements.corners.extend_from_slice(corners);
        scope.elements.positions.push(begin);
        if let Some(set) = set {
            push_number(&mut scope.set(false, set).members, pending[0]);
        }
        pending.clear();
        Ok(())
    }

    /// Ends a section: an element must be complete.
    fn finish_section(&mut self, line: usize) -> Result<(), Fault> {
        if let Section::Elements {
            element: Some(element),
            pending,
            name,
            ..
        } = &self.section
            && !pending.is_empty()
            && pending.len() <= element.nodes
        {
            let (number, found, needed) = (pending[0], pending.len() - 1, element.nodes);
            let reason = format!("element {number} ({name}) has {found} nodes; expected {needed}");
            return Err(Fault::at_line(line, reason));
        }
        let section = std::mem::take(&mut self.section);
        if let Section::Elements { pending, .. } = section
            && let Some(&number) = pending.first()
        {
            let reason = format!("element {number} ends with a comma, but no line follows");
            return Err(Fault::at_line(line, reason));
        }
        Ok(())
    }

    fn surface_line(&mut self, text: &str, line: usize) -> Result<(), Fault> {
        let mut words = words(text);
        let region = words.next().unwrap_or_default();
        let label = words.next().unwrap_or_default().to_ascii_uppercase();
        let label = match label.as_str() {
            "" => FaceLabel::Free,
            "SPOS" | "SNEG" => FaceLabel::Itself,
            _ => {
                let number = label.strip_prefix(['S', 'E', 'P', 'F']).unwrap_or(&label);
                let number = number.parse().map_err(|_| {
                    let reason = format!("unknown face {label:?}; allowed: S1 to S6, SPOS, SNEG");
                    Fault::at_line(line, reason)
                })?;
                FaceLabel::Number(number)
            }
        };
        let member = match region {
            // A blank region is the whole body.
            "" => Member::Range(i64::MIN, i64::MAX, 1),
            region => member(region),
        };
        if let Some(surface) = self.scope().surfaces.last_mut() {
            surface.faces.push((member, label));
        }
        Ok(())
    }

    fn placement(&mut self, text: &str, line: usize, lines: usize) -> Result<(), Fault> {
        let numbers = words(text)
            .map(|word| {
                if word.is_empty() {
                    Ok(0.0)
                } else {
                    real(word, line)
                }
            })
            .collect::<Result<Vec<f64>, Fault>>()?;
        let Level::Instance(instance) = self.level else {
            return Ok(());
        };
        let instance = &mut self.model.instances[instance];
        match (lines, numbers.as_slice()) {
            (1, &[x]) => instance.translation = [x, 0.0, 0.0],
            (1, &[x, y]) => instance.translation = [x, y, 0.0],
            (1, &[x, y, z]) => instance.translation = [x, y, z],
            (2, &[ax, ay, az, bx, by, bz, angle]) => {
                instance.rotation = Some(([ax, ay, az], [bx, by, bz], angle));
            }
            _ => {
                let reason = format!(
                    "line {lines} of the instance placement has {} numbers; allowed: 3 for the translation, then 7 for the rotation",
                    numbers.len()
                );
                return Err(Fault::at_line(line, reason));
            }
        }
        Ok(())
    }
}
