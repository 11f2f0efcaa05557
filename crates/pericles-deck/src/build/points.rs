//! The points of a body: those of its grid, or those listed in a file.

use pericles::PericlesError;
use pericles::space::{GradedCloud, GradedGrid, PointCloud, Shape, gauss_bar, rectangular_cells};

use super::Resources;
use crate::body::Quadrature;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::points::PointsFile;
use crate::reader::Path;

impl Deck {
    pub(super) fn points(&self, resources: &Resources<'_>) -> Result<GradedCloud, DeckError> {
        match &self.body.listed {
            Some(file) => self
                .listed_points(file, resources)
                .map(GradedCloud::of_one_grid),
            None => self.grid_points(resources),
        }
    }

    fn listed_points(
        &self,
        file: &PointsFile,
        resources: &Resources<'_>,
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

    fn grid_points(&self, resources: &Resources<'_>) -> Result<GradedCloud, DeckError> {
        let graded = GradedGrid {
            grid: self.body.grid.clone(),
            finer: self.body.finer.clone(),
        };
        let gauss = self.body.quadrature == Quadrature::Gauss;
        self.check_grid(&graded, if gauss { 2.0 } else { 1.0 }, resources)?;
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
                PericlesError::FinerEmpty { part } | PericlesError::FinerRatio { part, .. } => {
                    Path::from("body.refine").index(*part)
                }
                PericlesError::FinerParts { .. } => "body.refine".into(),
                _ => "body".into(),
            };
            self.at_path(&place, error.into())
        })
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
