//! Points of bodies of several pieces.

use pericles::family::pairs_within;
use pericles::space::{GradedCloud, Lattice, ListedPoints, Point, PointCloud};
use pericles::units::quantity;
use pericles_deck::{BuildError, Fault, KeyPath, Piece, Solid, piece_path, shortened, spot};

use super::assembler::{Assembler, Warnings};
use super::mesh_body::{MeshBody, Meshes, Placement};
use super::points::BodyPoints;
use super::rejection::{at, at_path};
use super::resources::Resources;

/// Distance of points of different pieces, in mean cell sizes, below which the pieces overlap.
const CLOSEST: f64 = 0.5;

/// Tolerance of positions on a common lattice, in spacings.
const ALIGNED: f64 = 1e-6;

/// Largest number of lattice nodes per point; wider gaps between pieces need a list of points.
const NODES: f64 = 32.0;

/// The points of a piece at their positions.
struct Placed {
    cloud: PointCloud,
    meshes: Meshes,
    /// Displacement of the lattice; `None` after a rotation.
    moved: Option<Point>,
    positions: Vec<Point>,
}

impl Assembler<'_> {
    /// Creates the points of all pieces: on a common lattice if all gaps are whole cells, else as a list.
    pub(super) fn piece_points(
        &self,
        solid: &Solid,
        pieces: &[Piece],
        resources: &Resources<'_>,
    ) -> Result<BodyPoints, BuildError> {
        let mut placed = Vec::new();
        // Pieces are created whole: the body is divided when they are in place.
        let alone = Resources {
            comm: None,
            ..*resources
        };
        for (k, piece) in pieces.iter().enumerate() {
            let (body, path) = (KeyPath::from("body"), piece_path(k));
            let own = Solid {
                shape: piece.shape.clone(),
                ..solid.clone()
            };
            let found = Warnings::default();
            let assembler = Assembler {
                warnings: &found,
                ..*self
            };
            let made = assembler
                .points(&own, &alone)
                .map_err(|error| error.moved(&body, &path))?;
            let found = found.taken().into_iter();
            self.warnings
                .extend(found.map(|one| one.moved(&body, &path)));
            placed.push(place(piece, made));
        }
        let joined = match on_common_lattice(&placed, pieces)? {
            Some(cloud) => BodyPoints {
                cloud: GradedCloud::of_one_grid(cloud),
                meshes: Meshes::default(),
            },
            None => self.listed_pieces(solid, pieces, placed, resources)?,
        };
        reject_overlap(&joined.cloud.cloud, pieces)?;
        Ok(joined)
    }

    /// Creates a list of the points of all pieces.
    fn listed_pieces(
        &self,
        solid: &Solid,
        pieces: &[Piece],
        placed: Vec<Placed>,
        resources: &Resources<'_>,
    ) -> Result<BodyPoints, BuildError> {
        let mut listed = ListedPoints::default();
        let mut of_entry = Vec::new();
        let mut meshes = Meshes::default();
        for (k, piece) in placed.into_iter().enumerate() {
            let first = listed.positions.len();
            for i in piece.order() {
                listed.positions.push(piece.positions[i]);
                listed.volumes.push(piece.cloud.volumes()[i]);
                listed.blocks.push(piece.cloud.block(i));
                of_entry.push(k as u32);
            }
            meshes.all.extend(piece.meshes.all.into_iter().map(|mesh| {
                let placement = Placement {
                    piece: match k {
                        0 => String::new(),
                        k => pieces[k].name.clone(),
                    },
                    first,
                    ..mesh.placement
                };
                MeshBody { placement, ..mesh }
            }));
        }
        if let Some((a, b)) = listed.first_twins() {
            let at = listed.positions[a];
            return Err(overlap(
                [a, b].map(|entry| of_entry[entry]),
                at,
                0.0,
                pieces,
            ));
        }
        let section = solid.shape.section();
        let cloud = listed
            .cloud(solid.shape.dimension(), section)
            .map_err(|error| at("body", error))?;
        let of_point = (0..cloud.len()).map(|i| of_entry[cloud.user_number(i)]);
        let of_point = of_point.collect();
        let cloud = cloud
            .with_pieces(of_point)
            .map_err(|error| at("body.piece", error))?;
        self.check_listed(solid, &cloud, resources)?;
        Ok(BodyPoints {
            cloud: GradedCloud::of_one_grid(cloud),
            meshes,
        })
    }
}

impl Placed {
    /// Returns the points in the user's order.
    fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.cloud.len()).collect();
        order.sort_unstable_by_key(|&i| self.cloud.user_number(i));
        order
    }
}

/// Moves the points of a piece to their positions.
fn place(piece: &Piece, made: BodyPoints) -> Placed {
    let cloud = made.cloud.cloud;
    let mut placement = Placement {
        origin: piece.origin,
        ..Placement::default()
    };
    placement.rotation = piece.rotation.as_ref().map(|rotation| {
        let middle = || {
            let bounds = cloud.bounds();
            placement.moved(std::array::from_fn(|c| 0.5 * (bounds[0][c] + bounds[1][c])))
        };
        let centre = rotation.centre.unwrap_or_else(middle);
        (rotation.matrix(), centre)
    });
    let mut meshes = made.meshes;
    for mesh in &mut meshes.all {
        mesh.placement = placement.clone();
    }
    let all = 0..cloud.len();
    Placed {
        moved: piece.rotation.is_none().then_some(piece.origin),
        meshes,
        positions: all.map(|i| placement.moved(cloud.point(i))).collect(),
        cloud,
    }
}

