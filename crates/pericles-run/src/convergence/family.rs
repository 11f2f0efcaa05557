//! Families of runs that converge to the same limit.

use super::Limit;
use super::order::observed_order;
use crate::units::quantity;

/// One run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// Spacing, m.
    pub(super) spacing: f64,
    /// Horizon, m.
    pub(super) horizon: f64,
    /// Time step, s.
    pub(super) dt: f64,
    /// The scalar.
    pub(super) value: f64,
}

impl Point {
    /// Returns the ratio of horizon to spacing, rounded because the horizon is a product of decimal fractions.
    pub(super) fn ratio(&self) -> f64 {
        (1e6 * self.horizon / self.spacing).round() / 1e6
    }
}

/// Runs that converge to the same limit, the coarsest first.
pub(super) struct Family {
    /// The common parameter: `m = 3`, `δ = 40.0 mm`.
    pub(super) name: String,
    pub(super) points: Vec<Point>,
}

impl Family {
    /// Returns the observed order at a run: of the error against the reference since the previous run or, without a
    /// reference, of the last three results.
    pub(super) fn order(&self, at: usize, limit: Limit, reference: Option<f64>) -> Option<f64> {
        let pairs: Vec<(f64, f64)> = self.points[..=at]
            .iter()
            .map(|point| (limit.step(point), point.value))
            .collect();
        observed_order(&pairs, reference)
    }
}

/// Groups runs with the same limit, from coarse to fine.
pub(super) fn families(mut points: Vec<Point>, limit: Limit) -> Vec<Family> {
    points.sort_by(|a, b| limit.step(b).total_cmp(&limit.step(a)));
    let mut families: Vec<Family> = Vec::new();
    for point in points {
        let name = match limit {
            Limit::Local => format!("m = {}", point.ratio()),
            Limit::Nonlocal => format!("δ = {}", quantity(point.horizon, "m")),
            Limit::Time => format!("dx = {}", quantity(point.spacing, "m")),
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
    fn families_are_separated_and_ordered_from_coarse_to_fine() {
        let point = |spacing: f64, m: f64| Point {
            spacing,
            horizon: m * spacing,
            dt: 0.1 * spacing,
            value: 1.0,
        };
        let all = vec![
            point(0.1, 3.0),
            point(0.05, 2.0),
            point(0.2, 3.0),
            point(0.1, 2.0),
        ];
        let found = families(all, Limit::Local);
        let names: Vec<&str> = found.iter().map(|family| &family.name[..]).collect();
        assert_eq!(names, ["m = 2", "m = 3"]);
        let spacings: Vec<f64> = found[1].points.iter().map(|point| point.spacing).collect();
        assert_eq!(spacings, [0.2, 0.1]);
        let fixed = vec![point(0.1, 2.0), point(0.05, 4.0)];
        let found = families(fixed, Limit::Nonlocal);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].name, "δ = 200 mm");
        let steps = vec![point(0.1, 2.0), point(0.1, 2.0)];
        let found = families(steps, Limit::Time);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].name, "dx = 100 mm");
    }
}
