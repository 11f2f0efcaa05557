//! Named scalars of a run: the columns of its tables and the quantities derived from them.
//!
//! A registry lists the sources of the scalars that depend on the current state alone, so that tables, derived
//! quantities and stop conditions have the same values whatever their schedules are. Columns that depend on earlier
//! rows (errors so far, the energy bound) are not signals.

mod stop;

use std::fmt;
use std::sync::Arc;

use pericles::System;
use pericles::observe::{ObserveError, Probe, Snapshot, TrackedCrack};
use pericles::space::PointCloud;
use pericles::time::Integrator;
use pericles::units::BodyUnits;
use pericles_deck::{
    BuildError, DerivedQuantity, Fault, KeyPath, Model, Remark, Scheme, SignalExpression,
    StaticBreaking,
};
use pericles_io::observers::{
    ContactColumns, CrackSignals, EnergySignals, ExtremeColumns, ImpactorSignals, InnerColumns,
    LoadFactorColumn, ProbeSignals, ReactionSignals, Signals, TimeSignal,
};
use pericles_io::{Cell, Column};

use crate::heat::HeatColumns;

pub(crate) use self::stop::SignalStop;

/// The scalars of a run by name.
pub struct SignalRegistry {
    sources: Vec<Source>,
    /// Columns of all sources, in their order.
    columns: Vec<Column>,
    quantities: Vec<Quantity>,
    units: BodyUnits,
}

/// A source and the index of its first column.
struct Source {
    signals: Box<dyn Signals>,
    first: usize,
}

/// A derived quantity.
struct Quantity {
    name: String,
    unit: String,
    /// The unit if the units of forces and energies are those of the whole body.
    whole: String,
    value: Bound,
}

/// An expression with the indices of its names.
#[derive(Debug, Clone)]
struct Bound {
    expression: SignalExpression,
    names: Vec<usize>,
}

impl Bound {
    fn value(&self, values: &[f64]) -> f64 {
        let given: Vec<f64> = self.names.iter().map(|&k| values[k]).collect();
        self.expression.value(&given)
    }
}

/// Returns the signals in the history of a model after the energies: those of the scheme, and those of fields and contact.
pub(crate) fn history_signals(
    model: &Model,
    system: &System,
    integrator: &dyn Integrator,
) -> [Vec<Box<dyn Signals>>; 2] {
    let mut of_scheme: Vec<Box<dyn Signals>> = Vec::new();
    if integrator.inner_iterations().is_some() {
        of_scheme.push(Box::new(match model.time.scheme {
            Scheme::AdaptiveDynamicRelaxation { .. } | Scheme::Fire(_) | Scheme::Static(_) => {
                InnerColumns::Residual
            }
            _ => InnerColumns::Velocity,
        }));
    }
    if scales_loads(model) {
        of_scheme.push(Box::new(LoadFactorColumn));
    }
    let mut of_state: Vec<Box<dyn Signals>> = Vec::new();
    let extremes = &model.output.history.extremes;
    if !extremes.is_empty() {
        let columns = ExtremeColumns::new(extremes.clone(), system.dimension());
        of_state.push(Box::new(columns));
    }
    if let Some(columns) = HeatColumns::of(system) {
        of_state.push(Box::new(columns));
    }
    if system.interactions().next().is_some() {
        of_state.push(Box::new(ContactColumns {
            units: system.cloud().body_units(),
        }));
    }
    [of_scheme, of_state]
}

/// Returns whether the scheme determines the factor of the loads, so that they are not proportional to time.
pub(crate) fn scales_loads(model: &Model) -> bool {
    breaks_by_events(model)
        || matches!(&model.time.scheme, Scheme::Static(options) if options.control.is_some())
}

/// Returns whether a static scheme finds the loads at which each bond breaks.
pub(crate) fn breaks_by_events(model: &Model) -> bool {
    matches!(
        &model.time.scheme,
        Scheme::Static(options) if options.breaking == StaticBreaking::Event
    )
}

/// Returns the impactors of a model as signals; `None` without impactors.
pub(crate) fn impactor_signals(model: &Model, cloud: &PointCloud) -> Option<ImpactorSignals> {
    let impactors = model.impactors.iter().map(|impactor| impactor.name.clone());
    let names: Vec<String> = impactors.collect();
    (!names.is_empty()).then_some(ImpactorSignals {
        names,
        dimension: cloud.dimension(),
        units: cloud.body_units(),
    })
}

