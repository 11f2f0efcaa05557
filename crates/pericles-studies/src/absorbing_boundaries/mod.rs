//! Exact absorbing ends of bars and beams.
//!
//! Ji, Pang, Zhang, Yang, Perdikaris, *Exact artificial boundary conditions of 1D semi-discretized peridynamics*. The paper's errors are those of its semi-discrete
//! ends together with velocity Verlet's, against the solution in continuous time; they are computed again with the paper's ends, and those of ends that are
//! exact for the scheme stand beside them. Numbers marked as recomputed come from a separate code.

mod bar;
mod cost;
mod kernels;
mod layer;
mod midpoint;
mod strip;
mod tables;

use crate::study::{Topic, data};

/// The topic's studies.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("absorbing-boundaries/table-1"),
        data!("absorbing-boundaries/table-2"),
        data!("absorbing-boundaries/table-3"),
        data!("absorbing-boundaries/table-4"),
        data!("absorbing-boundaries/table-5"),
        data!("absorbing-boundaries/table-6"),
        data!("absorbing-boundaries/cost"),
        data!("absorbing-boundaries/damping-layer"),
        data!("absorbing-boundaries/midpoint"),
        data!("absorbing-boundaries/strip"),
    ],
    measures: &[
        ("kernels", kernels::kernels),
        ("error", tables::error),
        ("order", tables::order),
        ("fields", tables::fields),
        ("interfaces", tables::interfaces),
        ("wavelet", tables::wavelet),
        ("cost", cost::compared),
        ("million-steps", cost::million_steps),
        ("reflection", layer::reflected),
        ("reflection-of-angles", layer::of_angles),
        ("midpoint", midpoint::midpoint),
        ("strip", strip::strip_ends),
    ],
};
