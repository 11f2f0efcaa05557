//! Assembly of the mesh from the model and its instances.

use std::collections::HashMap;

use super::resolve::{Placed, Resolver, undefined};
use super::scope::{FaceLabel, Instance, Model, Position, Scope};
use super::types::facet_of;
use crate::cell::CellKind;
use crate::fault::Fault;
use crate::raw::{Cells, FaceSet, NamedList, RawMesh};
use crate::scan::Numbering;

impl Model {
    /// Returns the mesh of the model and all instances, or of all parts if there are no instances.
    pub(super) fn assemble(mut self) -> Result<RawMesh, Fault> {
        let mut mesh = RawMesh {
            left_out: std::mem::take(&mut self.left_out),
            ..RawMesh::default()
        };
        let files = std::mem::take(&mut self.files);
        let mut scopes = vec![(None, String::new(), std::mem::take(&mut self.root))];
        let several = self.instances.len().max(self.parts.len()) > 1;
        let prefix = |shown: &str, count: usize| match count > 1 {
            true => format!("{shown}."),
            false => String::new(),
        };
        if self.instances.is_empty() && several {
            for (name, shown, scope) in self.parts {
                scopes.push((Some(name), prefix(&shown, 2), scope));
            }
        } else if self.instances.is_empty() {
            let parts = self.parts.into_iter();
            scopes.extend(parts.map(|(name, _, scope)| (Some(name), String::new(), scope)));
        } else {
            let count = self.instances.len();
            for instance in std::mem::take(&mut self.instances) {
                let (name, shown) = (instance.name.clone(), instance.shown.clone());
                scopes.push((Some(name), prefix(&shown, count), self.copy(instance)?));
            }
        }
        // Element numbers are taken from the file if they are unique.
        let with_elements = scopes.iter().filter(|s| !s.2.elements.kinds.is_empty());
        let own_numbers = with_elements.count() <= 1;
        let mut placed = Vec::new();
        for (name, prefix, scope) in scopes {
            let place = place(&mut mesh, scope, own_numbers, &files)?;
            placed.push(Placed {
                name,
                prefix,
                ..place
            });
        }
        let cells = std::mem::take(&mut mesh.cells);
        add_sets(&mut mesh, &placed, &cells)?;
        mesh.cells = cells;
        Ok(mesh)
    }

    /// Returns a translated and rotated copy of the part of an instance and the instance's own content.
    fn copy(&self, instance: Instance) -> Result<Scope, Fault> {
        let named = instance.part.as_ref();
        let part = self.parts.iter().find(|(name, ..)| Some(name) == named);
        let mut scope = match part {
            Some((_, _, part)) => part.clone(),
            // The instance has its own mesh.
            None if !instance.scope.nodes.is_empty() => Scope::default(),
            None => {
                return Err(Fault::of_file(format!(
                    "the instance {:?} has no mesh, and its part is not defined",
                    instance.shown
                )));
            }
        };
        scope.replace(&instance.scope);
        scope.append(instance.scope);
        for (_, x, _) in &mut scope.nodes {
            for (x, t) in x.iter_mut().zip(instance.translation) {
                *x += t;
            }
            if let Some((a, b, angle)) = instance.rotation {
                *x = rotated(*x, a, b, angle);
            }
        }
        Ok(scope)
    }
}

/// Rotates a point about the axis from a to b by an angle in degrees (Rodrigues' formula).
fn rotated(x: [f64; 3], a: [f64; 3], b: [f64; 3], angle: f64) -> [f64; 3] {
    let axis: [f64; 3] = std::array::from_fn(|c| b[c] - a[c]);
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return x;
    }
    let n = axis.map(|x| x / length);
    let r: [f64; 3] = std::array::from_fn(|c| x[c] - a[c]);
    let (sin, cos) = angle.to_radians().sin_cos();
    let along = (0..3).map(|c| n[c] * r[c]).sum::<f64>();
    std::array::from_fn(|c| {
        let (d, e) = ((c + 1) % 3, (c + 2) % 3);
        let across = n[d] * r[e] - n[e] * r[d];
        a[c] + r[c] * cos + across * sin + n[c] * along * (1.0 - cos)
    })
}

fn fault_at(position: Position, files: &[String], reason: String) -> Fault {
    let included = (position.file as usize).checked_sub(1);
    Fault {
        included: included.and_then(|file| files.get(file).cloned()),
        ..Fault::at_line(position.line as usize, reason)
    }
}

