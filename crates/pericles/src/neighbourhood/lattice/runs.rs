//! Runs of points in the rows of a divided or periodic body.

use std::ops::Range;

use super::rows::NodeRows;
use crate::domain::Field;

/// Consecutive nodes of a row with consecutive points, all own points or all ghosts.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// Column of the first node along x.
    column: u32,
    /// First point; ghosts are numbered after own points.
    point: u32,
    length: u32,
}

/// Points of the nodes of rows. Values of own points and ghosts, which are stored apart and in the order of points, are copied to
/// rows run by run.
#[derive(Debug, Clone)]
pub struct PointRuns {
    runs: Vec<Run>,
    /// First run of each row, followed by the number of runs.
    start: Vec<u32>,
    owned: u32,
}

impl PointRuns {
    /// Finds the runs of rows of nodes with the given points, of which those below `owned` are own points.
    pub fn new(rows: &NodeRows, points: &[u32], owned: usize) -> Self {
        let owned = owned as u32;
        let mut runs: Vec<Run> = Vec::new();
        let mut start = vec![0];
        for row in 0..rows.rows() {
            let first = runs.len();
            for node in rows.row(row) {
                let (column, point) = (rows.column(row, node) as u32, points[node]);
                match runs[first..].last_mut() {
                    Some(run)
                        if run.column + run.length == column
                            && run.point + run.length == point
                            && point != owned =>
                    {
                        run.length += 1;
                    }
                    _ => runs.push(Run {
                        column,
                        point,
                        length: 1,
                    }),
                }
            }
            start.push(runs.len() as u32);
        }
        Self { runs, start, owned }
    }

    /// Copies component `c` of `components` of a vector field to a piece of a row that begins at column `x`, and converts the
    /// numbers; places without a node are unchanged.
    pub fn pad_piece<N>(
        &self,
        (row, x): (usize, usize),
        field: Field<'_>,
        (c, components): (usize, usize),
        number: &impl Fn(f64) -> N,
        padded: &mut [N],
    ) {
        let component = |values: &'_ [f64]| {
            let length = values.len() / components;
            c * length..(c + 1) * length
        };
        let own = &field.owned[component(field.owned)];
        let ghosts = &field.ghosts[component(field.ghosts)];
        let runs = &self.runs[self.start[row] as usize..self.start[row + 1] as usize];
        let first = runs.partition_point(|run| (run.column + run.length) as usize <= x);
        for run in &runs[first..] {
            let Range { start, end } = (run.column as usize).max(x)
                ..((run.column + run.length) as usize).min(x + padded.len());
            if start >= end {
                break;
            }
            let values = match run.point.checked_sub(self.owned) {
                None => &own[run.point as usize..],
                Some(ghost) => &ghosts[ghost as usize..],
            };
            let values = &values[start - run.column as usize..][..end - start];
            for (place, &value) in padded[start - x..end - x].iter_mut().zip(values) {
                *place = number(value);
            }
        }
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.runs[..]) + size_of_val(&self.start[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_copy_own_points_and_ghosts_to_their_columns() {
        // Two rows of 12 nodes. Own points 0 to 4, ghosts 5 to 8; the last node is an image of point 0.
        let nodes = [1, 2, 3, 6, 7, 13, 14, 16, 17, 23];
        let points = [5, 0, 1, 2, 6, 3, 4, 7, 8, 0];
        let rows = NodeRows::new([12, 2, 1], &nodes);
        let runs = PointRuns::new(&rows, &points, 5);
        let owned: Vec<f64> = (0..10).map(f64::from).collect();
        let ghosts: Vec<f64> = (100..108).map(f64::from).collect();
        let field = Field::new(&owned, &ghosts);
        for c in 0..2 {
            for x in 0..12 {
                for length in 0..=12 - x {
                    for row in 0..2 {
                        let mut piece = vec![-1.0; length];
                        runs.pad_piece((row, x), field, (c, 2), &|value| value, &mut piece);
                        let expected: Vec<f64> = (x..x + length)
                            .map(|column| {
                                let node = (12 * row + column) as u32;
                                let found = nodes.iter().position(|&one| one == node);
                                found.map_or(-1.0, |k| field.entry(2, c, points[k] as usize))
                            })
                            .collect();
                        assert_eq!(piece, expected, "row {row}, columns {x} + {length}");
                    }
                }
            }
        }
    }
}
