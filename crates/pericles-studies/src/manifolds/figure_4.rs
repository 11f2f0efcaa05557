//! Surface stretch for all powers and exponents.

use pericles_io::Axis;
use pericles_run::RunError;

use super::course::{Course, chart, run};
use super::presets::{CALIBRATED, PAPER, STANDARD, change};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "manifolds/figure-4",
    paper: PAPER,
    title: "Surface stretch for p = 2, 3, 5, three α and three speeds",
    run: study,
};

fn changes(p: f64, alpha: f64, speed: f64) -> Vec<String> {
    vec![
        change("material.p", p),
        change("material.alpha", alpha),
        change("initial.0.random_velocity.radius", speed),
    ]
}

fn study(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = spreads()?;
    let (powers, speeds): (&[f64], &[f64]) = if context.full {
        (&[2.0, 3.0, 5.0], &[0.1, 0.5, 1.0])
    } else {
        (&[2.0, 5.0], &[1.0])
    };
    for &p in powers {
        for &speed in speeds {
            let mut courses = Vec::new();
            for alpha in [0.0001, 0.5, 0.999] {
                let (_, course) = run(CALIBRATED, &changes(p, alpha, speed), |_| Ok(()))?;
                let (mean, spread) = second_half(&course);
                let case = format!("p = {p}, α = {alpha}, |v₀| = {speed}");
                let limit = if p == 2.0 { 1e-8 } else { 2e-3 };
                rows.push(
                    Row::new(
                        format!("spread of the energy, {case}"),
                        "",
                        Some(course.energy_spread()),
                    )
                    .within(0.0, limit),
                );
                rows.push(
                    Row::new(format!("mean stretch, second half, {case}"), "", Some(mean)).note(
                        format!(
                            "standard deviation over the mean: {:.2}; depends on the random data",
                            spread / mean.abs()
                        ),
                    ),
                );
                courses.push((format!("α = {alpha}"), course));
            }
            let curves: Vec<_> = courses
                .iter()
                .map(|(label, course)| (label.clone(), &course.t[..], &course.stretch[..]))
                .collect();
            chart(
                context,
                &format!("stretch-p{p}-v{speed}.png"),
                &format!("p = {p}, |v₀| = {speed}, calibrated preset"),
                Axis::new("surface stretch", ""),
                &curves,
            )?;
        }
    }
    Ok(rows)
}

/// For p ≠ 2 the scheme conserves energy to second order only.
fn spreads() -> Result<Vec<Row>, RunError> {
    let mut found = Vec::new();
    for dt in [1e-3, 5e-4, 2.5e-4] {
        let mut changes = changes(3.0, 0.999, 1.0);
        changes.extend([
            change("time.end", 1),
            change("time.dt", dt),
            change("time.tolerance", 1e-11),
        ]);
        found.push(run(STANDARD, &changes, |_| Ok(()))?.1.energy_spread());
    }
    let mut rows = vec![
        Row::new(
            "spread of the energy, standard, p = 3, α = 0.999, dt = 1 ms",
            "",
            Some(found[0]),
        )
        .within(0.0, 2e-3),
    ];
    for (k, label) in [(1, "0.5"), (2, "0.25")] {
        rows.push(
            Row::new(
                format!("the same over that of dt = {label} ms"),
                "",
                Some(found[k - 1] / found[k]),
            )
            .within_share(4.0, 0.1)
            .note("second order"),
        );
    }
    Ok(rows)
}

/// Mean and standard deviation of the stretch in the second half of a run.
fn second_half(course: &Course) -> (f64, f64) {
    let half = &course.stretch[course.stretch.len() / 2..];
    let mean = half.iter().sum::<f64>() / half.len() as f64;
    let square = half.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / half.len() as f64;
    (mean, square.sqrt())
}
