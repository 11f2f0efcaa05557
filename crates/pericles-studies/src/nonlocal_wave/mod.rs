//! Nonlocal wave equation on the line: quadrature in space, trigonometric, Störmer–Verlet and implicit schemes in
//! time, and the spectral method.
//!
//! Coclite, Fanizzi, Lopez, Maddalena, Pellegrino, Numerical methods for the nonlocal wave equation of the
//! peridynamics, Applied Numerical Mathematics 155 (2020) 119–139. Where the paper's values are misprinted, depend
//! on its regularisation or cannot be identified, rows are judged by values recomputed by an independent dense
//! code; the rows say so.
//!
//! Units: E = ρ = 1 and lengths in those of the initial pulse unless a row says otherwise. Errors are the largest
//! over all nodes and steps.

mod bar;
mod cost;
mod energy;
mod line;
mod load;
mod nonlinear;
mod spectral;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("nonlocal-wave/table-1"),
        data!("nonlocal-wave/table-2"),
        data!("nonlocal-wave/table-3"),
        data!("nonlocal-wave/table-4"),
        data!("nonlocal-wave/table-5"),
        data!("nonlocal-wave/energy"),
        data!("nonlocal-wave/figures"),
        data!("nonlocal-wave/nonlinear"),
        data!("nonlocal-wave/cost"),
    ],
    measures: &[
        ("error", line::error),
        ("order", line::order),
        ("local-limit", line::local_limit),
        ("spectral-error", spectral::error),
        ("spectral-period", spectral::period),
        ("bar-error", bar::error),
        ("energy", energy::energy),
        ("inequality", energy::inequality),
        ("pulse", energy::pulse_on_line),
        ("treatment", nonlinear::treatment),
        ("scheme", nonlinear::scheme),
        ("series", nonlinear::series),
        ("linearisation", nonlinear::linearisation),
        ("load-rule", load::load_rule),
        ("cost", cost::cost),
        ("million-points", cost::million_points),
    ],
};
