//! Table 3: the local limit l → 0.

use pericles_run::RunError;
use pericles_waves::exact::{LineSolution, TravellingPulse};

use super::convergence::LINE;
use super::line::{GT, MT, Medium, Method, Reference, nodes};
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "nonlocal-wave/table-3",
    paper: PAPER,
    title: "Distance from d'Alembert's solution as the micromodulus becomes short",
    run,
};

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    const H: f64 = 0.1;
    const STEPS: usize = 30;
    let string = TravellingPulse {
        speed: 1.0,
        width: 1.0,
        amplitude: 1.0,
        centre: 0.0,
    };
    let methods = [
        ("MSV", Method::Msv),
        ("MT", MT),
        ("GT", GT),
        ("MMI", Method::Mmi),
    ];
    let table = [
        (
            0.4,
            [5.4948e-2, 5.2569e-2, 5.6887e-2, 6.0951e-2],
            [5.49472e-2, 5.25693e-2, 5.68870e-2, 6.09509e-2],
            5.70158e-2,
        ),
        (
            0.2,
            [1.2269e-2, 1.5168e-2, 1.4646e-2, 1.9493e-2],
            [1.22687e-2, 1.51681e-2, 1.46463e-2, 1.94931e-2],
            1.47581e-2,
        ),
        (
            0.1,
            [2.4625e-3, 6.0420e-3, 3.7111e-3, 9.6978e-3],
            [2.46246e-3, 6.04199e-3, 3.71109e-3, 9.69776e-3],
            3.67132e-3,
        ),
    ];
    let mut rows = Vec::new();
    let mut gaps = Vec::new();
    // The gap of the exact solutions is looked for on a fine grid.
    let cloud = nodes(Method::Msv, 0.01)?;
    for (length, printed, recomputed, gap) in table {
        let medium = Medium { young: 1.0, length };
        for (k, (name, method)) in methods.into_iter().enumerate() {
            let nodes = nodes(method, H)?;
            let reference = Reference::new(&string, &nodes, H, STEPS);
            let distance = reference.error(medium, method, H, 1.0)?;
            rows.push(
                Row::new(format!("{name}, l = {length}"), "", Some(distance))
                    .printed(printed[k])
                    .within_share(recomputed[k], 3e-5),
            );
        }
        let exact = LineSolution { length, ..LINE };
        let nonlocal = Reference::new(&exact, &cloud, H, STEPS);
        let distance = nonlocal.distance(&Reference::new(&string, &cloud, H, STEPS));
        gaps.push(distance);
        rows.push(
            Row::new(format!("exact, l = {length}"), "", Some(distance)).within_share(gap, 1e-5),
        );
    }
    rows.push(
        Row::new("exact: order in l", "", Some((gaps[1] / gaps[2]).log2()))
            .within(2.0, 0.02)
            .note(
                "MSV looks faster and MMI slower only because of errors in time of opposite sign",
            ),
    );
    Ok(rows)
}
