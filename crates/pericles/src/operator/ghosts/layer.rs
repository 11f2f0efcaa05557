//! Positions of the ghost points of a body.

use std::sync::Arc;

use crate::error::{PericlesError, Result};
use crate::family::VolumeCorrection;
use crate::space::{Lattice, Point, PointCloud};

/// The points of a body and the ghost points around it as one cloud.
#[derive(Debug, Clone)]
pub struct GhostLayer {
    cloud: Arc<PointCloud>,
    /// Place in the cloud of each point of the body.
    body: Vec<u32>,
    /// Places of the ghosts in ascending order.
    ghosts: Vec<u32>,
}

impl GhostLayer {
    /// Creates ghosts in all free lattice cells within reach of a point of the body, which completes the
    /// families. Periodic bodies have no surface and no ghosts.
    ///
    /// # Errors
    /// Points that do not lie on a lattice, a body divided among processes, too many cells for the index
    /// type.
    pub fn on_lattice(
        cloud: &PointCloud,
        horizon: f64,
        correction: VolumeCorrection,
    ) -> Result<Self> {
        check_whole(cloud)?;
        let Some(lattice) = cloud.lattice() else {
            return Err(rejected(
                "ghost points occupy free cells of a lattice, but the points of this body do not lie on a regular grid; use a body on a grid or omit surface_correction = \"ghosts\"",
            ));
        };
        if cloud.has_pieces() {
            return Err(rejected(
                "a ghost point in the gap between two pieces would extrapolate the displacements of both, although no bond joins them; use surface_correction = \"energy\" or \"volume\"",
            ));
        }
        let n = cloud.len();
        if cloud.is_periodic() {
            return Ok(Self {
                cloud: Arc::new(cloud.clone()),
                body: (0..n as u32).collect(),
                ghosts: Vec::new(),
            });
        }
        let dimension = cloud.dimension();
        let reach = correction.reach(horizon, cloud.spacing());
        let (margin, offsets) = offsets(lattice, dimension, reach);
        let shape: [usize; 3] = std::array::from_fn(|c| lattice.shape[c] + 2 * margin[c] as usize);
        let nodes = shape.iter().map(|&nodes| nodes as f64).product::<f64>();
        if nodes > f64::from(u32::MAX) {
            return Err(PericlesError::TooManyPoints {
                cells: nodes,
                limit: u64::from(u32::MAX),
            });
        }
        let node = |at: [i32; 3]| {
            let [x, y, z] = std::array::from_fn(|c| (at[c] + margin[c]) as usize);
            x + shape[0] * (y + shape[1] * z)
        };
        let mut kinds = vec![Kind::Beyond; shape.iter().product()];
        for &of_point in &lattice.node {
            kinds[node(lattice.coordinates(of_point))] = Kind::Body;
        }
        for &of_point in &lattice.node {
            let at = lattice.coordinates(of_point);
            for offset in &offsets {
                let kind = &mut kinds[node(std::array::from_fn(|c| at[c] + offset[c]))];
                if *kind == Kind::Beyond {
                    *kind = Kind::Ghost;
                }
            }
        }
        let (mut used, mut body, mut ghosts) = (Vec::new(), Vec::new(), Vec::new());
        for (node, kind) in kinds.iter().enumerate() {
            let places = match kind {
                Kind::Beyond => continue,
                Kind::Body => &mut body,
                Kind::Ghost => &mut ghosts,
            };
            places.push(used.len() as u32);
            used.push(node as u32);
        }
        let first = lattice.coordinates(lattice.node[0]);
        let origin = std::array::from_fn(|c| {
            let steps = f64::from(first[c] + margin[c]);
            cloud.point(0)[c] - steps * lattice.spacing[c]
        });
        let extended = Lattice {
            spacing: lattice.spacing,
            shape,
            node: used,
        };
        let cloud = PointCloud::on_lattice(dimension, origin, extended, cloud.section())?;
        Ok(Self {
            cloud: Arc::new(cloud),
            body,
            ghosts,
        })
    }

    /// Uses given ghost points with their volumes, m³, for bodies without a lattice.
    ///
    /// # Errors
    /// A body divided among processes, volumes that are not positive or not one per ghost.
    pub fn of_points(cloud: &PointCloud, ghosts: &[Point], volumes: &[f64]) -> Result<Self> {
        check_whole(cloud)?;
        let n = cloud.len();
        let axis = |c: usize| {
            let beyond = ghosts.iter().map(move |ghost| ghost[c]);
            cloud.axis(c).iter().copied().chain(beyond)
        };
        let positions = (0..cloud.dimension()).flat_map(axis).collect();
        let volumes = [cloud.volumes(), volumes].concat();
        let places = n as u32..(n + ghosts.len()) as u32;
        let extended = PointCloud::new(cloud.dimension(), positions, volumes, cloud.section())?;
        Ok(Self {
            cloud: Arc::new(extended),
            body: (0..n as u32).collect(),
            ghosts: places.collect(),
        })
    }

    /// Returns the points of the body and the ghosts.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// Returns the place in the cloud of each point of the body.
    pub fn body(&self) -> &[u32] {
        &self.body
    }

    /// Returns the places of the ghosts in the cloud, in ascending order.
    pub fn ghosts(&self) -> &[u32] {
        &self.ghosts
    }

    /// Returns the index in the body of the point at each place; `None` for ghosts.
    pub(super) fn numbers(&self) -> Vec<Option<u32>> {
        let mut numbers = vec![None; self.cloud.len()];
        for (i, &place) in self.body.iter().enumerate() {
            numbers[place as usize] = Some(i as u32);
        }
        numbers
    }
}

/// Kind of a lattice cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Cell out of reach of the body.
    Beyond,
    Body,
    Ghost,
}

/// Returns the number of cells of the reach along each axis, and the offsets to all nodes within the reach.
fn offsets(lattice: &Lattice, dimension: usize, reach: f64) -> ([i32; 3], Vec<[i32; 3]>) {
    // Nodes at exactly the horizon are included despite rounding; additional ghosts are harmless.
    let reach = reach * (1.0 + 1e-9);
    let margin: [i32; 3] = std::array::from_fn(|c| match c < dimension {
        true => (reach / lattice.spacing[c]).floor() as i32,
        false => 0,
    });
    let [x, y, z] = margin;
    let mut offsets = Vec::new();
    for k in -z..=z {
        for j in -y..=y {
            for i in -x..=x {
                let square: f64 = lattice.vector([i, j, k])[..dimension]
                    .iter()
                    .map(|step| step * step)
                    .sum();
                if square > 0.0 && square <= reach * reach {
                    offsets.push([i, j, k]);
                }
            }
        }
    }
    (margin, offsets)
}

/// Returns the error of a body without a ghost layer.
pub(super) fn rejected(reason: impl Into<String>) -> PericlesError {
    PericlesError::NoGhostLayer {
        reason: reason.into(),
    }
}

/// Returns the error of bodies with breakable bonds.
pub(super) fn breaking() -> PericlesError {
    rejected(
        "ghost points complete the families at unbroken outer surfaces only, but bonds of this body can break; omit the failure criterion, or use surface_correction = \"energy\"",
    )
}

fn check_whole(cloud: &PointCloud) -> Result<()> {
    match cloud.domain().is_divided() {
        false => Ok(()),
        true => Err(rejected(
            "the body is divided among processes; ghost layers need a whole body",
        )),
    }
}