impl SignalRegistry {
    /// Creates the registry of a model with its derived quantities.
    ///
    /// # Errors
    /// A quantity refers to an unknown column, has the name of another column, or has no unit.
    pub(crate) fn of(
        model: &Model,
        (system, integrator): (&System, &dyn Integrator),
        probes: &[Probe],
        cracks: &[TrackedCrack],
    ) -> Result<Self, BuildError> {
        let dimension = system.dimension();
        let mut registry = Self {
            sources: Vec::new(),
            columns: Vec::new(),
            quantities: Vec::new(),
            units: system.cloud().body_units(),
        };
        registry.add(Box::new(TimeSignal));
        registry.add(Box::new(EnergySignals {
            dimension,
            units: system.cloud().body_units(),
        }));
        let of_history = history_signals(model, system, integrator);
        (of_history.into_iter().flatten()).for_each(|signals| registry.add(signals));
        registry.add(Box::new(ProbeSignals {
            probes: probes.to_vec(),
            dimension,
        }));
        registry.add(Box::new(ReactionSignals::new(system)));
        if let Some(impactors) = impactor_signals(model, system.cloud()) {
            registry.add(Box::new(impactors));
        }
        if system.operator().can_break() {
            let threshold = model.output.cracks.threshold;
            let cracks = CrackSignals::new(cracks.to_vec(), threshold, dimension);
            registry.add(Box::new(cracks));
        }
        for (k, quantity) in model.output.quantities.iter().enumerate() {
            let path = KeyPath::from("output.quantity").index(k);
            registry.derive(quantity, &path)?;
        }
        Ok(registry)
    }

    /// Creates the registry of the displacements of probes and of the quantities that are derived from them alone.
    pub(crate) fn of_probes(model: &Model, probes: &[Probe]) -> Self {
        let mut registry = Self {
            sources: Vec::new(),
            columns: Vec::new(),
            quantities: Vec::new(),
            units: BodyUnits::of(3, 1.0),
        };
        registry.add(Box::new(ProbeSignals {
            probes: probes.to_vec(),
            dimension: model.body.dimension(),
        }));
        for (k, quantity) in model.output.quantities.iter().enumerate() {
            // Quantities of other columns have errors here.
            let _ = registry.derive(quantity, &KeyPath::from("output.quantity").index(k));
        }
        registry
    }

    /// Returns the names of the signals in metres.
    pub(crate) fn lengths(&self) -> impl Iterator<Item = &str> {
        let is_length = |&k: &usize| SignalExpression::is_same_unit(self.unit(k), "m");
        let count = self.columns.len() + self.quantities.len();
        (0..count).filter(is_length).map(|k| self.name(k))
    }

    /// Returns the index of a signal in metres; `None` if there is none with this name.
    pub(crate) fn length(&self, name: &str) -> Option<usize> {
        let index = self.index(name, &KeyPath::from("")).ok()?;
        SignalExpression::is_same_unit(self.unit(index), "m").then_some(index)
    }

    /// Evaluates a signal. All processes call it together.
    pub(crate) fn value(&self, snapshot: &Snapshot<'_>, index: usize) -> Result<f64, ObserveError> {
        Ok(self.values(snapshot, &[index])?[index])
    }

    fn add(&mut self, signals: Box<dyn Signals>) {
        let first = self.columns.len();
        self.columns.extend(signals.columns());
        self.sources.push(Source { signals, first });
    }

    /// Adds a quantity.
    fn derive(&mut self, quantity: &DerivedQuantity, path: &KeyPath) -> Result<(), BuildError> {
        let DerivedQuantity {
            name,
            expression,
            unit,
        } = quantity;
        let fault = |key: &str, fault: Fault| Err(Remark::new(path.key(key), fault).into());
        if self.names().any(|known| known == name) {
            return fault(
                "name",
                Fault::BadName {
                    name: name.clone(),
                    reason: "a column of another table has it",
                    allowed: "allowed: a name that no other table has, such as \"CMOD\"",
                },
            );
        }
        let value = self.bound(expression, &path.key("expression"))?;
        let units: Vec<&str> = value.names.iter().map(|&k| self.unit(k)).collect();
        let wholes: Vec<&str> = value.names.iter().map(|&k| self.whole_unit(k)).collect();
        let whole = expression.unit(&wholes);
        let is_whole = |unit: &str| {
            let whole = whole.as_ref();
            whole.is_ok_and(|whole| SignalExpression::is_same_unit(unit, whole))
        };
        let unit = match (expression.unit(&units), unit) {
            (Ok(derived), None) => derived,
            (Err(_), Some(unit)) => unit.clone(),
            // The thickness of a body without one is 1 m: forces of the whole body have the same numbers.
            (Ok(derived), Some(unit))
                if SignalExpression::is_same_unit(unit, &derived) || is_whole(unit) =>
            {
                unit.clone()
            }
            (Ok(derived), Some(unit)) => {
                let derived = match derived.as_str() {
                    "" => "numbers without a unit",
                    derived => derived,
                };
                return fault(
                    "unit",
                    Fault::OutOfRange {
                        value: unit.clone(),
                        allowed: format!(
                            "allowed: the SI unit of the expression, {derived}, in any notation; remove `unit` to use it"
                        ),
                    },
                );
            }
            (Err(reason), None) => {
                return fault(
                    "expression",
                    Fault::BadExpression {
                        text: expression.text().into(),
                        reason: format!("its unit cannot be derived: {reason}"),
                        allowed: "combine values of equal units, or set `unit`, such as unit = \"N/m\"",
                    },
                );
            }
        };
        self.quantities.push(Quantity {
            name: name.clone(),
            whole: whole.unwrap_or_else(|_| unit.clone()),
            unit,
            value,
        });
        Ok(())
    }

