//! Quadrature on a contour, and residuals at its nodes.

use std::num::NonZeroUsize;

use gauss_quad::GaussLegendre;

use crate::contour::Contour;
use crate::vector::Vector;

/// Residuals of all branches at one wave vector: R_b = rows[b] · α − values[b].
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub k: Vector,
    pub rows: Vec<Vec<f64>>,
    pub values: Vec<f64>,
}

/// Quadrature node on a contour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub k: Vector,
    pub segment: usize,
    /// Arc length.
    pub abscissa: f64,
    pub weight: f64,
}

/// Gauss nodes on every interval between `breaks` (arc lengths) and corners, each divided into `cuts` equal panels.
pub(super) fn places(
    contour: &Contour,
    breaks: &[f64],
    cuts: impl Fn(f64) -> usize,
    nodes: usize,
) -> Vec<Place> {
    let rule = GaussLegendre::new(NonZeroUsize::new(nodes).unwrap_or(NonZeroUsize::MIN));
    let mut all = Vec::new();
    let mut start = 0.0;
    for (number, segment) in contour.segments.iter().enumerate() {
        let length = segment.length();
        let mut edges = vec![0.0, length];
        let inside = breaks.iter().map(|s| s - start);
        edges.extend(inside.filter(|s| *s > 1e-9 * length && *s < (1.0 - 1e-9) * length));
        edges.sort_by(f64::total_cmp);
        for piece in edges.windows(2) {
            let panels = cuts(piece[1] - piece[0]).max(1);
            let width = (piece[1] - piece[0]) / panels as f64;
            for panel in 0..panels {
                let from = piece[0] + width * panel as f64;
                for (node, weight) in rule.as_node_weight_pairs() {
                    let distance = from + 0.5 * width * (node + 1.0);
                    all.push(Place {
                        k: segment.at(distance),
                        segment: number,
                        abscissa: start + distance,
                        weight: 0.5 * width * weight,
                    });
                }
            }
        }
        start += length;
    }
    all
}

/// Composite rule with about `count` panels in total.
pub(super) fn panels(contour: &Contour, count: usize, nodes: usize) -> Vec<Place> {
    let length = contour.length();
    let share = |piece: f64| (count as f64 * piece / length).ceil() as usize;
    places(contour, &[], share, nodes)
}
