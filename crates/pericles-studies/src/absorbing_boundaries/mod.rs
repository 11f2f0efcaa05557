//! Exact absorbing boundaries of bars and beams.
//!
//! Ji, Pang, Zhang, Yang, Perdikaris, *Exact artificial boundary conditions of 1D semi-discretized peridynamics*.
//! The errors in the paper are those of its semi-discrete boundaries together with velocity Verlet, relative to the
//! solution in continuous time; they are reproduced with the boundaries of the paper and listed beside those of
//! boundaries exact for the scheme. Values marked as recomputed come from a separate code.

mod bar;
mod cost;
mod kernels;
mod layer;
mod long_time;
mod midpoint;
mod strip;
mod tables;

use crate::study::{Topic, data};

/// Studies of this topic.
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
        ("long-time", long_time::long_time),
        ("cost", cost::compared),
        ("million-steps", cost::million_steps),
        ("reflection", layer::reflected),
        ("reflection-of-angles", layer::of_angles),
        ("midpoint", midpoint::midpoint),
        ("strip", strip::strip_ends),
    ],
};
