//! Table 1: errors as the grid and the step are refined together.

use pericles_run::RunError;
use pericles_waves::exact::LineSolution;

use super::line::{GT, MT, Method, Reference, UNIT, nodes};
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "nonlocal-wave/table-1",
    paper: PAPER,
    title: "Errors of four methods on the line, h = τ = 0.1, 0.05, 0.025",
    run,
};

/// The exact solution of the unit medium.
pub(super) const LINE: LineSolution = LineSolution {
    young: 1.0,
    density: 1.0,
    length: 1.0,
    width: 1.0,
    amplitude: 1.0,
    centre: 0.0,
};

const GRIDS: [(f64, usize); 3] = [(0.1, 30), (0.05, 60), (0.025, 120)];

struct Cells {
    name: &'static str,
    method: Method,
    printed: [f64; 3],
    recomputed: [f64; 3],
    notes: [&'static str; 3],
}

const TABLE: [Cells; 4] = [
    Cells {
        name: "MSV",
        method: Method::Msv,
        printed: [1.2911e-3, 3.2340e-4, 8.0821e-5],
        recomputed: [1.29108e-3, 3.23403e-4, 8.08213e-5],
        notes: [""; 3],
    },
    Cells {
        name: "MT, A + h^2.4",
        method: MT,
        printed: [5.9276e-3, 1.1126e-3, 2.1350e-4],
        recomputed: [5.92763e-3, 1.12618e-3, 2.13499e-4],
        notes: [
            "",
            "printed with two digits changed places: the paper's own orders 2.3959 and 2.3992 fit 1.1262e-3",
            "",
        ],
    },
    Cells {
        name: "MMI",
        method: Method::Mmi,
        printed: [2.5754e-3, 6.4621e-4, 1.6106e-4],
        recomputed: [2.57546e-3, 6.46212e-4, 1.61606e-4],
        notes: [
            "",
            "",
            "0.3 % from the printed number, whose order would be 2.0043; the recomputed one is 1.9995",
        ],
    },
    Cells {
        name: "GT, A + h^4",
        method: GT,
        printed: [1.4940e-4, 9.3380e-6, 5.8300e-7],
        recomputed: [1.49398e-4, 9.33822e-6, 5.83653e-7],
        notes: [
            "",
            "",
            "0.1 % from the printed number; the error of the piece of line, 2e-7, is near",
        ],
    },
];

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    let mut plain = Vec::new();
    let mut orders = Vec::new();
    for (gauss, methods) in [(false, &TABLE[..3]), (true, &TABLE[3..])] {
        let unregularised = if gauss {
            Method::Gt(None)
        } else {
            Method::Mt(None)
        };
        let name = if gauss { "GT" } else { "MT" };
        let mut found = vec![Vec::new(); methods.len()];
        for (grid, &(h, steps)) in GRIDS.iter().enumerate() {
            let cloud = nodes(unregularised, h)?;
            let reference = Reference::new(&LINE, &cloud, h, steps);
            for (k, cells) in methods.iter().enumerate() {
                let error = reference.error(UNIT, cells.method, h, 1.0)?;
                found[k].push(error);
                let row = Row::new(format!("{}, h = {h}", cells.name), "", Some(error))
                    .printed(cells.printed[grid])
                    .within_share(cells.recomputed[grid], 2e-5)
                    .note(cells.notes[grid]);
                rows.push(row);
            }
            let error = reference.error(UNIT, unregularised, h, 1.0)?;
            let row = Row::new(
                format!("{name} without regularisation, h = {h}"),
                "",
                Some(error),
            );
            plain.push(row.within(0.0, 2.5e-7));
        }
        for (cells, errors) in methods.iter().zip(found) {
            if matches!(cells.method, Method::Msv | Method::Mmi) {
                let order = (errors[1] / errors[2]).log2();
                let row = Row::new(
                    format!("{}: order from the last two", cells.name),
                    "",
                    Some(order),
                );
                orders.push(row.within(2.0, 0.02));
            }
        }
    }
    if let Some(first) = plain.first_mut() {
        *first = first.clone().note(
            "so that the regularisation, said not to matter, is nearly all of the printed error; what is left comes from the ends of the piece of line",
        );
    }
    rows.extend(plain);
    rows.extend(orders);
    Ok(rows)
}
