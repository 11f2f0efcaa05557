//! The points of a body: those of its grid, or those listed in a file.

use pericles::PericlesError;
use pericles::family::pairs_within;
use pericles::space::{
    GradedCloud, GradedGrid, ListedPoints, PointCloud, Shape, gauss_bar, idle_holes,
    rectangular_cells,
};

use super::Resources;
use crate::body::{PointsFile, Quadrature};
use crate::caution::Caution;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Warning;
use crate::reader::Path;

impl Deck {
    pub(super) fn points(
        &self,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<GradedCloud, DeckError> {
        let points = match &self.body.listed {
            Some(file) => self
                .listed_points(file, resources, warnings)
                .map(GradedCloud::of_one_grid),
            None => self.grid_points(resources, warnings),
        }?;
        /// The distance of atoms in a crystal, m.
        const ATOMS: f64 = 1e-10;
        let spacing = points.cloud.spacing();
        if spacing < ATOMS {
            warnings.push(self.finding(&"body.spacing".into(), Caution::TinySpacing { spacing }));
        }
        Ok(points)
    }

    fn listed_points(
        &self,
        file: &PointsFile,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<PointCloud, DeckError> {
        /// Volumes and spacing disagree by this factor only if one of them has another unit.
        const OFF: f64 = 2.0;
        let path = self.beside(&file.path);
        let listed = (resources.read_points)(&path, file.dimension, resources.memory);
        let listed = listed.map_err(|error| {
            let fault = error.fault(|reason| Fault::BadPoints { reason });
            self.at_path(&"body.file".into(), fault)
        })?;
        let cloud = listed
            .cloud(file.dimension, self.body.grid.section)
            .map_err(|error| self.at("body.file", error))?;
        let (given, found) = (self.body.grid.spacing, cloud.spacing());
        if (1.0 / OFF..=OFF).contains(&(found / given)) {
            self.check_listed(&cloud, resources)?;
            warnings.extend(self.judge_listed(&listed, &cloud));
            return Ok(cloud);
        }
        let section = ["area", "thickness"].get(file.dimension - 1).copied();
        let fault = Fault::OtherSpacing {
            given,
            found,
            section,
        };
        Err(self.at_path(&"body.spacing".into(), fault))
    }

    /// Warns of coordinates that the body does not use, and of points that are much closer to each other than the others.
    fn judge_listed(&self, listed: &ListedPoints, cloud: &PointCloud) -> Vec<Warning> {
        /// Share of the spacing.
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
            .map(|caution| self.finding(&"body.file".into(), caution))
            .collect()
    }

    /// Warns of holes that take nothing from the body.
    fn judge_holes(&self, graded: &GradedGrid) -> Vec<Warning> {
        let grid = &graded.grid;
        let idle = match (&grid.shape, &self.body.rectangular) {
            (Shape::Box { origin, size }, Some(spacing)) => {
                idle_holes(*origin, size, spacing, &grid.holes)
            }
            _ => graded.idle_holes(),
        };
        // What is wrong with the grid is reported where its points are made.
        let idle = idle.unwrap_or_default().into_iter();
        idle.map(|k| {
            let hole = Path::from("body.hole").index(k);
            // The bore of a tube or ring follows the holes of the deck.
            let place = match self.record.is_given(&hole) {
                true => hole,
                false => "body.inner_radius".into(),
            };
            self.finding(&place, Caution::IdleHole)
        })
        .collect()
    }

    fn grid_points(
        &self,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<GradedCloud, DeckError> {
        let graded = GradedGrid {
            grid: self.body.grid.clone(),
            finer: self.body.finer.clone(),
        };
        let gauss = self.body.quadrature == Quadrature::Gauss;
        self.check_grid(&graded, if gauss { 2.0 } else { 1.0 }, resources)?;
        warnings.extend(self.judge_holes(&graded));
        let grid = &graded.grid;
        let points = match (&grid.shape, self.body.quadrature) {
            (Shape::Box { origin, size }, _) if self.body.rectangular.is_some() => {
                let spacing = self.body.rectangular.as_deref().unwrap_or_default();
                rectangular_cells(*origin, size, spacing, grid.section, &grid.holes)
                    .map(GradedCloud::of_one_grid)
            }
            (Shape::Box { origin, size }, Quadrature::Gauss) => {
                gauss_bar(origin[0], size[0], grid.spacing, grid.section)
                    .map(GradedCloud::of_one_grid)
            }
            _ if self.body.periodic => grid
                .points()
                .and_then(PointCloud::with_periodic_faces)
                .map(GradedCloud::of_one_grid),
            _ if graded.finer.is_empty() => grid.points().map(GradedCloud::of_one_grid),
            _ => graded.points(),
        };
        points.map_err(|error| {
            let place = match &error {
                PericlesError::NotWholeCells { length, .. } => self.side(*length),
                PericlesError::TooManyPoints { .. } => "body.spacing".into(),
                PericlesError::Unresolved { .. } => self.corner(),
                PericlesError::FinerEmpty { part } | PericlesError::FinerRatio { part, .. } => {
                    Path::from("body.refine").index(*part)
                }
                PericlesError::FinerParts { .. } => "body.refine".into(),
                _ => "body".into(),
            };
            self.at_path(&place, error.into())
        })
    }

    /// The entry that says where the body is.
    fn corner(&self) -> Path {
        let places = ["body.origin", "body.centre", "body.base"].map(Path::from);
        let given = |place: &Path| self.record.is_given(place);
        places.into_iter().find(given).unwrap_or("body".into())
    }

    /// The entry that gives a side of this length.
    fn side(&self, length: f64) -> Path {
        let given =
            |path: &Path| self.record.value(path).and_then(|value| value.as_f64()) == Some(length);
        let size = Path::from("body.size");
        let candidates = [
            size.index(0),
            size.index(1),
            size.index(2),
            "body.length".into(),
            "body.height".into(),
        ];
        candidates.into_iter().find(given).unwrap_or(size)
    }
}
