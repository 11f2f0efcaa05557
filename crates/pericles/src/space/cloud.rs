//! Point clouds: the points of a body.

mod divided;

use super::set::{check_resolution, check_set};
use super::{Lattice, Point, Region};
use crate::domain::Domain;
use crate::error::{PericlesError, Result, positive};
use crate::units::BodyUnits;

/// Point numbers in ascending order, in the order of the cloud.
pub type PointSet = Vec<u32>;

/// The points of a body with their volumes, as structure of arrays.
///
/// Vectors on points (positions, displacements, forces …) are component-major: component c of point i is entry `c *
/// len() + i`. Points are stored in an order that suits memory (grid order); [`PointCloud::user_number`] returns
/// the number of a point in result files.
#[derive(Debug, Clone)]
pub struct PointCloud {
    dimension: usize,
    positions: Vec<f64>,
    volumes: Vec<f64>,
    /// Cross-section of a bar (m²) or thickness of a plate (m); 1 in 3D.
    section: f64,
    spacing: f64,
    lattice: Option<Lattice>,
    /// Sides of the cells, m, if all are equal boxes.
    cell_sides: Option<Point>,
    periodic: bool,
    /// User's numbers of the points; empty if they equal the point numbers.
    user_numbers: Vec<u32>,
    /// The block of each point; empty if all are in block 1.
    blocks: Vec<u32>,
    /// The piece of each point; empty if no point is in another piece than 0.
    pub(super) pieces: Vec<u32>,
    domain: Domain,
}

impl PointCloud {
    /// Makes a cloud from positions (m, component-major, `dimension * n` entries) and volumes (m³).
    ///
    /// `section` is the cross-section in 1D (m²), the thickness in 2D (m) and 1 in 3D, so that a cell of size Δx
    /// has the volume section · Δx^dimension. Volume corrections use the cell size of the mean volume.
    ///
    /// # Errors
    /// No points or too many; arrays of wrong length; volumes that are not positive; coordinates that are not
    /// finite, or so large that double precision does not resolve the spacing.
    pub fn new(
        dimension: usize,
        positions: Vec<f64>,
        volumes: Vec<f64>,
        section: f64,
    ) -> Result<Self> {
        Self::with_spacing(dimension, positions, volumes, section, None)
    }

    /// As [`PointCloud::new`], with a given spacing, or the spacing of the mean cell if `None`.
    fn with_spacing(
        dimension: usize,
        positions: Vec<f64>,
        volumes: Vec<f64>,
        section: f64,
        spacing: Option<f64>,
    ) -> Result<Self> {
        positive("the section (area in 1D, thickness in 2D)", section)?;
        let n = volumes.len();
        if n == 0 {
            return Err(PericlesError::EmptyBody);
        }
        if n > u32::MAX as usize - 1 {
            return Err(PericlesError::TooManyPoints {
                cells: n as f64,
                limit: u64::from(u32::MAX - 1),
            });
        }
        if !(1..=3).contains(&dimension) || positions.len() != dimension * n {
            return Err(PericlesError::WrongDimension {
                what: "an array of positions of this length",
                needed: "1, 2 or 3, with one number per point and axis",
                dimension,
            });
        }
        for &volume in &volumes {
            positive("the volume of a point", volume)?;
        }
        if let Some(entry) = positions.iter().position(|x| !x.is_finite()) {
            return Err(PericlesError::NotFinite {
                point: entry % n,
                value: positions[entry],
            });
        }
        let spacing = spacing.unwrap_or_else(|| {
            let mean = volumes.iter().sum::<f64>() / n as f64;
            (mean / section).powf(1.0 / dimension as f64)
        });
        check_resolution(&positions, spacing)?;
        Ok(Self {
            dimension,
            positions,
            volumes,
            section,
            spacing,
            lattice: None,
            cell_sides: None,
            periodic: false,
            user_numbers: Vec::new(),
            blocks: Vec::new(),
            pieces: Vec::new(),
            domain: Domain::alone(n),
        })
    }

    /// Makes opposite faces of the box of cells periodic.
    ///
    /// # Errors
    /// Points that are not a full box of cells.
    pub fn with_periodic_faces(self) -> Result<Self> {
        match &self.lattice {
            Some(lattice) if lattice.shape.iter().product::<usize>() == self.len() => Ok(Self {
                periodic: true,
                ..self
            }),
            _ => Err(PericlesError::NotPeriodic),
        }
    }

    /// Returns whether opposite faces of the whole body are periodic.
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// Points of a surface in 3D, with areas (m²) in place of volumes, so that densities are per area.
    ///
    /// `spacing` is a typical distance of neighbouring points, m; `user_numbers[i]` is the number of point i in
    /// files.
    ///
    /// # Errors
    /// Areas that are not positive, or not one per point.
    pub fn of_areas(
        positions: &[Point],
        areas: Vec<f64>,
        spacing: f64,
        user_numbers: &[u32],
    ) -> Result<Self> {
        let flat = (0..3)
            .flat_map(|c| positions.iter().map(move |position| position[c]))
            .collect();
        let mut cloud = Self::with_spacing(3, flat, areas, 1.0, Some(spacing))?;
        cloud.user_numbers = user_numbers.to_vec();
        Ok(cloud)
    }

