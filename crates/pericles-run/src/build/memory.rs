//! What a model would take in memory, estimated from a few sizes before anything of its size is allocated.
//!
//! | what | bytes |
//! |---|---|
//! | a point | [`POINT`] and, for each component, [`COMPONENT`] numbers: place, state, copies for checkpoints and files, what a scheme needs |
//! | a bond of a grid | a bit |
//! | a bond of a list | [`LISTED`] while families are found, of which three stay; [`KEPT`] more where the stiffness of every bond is kept |
//! | a point of a state-based material | [`SOLID`] besides |
//! | a point of a correspondence material | [`TENSORS`] besides |
//! | a bond of a correspondence material | [`NUMBER`] besides |
//! | a bond that breaks by its energy | [`WORKED`] besides |
//! | a transform | [`TRANSFORM`] for each entry of a matrix of D × D on the doubled box |
//! | a vertex of a surface | [`VERTEX`] besides, for its triangles and their neighbours |
//! | a bond of a surface | [`GEODESIC`] |
//! | a site beyond an absorbing end | [`EXTERIOR`] numbers where initial fields continue there |
//! | an absorbing end | [`LAG`] numbers for each site of the outer layer and each step, whose number blocks of Fourier transforms round up to a power of two; three times as many with fields beyond it |
//!
//! The numbers are peaks measured on blocks, plates, bars, surfaces and ends: the estimate is not below three quarters of what is taken, and at most two and a half times as much.

use pericles::material::BondFailure;
use pericles::space::{GradedGrid, PointCloud, Shape};
use pericles_deck::{
    BuildError, Fault, InterfaceFailure, KeyPath, Keys, MaterialModel, Model, Scheme, Solid,
};
use pericles_waves::ForceForm;

use super::assembler::Assembler;
use super::assembly::Assembly;
use super::refusal::{HORIZON, at_path};
use super::resources::Resources;

const NUMBER: f64 = 8.0;
const POINT: f64 = 120.0;
/// Of a scheme without stages, and of any other.
const COMPONENT: [f64; 2] = [10.0, 20.0];
const LISTED: f64 = 16.0;
const KEPT: f64 = 4.0;
/// Rows of displacements, references and dilatations of a state-based point, and its constants.
const SOLID: f64 = 160.0;
/// Rows of displacements, references, force states, shape tensors and plastic history of a correspondence point: by the sizes of these arrays.
const TENSORS: f64 = 900.0;
const WORKED: f64 = 24.0;
const TRANSFORM: f64 = 4.0;
const VERTEX: f64 = 400.0;
const GEODESIC: f64 = 84.0;
/// A cell of the box of a surface that is filled: whether it is inside, and a node of it.
const CELL: f64 = 30.0;
const LAG: f64 = 22.0;
/// Numbers for a site of the exterior: its initial fields, and the state and work arrays of their motion.
const EXTERIOR: f64 = 8.0;

impl Assembly {
    /// The estimated peak of a run's memory, bytes: points with their state, bonds as they are found, transforms, histories of absorbing ends.
    /// Files and pictures are not counted.
    pub fn memory_estimate(&self, model: &Model) -> u64 {
        Assembler::new(model).memory_estimate(self)
    }
}

