//! Exodus II files (netCDF): element blocks, node sets, side sets and element sets.
//!
//! Unnamed blocks are called `block_ID`, sets `nodelist_ID`, `sideset_ID` and `elemset_ID`. Spheres are
//! points whose volume is the second attribute of their block (radius, volume) or the nodal variable
//! `Volume`.

use crate::cell::CellKind;
use crate::fault::Fault;
use crate::netcdf::{NetCdf, Variable};
use crate::raw::{Cells, FaceSet, NamedList, RawMesh};

/// Returns the cell type by the prefix of the type name and the number of nodes; `None` for unsupported types.
fn kind_of(name: &str, nodes: usize) -> Option<CellKind> {
    let name = name.to_ascii_uppercase();
    let begins = |words: &[&str]| words.iter().any(|word| name.starts_with(word));
    let kind = if begins(&["HEX"]) {
        CellKind::Hexahedron
    } else if begins(&["TET"]) {
        CellKind::Tetrahedron
    } else if begins(&["WED", "PRISM"]) {
        CellKind::Wedge
    } else if begins(&["PYR"]) {
        CellKind::Pyramid
    } else if begins(&["TRI"]) || (begins(&["SHELL"]) && matches!(nodes, 3 | 6 | 7)) {
        CellKind::Triangle
    } else if begins(&["QUAD", "SHELL"]) {
        CellKind::Quadrilateral
    } else if begins(&["BAR", "BEAM", "TRUSS", "EDGE", "ROD", "SPRING"]) {
        CellKind::Line
    } else if begins(&["SPHERE", "CIRCLE", "POINT", "PARTICLE"]) {
        CellKind::Point
    } else {
        return None;
    };
    (nodes >= kind.corners()).then_some(kind)
}

struct Reading<'a> {
    file: NetCdf<'a>,
    mesh: RawMesh,
    /// Cell of each element; `None` for elements that are not used.
    elements: Vec<Option<u32>>,
    is_plane: bool,
}

pub(super) fn parse(content: &[u8], memory: u64) -> Result<RawMesh, Fault> {
    let file = NetCdf::new(content, memory)?;
    if file.dimension("num_processors").is_some_and(|n| n > 1) {
        return Err(Fault::of_file(
            "the file is one part of a decomposed mesh; join the parts with epu first",
        ));
    }
    let mut reading = Reading {
        is_plane: file.dimension("num_dim") == Some(2),
        file,
        mesh: RawMesh::default(),
        elements: Vec::new(),
    };
    reading.nodes()?;
    reading.blocks()?;
    reading.node_sets()?;
    reading.element_sets()?;
    reading.side_sets()?;
    Ok(reading.mesh)
}

