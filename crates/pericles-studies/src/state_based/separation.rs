//! Rigid separation of two halves of a lattice: the work, measured by the force between them.

use std::sync::Arc;

use pericles::StepEnd;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, LinearSolid, LinearSolidConstants, StateInfluence, Strains, StressState,
};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};
use pericles::space::PointCloud;
use pericles_run::RunError;

use super::{cells, solid};

/// Work per area, J/m², in a body of a solid with a constant influence function and full volumes; `None` if the
/// halves are still connected at the largest opening.
pub(super) fn energy_spent(
    state: StressState,
    spacings: usize,
    nu: f64,
    failure: BondFailure,
) -> Result<Option<f64>, RunError> {
    let (dimension, layers) = (state.dimension(), 2 * spacings);
    // A column whose neighbours have full families of points that have full families.
    let width = 4 * spacings + 1;
    let mut counts = vec![width; dimension];
    counts[0] = 2 * layers;
    let cloud = Arc::new(cells(&counts)?);
    let constant = StateInfluence::Function(InfluenceFunction::Constant);
    let material = LinearSolid {
        failure,
        ..solid(nu, spacings, constant, VolumeCorrection::None)
    };
    let constants = material.constants(&cloud, state)?;
    let body = LinearSolidBody {
        strains: Strains::Small,
        ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
    };
    let halves = Halves::new(&cloud, layers as f64, 0.5 * width as f64);
    let mut operator = body.operator(BondForm::Fastest)?.operator;
    let openings = openings(&constants, dimension, spacings as i32);
    let mut force = halves.apart(0.0);
    let mut work = 0.5 * openings[0].at * halves.pull(&*operator, openings[0].at);
    for ends in openings.windows(2) {
        let decided = halves.apart(ends[0].decided);
        let step = StepEnd::sub_step(0.0, 0.0, &decided);
        operator.end_step(&step, PointSubset::All, &mut force);
        let pulls = [ends[0].at, ends[1].at].map(|at| halves.pull(&*operator, at));
        let mean = 0.5 * (pulls[0] + pulls[1]);
        if mean.abs() < 1e-12 {
            return Ok(Some(work));
        }
        work += mean * (ends[1].at - ends[0].at);
    }
    Ok(None)
}

/// Body of two halves.
struct Halves {
    /// Points that move.
    moved: Vec<usize>,
    /// Moving points in the column of unit cross-section through the middle.
    column: Vec<usize>,
    entries: usize,
}

impl Halves {
    fn new(cloud: &PointCloud, boundary: f64, middle: f64) -> Self {
        let dimension = cloud.dimension();
        let is_moved = |i: &usize| cloud.point(*i)[0] > boundary;
        let moved: Vec<usize> = (0..cloud.len()).filter(is_moved).collect();
        let is_inside = |i: &usize| {
            let point = cloud.point(*i);
            (1..dimension).all(|c| (point[c] - middle).abs() < 0.1)
        };
        Self {
            column: moved.iter().copied().filter(is_inside).collect(),
            moved,
            entries: dimension * cloud.len(),
        }
    }

    /// Displacement with a gap of this width, m.
    fn apart(&self, opening: f64) -> Vec<f64> {
        let mut u = vec![0.0; self.entries];
        self.moved.iter().for_each(|&i| u[i] = opening);
        u
    }

    /// Force per area that closes the gap, N/m².
    fn pull(&self, operator: &dyn Force, opening: f64) -> f64 {
        let mut force = vec![0.0; self.entries];
        operator.add_force(0.0, &self.apart(opening), PointSubset::All, &mut force);
        -self.column.iter().map(|&i| force[i]).sum::<f64>()
    }
}

/// Width of the gap, and the width at which breaking is evaluated there, m.
struct Opening {
    at: f64,
    decided: f64,
}

/// By stretch: the openings at which bonds break, s₀ r²/ξ_x for small strains, and just above each; the force is
/// linear in between. By bond energy: openings that grow by 3 %, where half of the bonds that break within a step
/// break at its start and half at its end.
fn openings(constants: &LinearSolidConstants, dimension: usize, spacings: i32) -> Vec<Opening> {
    if constants.limits.stretch.is_infinite() {
        let first = 0.2 * (constants.fracture_energy / constants.deviatoric).sqrt();
        let of = |k: i32| {
            let at = first * 1.03f64.powi(k);
            let decided = at * 1.03f64.sqrt();
            Opening { at, decided }
        };
        return (0..300).map(of).collect();
    }
    let across = |c: usize| match c < dimension {
        true => -spacings..=spacings,
        false => 0..=0,
    };
    let mut found = Vec::new();
    for x in 1..=spacings {
        for y in across(1) {
            for z in across(2) {
                let square = x * x + y * y + z * z;
                if square <= spacings * spacings {
                    found.push(constants.limits.stretch * f64::from(square) / f64::from(x));
                }
            }
        }
    }
    found.sort_by(f64::total_cmp);
    found.dedup_by(|a, b| *a - *b < 1e-9 * *b);
    found.push(2.0 * found[found.len() - 1]);
    let just_above = |at: f64| Opening {
        at,
        decided: at * (1.0 + 1e-6),
    };
    found.into_iter().map(just_above).collect()
}
