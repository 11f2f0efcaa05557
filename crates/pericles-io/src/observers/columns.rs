//! Optional columns of histories.
//!
//! Every scalar time history is a column of `history.csv`: inner iterations, errors against a known solution, bounds
//! of the energy.

use pericles::Checkpointed;
use pericles::observe::{Field, ObserveError, Snapshot};
use pericles::space::PointSet;
use pericles::units::BodyUnits;
use pericles_manifold::EnergyInequality;
use pericles_waves::exact::{ExactSolution, SolutionError};

use super::picture_of::{name_of, scalar_of};
use super::signals::Signals;
use super::table::whole;
use crate::csv::{Cell, Column};

/// Additional columns of a [`History`](super::History) that depend on earlier states; [`Signals`] do not.
pub trait HistoryColumns: Checkpointed + Send {
    /// Returns their names and units.
    fn columns(&self) -> Vec<Column>;

    /// Returns their cells for a state.
    ///
    /// # Errors
    /// They cannot be computed.
    fn cells(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError>;
}

/// Columns of schemes with inner iterations: iterations of the last step, and the remaining residual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InnerColumns {
    /// Implicit steps: the last change of velocity.
    Velocity,
    /// Adaptive dynamic relaxation: the residual relative to the acting forces.
    Residual,
}

impl Signals for InnerColumns {
    fn columns(&self) -> Vec<Column> {
        let left = match self {
            Self::Velocity => Column::real("inner_change", "m/s"),
            Self::Residual => Column::real("residual", "1"),
        };
        vec![Column::integer("inner_iterations"), left]
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let inner = snapshot.inner_iterations().unwrap_or_default();
        Ok(vec![whole(inner.last), inner.change.into()])
    }
}

/// Factor of loads and prescribed displacements in a state that a scheme found by scaling them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadFactorColumn;

impl Signals for LoadFactorColumn {
    fn columns(&self) -> Vec<Column> {
        vec![Column::real("load_factor", "1")]
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let factor = snapshot.system().load_factor();
        Ok(vec![factor.unwrap_or(f64::NAN).into()])
    }
}

/// Errors against an exact solution of a bar: the maximum error over selected points (m), its maximum up to
/// now, and the root mean square error relative to that of the solution.
pub struct ErrorColumns {
    solution: Box<dyn ExactSolution>,
    points: PointSet,
    largest: f64,
}

impl ErrorColumns {
    /// Creates columns of the errors against a solution at the given points.
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

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let state = snapshot.state();
        let pick = |field: &[f64]| -> Vec<f64> {
            self.points.iter().map(|&i| field[i as usize]).collect()
        };
        let Some(u) = snapshot.whole(Field::Displacement) else {
            return Ok([f64::NAN; 3].map(Cell::from).to_vec());
        };
        let places = pick(snapshot.whole_cloud().axis(0));
        let mut exact = vec![0.0; places.len()];
        self.solution
            .displacement_into(state.t, &places, &mut exact);
        let error = SolutionError::between(&pick(&u), &exact);
        self.largest = if error.largest.is_nan() {
            f64::NAN
        } else {
            self.largest.max(error.largest)
        };
        let errors = [error.largest, self.largest, error.relative];
        Ok(errors.map(Cell::from).to_vec())
    }
}

pericles::saved! {
    impl Checkpointed for ErrorColumns {
        largest: array("observer/errors/largest"),
        solution, points: fixed,
    }
}

/// Minimum and maximum over the points of fields or field components; vectors and tensors without a component
/// by their norm.
pub struct ExtremeColumns {
    fields: Vec<(Field, Option<usize>)>,
    dimension: usize,
}

impl ExtremeColumns {
    /// Creates columns of the extremes of fields, for a body of the given dimension.
    pub fn new(fields: Vec<(Field, Option<usize>)>, dimension: usize) -> Self {
        Self { fields, dimension }
    }
}

impl Signals for ExtremeColumns {
    fn columns(&self) -> Vec<Column> {
        let named = self.fields.iter().flat_map(|&(field, component)| {
            let name = name_of(field, component, self.dimension);
            ["min", "max"].map(|what| Column::real(format!("{what}_{name}"), field.unit()))
        });
        named.collect()
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let points = snapshot.system().points();
        let extremes = self.fields.iter().flat_map(|&(field, component)| {
            let values = scalar_of(snapshot.field(field), points, component);
            let fold = |start: f64, pick: fn(f64, f64) -> f64| {
                // NaN must not be hidden: it is neither minimum nor maximum.
                values
                    .iter()
                    .fold(start, |found, &value| match value.is_nan() {
                        true => f64::NAN,
                        false if found.is_nan() => found,
                        false => pick(found, value),
                    })
            };
            let domain = snapshot.system().domain();
            [
                -domain.max(-fold(f64::INFINITY, f64::min)),
                domain.max(fold(f64::NEG_INFINITY, f64::max)),
            ]
        });
        Ok(extremes.map(Cell::from).collect())
    }
}

/// Upper bound of kinetic plus elastic energy and the margin below it, J.
pub struct EnergyBoundColumns {
    /// The bound.
    pub inequality: EnergyInequality,
    /// Units of the energies.
    pub units: BodyUnits,
}

impl HistoryColumns for EnergyBoundColumns {
    fn columns(&self) -> Vec<Column> {
        let names = ["energy_bound", "energy_margin"];
        names
            .map(|name| Column::real(name, self.units.unit("J")))
            .into()
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let bound = self.inequality.bound(snapshot);
        let energies = snapshot.energies();
        let margin = bound - energies.kinetic - energies.elastic;
        Ok(vec![bound.into(), margin.into()])
    }
}

pericles::saved! {
    impl Checkpointed for EnergyBoundColumns {
        inequality: part,
        units: fixed,
    }
}
