//! Memory estimate of a model, before large allocations.
//!
//! | item | bytes |
//! |---|---|
//! | a point | [`POINT`] and, per component, [`COMPONENT`] numbers: position, state, copies for checkpoints and files, arrays of the scheme |
//! | a bond of a grid | one bit |
//! | a bond of a list | [`LISTED`] during the neighbour search, three afterwards; [`KEPT`] more if the stiffness of every bond is stored |
//! | a point of a state-based material | [`SOLID`] in addition |
//! | a point of a correspondence material | [`TENSORS`] in addition |
//! | a bond of a correspondence material | [`NUMBER`] in addition |
//! | a bond that breaks by its energy | [`WORKED`] in addition |
//! | a Fourier transform | [`TRANSFORM`] per entry of a D × D matrix on the doubled box |
//! | a point that conducts heat | [`HEAT`] numbers in addition; [`NEAR`] per conductor of the multigrid with implicit and steady schemes |
//! | a bond that conducts heat | two bits on a lattice, [`CONDUCTOR`] in a list |
//! | a cell in field files | [`WRITTEN`]: its corners, its share of the nodes, and the search for common nodes |
//! | a vertex of a surface | [`VERTEX`] in addition, for its triangles and their neighbours |
//! | a bond of a surface | [`GEODESIC`] |
//! | a site beyond an absorbing boundary | [`EXTERIOR`] numbers, if initial fields extend there |
//! | an absorbing boundary | [`LAG`] numbers per site of the outer layer and step (rounded up to a power of two for Fourier transforms); three times as many with fields beyond it |
//!
//! The constants are measured peaks of blocks, plates, bars, surfaces and absorbing boundaries. The estimate is
//! between 0.75 and 2.5 times the actual peak.
//!
//! A body that does not fit is rejected by its numbers of cells, neighbours and steps. The program determines the
//! available memory; the engine and decks do not query the machine.

use pericles::material::BondFailure;
use pericles::space::{GradedGrid, PointCloud, Shape};
use pericles_deck::{
    BuildError, ConductionScheme, Fault, InterfaceFailure, KeyPath, Keys, MaterialModel, Model,
    Scheme, Solid,
};
use pericles_waves::ForceForm;

use super::assembler::{Assembler, Warnings};
use super::assembly::Assembly;
use super::rejection::{HORIZON, at_path};
use super::resources::Resources;

const NUMBER: f64 = 8.0;
const POINT: f64 = 120.0;
/// Numbers per component for schemes without stages, and for other schemes.
const COMPONENT: [f64; 2] = [10.0, 20.0];
const LISTED: f64 = 16.0;
const KEPT: f64 = 4.0;
/// Bytes of a state-based point: rows of displacements, reference positions and dilatations, and constants.
const SOLID: f64 = 160.0;
/// Bytes of a correspondence point: rows of displacements and reference positions, force states, shape tensors,
/// plastic history.
const TENSORS: f64 = 900.0;
const WORKED: f64 = 24.0;
/// Bytes per bond of viscous and plastic materials, in addition to 8 for each stored number: weight, stretch of the last
/// step, force state, reverse entry.
const HISTORY: f64 = 28.0;
const TRANSFORM: f64 = 4.0;
const VERTEX: f64 = 400.0;
const GEODESIC: f64 = 84.0;
/// Numbers per point of heat conduction: temperatures at both ends of the accepted and the next step, capacity, flows,
/// work arrays of a step; conductivity and marks of incomplete families. The tensor of the surface correction comes in addition.
const HEAT: f64 = 24.0;
/// Bytes per conducting bond of a list: list and conductances.
const CONDUCTOR: f64 = 20.0;
/// Bytes per conductor between neighbouring points in the multigrid of implicit steps and steady states.
const NEAR: f64 = 96.0;
/// Conductors of a point in one, two and three dimensions.
const CONDUCTORS: [f64; 3] = [4.0, 12.0, 32.0];
/// Bytes per cell of the bounding box of a filled surface: inside flag and node.
const CELL: f64 = 30.0;
/// Bytes per cell of field files on cells.
const WRITTEN: f64 = 100.0;
const LAG: f64 = 22.0;
/// Numbers per exterior site: initial fields, state and work arrays of their motion.
const EXTERIOR: f64 = 8.0;

impl Assembly {
    /// Returns the estimated peak memory of a run, bytes: points with their state, neighbour search, transforms,
    /// histories of absorbing boundaries. Output is not included.
    pub fn memory_estimate(&self, model: &Model) -> u64 {
        Assembler::new(model, &Warnings::default()).memory_estimate(self)
    }
}

