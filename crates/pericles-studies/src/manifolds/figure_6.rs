//! Peak surface stretch of a sphere pulled at its poles.

use pericles_io::Axis;
use pericles_run::RunError;

use super::course::{chart, run};
use super::presets::{PAPER, POLES, change};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "manifolds/figure-6",
    paper: PAPER,
    title: "Peak surface stretch under a pull at the poles, p = 2",
    run: study,
};

/// α, printed peak, peaks with 38 and with 2 loaded vertices.
const CASES: [(f64, f64, f64, f64); 5] = [
    (0.0001, 1.8e-4, 7.65e-4, 4.08e-5),
    (0.25, 8.27e-5, 4.23e-4, 2.26e-5),
    (0.5, 3.75e-5, 2.23e-4, 1.19e-5),
    (0.75, 1.65e-5, 1.115e-4, 5.96e-6),
    (0.999, 0.8e-5, 5.31e-5, 2.84e-6),
];

fn study(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    let mut courses = Vec::new();
    for (alpha, printed, wide, narrow) in CASES {
        let alpha_is = change("material.alpha", alpha);
        let (simulation, course) = run(POLES, std::slice::from_ref(&alpha_is), |_| Ok(()))?;
        if courses.is_empty() {
            let loaded: usize = simulation
                .system()
                .loads()
                .iter()
                .map(|load| load.points.len())
                .sum();
            rows.push(
                Row::new("loaded vertices, |z| ≥ 0.95", "", Some(loaded as f64)).within(38.0, 0.0),
            );
        }
        rows.push(
            Row::new(format!("peak stretch, |z| ≥ 0.95, α = {alpha}"), "", Some(course.peak()))
                .printed(printed)
                .within_share(wide, 0.01)
                .note("how the load is spread is not printed; no rule that was tried gives the printed peaks for all α"),
        );
        courses.push((format!("α = {alpha}"), course));
        let changes = [
            alpha_is,
            change("sets.north.half_space.point", "[0, 0, 0.999]"),
            change("sets.south.half_space.point", "[0, 0, -0.999]"),
        ];
        let (_, course) = run(POLES, &changes, |_| Ok(()))?;
        rows.push(
            Row::new(
                format!("peak stretch, the two poles, α = {alpha}"),
                "",
                Some(course.peak()),
            )
            .printed(printed)
            .within_share(narrow, 0.01),
        );
    }
    let stronger = [
        change("load.0.traction", "[0, 0, 1e-4]"),
        change("load.1.traction", "[0, 0, -1e-4]"),
    ];
    let (simulation, _) = run(POLES, &stronger, |_| Ok(()))?;
    let (reference, _) = run(POLES, &[], |_| Ok(()))?;
    let ratio = largest(&reference.state().u) / largest(&simulation.state().u);
    rows.push(
        Row::new("displacement under ten times the load over that under one", "", Some(ratio))
            .within_share(10.0, 1e-4)
            .note("p = 2 is linear: a load of 0.1 cannot damage what one of 0.001 does not, as is printed"),
    );
    let curves: Vec<_> = courses
        .iter()
        .map(|(label, course)| (label.clone(), &course.t[..], &course.stretch[..]))
        .collect();
    chart(
        context,
        "stretch.png",
        "sphere pulled at its poles, 0.001 per area, standard preset",
        Axis::new("surface stretch", ""),
        &curves,
    )?;
    Ok(rows)
}

fn largest(u: &[f64]) -> f64 {
    u.iter().fold(0.0, |most, x| most.max(x.abs()))
}
