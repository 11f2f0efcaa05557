//! Prediction of a run divided among several processes, without starting any.

use pericles::division::{Share, shares};
use pericles_deck::{BuildError, Fault, Model, Scheme, SolidShape};
use pericles_heat::HeatError;
use pericles_statics::{MOST_REPLICATED, StaticsError};
use serde::Serialize;

use super::assembler::{Assembler, Warnings};
use super::assembly::Assembly;
use super::points::has_equal_cells;
use super::rejection::{at, at_path};
use crate::division::owners;

/// Mean and largest value over the processes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The largest value.
    pub largest: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let (count, sum) = values
            .clone()
            .fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
        Self {
            mean: sum / count,
            largest: values.fold(0.0, f64::max),
        }
    }
}

/// A body divided among several processes: what each of them computes, stores and sends.
#[derive(Debug, Clone, Serialize)]
pub struct Forecast {
    /// Number of processes.
    pub processes: usize,
    /// Own points.
    pub points: Spread,
    /// Ghosts per own point.
    pub halo: Spread,
    /// Share of own points that interact with points of other processes.
    pub boundary: Spread,
    /// Messages sent in each exchange.
    pub messages: Spread,
    /// Estimated peak memory, bytes.
    pub memory: Spread,
    /// Bytes received per force evaluation.
    pub bytes: Spread,
    /// Exchanges per force evaluation.
    pub exchanges: usize,
    /// Points of the whole body.
    #[serde(skip)]
    whole: f64,
}

/// Time between sending a message and its arrival, s: a fast network.
pub const LATENCY: f64 = 2e-6;
/// Bytes per second that a process receives: a fast network shared by the processes of a machine.
pub const BANDWIDTH: f64 = 10e9;

const NUMBER: f64 = 8.0;
/// Bytes per point of the whole body and dimension, and per point, while a process takes its part of points that are not created in
/// parts: positions; volume, node, number, block, grid.
const WHOLE: [f64; 2] = [8.0, 32.0];
/// Bytes per unknown of the whole body in one, two and three dimensions: matrix, prolongations and vectors of the multigrid that
/// every process of a static run stores.
const MULTIGRID: [f64; 3] = [400.0, 1000.0, 2500.0];

impl Forecast {
    /// Returns the time of a step, s: the time of the largest part and of its exchanges, which are not overlapped.
    ///
    /// `alone` is the time of a step of the whole body on one process with the same number of threads, and `evaluations` the
    /// number of force evaluations in it.
    pub fn step(&self, alone: f64, evaluations: f64) -> f64 {
        let compute = alone * self.points.largest / self.whole;
        let messages = self.exchanges as f64 * self.messages.largest * LATENCY;
        compute + evaluations * (messages + self.bytes.largest / BANDWIDTH)
    }
}

impl Assembly {
    /// Predicts a run of this body divided among several processes. The body itself must not be divided.
    ///
    /// # Errors
    /// A model that cannot be divided, with the reason; more processes than parts.
    pub fn forecast(&self, model: &Model, processes: usize) -> Result<Forecast, BuildError> {
        let warnings = Warnings::default();
        let assembler = Assembler::new(model, &warnings);
        let cloud = &self.cloud;
        if processes > 1
            && let Some((keys, reason)) = assembler.undivided()
        {
            return Err(at_path(keys, Fault::Undivided { reason }));
        }
        let reach = assembler.reach(cloud);
        let of_processes = || shares(cloud, &owners(cloud, reach, processes)?, processes, reach);
        let shares = of_processes().map_err(|error| at("body", error))?;
        if shares.iter().any(|share| share.owned == 0) {
            let fault = Fault::TooManyProcesses {
                processes,
                points: cloud.len(),
            };
            return Err(at_path("body", fault));
        }
        let dimension = cloud.dimension() as f64;
        // Forces in two passes also exchange the values of the points between the passes.
        let values = self.system.operator().values_between_passes();
        // Conduction exchanges temperatures once per step, if it needs no sub-steps.
        let heat = usize::from(self.temperature.is_some());
        let numbers = dimension + (values + heat) as f64;
        let whole = cloud.len() as f64;
        let of_point = self.memory_estimate(model) as f64 / whole;
        let shape = model.body.solid().map(|solid| &solid.shape);
        let in_parts =
            matches!(shape, Some(SolidShape::Lattice(lattice)) if has_equal_cells(lattice));
        let created = match processes {
            1 => 0.0,
            _ if in_parts => 0.0,
            _ => whole * (WHOLE[0] * dimension + WHOLE[1]),
        };
        // The preconditioner of static states is not divided.
        let unknowns = whole * dimension;
        let multigrid = match model.time.scheme {
            Scheme::Static(_) if processes > 1 => {
                if unknowns > MOST_REPLICATED as f64 {
                    let unknowns = unknowns as usize;
                    return Err(at(
                        "time.scheme",
                        StaticsError::TooManyUnknowns { unknowns }.into(),
                    ));
                }
                unknowns * MULTIGRID[cloud.dimension() - 1]
            }
            _ => 0.0,
        };
        // The same holds for implicit and steady heat conduction; every process already counts the memory of its own points.
        let conductors = match processes {
            1 => 0.0,
            _ => assembler.bytes_of_heat_multigrid(cloud.dimension()),
        };
        if conductors > 0.0 && cloud.len() > MOST_REPLICATED {
            let points = cloud.len();
            return Err(at(
                "thermal.scheme",
                HeatError::TooManyPoints { points }.into(),
            ));
        }
        let spread = |of: &dyn Fn(&Share) -> f64| Spread::of(shares.iter().map(of));
        let per_own = |count: usize, share: &Share| count as f64 / share.owned as f64;
        Ok(Forecast {
            processes,
            points: spread(&|share| share.owned as f64),
            halo: spread(&|share| per_own(share.ghosts, share)),
            boundary: spread(&|share| per_own(share.boundary, share)),
            messages: spread(&|share| share.peers as f64),
            memory: spread(&|share| {
                created
                    + multigrid
                    + conductors * (whole - share.owned as f64)
                    + of_point * share.owned as f64
                    + 2.0 * NUMBER * numbers * share.ghosts as f64
            }),
            bytes: spread(&|share| NUMBER * numbers * share.ghosts as f64),
            exchanges: 1 + usize::from(values > 0) + heat,
            whole,
        })
    }
}
