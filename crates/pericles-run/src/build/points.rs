//! Points of a body: on a grid, or listed in a file.

use pericles::PericlesError;
use pericles::family::{VolumeCorrection, pairs_within};
use pericles::space::{
    GradedCloud, GradedGrid, Grid, ListedPoints, PointCloud, PointSource, Shape, gauss_bar,
    idle_holes, rectangular_body,
};
use pericles::units::quantity;
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, Keys, Lattice, ModelWarning, PointsFile, Positions,
    Quadrature, Remark, Solid, SolidShape,
};

use super::assembler::Assembler;
use super::mesh_body::Meshes;
use super::random::{Space, nodes_of};
use super::rejection::{at, at_path, refined_key};
use super::resources::Resources;

/// The points of a body, and the meshes whose elements they are.
pub(super) struct BodyPoints {
    pub(super) cloud: GradedCloud,
    pub(super) meshes: Meshes,
}

/// Returns whether the points of a grid are the centres of equal cells, so that a process can create its own ones only.
pub(super) fn has_equal_cells(lattice: &Lattice) -> bool {
    let is_regular =
        lattice.periodic || lattice.finer.is_empty() && !lattice.positions.are_random();
    lattice.rectangular.is_some() || lattice.quadrature != Quadrature::Gauss && is_regular
}

