//! Lattices and random points in closed surfaces and outlines.

use pericles::space::{GradedCloud, Lattice as Nodes, ListedPoints, PointCloud};
use pericles_deck::{
    Boundary, BuildError, Caution, Fault, FilledCells, FilledShape, ModelWarning, Positions,
    Remark, Solid,
};
use pericles_mesh::fill::{FillError, Filled, Lattice, Outline, PartialCells, TriangleSurface};

use super::assembler::Assembler;
use super::enclosure::{Enclosure, Holes};
use super::random::Space;
use super::rejection::{at, at_path};
use super::resources::Resources;

impl Assembler<'_> {
    /// Creates the points in a closed surface or an outline.
    pub(super) fn filled_points(
        &self,
        solid: &Solid,
        shape: &FilledShape,
        resources: &Resources<'_>,
    ) -> Result<GradedCloud, BuildError> {
        let enclosure = self.enclosure(shape, resources)?;
        let bounds = enclosure.bounds();
        let (dimension, spacing) = (shape.dimension, shape.spacing);
        let cells: f64 = (0..dimension)
            .map(|c| ((bounds[1][c] - bounds[0][c]) / spacing).ceil().max(1.0))
            .product();
        let enclosed = enclosure.enclosed();
        let points = enclosed.map_or(cells, |volume| volume / spacing.powi(dimension as i32));
        self.check_filled(solid, points, cells, resources)?;
        let holes = Holes {
            regions: &shape.holes,
            bounds,
            tolerance: 1e-9 * spacing,
        };
        if shape.finer.is_empty() {
            let cloud = self.filled_cells(shape, &enclosure, &holes)?;
            return Ok(GradedCloud::of_one_grid(cloud));
        }
        let enclosed = enclosed.unwrap_or(cells * spacing.powi(dimension as i32));
        let filled = (&enclosure, &holes, enclosed);
        let graded = self.graded_cells(solid, shape, filled, resources)?;
        self.warnings.extend(check(
            shape,
            (graded.volume, enclosure.enclosed()),
            graded.was_turned,
        ));
        Ok(graded.cloud)
    }

    /// Creates the points in cells of one size, or at random positions.
    fn filled_cells(
        &self,
        shape: &FilledShape,
        enclosure: &Enclosure,
        holes: &Holes<'_>,
    ) -> Result<PointCloud, BuildError> {
        let (dimension, spacing) = (shape.dimension, shape.spacing);
        let rejected = |error| self.no_fill(shape, error);
        if shape.cells == FilledCells::Partial {
            let cells = enclosure.fill_partially(spacing).map_err(rejected)?;
            return partial_points(&cells, holes, shape.section)
                .cloud(dimension, shape.section)
                .map_err(|error| at("body.spacing", error));
        }
        let filled = match shape.positions {
            Positions::BlueNoise { .. } => None,
            _ => Some(enclosure.fill(spacing).map_err(rejected)?),
        };
        if let Some(filled) = &filled {
            let volumes = (filled.volume(), enclosure.enclosed());
            self.warnings
                .extend(check(shape, volumes, filled.was_turned()));
        }
        let nodes: Vec<[usize; 3]> = filled.iter().flat_map(Filled::nodes).collect();
        let lattice = filled.as_ref().map(|filled| *filled.lattice());
        let nodes: Vec<[usize; 3]> = match &lattice {
            Some(lattice) => {
                let solid = |node: &[usize; 3]| !holes.contain(lattice.position(*node));
                nodes.into_iter().filter(solid).collect()
            }
            None => nodes,
        };
        if let (Some(lattice), Positions::Lattice) = (&lattice, shape.positions) {
            return on_lattice(lattice, &nodes, dimension, shape)
                .map_err(|error| at("body.spacing", error));
        }
        let within = enclosure.inside();
        let space = Space {
            dimension,
            bounds: holes.bounds,
            spacing,
            section: shape.section,
            inside: &|x| within(x) && !holes.contain(x),
        };
        // Blue noise needs no lattice.
        let empty = Lattice {
            centre: [0.0; 3],
            spacing: [spacing; 3],
            counts: [0; 3],
        };
        let listed = space.points(shape.positions, || (lattice.unwrap_or(empty), nodes));
        listed
            .map_err(rejected)?
            .cloud(dimension, shape.section)
            .map_err(|error| at("body.spacing", error))
    }

    /// Reads the boundary.
    fn enclosure(
        &self,
        shape: &FilledShape,
        resources: &Resources<'_>,
    ) -> Result<Enclosure, BuildError> {
        let rejected = |error| self.no_fill(shape, error);
        match &shape.boundary {
            Boundary::File { path, unit, open } if shape.dimension == 3 => {
                let mesh = self.read_mesh("body.file", &resources.beside(path), resources)?;
                let surface = TriangleSurface::of_mesh(&mesh, *unit).map_err(rejected)?;
                let (surface, reversed) = surface.repaired();
                self.warnings.extend(reversed.map(|reversed| {
                    let problem = reversed.to_string();
                    Remark::new("body.file", Caution::Mesh { problem })
                }));
                Ok(match open {
                    true => Enclosure::Open(surface),
                    false => Enclosure::Surface(surface),
                })
            }
            Boundary::Polygons(polygons) => {
                let outline = Outline::new(polygons.clone()).map_err(rejected)?;
                Ok(Enclosure::Outline(outline))
            }
            Boundary::File { path, unit, .. } => {
                let path = resources.beside(path);
                let polygons = (resources.read_outline)(&path, resources.memory);
                let polygons = polygons.map_err(|error| {
                    let fault = error.fault(|reason| Fault::BadMesh { reason });
                    at_path("body.file", fault)
                })?;
                let in_metres = |polygon: Vec<[f64; 2]>| {
                    let corners = polygon.iter().map(|corner| corner.map(|x| x * unit));
                    corners.collect()
                };
                let polygons = polygons.into_iter().map(in_metres).collect();
                let outline = Outline::new(polygons).map_err(rejected)?;
                Ok(Enclosure::Outline(outline))
            }
        }
    }

    /// Creates the error for a boundary, at its key.
    pub(super) fn no_fill(&self, shape: &FilledShape, error: FillError) -> BuildError {
        let key = match (&error, &shape.boundary) {
            (FillError::Spacing { .. } | FillError::TooMany { .. }, _) => "body.spacing",
            (FillError::Amplitude { .. }, _) => "body.jitter",
            (_, Boundary::Polygons(_)) => "body.polygons",
            _ => "body.file",
        };
        let reason = match (&error, shape.boundary.file()) {
            (FillError::Open { .. }, Some(file)) => {
                format!("{}: {error} (open = true)", file.display())
            }
            (_, Some(file)) => format!("{}: {error}", file.display()),
            (_, None) => error.to_string(),
        };
        at_path(key, Fault::BadMesh { reason })
    }
}