    /// Points at nodes of a lattice with node (0, 0, 0) at `origin`, m, each with the volume of a cell; `section`
    /// as in [`PointCloud::new`].
    ///
    /// ```
    /// use pericles::space::{Lattice, PointCloud};
    /// // Three cells of a square of 2 × 2.
    /// let lattice = Lattice { spacing: [0.5; 3], shape: [2, 2, 1], node: vec![0, 1, 3] };
    /// let corner = PointCloud::on_lattice(2, [0.25, 0.25, 0.0], lattice, 2.0)?;
    /// assert_eq!((corner.point(2), corner.volumes()[2]), ([0.75, 0.75, 0.0], 0.5));
    /// # Ok::<(), pericles::PericlesError>(())
    /// ```
    ///
    /// # Errors
    /// No points; a spacing or section that is not positive; nodes not in ascending order or outside the lattice.
    pub fn on_lattice(
        dimension: usize,
        origin: Point,
        lattice: Lattice,
        section: f64,
    ) -> Result<Self> {
        positive("the section (area in 1D, thickness in 2D)", section)?;
        for dx in lattice.spacing {
            positive("the spacing", dx)?;
        }
        check_set("the nodes of a lattice", &lattice.node, lattice.nodes())?;
        let n = lattice.node.len();
        if n == 0 {
            return Err(PericlesError::EmptyBody);
        }
        let cloud = Self::at_nodes((dimension, origin), lattice, section, Domain::alone(n));
        check_resolution(&cloud.positions, cloud.spacing)?;
        Ok(cloud)
    }

    /// As [`PointCloud::on_lattice`] for any part of a body, which may be empty; its nodes and dimensions have been checked.
    pub(super) fn at_nodes(
        (dimension, origin): (usize, Point),
        lattice: Lattice,
        section: f64,
        domain: Domain,
    ) -> Self {
        let n = lattice.node.len();
        let mut positions = vec![0.0; dimension * n];
        for (i, &node) in lattice.node.iter().enumerate() {
            let place = lattice.position(dimension, origin, node);
            for c in 0..dimension {
                positions[c * n + i] = place[c];
            }
        }
        let volume = section
            * match lattice.is_cubic(dimension) {
                true => lattice.spacing[0].powi(dimension as i32),
                false => lattice.spacing[..dimension].iter().product(),
            };
        Self {
            dimension,
            positions,
            volumes: vec![volume; n],
            section,
            spacing: lattice.size(dimension),
            cell_sides: Some(lattice.spacing),
            lattice: Some(lattice),
            periodic: false,
            user_numbers: domain.own_numbers(),
            blocks: Vec::new(),
            pieces: Vec::new(),
            domain,
        }
    }

    /// Makes opposite faces of the whole body periodic, or not.
    pub(super) fn with_faces(self, periodic: bool) -> Self {
        Self { periodic, ..self }
    }

    /// A cloud of cells of several sizes; the spacing belongs to the largest cells.
    pub(super) fn graded(
        dimension: usize,
        positions: Vec<f64>,
        volumes: Vec<f64>,
        section: f64,
        spacing: f64,
    ) -> Result<Self> {
        Self::with_spacing(dimension, positions, volumes, section, Some(spacing))
    }