impl Assembler<'_> {
    pub(super) fn points(
        &self,
        solid: &Solid,
        resources: &Resources<'_>,
    ) -> Result<BodyPoints, BuildError> {
        let mut meshes = Meshes::default();
        let cloud = match &solid.shape {
            SolidShape::Pieces(pieces) => {
                return self.piece_points(solid, pieces, resources);
            }
            SolidShape::Points(file) => self
                .listed_points(solid, file, resources)
                .map(GradedCloud::of_one_grid),
            SolidShape::Lattice(lattice) => self.grid_points(solid, lattice, resources),
            SolidShape::Filled(shape) => self.filled_points(solid, shape, resources),
            SolidShape::Mesh(file) => {
                let made = self.mesh_points(solid, file, resources);
                made.map(|(cloud, body)| {
                    meshes.all.push(body);
                    GradedCloud::of_one_grid(cloud)
                })
            }
        }?;
        /// Atomic spacing in crystals, m.
        const ATOMS: f64 = 1e-10;
        let spacing = cloud.cloud.spacing();
        if spacing < ATOMS {
            self.warn("body.spacing", Caution::TinySpacing { spacing });
        }
        Ok(BodyPoints { cloud, meshes })
    }

    fn listed_points(
        &self,
        solid: &Solid,
        file: &PointsFile,
        resources: &Resources<'_>,
    ) -> Result<PointCloud, BuildError> {
        /// Larger factors between volumes and spacing indicate a wrong unit.
        const OFF: f64 = 2.0;
        let path = resources.beside(&file.path);
        let listed = (resources.read_points)(&path, file.dimension, resources.memory);
        let mut listed = listed.map_err(|error| {
            let fault = error.fault(|reason| {
                Fault::other(
                    "invalid",
                    reason,
                    "expected: one line `x y z block volume` per point, in `unit` (default: m) and its third power; a relative path starts at the deck's folder",
                )
            });
            at_path("body.file", fault)
        })?;
        let unit = file.unit.unwrap_or(1.0);
        for place in &mut listed.positions {
            *place = place.map(|x| x * unit);
        }
        for volume in &mut listed.volumes {
            *volume *= unit.powi(3);
        }
        let cloud = listed
            .cloud(file.dimension, solid.shape.section())
            .map_err(|error| at("body.file", error))?;
        let found = cloud.spacing();
        // Without partial volumes the size of the cells has no influence.
        let is_used = solid.material.volume_correction() != VolumeCorrection::None;
        let is_far = |given: &f64| is_used && !(1.0 / OFF..=OFF).contains(&(found / given));
        let Some(given) = file.spacing.filter(is_far) else {
            self.check_listed(solid, &cloud, resources)?;
            self.warnings
                .extend(self.check_listed_points(&listed, &cloud));
            return Ok(cloud);
        };
        let section = ["area", "thickness"].get(file.dimension - 1);
        let section = section.map(|key| format!("; `{key}` is part of the volumes"));
        let fault = Fault::other(
            "different size",
            format!(
                "the volumes of the listed points correspond to a spacing of {}, but `spacing` is {}",
                quantity(found, "m"),
                quantity(given, "m")
            ),
            format!(
                "check `spacing`, and `unit`: coordinates are in this unit of length (default: m), volumes in its third power{}",
                section.unwrap_or_default()
            ),
        );
        Err(at_path("body.spacing", fault))
    }

    /// Warns of unused coordinates, and of points that are much closer to each other than the others.
    pub(super) fn check_listed_points(
        &self,
        listed: &ListedPoints,
        cloud: &PointCloud,
    ) -> Vec<ModelWarning> {
        /// Distance that leads to a warning, relative to the spacing.
        const CLOSE: f64 = 1e-3;
        let mut cautions = Vec::new();
        for c in cloud.dimension()..3 {
            let value = listed.positions[0][c];
            if value != 0.0 {
                let axis = ['x', 'y', 'z'][c];
                cautions.push(Caution::UnusedCoordinate { axis, value });
            }
        }
        let (start, near) = pairs_within(cloud, CLOSE * cloud.spacing());
        if let Some(&second) = near.first() {
            let first = start.partition_point(|&start| start == 0) - 1;
            let (a, b) = (cloud.point(first), cloud.point(second as usize));
            let square: f64 = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum();
            cautions.push(Caution::ClosePoints {
                points: [first, second as usize].map(|i| cloud.user_number(i) + 1),
                distance: square.sqrt(),
                spacing: cloud.spacing(),
            });
        }
        let cautions = cautions.into_iter();
        cautions
            .map(|caution| Remark::new("body.file", caution))
            .collect()
    }

    /// Warns of holes that remove no points.
    fn check_holes(&self, lattice: &Lattice, graded: &GradedGrid) -> Vec<ModelWarning> {
        let grid = &graded.grid;
        let idle = match (&grid.shape, &lattice.rectangular) {
            (Shape::Box { origin, size }, Some(spacing)) => {
                idle_holes(*origin, size, spacing, &grid.holes)
            }
            _ => graded.idle_holes(),
        };
        // Errors of the grid are reported when its points are created.
        let idle = idle.unwrap_or_default().into_iter();
        idle.map(|k| {
            let hole = KeyPath::from("body.hole").index(k);
            // The bore of a tube or ring is listed after the holes of the deck.
            Remark::new([hole, "body.inner_radius".into()], Caution::IdleHole)
        })
        .collect()
    }

    fn grid_points(
        &self,
        solid: &Solid,
        lattice: &Lattice,
        resources: &Resources<'_>,
    ) -> Result<GradedCloud, BuildError> {
        let graded = GradedGrid {
            grid: lattice.grid.clone(),
            finer: lattice.finer.clone(),
        };
        let gauss = lattice.quadrature == Quadrature::Gauss;
        self.check_grid(solid, &graded, if gauss { 2.0 } else { 1.0 }, resources)?;
        self.warnings.extend(self.check_holes(lattice, &graded));
        let grid = &graded.grid;
        let points = match (&grid.shape, lattice.quadrature) {
            _ if has_equal_cells(lattice) => self.lattice_points(lattice, resources),
            (Shape::Box { origin, size }, Quadrature::Gauss) => {
                gauss_bar(origin[0], size[0], grid.spacing, grid.section)
                    .map(GradedCloud::of_one_grid)
            }
            _ if lattice.positions.are_random() => {
                return self
                    .random_points(grid, lattice.positions)
                    .map(GradedCloud::of_one_grid)
                    .map_err(|error| self.no_grid(lattice, error));
            }
            _ => graded.points(),
        };
        points.map_err(|error| self.no_grid(lattice, error))
    }

    /// Creates the cells of a grid, of one of several processes its own ones only.
    fn lattice_points(
        &self,
        lattice: &Lattice,
        resources: &Resources<'_>,
    ) -> pericles::Result<GradedCloud> {
        let grid = &lattice.grid;
        let body = match (&grid.shape, &lattice.rectangular) {
            (Shape::Box { origin, size }, Some(spacing)) => {
                rectangular_body(*origin, size, spacing, grid.section, &grid.holes)
            }
            _ => grid.body(),
        }?;
        let body = match lattice.periodic {
            true => body.with_periodic_faces()?,
            false => body,
        };
        let cloud = match resources.several() {
            None => body.points(),
            Some(comm) => self.divided(&body, &body.points_where(&mut |_, _| false), comm)?,
        };
        Ok(GradedCloud::of_one_grid(cloud))
    }

    /// Creates random points in the shape of a grid.
    fn random_points(&self, grid: &Grid, positions: Positions) -> pericles::Result<PointCloud> {
        let dimension = grid.dimension();
        let inside = grid.inside()?;
        let space = Space {
            dimension,
            bounds: grid.bounds()?,
            spacing: grid.spacing,
            section: grid.section,
            inside: &inside,
        };
        let cloud = grid.points()?;
        let Some(nodes) = nodes_of(grid, &cloud) else {
            return Ok(cloud);
        };
        let listed = space.points(positions, || nodes);
        let listed = listed.map_err(|error| PericlesError::Extension(Box::new(error)))?;
        listed.cloud(dimension, grid.section)
    }

    /// Creates the error for a grid, at the key that causes it.
    fn no_grid(&self, lattice: &Lattice, error: PericlesError) -> BuildError {
        let place: Keys = match &error {
            PericlesError::NotWholeCells { length, .. } => self.side(lattice, *length),
            PericlesError::TooManyPoints { .. } => "body.spacing".into(),
            PericlesError::Unresolved { .. } => self.corner(lattice).into(),
            error => refined_key(error).unwrap_or("body".into()),
        };
        at_path(place, error.into())
    }

    /// Returns the key of the position of the body.
    fn corner(&self, lattice: &Lattice) -> &'static str {
        match lattice.grid.shape {
            Shape::Box { .. } => "body.origin",
            Shape::Disc { .. } | Shape::Ball { .. } => "body.centre",
            Shape::Cylinder { .. } => "body.base",
        }
    }

    /// Returns the keys that may give a side of this length.
    fn side(&self, lattice: &Lattice, length: f64) -> Keys {
        let size = KeyPath::from("body.size");
        match &lattice.grid.shape {
            Shape::Box { size: sides, .. } => match sides.iter().position(|side| *side == length) {
                Some(0) if sides.len() == 1 => ["body.length".into(), size.index(0)].into(),
                Some(axis) => size.index(axis).into(),
                None => size.into(),
            },
            Shape::Cylinder { height, .. } if *height == length => "body.height".into(),
            _ => size.into(),
        }
    }
}