impl Reading<'_> {
    fn nodes(&mut self) -> Result<(), Fault> {
        let mut axes = Vec::new();
        if let Some(all) = self.file.variable("coord") {
            let values = self.file.real(all, 0)?;
            let nodes = usize::try_from(all.last_length()).unwrap_or(usize::MAX);
            axes.extend(values.chunks(nodes.max(1)).map(<[f64]>::to_vec));
        } else {
            for name in ["coordx", "coordy", "coordz"] {
                if let Some(variable) = self.file.variable(name) {
                    axes.push(self.file.real(variable, 0)?);
                }
            }
        }
        let count = axes.first().map_or(0, Vec::len);
        if axes.len() > 3 || axes.iter().any(|axis| axis.len() != count) {
            return Err(Fault::of_file(
                "the node coordinates are not 1 to 3 arrays of equal length",
            ));
        }
        self.mesh.nodes = (0..count)
            .map(|node| std::array::from_fn(|c| axes.get(c).map_or(0.0, |axis| axis[node])))
            .collect();
        Ok(())
    }

    /// Returns the names of blocks or sets: as in the file, or a word and the ID.
    fn names(
        &self,
        names: &str,
        identities: &str,
        word: &str,
        count: usize,
    ) -> Result<Vec<String>, Fault> {
        let given = match self.file.variable(names) {
            Some(variable) => self.file.texts(variable)?,
            None => Vec::new(),
        };
        let identities = match self.file.variable(identities) {
            Some(variable) => self.file.whole(variable, 0)?,
            None => Vec::new(),
        };
        let name = |k: usize| {
            let given = given.get(k).filter(|name| !name.is_empty());
            given.cloned().unwrap_or_else(|| match identities.get(k) {
                Some(identity) => format!("{word}_{identity}"),
                None => format!("{word}_{}", k + 1),
            })
        };
        Ok((0..count).map(name).collect())
    }

    /// Returns the number of blocks or sets; each one has a variable or is empty.
    fn count(&self, dimension: &str) -> Result<usize, Fault> {
        let count = self.file.dimension(dimension).unwrap_or(0);
        // Each has an ID of four bytes.
        let most = self.file.bytes() / 4;
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= most)
            .ok_or_else(|| {
                let bytes = self.file.bytes();
                Fault::of_file(format!(
                    "{dimension} is {count}, but the {bytes} bytes of the file hold at most {most}"
                ))
            })
    }

    fn blocks(&mut self) -> Result<(), Fault> {
        let count = self.count("num_el_blk")?;
        let names = self.names("eb_names", "eb_prop1", "block", count)?;
        let numbers = match self.file.variable("elem_num_map") {
            Some(variable) => self.file.whole(variable, 0)?,
            None => Vec::new(),
        };
        for (k, name) in (1..).zip(names) {
            // A block without elements has no variable.
            let Some(variable) = self.file.variable(&format!("connect{k}")) else {
                continue;
            };
            let begin = self.mesh.cells.len() as u32;
            let each = usize::try_from(variable.last_length()).unwrap_or(usize::MAX);
            let nodes = self.file.whole(variable, 0)?;
            let word = variable.attribute("elem_type").unwrap_or("without a type");
            let kind = kind_of(word, each);
            let word = word.to_owned();
            for element in nodes.chunks(each.max(1)) {
                let place = self.elements.len();
                let Some(kind) = kind else {
                    *self.mesh.left_out.entry(word.clone()).or_default() += 1;
                    self.elements.push(None);
                    continue;
                };
                let mut corners = [0; 8];
                let corners = &mut corners[..kind.corners()];
                for (corner, &node) in corners.iter_mut().zip(element) {
                    *corner = self.node(node, &name)?;
                }
                let number = numbers
                    .get(place)
                    .map_or(place as u64 + 1, |n| n.unsigned_abs());
                self.elements.push(Some(self.mesh.cells.len() as u32));
                self.mesh.cells.push_numbered(number, kind, corners);
            }
            let members: Vec<u32> = (begin..self.mesh.cells.len() as u32).collect();
            if kind == Some(CellKind::Point) {
                self.point_volumes(k, &members)?;
            }
            self.mesh.groups.push(NamedList { name, members });
        }
        Ok(())
    }

    /// Returns the index of a node, numbered from 1 in the file.
    fn node(&self, number: i64, set: &str) -> Result<u32, Fault> {
        let node = number
            .checked_sub(1)
            .and_then(|node| u32::try_from(node).ok());
        let node = node.filter(|&node| (node as usize) < self.mesh.nodes.len());
        node.ok_or_else(|| {
            Fault::of_file(format!(
                "{set:?} refers to node {number}; nodes are numbered 1 to {}",
                self.mesh.nodes.len()
            ))
        })
    }

    /// Returns the index of an element, numbered from 1 in the file.
    fn element(&self, number: i64, set: &str) -> Result<Option<u32>, Fault> {
        let element = number.checked_sub(1).and_then(|n| usize::try_from(n).ok());
        let element = element.and_then(|element| self.elements.get(element));
        element.copied().ok_or_else(|| {
            Fault::of_file(format!(
                "{set:?} refers to element {number}; elements are numbered 1 to {}",
                self.elements.len()
            ))
        })
    }

    /// Reads volumes of spheres: the attribute named volume, or the second attribute, or the nodal variable
    /// Volume.
    fn point_volumes(&mut self, block: usize, cells: &[u32]) -> Result<(), Fault> {
        let attributes = self.file.variable(&format!("attrib{block}"));
        let width = |v: &Variable| usize::try_from(v.last_length()).unwrap_or(1);
        if let Some(variable) = attributes.filter(|variable| width(variable) >= 2) {
            let names = match self.file.variable(&format!("attrib_name{block}")) {
                Some(names) => self.file.texts(names)?,
                None => Vec::new(),
            };
            let named = names.iter().position(|n| n.eq_ignore_ascii_case("volume"));
            let each = width(variable);
            let column = named.unwrap_or(1).min(each - 1);
            let values = self.file.real(variable, 0)?;
            let volumes = values.chunks(each).filter_map(|row| row.get(column));
            let pairs = cells.iter().copied().zip(volumes.copied());
            self.mesh.point_volumes.extend(pairs);
            return Ok(());
        }
        let names = match self.file.variable("name_nod_var") {
            Some(names) => self.file.texts(names)?,
            None => Vec::new(),
        };
        let place = names.iter().position(|n| n.eq_ignore_ascii_case("volume"));
        let variable = place.and_then(|p| self.file.variable(&format!("vals_nod_var{}", p + 1)));
        if let Some(variable) = variable.filter(|_| self.file.records() > 0) {
            let values = self.file.real(variable, 0)?;
            for &cell in cells {
                let node = self.mesh.cells.corners(cell as usize)[0] as usize;
                if let Some(&volume) = values.get(node) {
                    self.mesh.point_volumes.push((cell, volume));
                }
            }
        }
        Ok(())
    }

    fn node_sets(&mut self) -> Result<(), Fault> {
        let count = self.count("num_node_sets")?;
        let names = self.names("ns_names", "ns_prop1", "nodelist", count)?;
        for (k, name) in (1..).zip(names) {
            if let Some(variable) = self.file.variable(&format!("node_ns{k}")) {
                let nodes = self.file.whole(variable, 0)?;
                let members = nodes.iter().map(|&node| self.node(node, &name));
                let members = members.collect::<Result<Vec<u32>, Fault>>()?;
                self.mesh.node_sets.push(NamedList { name, members });
            }
        }
        Ok(())
    }

    fn element_sets(&mut self) -> Result<(), Fault> {
        let count = self.count("num_elem_sets")?;
        let names = self.names("els_names", "els_prop1", "elemset", count)?;
        for (k, name) in (1..).zip(names) {
            if let Some(variable) = self.file.variable(&format!("elem_els{k}")) {
                let mut members = Vec::new();
                for element in self.file.whole(variable, 0)? {
                    members.extend(self.element(element, &name)?);
                }
                self.mesh.groups.push(NamedList { name, members });
            }
        }
        Ok(())
    }

    fn side_sets(&mut self) -> Result<(), Fault> {
        let count = self.count("num_side_sets")?;
        let names = self.names("ss_names", "ss_prop1", "sideset", count)?;
        for (k, name) in (1..).zip(names) {
            let elements = self.file.variable(&format!("elem_ss{k}"));
            let sides = self.file.variable(&format!("side_ss{k}"));
            let Some((elements, sides)) = elements.zip(sides) else {
                continue;
            };
            let (elements, sides) = (self.file.whole(elements, 0)?, self.file.whole(sides, 0)?);
            let mut faces = Cells::default();
            for (&element, &side) in elements.iter().zip(&sides) {
                if let Some(cell) = self.element(element, &name)? {
                    self.side(cell, side, &name, &mut faces)?;
                }
            }
            self.mesh.face_sets.push(FaceSet { name, faces });
        }
        Ok(())
    }

    /// Adds a side of a cell. Shells in space have two faces, both the shell itself, followed by their edges.
    fn side(&self, cell: u32, side: i64, set: &str, faces: &mut Cells) -> Result<(), Fault> {
        let (kind, corners) = (
            self.mesh.cells.kind(cell as usize),
            self.mesh.cells.corners(cell as usize),
        );
        let is_shell = kind.dimension() == 2 && !self.is_plane;
        if is_shell && matches!(side, 1 | 2) {
            faces.push(kind, corners);
            return Ok(());
        }
        let first = if is_shell { 3 } else { 1 };
        let facet = side
            .checked_sub(first)
            .and_then(|n| usize::try_from(n).ok());
        match facet.and_then(|facet| kind.facets().get(facet)) {
            Some((kind, places)) => {
                let nodes: Vec<u32> = places.iter().map(|&place| corners[place]).collect();
                faces.push(*kind, &nodes);
                Ok(())
            }
            None => Err(Fault::of_file(format!(
                "{set:?} refers to side {side} of element {} ({kind}); its sides are numbered 1 to {}",
                self.mesh.cells.number(cell as usize),
                kind.facets().len() + first as usize - 1
            ))),
        }
    }
}
