//! Lines of `check` about multirate schemes: zones, cost and expected speed-up.

use pericles_run::refinement::{Comparison, RefinementFacts};
use pericles_run::units::{count, percent, quantity, significant};
use pericles_run::{Facts, Section};
use serde_json::json;

/// Adds the lines about a multirate scheme.
pub(super) fn add_lines(
    all: &mut Facts,
    facts: &RefinementFacts,
    (scheme, dt): (&str, f64),
    comparison: &Comparison,
) {
    let fine_dt = dt / f64::from(facts.ratio);
    let frequencies = match (facts.omega_dt, facts.omega_dt_fine) {
        (Some(coarse), Some(fine)) => format!("; ω dt {coarse:.2} coarse, {fine:.2} fine"),
        _ => String::new(),
    };
    let plain = plain_name(scheme);
    let following = if facts.follows_damage {
        " at the start, increasing where bonds approach failure"
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
        "{} points with the fine step, {} with the coarse step, of which {} interact with fine points",
        count(facts.fine_points),
        count(facts.coarse_points),
        count(facts.border_points),
    );
    let over_uniform = comparison.uniform / comparison.seconds;
    let over_verlet = comparison.verlet / comparison.seconds;
    let cost = format!(
        "{} force evaluations per point and step; with the fine step everywhere {plain} needs {} times as many ({} times the measured time), velocity-verlet {} times ({} times the measured time)",
        significant(facts.evaluations, 3),
        significant(facts.speed_up, 3),
        significant(over_uniform, 3),
        significant(facts.speed_up_over_verlet, 3),
        significant(over_verlet, 3),
    );
    all.line(Section::Cost, "multirate steps", steps)
        .checked("dt_fine", "s", fine_dt);
    all.line(Section::Cost, "multirate zones", zones);
    all.line(Section::Cost, "multirate cost", cost).checked(
        "refinement_by_clock",
        "",
        json!({ "speed_up": over_uniform, "speed_up_over_verlet": over_verlet }),
    );
    all.line(
        Section::Cost,
        "net speed-up",
        verdict(facts, scheme, comparison),
    );
}

/// Returns the name of the scheme with a single time step.
fn plain_name(scheme: &str) -> &str {
    match scheme {
        "respa" => "velocity-verlet",
        name => name.strip_prefix("multirate-").unwrap_or(name),
    }
}

fn verdict(facts: &RefinementFacts, scheme: &str, comparison: &Comparison) -> String {
    let needless = facts
        .omega_dt_fine
        .zip(facts.omega_dt)
        // The frequencies of the body and of its coarse part agree within a few percent: no point needs the smaller
        // step.
        .is_some_and(|(fine, coarse)| fine * f64::from(facts.ratio) < 1.05 * coarse);
    let reason = if needless {
        "coarse and fine points have the same stable step, so the smaller step only improves accuracy"
    } else {
        "the fine points need the smaller step for stability"
    };
    let gain = comparison.verlet / comparison.seconds;
    let own = facts
        .speed_up_over_stable_verlet
        .filter(|own| *own < 1.0)
        .map_or(String::new(), |own| {
            format!(
                "; velocity-verlet with its own stable step needs {} of the force evaluations",
                percent(own)
            )
        });
    if gain > 1.0 {
        format!(
            "{} times faster than velocity-verlet with the fine step everywhere; {reason}{own}",
            significant(gain, 3)
        )
    } else if comparison.uniform > comparison.seconds && scheme != "respa" {
        format!(
            "none, except for the accuracy of {}: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            plain_name(scheme),
            percent(gain)
        )
    } else {
        format!(
            "none: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            percent(gain)
        )
    }
}