/// Adds the nodes and elements of a scope to the mesh.
fn place(
    mesh: &mut RawMesh,
    scope: Scope,
    own_numbers: bool,
    files: &[String],
) -> Result<Placed, Fault> {
    let (mut nodes, mut elements) = (Numbering::default(), Numbering::default());
    for &(number, x, position) in &scope.nodes {
        if !nodes.insert(number, mesh.nodes.len() as u32) {
            let reason = format!("node {number} is defined twice");
            return Err(fault_at(position, files, reason));
        }
        mesh.nodes.push(x);
    }
    let mut corners = scope.elements.corners.iter();
    let mut cell = Vec::new();
    for (place, &kind) in scope.elements.kinds.iter().enumerate() {
        let (number, position) = (
            scope.elements.numbers[place],
            scope.elements.positions[place],
        );
        cell.clear();
        for &corner in corners.by_ref().take(kind.corners()) {
            cell.push(nodes.get(corner).ok_or_else(|| {
                let reason =
                    format!("element {number} refers to node {corner}, which is not defined");
                fault_at(position, files, reason)
            })?);
        }
        let next = mesh.cells.len() as u32;
        if !elements.insert(number, next) {
            let reason = format!("element {number} is defined twice");
            return Err(fault_at(position, files, reason));
        }
        match own_numbers {
            true => mesh.cells.push_numbered(number.unsigned_abs(), kind, &cell),
            false => mesh.cells.push(kind, &cell),
        }
    }
    Ok(Placed {
        name: None,
        prefix: String::new(),
        scope,
        nodes,
        elements,
    })
}

/// Adds the sets and surfaces of all scopes.
fn add_sets(mesh: &mut RawMesh, placed: &[Placed], cells: &Cells) -> Result<(), Fault> {
    let mut resolver = Resolver::new(placed, cells);
    for (scope, place) in placed.iter().enumerate() {
        for of_nodes in [false, true] {
            let sets = match of_nodes {
                true => &place.scope.node_sets,
                false => &place.scope.element_sets,
            };
            for (number, set) in sets.iter().enumerate() {
                let members = resolver.set((scope, of_nodes, number), 0)?;
                if set.is_internal || members.is_empty() {
                    continue;
                }
                let list = NamedList {
                    name: format!("{}{}", place.prefix, set.shown),
                    members,
                };
                match of_nodes {
                    true => mesh.node_sets.push(list),
                    false => mesh.groups.push(list),
                }
            }
        }
    }
    for (scope, place) in placed.iter().enumerate() {
        for surface in &place.scope.surfaces {
            let mut faces = Cells::default();
            for (member, label) in &surface.faces {
                let cells = resolver.member(scope, false, member, 0)?;
                let Some(cells) = cells else {
                    return Err(undefined("surface", &surface.shown, member));
                };
                add_faces(resolver.cells, &cells, *label, &mut faces)?;
            }
            if !faces.is_empty() {
                let name = format!("{}{}", place.prefix, surface.shown);
                mesh.face_sets.push(FaceSet { name, faces });
            }
        }
    }
    Ok(())
}

fn add_faces(
    cells: &Cells,
    members: &[u32],
    label: FaceLabel,
    faces: &mut Cells,
) -> Result<(), Fault> {
    let face = |cell: u32, facet: usize| {
        let corners = cells.corners(cell as usize);
        let (kind, places) = cells.kind(cell as usize).facets()[facet];
        let nodes: Vec<u32> = places.iter().map(|&place| corners[place]).collect();
        (kind, nodes)
    };
    if label == FaceLabel::Free {
        // Faces shared by two elements of the mesh are interior.
        let all = (0..cells.len() as u32).filter(|&cell| {
            let dimension = cells.kind(cell as usize).dimension();
            Some(dimension) == cells.dimension()
        });
        let mut owners: HashMap<(CellKind, Vec<u32>), usize> = HashMap::new();
        for cell in all {
            for facet in 0..cells.kind(cell as usize).facets().len() {
                let (kind, mut nodes) = face(cell, facet);
                nodes.sort_unstable();
                *owners.entry((kind, nodes)).or_default() += 1;
            }
        }
        for &cell in members {
            for facet in 0..cells.kind(cell as usize).facets().len() {
                let (kind, nodes) = face(cell, facet);
                let mut sorted = nodes.clone();
                sorted.sort_unstable();
                if owners.get(&(kind, sorted)) == Some(&1) {
                    faces.push(kind, &nodes);
                }
            }
        }
        return Ok(());
    }
    for &cell in members {
        let kind = cells.kind(cell as usize);
        match label {
            FaceLabel::Number(number) => {
                let Some(facet) = facet_of(kind, number) else {
                    let number_in_file = cells.number(cell as usize);
                    return Err(Fault::of_file(format!(
                        "a surface refers to face S{number} of element {number_in_file} ({kind}), which has only {} faces",
                        kind.facets().len()
                    )));
                };
                let (kind, nodes) = face(cell, facet);
                faces.push(kind, &nodes);
            }
            _ => faces.push(kind, cells.corners(cell as usize)),
        }
    }
    Ok(())
}
