//! Runs that approach a limit together.

use super::order::observed_order;
use crate::units::quantity;

/// One run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// m
    pub(super) spacing: f64,
    /// m
    pub(super) horizon: f64,
    /// The number.
    pub(super) value: f64,
}

impl Point {
    /// Rounded, for the horizon is a product of decimal fractions.
    pub(super) fn ratio(&self) -> f64 {
        (1e6 * self.horizon / self.spacing).round() / 1e6
    }
}

/// Runs that approach a limit together, the coarsest first.
pub(super) struct Family {
    /// What they have in common: `m = 3`, `δ = 40.0 mm`.
    pub(super) name: String,
    pub(super) points: Vec<Point>,
}

impl Family {
    /// The observed order at a run: of the distance from the reference since the run before, or of the last three results without one.
    pub(super) fn order(&self, at: usize, reference: Option<f64>) -> Option<f64> {
        let pairs: Vec<(f64, f64)> = self.points[..=at]
            .iter()
            .map(|point| (point.spacing, point.value))
            .collect();
        observed_order(&pairs, reference)
    }
}

/// Runs of one horizon, or of one ratio, from coarse to fine.
pub(super) fn families(mut points: Vec<Point>, one_horizon: bool) -> Vec<Family> {
    points.sort_by(|a, b| b.spacing.total_cmp(&a.spacing));
    let mut families: Vec<Family> = Vec::new();
    for point in points {
        let name = if one_horizon {
            format!("δ = {}", quantity(point.horizon, "m"))
        } else {
            format!("m = {}", point.ratio())
        };
        match families.iter_mut().find(|family| family.name == name) {
            Some(family) => family.points.push(point),
            None => families.push(Family {
                name,
                points: vec![point],
            }),
        }
    }
    families.sort_by(|a, b| a.points[0].ratio().total_cmp(&b.points[0].ratio()));
    families
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_told_apart_and_run_from_coarse_to_fine() {
        let point = |spacing: f64, m: f64| Point {
            spacing,
            horizon: m * spacing,
            value: 1.0,
        };
        let all = vec![
            point(0.1, 3.0),
            point(0.05, 2.0),
            point(0.2, 3.0),
            point(0.1, 2.0),
        ];
        let found = families(all, false);
        let names: Vec<&str> = found.iter().map(|family| &family.name[..]).collect();
        assert_eq!(names, ["m = 2", "m = 3"]);
        let spacings: Vec<f64> = found[1].points.iter().map(|point| point.spacing).collect();
        assert_eq!(spacings, [0.2, 0.1]);
        let fixed = vec![point(0.1, 2.0), point(0.05, 4.0)];
        let found = families(fixed, true);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].name, "δ = 200 mm");
    }
}
