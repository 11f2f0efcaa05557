//! Facts, history columns and heat balance of bodies with heat conduction.

use pericles::Simulation;
use pericles::observe::{ObserveError, Snapshot};
use pericles::units::BodyUnits;
use pericles_heat::{DiffusingField, SharedField};
use pericles_io::observers::Signals;
use pericles_io::{Cell, Column};
use serde::Serialize;

/// Properties of heat conduction before the first step; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct HeatFacts {
    /// Time integration scheme.
    pub scheme: &'static str,
    /// Thermal step, s; `None` if the temperature advances with the steps of the body.
    pub step: Option<f64>,
    /// Largest stable step of the explicit scheme at the start, s.
    pub explicit_limit: f64,
    /// Heat content ρ c V T of the initial temperature, J.
    pub content: f64,
    /// Share of the dissipated energy that becomes heat.
    pub dissipation: f64,
    /// Conducting bonds, each counted from both ends.
    pub directed_bonds: u64,
}

impl HeatFacts {
    pub(crate) fn of(field: &SharedField) -> Self {
        let options = field.options();
        Self {
            scheme: options.scheme.name(),
            step: options.step,
            explicit_limit: field.explicit_limit(0.0),
            content: field.initial_content(),
            dissipation: options.dissipation,
            directed_bonds: field.with_problem(|problem| problem.diffusion().directed_bonds()),
        }
    }
}

/// Heat that has flowed into the body through the conditions of a set.
#[derive(Debug, Clone, Serialize)]
pub struct Inflow {
    /// The set.
    pub set: String,
    /// Heat since the start, J.
    pub heat: f64,
}

/// Heat balance at the end of a run.
#[derive(Debug, Clone, Serialize)]
pub struct HeatBalance {
    /// Heat content ρ c V T at the end, J.
    pub content: f64,
    /// Heat content at the start, J.
    pub initial_content: f64,
    /// Heat through the conditions of each set.
    pub inflows: Vec<Inflow>,
    /// Heat from energy dissipated by the body, J; `None` if dissipated energy does not become heat.
    pub from_dissipation: Option<f64>,
    /// Heat that points brought when they became active, J; `None` if they keep their temperatures.
    pub from_activation: Option<f64>,
    /// Content minus initial content minus all inflows and heat from dissipation and activation, J; `None` for steady states, whose change of content is not
    /// followed.
    pub balance: Option<f64>,
    /// The balance relative to the heat content.
    pub balance_relative: Option<f64>,
    /// Lowest temperature, K.
    pub lowest: f64,
    /// Highest temperature, K.
    pub highest: f64,
    /// Products with the conductances since the start.
    pub products: u64,
    /// Largest number of products of the solution of a linear system.
    pub most_products: u64,
}

impl HeatBalance {
    /// Returns the heat balance of a simulation, if its body conducts heat.
    pub fn of(simulation: &Simulation) -> Option<Self> {
        let field = of_system(simulation.system())?;
        let t = simulation.state().t;
        let (content, initial_content) = (field.content(t), field.initial_content());
        let inflows = inflows(&field, t);
        let total: f64 = inflows.iter().map(|inflow| inflow.heat).sum();
        let from_dissipation = field.heat_from_dissipation();
        let from_activation = field.content_of_new_points();
        let generated = from_dissipation.unwrap_or_default() + from_activation.unwrap_or_default();
        let balance = content - initial_content - total - generated;
        let is_steady = field.options().scheme == pericles_heat::Scheme::Steady;
        let scale = inflows.iter().map(|inflow| inflow.heat.abs()).sum::<f64>();
        let scale = scale.max(content.abs()).max(generated.abs());
        let scale = scale.max(f64::MIN_POSITIVE);
        let [lowest, highest] = field.range(t);
        let effort = field.effort();
        Some(Self {
            content,
            initial_content,
            inflows,
            from_dissipation,
            from_activation,
            balance: (!is_steady).then_some(balance),
            balance_relative: (!is_steady).then_some(balance / scale),
            lowest,
            highest,
            products: effort.total,
            most_products: effort.most,
        })
    }
}

/// Returns the computed temperature of a system.
fn of_system(system: &pericles::System) -> Option<SharedField> {
    let mut fields = system.fields();
    fields.find_map(|field| {
        field
            .downcast_ref::<DiffusingField>()
            .map(DiffusingField::shared)
    })
}

/// Returns the inflow through the conditions of each set, in the order of their first condition.
fn inflows(field: &SharedField, t: f64) -> Vec<Inflow> {
    let mut inflows: Vec<Inflow> = Vec::new();
    let flows = field.flows(t);
    let sets = field.with_problem(|problem| {
        let names = problem.conditions().iter().map(|one| one.name.clone());
        names.collect::<Vec<_>>()
    });
    for (set, heat) in sets.into_iter().zip(flows) {
        match inflows.iter_mut().find(|inflow| inflow.set == set) {
            Some(inflow) => inflow.heat += heat,
            None => inflows.push(Inflow { set, heat }),
        }
    }
    inflows
}

/// Columns of bodies with heat conduction: heat content, heat through the conditions of each set and from dissipated
/// energy since the start, and the extremes of the temperature.
pub(crate) struct HeatColumns {
    field: SharedField,
    units: BodyUnits,
}

impl HeatColumns {
    /// Returns the columns of a system, if its body conducts heat.
    pub(crate) fn of(system: &pericles::System) -> Option<Self> {
        let units = system.cloud().body_units();
        of_system(system).map(|field| Self { field, units })
    }
}

impl Signals for HeatColumns {
    fn columns(&self) -> Vec<Column> {
        let unit = self.units.unit("J");
        let heat = |name: String| Column::real(name, unit.as_str());
        let mut columns = vec![heat("heat_content".into())];
        for inflow in inflows(&self.field, 0.0) {
            columns.push(heat(format!("heat_through_{}", inflow.set)));
        }
        if self.field.heat_from_dissipation().is_some() {
            columns.push(heat("heat_from_dissipation".into()));
        }
        if self.field.content_of_new_points().is_some() {
            columns.push(heat("heat_from_activation".into()));
        }
        columns.extend(
            ["lowest_temperature", "highest_temperature"].map(|name| Column::real(name, "K")),
        );
        columns
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> Result<Vec<Cell>, ObserveError> {
        let t = snapshot.state().t;
        let heats = inflows(&self.field, t)
            .into_iter()
            .map(|inflow| inflow.heat);
        let mut cells = vec![Cell::Real(self.field.content(t))];
        cells.extend(heats.map(Cell::Real));
        cells.extend(self.field.heat_from_dissipation().map(Cell::Real));
        cells.extend(self.field.content_of_new_points().map(Cell::Real));
        cells.extend(self.field.range(t).map(Cell::Real));
        Ok(cells)
    }
}