    /// Sets the user's numbers and blocks of a list of points.
    pub(super) fn listed(self, user_numbers: Vec<u32>, blocks: Vec<u32>) -> Self {
        Self {
            user_numbers,
            blocks,
            ..self
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.volumes.len()
    }

    /// Returns false: a cloud has at least one point.
    pub fn is_empty(&self) -> bool {
        self.volumes.is_empty()
    }

    /// The domain: how the body is divided among processes.
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Returns `count` points moved by whole numbers of periods (the sides of the lattice box), which `moved` returns with the number
    /// of the point; several may be images of one point. The nodes of their lattice are not ordered.
    pub(super) fn moved_points(
        &self,
        count: usize,
        moved: impl Fn(usize) -> ([i16; 3], usize),
    ) -> Self {
        let far: [i32; 3] = std::array::from_fn(|c| {
            let along = (0..count).map(|k| i32::from(moved(k).0[c]).abs());
            along.max().unwrap_or(0)
        });
        let lattice = self.lattice.as_ref().map(|lattice| {
            let sides = lattice.shape.map(|nodes| nodes as i32);
            let shape: [usize; 3] = std::array::from_fn(|c| ((2 * far[c] + 1) * sides[c]) as usize);
            let node = |k: usize| {
                let (shift, point) = moved(k);
                let at = lattice.coordinates(lattice.node[point]);
                let [x, y, z] = std::array::from_fn(|c| {
                    (at[c] + (i32::from(shift[c]) + far[c]) * sides[c]) as usize
                });
                (x + shape[0] * (y + shape[1] * z)) as u32
            };
            Lattice {
                spacing: lattice.spacing,
                shape,
                node: (0..count).map(node).collect(),
            }
        });
        let side = |c: usize| match &self.lattice {
            Some(lattice) => lattice.sides()[c],
            None => 0.0,
        };
        let n = self.len();
        let mut positions = Vec::with_capacity(self.dimension * count);
        for c in 0..self.dimension {
            let (axis, side) = (&self.positions[c * n..(c + 1) * n], side(c));
            positions.extend((0..count).map(|k| {
                let (shift, point) = moved(k);
                axis[point] + f64::from(shift[c]) * side
            }));
        }
        let points = (0..count).map(|k| moved(k).1);
        Self {
            pieces: match self.has_pieces() {
                true => points.clone().map(|i| self.piece(i)).collect(),
                false => Vec::new(),
            },
            positions,
            volumes: points.map(|i| self.volumes[i]).collect(),
            lattice,
            periodic: false,
            user_numbers: Vec::new(),
            blocks: Vec::new(),
            domain: Domain::alone(count),
            ..*self
        }
    }

    /// 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Reference positions, m, component-major.
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Coordinate c of all points, m.
    pub fn axis(&self, c: usize) -> &[f64] {
        let n = self.len();
        &self.positions[c * n..(c + 1) * n]
    }

    /// Reference position of a point, m; missing components are zero.
    pub fn point(&self, i: usize) -> Point {
        let mut point = [0.0; 3];
        for (c, x) in point.iter_mut().enumerate().take(self.dimension) {
            *x = self.positions[c * self.len() + i];
        }
        point
    }

    /// Volumes, m³.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// Cross-section of a bar (m²), thickness of a plate (m), 1 in 3D.
    pub fn section(&self) -> f64 {
        self.section
    }

    /// Returns the units of quantities of the whole body, which are given per unit of a unit section.
    pub fn body_units(&self) -> BodyUnits {
        BodyUnits::of(self.dimension, self.section)
    }

    /// Distance of neighbouring points, m: the spacing of the lattice, or else the size of the mean cell.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Size of the cell of a point, m: (V / section)^(1/dimension).
    pub fn cell_size(&self, i: usize) -> f64 {
        if self.lattice.is_some() {
            self.spacing
        } else {
            (self.volumes[i] / self.section).powf(1.0 / self.dimension as f64)
        }
    }

    /// Sides of the cells, m, one per dimension, if all cells are equal boxes side by side; `None` for listed
    /// points, quadrature nodes, surfaces and bodies with several cell sizes.
    pub fn cell_sides(&self) -> Option<&[f64]> {
        let sides = self.cell_sides.as_ref()?;
        Some(&sides[..self.dimension])
    }

    /// Side of a cell along an axis, m: exact for equal boxes, else the spacing.
    pub fn cell_side(&self, axis: usize) -> f64 {
        match &self.cell_sides {
            Some(sides) => sides[axis],
            None => self.spacing,
        }
    }

    /// The lattice, if the points are on one.
    pub fn lattice(&self) -> Option<&Lattice> {
        self.lattice.as_ref()
    }

    /// User's number of a point, which is used in files.
    pub fn user_number(&self, i: usize) -> usize {
        match &self.user_numbers[..] {
            [] => i,
            numbers => numbers[i] as usize,
        }
    }

    /// Block of a point; bodies on grids are block 1.
    pub fn block(&self, i: usize) -> u32 {
        self.blocks.get(i).copied().unwrap_or(1)
    }

    /// Bounding box of the cells, m: half a cell beyond the outermost points.
    pub fn bounds(&self) -> [Point; 2] {
        let mut bounds = [[0.0; 3]; 2];
        for c in 0..self.dimension {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (i, &x) in self.axis(c).iter().enumerate() {
                let side = self.cell_sides.map(|sides| sides[c]);
                let half = 0.5 * side.unwrap_or_else(|| self.cell_size(i));
                low = low.min(x - half);
                high = high.max(x + half);
            }
            (bounds[0][c], bounds[1][c]) = (low, high);
        }
        bounds
    }

    /// Returns the own points in a region; parts of a region may be given by the bounding box of the whole body. All processes must
    /// call it together.
    pub fn select(&self, region: &Region) -> PointSet {
        let bounds = self.body_bounds();
        let tolerance = 1e-9 * self.spacing;
        (0..self.len())
            .filter(|&i| region.contains(self.point(i), &bounds, tolerance))
            .map(|i| i as u32)
            .collect()
    }

    /// Returns the point nearest to a position; the first of several.
    pub fn nearest(&self, place: Point) -> usize {
        let square = |i: usize| -> f64 {
            let x = self.point(i);
            (0..self.dimension).map(|c| (x[c] - place[c]).powi(2)).sum()
        };
        let mut best = (0, square(0));
        for i in 1..self.len() {
            let distance = square(i);
            if distance < best.1 {
                best = (i, distance);
            }
        }
        best.0
    }
}
