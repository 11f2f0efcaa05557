//! Meshes with their points: sets, faces and cells in the numbering of a point cloud.

use pericles::space::{self, Point, PointCloud};
use pericles_deck::Depth;
use pericles_io::VtuCells;
use pericles_io::observers::CellMesh;
use pericles_mesh::{CellKind, MeshPoints, PointSet, RawMesh, SetKind};

use super::rotation::{Matrix, times};

/// The position of a mesh in a body of several pieces.
#[derive(Debug, Clone, Default)]
pub(super) struct Placement {
    /// Name of the piece; empty for the first one, whose sets have the names of the file.
    pub(super) piece: String,
    /// The user's number of its first point.
    pub(super) first: usize,
    /// Displacement, m.
    pub(super) origin: Point,
    /// Rotation about a point, after the displacement.
    pub(super) rotation: Option<(Matrix, Point)>,
}

impl Placement {
    /// Returns the place in the body of a place in the file, both in m.
    pub(super) fn moved(&self, x: Point) -> Point {
        let x = std::array::from_fn(|c| x[c] + self.origin[c]);
        match &self.rotation {
            None => x,
            Some((turn, centre)) => {
                let arm = times(turn, std::array::from_fn(|c| x[c] - centre[c]));
                std::array::from_fn(|c| centre[c] + arm[c])
            }
        }
    }
}

/// A mesh with its points.
#[derive(Debug, Clone)]
pub struct MeshBody {
    /// The mesh, in the length unit of the file.
    pub mesh: RawMesh,
    /// The elements as points, in the order of the file.
    pub points: MeshPoints,
    /// The length unit of the file, m.
    pub unit: f64,
    pub(super) placement: Placement,
}

/// The meshes of a body: of all its pieces that are meshes.
#[derive(Debug, Clone, Default)]
pub struct Meshes {
    /// The meshes, in the order of the pieces.
    pub all: Vec<MeshBody>,
}

impl Meshes {
    /// Returns the sets of all meshes in the numbering of a point cloud, or of a part of it.
    pub(super) fn sets<'a>(
        &'a self,
        cloud: &'a PointCloud,
    ) -> impl Iterator<Item = (String, space::PointSet)> + 'a {
        self.all.iter().flat_map(|mesh| mesh.sets(cloud))
    }

    /// Returns the points near the faces of a face set; `None` if no mesh has such a set.
    pub(super) fn near_faces(
        &self,
        cloud: &PointCloud,
        faces: &str,
        depth: Depth,
    ) -> Option<space::PointSet> {
        let mut meshes = self.all.iter();
        meshes.find_map(|mesh| mesh.near_faces(cloud, faces, depth))
    }

    /// Returns the face set with this name in decks, with its mesh.
    pub(super) fn face_set(&self, name: &str) -> Option<(&MeshBody, &PointSet)> {
        let mut meshes = self.all.iter();
        meshes.find_map(|mesh| Some((mesh, mesh.face_set(name)?)))
    }

    /// Returns the names of the face sets in decks.
    pub(super) fn face_sets(&self) -> impl Iterator<Item = String> {
        self.all.iter().flat_map(MeshBody::face_sets)
    }

    /// Returns the name in decks of the group of a block number of a piece.
    pub(crate) fn block_name(&self, piece: &str, block: u32) -> Option<String> {
        let mut meshes = self.all.iter();
        let mesh = meshes.find(|mesh| mesh.placement.piece == piece)?;
        Some(mesh.name_in_decks(mesh.block_name(block)?))
    }

    /// Returns the elements of all meshes as cells; `None` without a mesh.
    pub(crate) fn cells(&self) -> Option<CellMesh> {
        let mut cells = MeshCells::default();
        self.all.iter().for_each(|mesh| cells.add(mesh));
        (!self.all.is_empty()).then(|| cells.finish())
    }

    /// Returns the elements of all meshes as cells, and for each point of other pieces a cell with a node of its own;
    /// `None` without a mesh.
    pub(crate) fn cells_of_all(&self, cloud: &PointCloud) -> Option<CellMesh> {
        let mut places = vec![[0.0; 3]; cloud.len()];
        for i in 0..cloud.len() {
            places[cloud.user_number(i)] = cloud.point(i);
        }
        let mut cells = MeshCells::default();
        for mesh in &self.all {
            cells.add_points(&places[..mesh.placement.first]);
            cells.add(mesh);
        }
        cells.add_points(&places);
        (!self.all.is_empty()).then(|| cells.finish())
    }
}

/// Cells that are being collected, in the user's order of points.
#[derive(Default)]
struct MeshCells {
    nodes: Vec<Point>,
    cells: VtuCells,
    points: Vec<u32>,
}