/// Returns the points on a common lattice; `None` if they do not lie on one.
///
/// # Errors
/// Two pieces have a point at the same node.
fn on_common_lattice(
    placed: &[Placed],
    pieces: &[Piece],
) -> Result<Option<PointCloud>, BuildError> {
    let Some(parts) = nodes_of(placed) else {
        return Ok(None);
    };
    let first = &placed[0];
    let (dimension, section) = (first.cloud.dimension(), first.cloud.section());
    let all = || parts.nodes.iter().flatten();
    let low: [i64; 3] = std::array::from_fn(|c| all().map(|at| at[c]).min().unwrap_or(0));
    let high: [i64; 3] = std::array::from_fn(|c| all().map(|at| at[c]).max().unwrap_or(0));
    let shape: [usize; 3] = std::array::from_fn(|c| (high[c] - low[c] + 1) as usize);
    let wide = shape.iter().map(|&nodes| nodes as f64).product::<f64>();
    if wide > (NODES * all().count() as f64).min(f64::from(u32::MAX)) {
        return Ok(None);
    }
    let mut nodes: Vec<(u32, u32)> = Vec::new();
    for (k, of_piece) in parts.nodes.iter().enumerate() {
        for at in of_piece {
            let [x, y, z] = std::array::from_fn(|c| (at[c] - low[c]) as usize);
            nodes.push(((x + shape[0] * (y + shape[1] * z)) as u32, k as u32));
        }
    }
    nodes.sort_unstable();
    let origin = std::array::from_fn(|c| match c < dimension {
        true => parts.origin[c] + low[c] as f64 * parts.spacing[c],
        false => 0.0,
    });
    let lattice = Lattice {
        spacing: parts.spacing,
        shape,
        node: nodes.iter().map(|&(node, _)| node).collect(),
    };
    if let Some(two) = nodes.windows(2).find(|two| two[0].0 == two[1].0) {
        let cell = lattice.coordinates(two[0].0);
        let at = std::array::from_fn(|c| origin[c] + f64::from(cell[c]) * parts.spacing[c]);
        return Err(overlap([two[0].1, two[1].1], at, 0.0, pieces));
    }
    let of_point = nodes.iter().map(|&(_, piece)| piece).collect();
    PointCloud::on_lattice(dimension, origin, lattice, section)
        .and_then(|cloud| cloud.with_pieces(of_point))
        .map(Some)
        .map_err(|error| at("body", error))
}

/// Lattice nodes of pieces, counted from a common origin.
struct Nodes {
    origin: Point,
    spacing: Point,
    nodes: Vec<Vec<[i64; 3]>>,
}

/// Returns the nodes of all pieces on the lattice of the first one, if they have one.
fn nodes_of(placed: &[Placed]) -> Option<Nodes> {
    let first = &placed[0];
    let dimension = first.cloud.dimension();
    let spacing = first.cloud.lattice()?.spacing;
    let corner = |piece: &Placed| -> Option<Point> {
        let (lattice, moved) = (piece.cloud.lattice()?, piece.moved?);
        let cell = lattice.coordinates(*lattice.node.first()?);
        let at = piece.cloud.point(0);
        Some(std::array::from_fn(|c| {
            at[c] + moved[c] - f64::from(cell[c]) * spacing[c]
        }))
    };
    let origin = corner(first)?;
    let mut nodes = Vec::new();
    for piece in placed {
        let (lattice, from) = (piece.cloud.lattice()?, corner(piece)?);
        let mut steps = [0i64; 3];
        for c in 0..dimension {
            if (lattice.spacing[c] / spacing[c] - 1.0).abs() > 1e-12 {
                return None;
            }
            let gap = (from[c] - origin[c]) / spacing[c];
            if (gap - gap.round()).abs() > ALIGNED || gap.abs() > 1e9 {
                return None;
            }
            steps[c] = gap.round() as i64;
        }
        let at = |&node: &u32| {
            let cell = lattice.coordinates(node);
            std::array::from_fn(|c| i64::from(cell[c]) + steps[c])
        };
        nodes.push(lattice.node.iter().map(at).collect());
    }
    Some(Nodes {
        origin,
        spacing,
        nodes,
    })
}

/// Rejects pieces that overlap: points of different pieces closer than half of their mean cell size.
fn reject_overlap(cloud: &PointCloud, pieces: &[Piece]) -> Result<(), BuildError> {
    let sizes = (0..cloud.len()).map(|i| cloud.cell_size(i));
    let reach = CLOSEST * sizes.fold(0.0, f64::max);
    let (start, near) = pairs_within(cloud, reach);
    for i in 0..cloud.len() {
        for &j in &near[start[i]..start[i + 1]] {
            let j = j as usize;
            let (a, b) = (cloud.point(i), cloud.point(j));
            let distance = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt();
            let mean = 0.5 * (cloud.cell_size(i) + cloud.cell_size(j));
            if cloud.piece(i) != cloud.piece(j) && distance < CLOSEST * mean {
                let two = [cloud.piece(i), cloud.piece(j)];
                return Err(overlap(two, a, distance, pieces));
            }
        }
    }
    Ok(())
}

/// Creates the error for two pieces with points that are too close, at the later piece.
fn overlap(two: [u32; 2], place: Point, distance: f64, pieces: &[Piece]) -> BuildError {
    let [a, b] = [two[0].min(two[1]), two[0].max(two[1])].map(|piece| piece as usize);
    let dimension = pieces[a].shape.dimension();
    let fault = Fault::other(
        "overlap",
        format!(
            "the pieces `{}` and `{}` overlap: near {} two of their points are {} apart, less than half of a cell",
            shortened(&pieces[a].name),
            shortened(&pieces[b].name),
            spot(&place[..dimension]),
            quantity(distance, "m")
        ),
        "move one of them: points of different pieces must be at least half of a cell apart; points one cell apart touch",
    );
    at_path(piece_path(b), fault)
}