impl Assembler<'_> {
    /// Refuses a body on a grid that does not fit, from the number of its cells.
    pub(super) fn check_grid(
        &self,
        solid: &Solid,
        grid: &GradedGrid,
        points_per_cell: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let dimension = grid.grid.dimension();
        let each = points_per_cell * {
            let neighbours = self.neighbours(solid, dimension, solid.shape.spacing());
            self.bytes_of_point(solid, dimension, neighbours)
        };
        let cells = match (solid.shape.rectangular(), &grid.grid.shape) {
            (Some(spacing), Shape::Box { size, .. }) => {
                let counts = size.iter().zip(spacing).map(|(side, dx)| side / dx);
                counts.product()
            }
            _ => match grid.count(resources.memory as f64 / each) {
                Ok(cells) => cells,
                // A grid that cannot be is refused where its points are made.
                Err(_) => return Ok(()),
            },
        };
        self.refuse_if_more(
            "body.spacing",
            points_per_cell * cells,
            cells * each,
            resources,
        )
    }

    /// Refuses listed points whose bonds do not fit.
    pub(super) fn check_listed(
        &self,
        solid: &Solid,
        cloud: &PointCloud,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let (points, dimension) = (cloud.len() as f64, cloud.dimension());
        let spacing = solid.shape.spacing().or(Some(cloud.spacing()));
        let neighbours = self.neighbours(solid, dimension, spacing).min(points);
        let needed = points * self.bytes_of_point(solid, dimension, neighbours);
        self.refuse_if_more(HORIZON, points, needed, resources)
    }

    /// Refuses so many points in a closed surface or an outline, found among so many cells, that do not fit.
    pub(super) fn check_filled(
        &self,
        solid: &Solid,
        points: f64,
        cells: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let dimension = solid.shape.dimension();
        let neighbours = self.neighbours(solid, dimension, solid.shape.spacing());
        let neighbours = neighbours.min(points);
        let needed = points * self.bytes_of_point(solid, dimension, neighbours) + CELL * cells;
        self.refuse_if_more("body.spacing", points, needed, resources)
    }

    /// Refuses a surface whose vertices alone do not fit.
    pub(super) fn check_vertices(
        &self,
        vertices: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let needed = vertices * (self.bytes_of_state(3) + VERTEX);
        self.refuse_if_more("body.shape", vertices, needed, resources)
    }

    /// Refuses a surface whose bonds do not fit; `area` is that of all its points, m².
    pub(super) fn check_surface(
        &self,
        points: usize,
        area: f64,
        horizon: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let points = points as f64;
        let neighbours = (std::f64::consts::PI * horizon * horizon / area * points).min(points);
        let needed = points * (self.bytes_of_state(3) + VERTEX + GEODESIC * neighbours);
        self.refuse_if_more("material.horizon", points, needed, resources)
    }

    /// Refuses an absorbing end whose histories do not fit with those of the ends before; `sites` of all of them for so many steps.
    pub(super) fn check_history(
        &self,
        path: &KeyPath,
        sites: usize,
        steps: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let blocks = steps.max(1.0).log2().ceil().exp2();
        let needed = LAG * NUMBER * sites as f64 * blocks;
        if needed <= resources.memory as f64 {
            return Ok(());
        }
        let fault = Fault::LongHistory {
            steps,
            needed,
            memory: resources.memory,
        };
        Err(at_path(path, fault))
    }

    /// Refuses `sites` of the exterior, at all ends together, whose fields do not fit.
    pub(super) fn check_exterior(
        &self,
        path: &KeyPath,
        sites: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        self.refuse_if_more(path, sites, EXTERIOR * NUMBER * sites, resources)
    }

    fn refuse_if_more(
        &self,
        path: impl Into<Keys>,
        points: f64,
        needed: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        if needed <= resources.memory as f64 {
            return Ok(());
        }
        let fault = Fault::TooLarge {
            points,
            needed,
            memory: resources.memory,
        };
        Err(at_path(path, fault))
    }

    /// Points within the horizon of a point inside.
    fn neighbours(&self, solid: &Solid, dimension: usize, spacing: Option<f64>) -> f64 {
        let material = &solid.material;
        let spacing = match (solid.shape.rectangular(), spacing) {
            // The side of the square or cube of the same volume.
            (Some(sides), _) => sides.iter().product::<f64>().powf(1.0 / dimension as f64),
            (None, Some(spacing)) => spacing,
            // Of a mesh that is not read yet: the usual three spacings in a horizon.
            (None, None) => material.horizon() / 3.0,
        };
        let ratio = material
            .volume_correction()
            .reach(material.horizon(), spacing)
            / spacing;
        match dimension {
            1 => 2.0 * ratio,
            2 => std::f64::consts::PI * ratio.powi(2),
            _ => 4.0 / 3.0 * std::f64::consts::PI * ratio.powi(3),
        }
    }

    fn bytes_of_state(&self, dimension: usize) -> f64 {
        let plain = matches!(self.model.time.scheme, Scheme::VelocityVerlet);
        POINT + COMPONENT[usize::from(!plain)] * NUMBER * dimension as f64
    }

    fn bytes_of_point(&self, solid: &Solid, dimension: usize, neighbours: f64) -> f64 {
        let transform = TRANSFORM * 2f64.powi(dimension as i32) * (dimension as f64).powi(2);
        let listed = self.bytes_of_listed_bond(solid);
        let bonds = match solid.material.form {
            ForceForm::List => listed * neighbours,
            _ if solid.material.correspondence().is_some() => listed * neighbours,
            _ if solid.material.state_based().is_some() => match self.is_on_solid_stencil(solid) {
                true => neighbours / 8.0,
                false => listed * neighbours,
            },
            ForceForm::Convolution | ForceForm::Spectral => transform,
            ForceForm::Grid | ForceForm::FloatGrid => self.bytes_on_stencil(solid, neighbours),
            _ if solid.shape.is_refined() || solid.shape.is_listed() => listed * neighbours,
            _ if !self.has_one_stiffness(solid) => self.bytes_on_stencil(solid, neighbours),
            _ if solid.shape.is_periodic() => transform,
            _ => (neighbours / 8.0).max(transform),
        };
        let own = match &solid.material.model {
            MaterialModel::StateBased(_) => SOLID,
            MaterialModel::Correspondence(_) => TENSORS,
            MaterialModel::Bonds(_) => 0.0,
        };
        self.bytes_of_state(dimension) + own + bonds
    }

    /// Bytes of a point's bonds on a stencil.
    fn bytes_on_stencil(&self, solid: &Solid, neighbours: f64) -> f64 {
        let bits = neighbours / 8.0;
        if self.has_one_stiffness(solid) {
            bits
        } else if solid.material.surface_correction != Default::default() {
            // The correction takes the families from a list.
            bits + LISTED * neighbours
        } else {
            // A factor a bond, at most.
            bits + NUMBER * neighbours
        }
    }

    fn memory_estimate(self, assembly: &Assembly) -> u64 {
        let (points, dimension) = (assembly.cloud.len() as f64, assembly.cloud.dimension());
        let operator = assembly.system.operator();
        let bonds = operator.directed_bonds() as f64;
        let list = |solid: &Solid| self.bytes_of_listed_bond(solid) * bonds;
        let found = match (self.model.body.solid(), assembly.form) {
            (None, _) => VERTEX * points + GEODESIC * bonds,
            (Some(solid), ForceForm::List) => list(solid),
            // Whether every part of a static body has a support is found on a list of its bonds.
            (Some(solid), _) if matches!(self.model.time.scheme, Scheme::Relaxation(_)) => {
                list(solid)
            }
            _ => 0.0,
        };
        let ends: usize = assembly.ends.iter().map(|(_, end)| end.bytes).sum();
        let kept = operator.bytes() as f64;
        (points * self.bytes_of_state(dimension) + found.max(kept)) as u64 + ends as u64
    }

    /// Bytes of a bond of a list while families are found.
    fn bytes_of_listed_bond(&self, solid: &Solid) -> f64 {
        if solid.material.correspondence().is_some() {
            return LISTED + NUMBER;
        }
        let worked = self.breaks_by_energy(solid);
        let kept = match solid.material.state_based() {
            Some(_) => solid.material.surface_correction != Default::default(),
            None => !self.is_on_one_grid(solid),
        };
        LISTED + if kept { KEPT } else { 0.0 } + if worked { WORKED } else { 0.0 }
    }

    /// Whether a stencil can serve all points of a state-based body.
    fn is_on_solid_stencil(&self, solid: &Solid) -> bool {
        let shape = &solid.shape;
        !shape.is_listed()
            && solid.material.surface_correction == Default::default()
            && !self.breaks_by_energy(solid)
    }

    /// Whether all bonds of the same vector have one stiffness.
    fn has_one_stiffness(&self, solid: &Solid) -> bool {
        self.model.assignments.is_empty() && solid.material.surface_correction == Default::default()
    }

    /// Whether one stencil or transform can serve all points.
    fn is_on_one_grid(&self, solid: &Solid) -> bool {
        self.has_one_stiffness(solid) && !solid.shape.is_refined() && !solid.shape.is_listed()
    }

    /// Whether bonds of a state-based body break by their energy.
    fn breaks_by_energy(&self, solid: &Solid) -> bool {
        let by_energy = |failure: &BondFailure| matches!(failure, BondFailure::BondEnergy { .. });
        let others = self.model.materials.iter().map(|other| &other.model);
        let own = solid.material.state_based();
        own.is_some_and(|own| by_energy(&own.solid.failure))
            || others.into_iter().any(|model| match model {
                MaterialModel::StateBased(state) => by_energy(&state.solid.failure),
                MaterialModel::Bonds(_) | MaterialModel::Correspondence(_) => false,
            })
            || self.model.interfaces.iter().any(|interface| {
                matches!(&interface.failure, Some(InterfaceFailure::StateBased(failure)) if by_energy(failure))
            })
    }
}
