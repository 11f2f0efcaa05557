//! What `check` says of two time steps in one body: whether they will pay.

use pericles_run::refinement::{Comparison, RefinementFacts};
use pericles_run::units::{count, percent, quantity, significant};
use serde_json::json;

use super::line::Line;

/// The lines of `check` about two time steps.
pub(super) fn lines(
    facts: &RefinementFacts,
    scheme: &str,
    dt: f64,
    comparison: &Comparison,
) -> Vec<Line> {
    let fine_dt = dt / f64::from(facts.ratio);
    let frequencies = match (facts.omega_dt, facts.omega_dt_fine) {
        (Some(coarse), Some(fine)) => format!("; ω dt {coarse:.2} coarse, {fine:.2} fine"),
        _ => String::new(),
    };
    let plain = plain_name(scheme);
    let following = if facts.follows_damage {
        " at the start, more as bonds come near to breaking"
    } else {
        ""
    };
    let steps = format!(
        "{} and {} for {} of the points{following}{frequencies}",
        quantity(dt, "s"),
        quantity(fine_dt, "s"),
        percent(facts.fine_fraction),
    );
    let zones = format!(
        "{} points with the fine step, {} with the coarse step, {} of them next to fine ones",
        count(facts.fine_points),
        count(facts.coarse_points),
        count(facts.border_points),
    );
    let over_uniform = comparison.uniform / comparison.seconds;
    let over_verlet = comparison.verlet / comparison.seconds;
    let cost = format!(
        "{} evaluations per point and step; {plain} with the fine step everywhere {} times that ({} by the clock), velocity-verlet there {} times ({} by the clock)",
        significant(facts.evaluations, 3),
        significant(facts.speed_up, 3),
        significant(over_uniform, 3),
        significant(facts.speed_up_over_verlet, 3),
        significant(over_verlet, 3),
    );
    vec![
        Line::new("two time steps", steps).with("dt_fine", fine_dt),
        Line::new("their zones", zones),
        Line::new("their cost", cost).with(
            "refinement_by_clock",
            json!({ "speed_up": over_uniform, "speed_up_over_verlet": over_verlet }),
        ),
        Line::new("do they pay", verdict(facts, scheme, comparison)),
    ]
}

/// The scheme with one step.
fn plain_name(scheme: &str) -> &str {
    match scheme {
        "respa" => "velocity-verlet",
        name => name.strip_suffix("-mts").unwrap_or(name),
    }
}

fn verdict(facts: &RefinementFacts, scheme: &str, comparison: &Comparison) -> String {
    let needless = facts
        .omega_dt_fine
        .zip(facts.omega_dt)
        // Whole and coarse frequency within a few percent: nothing in the body asks for the smaller step.
        .is_some_and(|(fine, coarse)| fine * f64::from(facts.ratio) < 1.05 * coarse);
    let reason = if needless {
        "coarse and fine points have the same stable step, so the smaller one serves accuracy only"
    } else {
        "the fine points need the smaller step"
    };
    let gain = comparison.verlet / comparison.seconds;
    let own = facts
        .speed_up_over_stable_verlet
        .filter(|own| *own < 1.0)
        .map_or(String::new(), |own| {
            format!(
                "; velocity-verlet with its own stable step takes {} of the evaluations",
                percent(own)
            )
        });
    if gain > 1.0 {
        format!(
            "yes: {} times faster than velocity-verlet with the fine step everywhere; {reason}{own}",
            significant(gain, 3)
        )
    } else if comparison.uniform > comparison.seconds && scheme != "respa" {
        format!(
            "only for the accuracy of {}: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            plain_name(scheme),
            percent(gain)
        )
    } else {
        format!(
            "no: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            percent(gain)
        )
    }
}