impl Assembler<'_> {
    /// Checks the memory of a body on a grid, from the number of its cells.
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
                // Invalid grids are reported when their points are created.
                Err(_) => return Ok(()),
            },
        };
        self.reject_if_more(
            "body.spacing",
            points_per_cell * cells,
            cells * each,
            resources,
        )
    }

    /// Checks the memory of the bonds of listed points.
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
        self.reject_if_more(HORIZON, points, needed, resources)
    }

    /// Checks the memory of points in a closed surface or an outline, from the numbers of points and cells.
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
        self.reject_if_more("body.spacing", points, needed, resources)
    }

    /// Checks the memory of the vertices of a surface.
    pub(super) fn check_vertices(
        &self,
        vertices: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let needed = vertices * (self.bytes_of_state(3) + VERTEX);
        self.reject_if_more("body.shape", vertices, needed, resources)
    }

    /// Checks the memory of the bonds of a surface; `area` is its total area, m².
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
        self.reject_if_more("material.horizon", points, needed, resources)
    }

    /// Checks the memory of the histories of absorbing boundaries with `sites` sites in total over the steps of the
    /// run.
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

    /// Checks the memory of the exterior fields with `sites` sites in total.
    pub(super) fn check_exterior(
        &self,
        path: &KeyPath,
        sites: f64,
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        self.reject_if_more(path, sites, EXTERIOR * NUMBER * sites, resources)
    }

    fn reject_if_more(
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

    /// Returns the number of neighbours of an interior point.
    fn neighbours(&self, solid: &Solid, dimension: usize, spacing: Option<f64>) -> f64 {
        let material = &solid.material;
        let horizon = self.largest_horizon(solid);
        let spacing = match (solid.shape.rectangular(), spacing) {
            // Side of the square or cube of the same volume.
            (Some(sides), _) => sides.iter().product::<f64>().powf(1.0 / dimension as f64),
            (None, Some(spacing)) => spacing,
            // For a mesh that is not yet read: the common horizon of three spacings.
            (None, None) => horizon / 3.0,
        };
        let ratio = material.volume_correction().reach(horizon, spacing) / spacing;
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
            _ if solid.material.softening.is_some() => listed * neighbours,
            _ if !self.has_one_stiffness(solid) => self.bytes_on_stencil(solid, neighbours),
            _ if solid.shape.is_periodic() => transform,
            _ => (neighbours / 8.0).max(transform),
        };
        let own = match &solid.material.model {
            MaterialModel::StateBased(_) => SOLID,
            MaterialModel::Correspondence(_) => TENSORS,
            MaterialModel::Bonds(_) => 0.0,
        };
        let cells = match self.model.output.writes_cells() && !solid.shape.is_listed() {
            true => WRITTEN,
            false => 0.0,
        };
        self.bytes_of_state(dimension)
            + own
            + bonds
            + cells
            + self.bytes_of_heat(solid, dimension, neighbours)
    }

    /// Returns the bytes of heat conduction of a point with this number of neighbours.
    fn bytes_of_heat(&self, solid: &Solid, dimension: usize, neighbours: f64) -> f64 {
        let thermal = self.model.thermal.as_ref();
        if thermal.is_none_or(|thermal| thermal.conduction.is_none()) {
            return 0.0;
        }
        let listed =
            solid.shape.is_refined() || solid.shape.is_listed() || self.has_several_horizons(solid);
        let bonds = match listed {
            true => CONDUCTOR * neighbours,
            false => neighbours / 4.0,
        };
        let tensor = dimension as f64 * (dimension as f64 + 1.0) / 2.0;
        (HEAT + tensor) * NUMBER + bonds + self.bytes_of_heat_multigrid(dimension)
    }

    /// Returns the bytes per point of the multigrid of implicit and steady heat conduction; zero for models without it.
    pub(super) fn bytes_of_heat_multigrid(&self, dimension: usize) -> f64 {
        let thermal = self.model.thermal.as_ref();
        match thermal.and_then(|thermal| thermal.conduction.as_ref()) {
            Some(conduction) if conduction.scheme != ConductionScheme::Explicit => {
                NEAR * CONDUCTORS[dimension - 1]
            }
            _ => 0.0,
        }
    }

    /// Returns the bytes of the bonds of a point on a stencil.
    fn bytes_on_stencil(&self, solid: &Solid, neighbours: f64) -> f64 {
        let bits = neighbours / 8.0;
        if self.has_one_stiffness(solid) {
            bits
        } else if solid.material.surface_correction != Default::default()
            || self.has_several_horizons(solid)
        {
            // Surface corrections, and limits of bonds between different horizons, need a neighbour list.
            bits + LISTED * neighbours
        } else {
            // At most one factor per bond.
            bits + NUMBER * neighbours
        }
    }

    fn memory_estimate(self, assembly: &Assembly) -> u64 {
        let (points, dimension) = (assembly.system.points() as f64, assembly.cloud.dimension());
        let operator = assembly.system.operator();
        let bonds = operator.directed_bonds() as f64;
        let list = |solid: &Solid| self.bytes_of_listed_bond(solid) * bonds;
        let found = match (self.model.body.solid(), assembly.form) {
            (None, _) => VERTEX * points + GEODESIC * bonds,
            (Some(solid), ForceForm::List) => list(solid),
            // The constraints of static bodies are checked with a neighbour list.
            (Some(solid), _) if self.model.time.scheme.is_static() => list(solid),
            (Some(solid), _) if self.has_several_horizons(solid) => list(solid),
            _ => 0.0,
        };
        let ends: usize = assembly.ends.iter().map(|(_, end)| end.bytes).sum();
        let kept = operator.bytes() as f64;
        let heat = |solid| points * self.bytes_of_heat(solid, dimension, bonds / points);
        let heat = self.model.body.solid().map_or(0.0, heat);
        (points * self.bytes_of_state(dimension) + found.max(kept) + heat) as u64 + ends as u64
    }

    /// Returns the bytes per bond of a list during the neighbour search.
    fn bytes_of_listed_bond(&self, solid: &Solid) -> f64 {
        let by_energy = |failure: &BondFailure| matches!(failure, BondFailure::BondEnergy { .. });
        let worked = match self.breaks(solid, &by_energy) {
            true => WORKED,
            false => 0.0,
        };
        if solid.material.correspondence().is_some() {
            return LISTED + NUMBER + worked;
        }
        let kept = match solid.material.state_based() {
            Some(_) => solid.material.surface_correction != Default::default(),
            None => !self.is_on_one_grid(solid),
        };
        let softens = solid.material.softening.is_some();
        let history = self.history_of_bond(solid) + if softens { NUMBER } else { 0.0 };
        LISTED + if kept { KEPT } else { 0.0 } + worked + history
    }

    /// Returns the bytes per bond of the history of viscous and plastic materials.
    fn history_of_bond(&self, solid: &Solid) -> f64 {
        let others = self.model.materials.iter().map(|other| &other.model);
        let models = std::iter::once(&solid.material.model).chain(others);
        let of_model = |model: &MaterialModel| match model {
            MaterialModel::StateBased(state) if !state.inelastic.is_elastic() => {
                // Plastic materials store the plastic stretch and the influence function.
                let stored = state.inelastic.terms().len();
                HISTORY + NUMBER * if stored == 0 { 2 } else { stored } as f64
            }
            _ => 0.0,
        };
        models.map(of_model).fold(0.0, f64::max)
    }

    /// Returns whether all points of a state-based body can share a stencil.
    fn is_on_solid_stencil(&self, solid: &Solid) -> bool {
        let shape = &solid.shape;
        !shape.is_listed()
            && solid.material.surface_correction == Default::default()
            && !self.breaks(solid, &|failure| {
                matches!(
                    failure,
                    BondFailure::BondEnergy { .. } | BondFailure::ByCriterion
                )
            })
            && self.history_of_bond(solid) == 0.0
    }

    /// Returns whether all bonds with the same vector have the same stiffness.
    fn has_one_stiffness(&self, solid: &Solid) -> bool {
        self.model.assignments.is_empty()
            && self.model.assigned_materials().is_empty()
            && solid.material.surface_correction == Default::default()
    }

    /// Returns the horizons of all materials, the body's material first.
    fn horizons(self, solid: &Solid) -> impl Iterator<Item = f64> {
        let others = self.model.materials.iter();
        let others = others.map(|other| other.model.horizon());
        std::iter::once(solid.material.horizon()).chain(others)
    }

    /// Returns the largest horizon of all materials.
    pub(super) fn largest_horizon(self, solid: &Solid) -> f64 {
        self.horizons(solid).fold(0.0, f64::max)
    }

    /// Returns whether materials have different horizons.
    fn has_several_horizons(self, solid: &Solid) -> bool {
        let own = solid.material.horizon();
        self.horizons(solid).any(|horizon| horizon != own)
    }

    /// Returns whether all points can share a stencil or transform.
    fn is_on_one_grid(&self, solid: &Solid) -> bool {
        self.has_one_stiffness(solid) && !solid.shape.is_refined() && !solid.shape.is_listed()
    }

    /// Returns whether the failure of some bonds of a state-based body is of a kind.
    fn breaks(&self, solid: &Solid, is: &dyn Fn(&BondFailure) -> bool) -> bool {
        let others = self.model.materials.iter().map(|other| &other.model);
        let mut models = std::iter::once(&solid.material.model).chain(others);
        models.any(|model| match model {
            MaterialModel::StateBased(state) => is(&state.solid.failure),
            MaterialModel::Correspondence(own) => is(&own.solid.failure),
            MaterialModel::Bonds(_) => false,
        })
            || self.model.interfaces.iter().any(|interface| {
                matches!(&interface.failure, Some(InterfaceFailure::StateBased(failure)) if is(failure))
            })
    }
}
