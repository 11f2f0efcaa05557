//! Exact absorbing ends of bars and beams.
//!
//! Ji, Pang, Zhang, Yang, Perdikaris, *Exact artificial boundary conditions of 1D semi-discretized peridynamics*. The paper's errors are those of its semi-discrete
//! ends together with velocity Verlet's, against the solution in continuous time; they are computed again with the paper's ends, and those of ends that are
//! exact for the scheme stand beside them. Numbers marked as recomputed come from a separate code.

mod bar;
mod cost;
mod figures;
mod layer;
mod midpoint;
mod paper;
mod strip;
mod table_1;
mod tables;

use crate::study::Study;

/// The topic's studies.
pub(super) const STUDIES: [Study; 10] = [
    table_1::TABLE_1,
    tables::TABLE_2,
    tables::TABLE_3,
    tables::TABLE_4,
    tables::TABLE_5,
    tables::TABLE_6,
    cost::COST,
    layer::DAMPING_LAYER,
    midpoint::MIDPOINT,
    strip::STRIP,
];
