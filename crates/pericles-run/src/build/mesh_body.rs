//! A mesh with its points: sets, faces and cells in the numbering of a point cloud.

use pericles::space::{self, PointCloud};
use pericles_deck::{ALL, Depth};
use pericles_io::VtuCells;
use pericles_io::observers::CellMesh;
use pericles_mesh::{CellKind, MeshPoints, PointSet, RawMesh, SetKind};

/// A mesh with its points.
#[derive(Debug, Clone)]
pub struct MeshBody {
    /// The mesh, in the length unit of the file.
    pub mesh: RawMesh,
    /// The elements as points, in the order of the file.
    pub points: MeshPoints,
    /// The length unit of the file, m.
    pub unit: f64,
}

/// Returns the name of a mesh set in decks: its own, unless it is "all".
fn name_in_decks(name: &str) -> String {
    match name {
        ALL => format!("{ALL} (mesh)"),
        name => name.to_owned(),
    }
}

impl MeshBody {
    /// Returns the sets of the mesh in the numbering of a point cloud, or of a part of it.
    pub(super) fn sets<'a>(
        &'a self,
        cloud: &'a PointCloud,
    ) -> impl Iterator<Item = (String, space::PointSet)> + 'a {
        let place = self.places(cloud);
        self.points.sets.iter().map(move |set| {
            let points = renumbered(&set.points, &place);
            (name_in_decks(&set.name), points)
        })
    }

    /// Returns the points near the faces of a face set; `None` if the mesh has no such set.
    pub(super) fn near_faces(
        &self,
        cloud: &PointCloud,
        faces: &str,
        depth: Depth,
    ) -> Option<space::PointSet> {
        let distance = depth.length(self.points.mean_size());
        let faces = &self.face_set(faces)?.name;
        let near = self
            .points
            .near_faces(&self.mesh, self.unit, faces, distance)?;
        Some(renumbered(&near, &self.places(cloud)))
    }

    /// Returns the point of each element; none for elements whose points other processes own.
    fn places(&self, cloud: &PointCloud) -> Vec<Option<u32>> {
        let mut place = vec![None; self.points.len()];
        for i in 0..cloud.len() {
            // The points of further pieces follow.
            if let Some(place) = place.get_mut(cloud.user_number(i)) {
                *place = Some(i as u32);
            }
        }
        place
    }

    /// Returns the face set with this name in decks.
    pub(super) fn face_set(&self, name: &str) -> Option<&PointSet> {
        let mut sets = self.points.sets.iter();
        sets.find(|set| set.kind == SetKind::Faces && name_in_decks(&set.name) == name)
    }

    /// Returns for each point of a face set the area of its faces times their outward normals, m², and the total
    /// area; `None` if the mesh has no such set.
    pub(super) fn face_vectors(
        &self,
        cloud: &PointCloud,
        name: &str,
        points: &[u32],
    ) -> Option<(Vec<[f64; 3]>, f64)> {
        let set = self.face_set(name)?;
        let vectors =
            self.points
                .face_vectors(&self.mesh, self.unit, cloud.section(), &set.name)?;
        // Elements of a set are ascending.
        let of_point = |&i: &u32| {
            let element = cloud.user_number(i as usize) as u32;
            let place = set.points.binary_search(&element).ok()?;
            Some(vectors[place])
        };
        let vectors: Option<Vec<[f64; 3]>> = points.iter().map(of_point).collect();
        Some((vectors?, set.area?))
    }

    /// Returns the names of the face sets.
    pub(super) fn face_sets(&self) -> impl Iterator<Item = &str> {
        let faces = |set: &&PointSet| set.kind == SetKind::Faces;
        self.points.sets.iter().filter(faces).map(|set| &*set.name)
    }

    /// Returns the name of the group of a block number.
    pub(crate) fn block_name(&self, block: u32) -> Option<&str> {
        let mut groups = self.points.sets.iter();
        let mut groups = groups.by_ref().filter(|set| set.kind == SetKind::Elements);
        groups
            .nth((block as usize).checked_sub(1)?)
            .map(|set| &*set.name)
    }

    /// Returns the elements as cells for result files, in the order of the points.
    pub(crate) fn cells(&self) -> CellMesh {
        let mut cells = VtuCells::default();
        for &cell in &self.points.cells {
            let kind = match self.mesh.cells.kind(cell as usize) {
                CellKind::Point => 1,
                CellKind::Line => 3,
                CellKind::Triangle => 5,
                CellKind::Quadrilateral => 9,
                CellKind::Tetrahedron => 10,
                CellKind::Hexahedron => 12,
                CellKind::Wedge => 13,
                CellKind::Pyramid => 14,
            };
            cells.push(kind, self.mesh.cells.corners(cell as usize));
        }
        let nodes = &self.mesh.nodes;
        let along = |c: usize| nodes.iter().map(move |x| x[c] * self.unit);
        CellMesh {
            nodes: (0..3).flat_map(along).collect(),
            cells,
        }
    }

    /// Returns the block number of each element: the index of its first group, from 1; 0 without a group, 1 in a mesh
    /// without groups.
    pub(super) fn blocks(&self) -> Vec<u32> {
        let groups = self.points.sets.iter();
        let groups: Vec<_> = groups.filter(|set| set.kind == SetKind::Elements).collect();
        let mut blocks = vec![u32::from(groups.is_empty()); self.points.len()];
        for (place, group) in groups.iter().enumerate().rev() {
            for &point in &group.points {
                blocks[point as usize] = place as u32 + 1;
            }
        }
        blocks
    }
}

fn renumbered(elements: &[u32], place: &[Option<u32>]) -> space::PointSet {
    let own = elements.iter().filter_map(|&k| place[k as usize]);
    let mut points: space::PointSet = own.collect();
    points.sort_unstable();
    points
}