/// Warns of surfaces with inward normals, and of cells whose total volume differs from the enclosed one.
fn check(
    shape: &FilledShape,
    (volume, enclosed): (f64, Option<f64>),
    was_turned: bool,
) -> Vec<ModelWarning> {
    /// Relative error of the volume that leads to a warning.
    const OFF: f64 = 0.02;
    let mut warnings = Vec::new();
    if was_turned {
        let problem = "all triangle normals point inwards; the orientation is reversed";
        let problem = problem.to_owned();
        warnings.push(Remark::new("body.file", Caution::Mesh { problem }));
    }
    if let Some(enclosed) = enclosed
        && (volume / enclosed - 1.0).abs() > OFF
    {
        let [volume, enclosed] = [volume, enclosed].map(|volume| volume * shape.section);
        let caution = Caution::FilledVolume { volume, enclosed };
        warnings.push(Remark::new("body.spacing", caution));
    }
    warnings
}

fn on_lattice(
    lattice: &Lattice,
    nodes: &[[usize; 3]],
    dimension: usize,
    shape: &FilledShape,
) -> pericles::Result<PointCloud> {
    let [nx, ny, _] = lattice.counts;
    let mut origin = lattice.position([0; 3]);
    origin[dimension..].fill(0.0);
    let node = |&[i, j, k]: &[usize; 3]| (i + nx * (j + ny * k)) as u32;
    let nodes = Nodes {
        spacing: [shape.spacing; 3],
        shape: lattice.counts,
        node: nodes.iter().map(node).collect(),
    };
    PointCloud::on_lattice(dimension, origin, nodes, shape.section)
}

/// Returns cells as points with their partial volumes, for an outline times the thickness `section`.
fn partial_points(cells: &PartialCells, holes: &Holes<'_>, section: f64) -> ListedPoints {
    let mut listed = ListedPoints::default();
    for (&cell, &part) in cells.cells.iter().zip(&cells.parts) {
        let place = cells.lattice.position(cell);
        if !holes.contain(place) {
            listed.positions.push(place);
            let volume = part * cells.lattice.cell_volume() * section;
            listed.volumes.push(volume);
            listed.blocks.push(1);
        }
    }
    listed
}
