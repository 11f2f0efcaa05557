//! Columns that only some histories have.

use pericles::observe::{Field, Snapshot};
use pericles::space::PointSet;
use pericles::{Archive, Result, Saved};
use pericles_manifold::EnergyInequality;
use pericles_waves::exact::{ExactSolution, Miss};

use super::pictures::{name_of, scalar_of};
use super::table::whole;
use crate::csv::{Cell, Column};

/// More columns of a [`History`](super::History).
pub trait HistoryColumns: Saved + Send {
    /// Their names and units.
    fn columns(&self) -> Vec<Column>;

    /// Their cells at a state.
    fn cells(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell>;
}

/// Of schemes with inner iterations: the iterations of the last step, and what was left at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InnerColumns {
    /// Implicit steps: the last change of the velocity.
    Velocity,
    /// Relaxation: the forces out of balance over those that act.
    Residual,
}

impl HistoryColumns for InnerColumns {
    fn columns(&self) -> Vec<Column> {
        let left = match self {
            Self::Velocity => Column::real("inner_change", "m/s"),
            Self::Residual => Column::real("residual", "1"),
        };
        vec![Column::integer("inner_iterations"), left]
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell> {
        let inner = snapshot.inner_iterations().unwrap_or_default();
        vec![whole(inner.last), inner.change.into()]
    }
}

/// A choice of columns has no state.
impl Saved for InnerColumns {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> Result<()> {
        Ok(())
    }
}

/// The distance from a known solution of a bar: the largest error over the points that count (m), the largest of that so far, and the root mean square error over that of the
/// solution.
pub struct ErrorColumns {
    solution: Box<dyn ExactSolution>,
    points: PointSet,
    largest: f64,
}

impl ErrorColumns {
    /// Errors against a solution, at some points.
    pub fn new(solution: Box<dyn ExactSolution>, points: PointSet) -> Self {
        Self {
            solution,
            points,
            largest: 0.0,
        }
    }
}

impl HistoryColumns for ErrorColumns {
    fn columns(&self) -> Vec<Column> {
        vec![
            Column::real("error", "m"),
            Column::real("error_so_far", "m"),
            Column::real("error_relative", "1"),
        ]
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell> {
        let state = snapshot.state();
        let pick = |field: &[f64]| -> Vec<f64> {
            self.points.iter().map(|&i| field[i as usize]).collect()
        };
        let places = pick(snapshot.system().cloud().axis(0));
        let mut exact = vec![0.0; places.len()];
        self.solution
            .displacement_into(state.t, &places, &mut exact);
        let miss = Miss::between(&pick(&state.u), &exact);
        self.largest = if miss.largest.is_nan() {
            f64::NAN
        } else {
            self.largest.max(miss.largest)
        };
        [miss.largest, self.largest, miss.relative]
            .map(Cell::from)
            .to_vec()
    }
}

pericles::saved! {
    impl Saved for ErrorColumns {
        largest: array("observer/errors/largest"),
        solution, points: fixed,
    }
}

/// The least and the greatest value over the points of fields, or of components of them; of a vector or tensor without a component those of its norm.
pub struct ExtremeColumns {
    fields: Vec<(Field, Option<usize>)>,
    dimension: usize,
}

impl ExtremeColumns {
    /// Extremes of these fields of a body of this dimension.
    pub fn new(fields: Vec<(Field, Option<usize>)>, dimension: usize) -> Self {
        Self { fields, dimension }
    }
}

impl HistoryColumns for ExtremeColumns {
    fn columns(&self) -> Vec<Column> {
        let named = self.fields.iter().flat_map(|&(field, component)| {
            let name = name_of(field, component, self.dimension);
            ["min", "max"].map(|what| Column::real(format!("{what}_{name}"), field.unit()))
        });
        named.collect()
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell> {
        let points = snapshot.system().points();
        let extremes = self.fields.iter().flat_map(|&(field, component)| {
            let values = scalar_of(snapshot.field(field), points, component);
            let fold = |start: f64, pick: fn(f64, f64) -> f64| {
                // A value that is no number must show: it is neither least nor greatest.
                values
                    .iter()
                    .fold(start, |found, &value| match value.is_nan() {
                        true => f64::NAN,
                        false if found.is_nan() => found,
                        false => pick(found, value),
                    })
            };
            [
                fold(f64::INFINITY, f64::min),
                fold(f64::NEG_INFINITY, f64::max),
            ]
        });
        extremes.map(Cell::from).collect()
    }
}

pericles::saved! {
    impl Saved for ExtremeColumns {
        fields, dimension: fixed,
    }
}

/// What kinetic plus elastic energy cannot exceed, and by how much they stay below it, J.
pub struct EnergyBoundColumns(pub EnergyInequality);

impl HistoryColumns for EnergyBoundColumns {
    fn columns(&self) -> Vec<Column> {
        vec![
            Column::real("energy_bound", "J"),
            Column::real("energy_margin", "J"),
        ]
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell> {
        let bound = self.0.bound(snapshot);
        let energies = snapshot.energies();
        vec![
            bound.into(),
            (bound - energies.kinetic - energies.elastic).into(),
        ]
    }
}

impl Saved for EnergyBoundColumns {
    fn save(&self, archive: &mut Archive) {
        let Self(inequality) = self;
        inequality.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let Self(inequality) = self;
        inequality.restore(archive)
    }
}