    /// Names of all signals, quantities last.
    fn names(&self) -> impl Iterator<Item = &str> {
        let columns = self.columns.iter().map(Column::name);
        columns.chain(
            self.quantities
                .iter()
                .map(|quantity| quantity.name.as_str()),
        )
    }

    fn name(&self, index: usize) -> &str {
        match self.columns.get(index) {
            Some(column) => column.name(),
            None => &self.quantities[index - self.columns.len()].name,
        }
    }

    fn unit(&self, index: usize) -> &str {
        match self.columns.get(index) {
            Some(column) => column.unit(),
            None => &self.quantities[index - self.columns.len()].unit,
        }
    }

    /// Returns the unit of a signal if those of forces and energies are those of the whole body.
    fn whole_unit(&self, index: usize) -> &str {
        match self.columns.get(index) {
            Some(column) => self.units.whole(column.unit()),
            None => &self.quantities[index - self.columns.len()].whole,
        }
    }

    fn bound(&self, expression: &SignalExpression, path: &KeyPath) -> Result<Bound, BuildError> {
        let names = expression.names().iter();
        let names: Result<Vec<usize>, BuildError> =
            names.map(|name| self.index(name, path)).collect();
        Ok(Bound {
            expression: expression.clone(),
            names: names?,
        })
    }

    /// Returns the index of a signal.
    fn index(&self, name: &str, path: &KeyPath) -> Result<usize, BuildError> {
        let is_named = |known: &&str| Column::real(*known, "").is_named(name);
        let mut found = self
            .names()
            .enumerate()
            .filter(|(_, known)| is_named(known));
        let fault = match (found.next(), found.next()) {
            (Some((index, _)), None) => return Ok(index),
            (Some(_), Some(_)) => Fault::BadName {
                name: name.into(),
                reason: "several tables have a column with this name",
                allowed: "rename the probe, set or impactor to which one of them belongs",
            },
            (None, _) => {
                let known: Vec<&str> = self.names().collect();
                Fault::unknown_word("column", name, known.into_iter())
            }
        };
        Err(Remark::new(path.clone(), fault).into())
    }

    /// Evaluates the signals with these indices, and those that they are derived from; others are NaN. All processes call
    /// it together.
    fn values(&self, snapshot: &Snapshot<'_>, wanted: &[usize]) -> Result<Vec<f64>, ObserveError> {
        let count = self.columns.len();
        let mut is_needed = vec![false; count + self.quantities.len()];
        wanted.iter().for_each(|&k| is_needed[k] = true);
        for (k, quantity) in self.quantities.iter().enumerate().rev() {
            if is_needed[count + k] {
                quantity
                    .value
                    .names
                    .iter()
                    .for_each(|&k| is_needed[k] = true);
            }
        }
        let mut values = vec![f64::NAN; is_needed.len()];
        for (k, source) in self.sources.iter().enumerate() {
            let end = self.sources.get(k + 1).map_or(count, |next| next.first);
            if !is_needed[source.first..end].contains(&true) {
                continue;
            }
            let cells = source.signals.cells(snapshot)?;
            for (value, cell) in values[source.first..end].iter_mut().zip(cells) {
                *value = match cell {
                    Cell::Real(value) => value,
                    Cell::Integer(value) => value as f64,
                };
            }
        }
        for (k, quantity) in self.quantities.iter().enumerate() {
            if is_needed[count + k] {
                values[count + k] = quantity.value.value(&values);
            }
        }
        Ok(values)
    }

    /// Returns the indices of all quantities.
    fn derived(&self) -> Vec<usize> {
        (self.columns.len()..self.columns.len() + self.quantities.len()).collect()
    }

    /// Returns whether the model has derived quantities.
    pub(crate) fn has_quantities(&self) -> bool {
        !self.quantities.is_empty()
    }
}

impl fmt::Debug for SignalRegistry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

/// The derived quantities of a run, as signals.
pub(crate) struct QuantitySignals(pub(crate) Arc<SignalRegistry>);

impl Signals for QuantitySignals {
    fn columns(&self) -> Vec<Column> {
        let quantities = self.0.quantities.iter();
        quantities
            .map(|quantity| Column::real(quantity.name.as_str(), quantity.unit.as_str()))
            .collect()
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> Result<Vec<Cell>, ObserveError> {
        let wanted = self.0.derived();
        let values = self.0.values(snapshot, &wanted)?;
        Ok(wanted.into_iter().map(|k| values[k].into()).collect())
    }
}