impl MeshCells {
    fn add(&mut self, body: &MeshBody) {
        let start = self.nodes.len() as u32;
        let placed = |x: &Point| body.placement.moved(x.map(|x| x * body.unit));
        self.nodes.extend(body.mesh.nodes.iter().map(placed));
        for &cell in &body.points.cells {
            let kind = body.mesh.cells.kind(cell as usize).vtk();
            let corners = body.mesh.cells.corners(cell as usize).iter();
            let corners: Vec<u32> = corners.map(|corner| start + corner).collect();
            self.cells.push(kind, &corners);
        }
        let first = body.placement.first as u32;
        let numbers = first..first + body.points.len() as u32;
        self.points.extend(numbers);
    }

    /// Adds cells of the points up to the end of `places` that have none.
    fn add_points(&mut self, places: &[Point]) {
        let next = self.points.last().map_or(0, |last| *last as usize + 1);
        for (number, place) in places.iter().enumerate().skip(next) {
            self.cells
                .push(CellKind::Point.vtk(), &[self.nodes.len() as u32]);
            self.nodes.push(*place);
            self.points.push(number as u32);
        }
    }

    fn finish(self) -> CellMesh {
        let along = |c: usize| self.nodes.iter().map(move |x| x[c]);
        CellMesh {
            nodes: (0..3).flat_map(along).collect(),
            cells: self.cells,
            points: self.points,
        }
    }
}

impl MeshBody {
    /// Returns the name of a set of the mesh in decks: with the name of the piece in front, unless it is the first one.
    pub fn name_in_decks(&self, name: &str) -> String {
        match &*self.placement.piece {
            "" => name.to_owned(),
            piece => format!("{piece}/{name}"),
        }
    }

    /// Returns the name of the piece; `None` for the first one.
    pub fn piece(&self) -> Option<&str> {
        Some(&*self.placement.piece).filter(|piece| !piece.is_empty())
    }

    /// Returns the sets of the mesh in the numbering of a point cloud, or of a part of it.
    fn sets<'a>(
        &'a self,
        cloud: &'a PointCloud,
    ) -> impl Iterator<Item = (String, space::PointSet)> + 'a {
        let place = self.places(cloud);
        self.points.sets.iter().map(move |set| {
            let points = renumbered(&set.points, &place);
            (self.name_in_decks(&set.name), points)
        })
    }

    /// Returns the points near the faces of a face set; `None` if the mesh has no such set.
    fn near_faces(&self, cloud: &PointCloud, faces: &str, depth: Depth) -> Option<space::PointSet> {
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
            // Other points belong to other pieces.
            let element = cloud.user_number(i).checked_sub(self.placement.first);
            if let Some(place) = element.and_then(|element| place.get_mut(element)) {
                *place = Some(i as u32);
            }
        }
        place
    }

    /// Returns the face set with this name in decks.
    fn face_set(&self, name: &str) -> Option<&PointSet> {
        let mut sets = self.points.sets.iter();
        sets.find(|set| set.kind == SetKind::Faces && self.name_in_decks(&set.name) == name)
    }

    /// Returns for each point of a face set of this mesh the area of its faces times their outward normals, m², and the
    /// total area.
    pub(super) fn face_vectors(
        &self,
        cloud: &PointCloud,
        set: &PointSet,
        points: &[u32],
    ) -> Option<(Vec<[f64; 3]>, f64)> {
        let vectors =
            self.points
                .face_vectors(&self.mesh, self.unit, cloud.section(), &set.name)?;
        // Elements of a set are ascending.
        let of_point = |&i: &u32| {
            let element = cloud
                .user_number(i as usize)
                .checked_sub(self.placement.first)?;
            let place = set.points.binary_search(&(element as u32)).ok()?;
            Some(match &self.placement.rotation {
                None => vectors[place],
                Some((turn, _)) => times(turn, vectors[place]),
            })
        };
        let vectors: Option<Vec<[f64; 3]>> = points.iter().map(of_point).collect();
        Some((vectors?, set.area?))
    }

    /// Returns the names of the face sets in decks.
    fn face_sets(&self) -> impl Iterator<Item = String> {
        let faces = |set: &&PointSet| set.kind == SetKind::Faces;
        let sets = self.points.sets.iter().filter(faces);
        sets.map(|set| self.name_in_decks(&set.name))
    }

    /// Returns the name of the group of a block number.
    fn block_name(&self, block: u32) -> Option<&str> {
        let mut groups = self.points.sets.iter();
        let mut groups = groups.by_ref().filter(|set| set.kind == SetKind::Elements);
        groups
            .nth((block as usize).checked_sub(1)?)
            .map(|set| &*set.name)
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
