//! A diffusing field as a secondary field of a system.
//!
//! Values do not depend on earlier evaluations: the field at a time after the accepted state is one step, or several
//! sub-steps of fixed length, from that state, and is kept for the last requested time only. Steps of a given length
//! end at fixed multiples of it, between which the field is linear in time.

mod shared;

use std::sync::{Arc, Mutex};

use pericles::archive::Layout;
use pericles::operator::Force;
use pericles::space::check_length;
use pericles::{
    Archive, BodyStep, Checkpointed, PericlesError, Result, SecondaryField, Values, positive,
};
use pericles_statics::MOST_REPLICATED;

use crate::advance::{Flows, Scheme, Span, advance};
use crate::dissipation::Dissipation;
use crate::error::HeatError;
use crate::problem::Problem;
use crate::solver::{Effort, Solver};

/// Options of a computed field.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FieldOptions {
    /// Time integration scheme.
    pub scheme: Scheme,
    /// Length of the steps of the field, s, which may be shorter or longer than those of the body; between their ends
    /// the field is linear in time. If `None`, the field advances with the steps of the body.
    pub step: Option<f64>,
    /// Share of the energy that the body dissipates by fracture and inelastic deformation which becomes heat at the
    /// points that dissipate it, 0 to 1.
    pub dissipation: f64,
}

/// A state of the field.
#[derive(Debug, Clone, PartialEq)]
struct Accepted {
    t: f64,
    values: Vec<f64>,
    /// Content that has flowed in by each condition since the start.
    flows: Flows,
    /// Heat from dissipated energy of each point that has not entered the values, J; empty without this heat.
    pending: Vec<f64>,
    /// Effort of the solver from the start to this state.
    effort: Effort,
}

/// The field between two states, linear in time.
#[derive(Debug, Clone, PartialEq)]
struct Interval {
    from: Accepted,
    to: Accepted,
}

struct State {
    problem: Problem,
    options: FieldOptions,
    solver: Solver,
    /// The last accepted interval; a single state at the start.
    accepted: Interval,
    /// The interval after the accepted one that was computed last.
    ahead: Option<Interval>,
    /// Content at the start.
    initial: f64,
    /// Number of changes of the accepted state.
    revision: u64,
    failure: Option<PericlesError>,
    /// Heat from dissipated energy, if any.
    dissipation: Option<Dissipation>,
    /// Values that points take when they become active, if any.
    new: Option<NewPoints>,
}

/// Values of points when they become active.
struct NewPoints {
    /// By own point; `None` for points that keep their value.
    values: Vec<Option<f64>>,
    /// Content that the points have brought so far.
    content: f64,
}

/// A computed field, shared by the system and the forces that depend on it. Values belong to own points, contents, flows and
/// extremes to the whole body: all processes must call its functions together.
#[derive(Clone)]
pub struct SharedField(Arc<Mutex<State>>);

/// A computed field as a part of a system; see [`SecondaryField`].
pub struct DiffusingField {
    shared: SharedField,
}

impl DiffusingField {
    /// Makes a field from its values at own points at the time t. All processes must call it together.
    ///
    /// # Errors
    /// Values that are not one per point; a step that is not positive; a share of dissipated energy outside of its range or with
    /// steady states; [`HeatError::TooManyPoints`].
    pub fn new(problem: Problem, options: FieldOptions, t: f64, values: Vec<f64>) -> Result<Self> {
        let what = "the temperatures of the points";
        let checked = check_length(what, values.len(), problem.len());
        problem.domain().agreed(checked)?;
        if problem.domain().is_divided() && options.scheme != Scheme::Explicit {
            let points = problem.domain().whole_points();
            if points > MOST_REPLICATED {
                return Err(HeatError::TooManyPoints { points }.into());
            }
        }
        if let Some(step) = options.step {
            positive("the thermal step", step)?;
        }
        let dissipation = Dissipation::new(options.dissipation, t)?;
        if dissipation.is_some() && options.scheme == Scheme::Steady {
            return Err(HeatError::SteadyDissipation.into());
        }
        let first = Accepted {
            t,
            pending: vec![0.0; dissipation.map_or(0, |_| values.len())],
            flows: vec![0.0; problem.conditions().len()],
            values,
            effort: Effort::default(),
        };
        let state = State {
            solver: Solver::new(&problem),
            initial: problem.content(&first.values),
            problem,
            options,
            accepted: Interval {
                from: first.clone(),
                to: first,
            },
            ahead: None,
            revision: 0,
            failure: None,
            dissipation,
            new: None,
        };
        Ok(Self {
            shared: SharedField(Arc::new(Mutex::new(state))),
        })
    }

    /// Sets the values that own points take when they become active
    /// ([`System::add_activation`](pericles::System::add_activation)); `None` for points that keep their value.
    ///
    /// # Errors
    /// A number of values other than that of the points.
    pub fn set_new_values(&mut self, values: Vec<Option<f64>>) -> Result<()> {
        let mut state = self.shared.state();
        let what = "the temperatures of points that become active";
        check_length(what, values.len(), state.problem.len())?;
        let content = 0.0;
        state.new = Some(NewPoints { values, content });
        Ok(())
    }

    /// Returns the field as forces and observers share it.
    pub fn shared(&self) -> SharedField {
        self.shared.clone()
    }
}

impl Interval {
    fn contains(&self, t: f64) -> bool {
        t <= self.to.t && (t > self.from.t || self.from.t == self.to.t)
    }

    /// Returns the weight of the later state at a time, exact at both ends.
    fn weight(&self, t: f64) -> f64 {
        match t {
            t if t >= self.to.t => 1.0,
            t if t <= self.from.t => 0.0,
            t => (t - self.from.t) / (self.to.t - self.from.t),
        }
    }

    fn mix(&self, t: f64, of: impl Fn(&Accepted) -> &[f64], out: &mut [f64]) {
        let weight = self.weight(t);
        for ((out, from), to) in out.iter_mut().zip(of(&self.from)).zip(of(&self.to)) {
            *out = if weight == 1.0 {
                *to
            } else {
                from + weight * (to - from)
            };
        }
    }
}

impl State {
    /// Makes sure that the accepted interval or the one ahead contains a time.
    fn reach(&mut self, t: f64) -> Result<()> {
        let is_known = |ahead: &Interval| match self.options.step {
            // Steps of the body: the field advances to the time itself.
            None => ahead.to.t == t,
            Some(_) => ahead.contains(t),
        };
        if t <= self.accepted.to.t || self.ahead.as_ref().is_some_and(is_known) {
            return Ok(());
        }
        let mut from = self.accepted.to.clone();
        loop {
            let start = from.t;
            let end = match self.options.step {
                None => t,
                // Multiples of the step, so that rounding errors of the time do not add up.
                Some(step) => ((start / step * (1.0 + 1e-12)).floor() + 1.0) * step,
            };
            let mut to = from.clone();
            to.t = end;
            let (problem, solver) = (&self.problem, &mut self.solver);
            let scheme = self.options.scheme;
            let times = [start, end];
            let part = self.dissipation.map_or(0.0, |heat| heat.part(times));
            let rate = |pending: &f64| part * pending / (end - start);
            let power: Vec<f64> = from.pending.iter().map(rate).collect();
            let span = Span {
                times,
                power: &power,
            };
            solver.effort = to.effort;
            advance(problem, scheme, solver, span, &mut to.values, &mut to.flows)?;
            to.effort = solver.effort;
            for pending in &mut to.pending {
                *pending -= part * *pending;
            }
            let interval = Interval { from, to };
            if interval.contains(t) {
                self.ahead = Some(interval);
                return Ok(());
            }
            from = interval.to;
        }
    }

    /// Returns the interval that contains a time; the failure is kept for the end of the step.
    fn interval(&mut self, t: f64) -> Option<&Interval> {
        match self.reach(t) {
            Ok(()) if t <= self.accepted.to.t => Some(&self.accepted),
            Ok(()) => self.ahead.as_ref(),
            Err(error) => {
                self.failure = Some(error);
                None
            }
        }
    }

    fn mix_into(&mut self, t: f64, of: impl Fn(&Accepted) -> &[f64], out: &mut [f64]) {
        match self.interval(t) {
            Some(interval) => interval.mix(t, of, out),
            None => out.fill(f64::NAN),
        }
    }

    /// Reads the times and values of the accepted interval from an archive.
    fn read_accepted(&mut self, archive: &Archive) -> Result<()> {
        let mut times = [0.0; 2];
        archive.f64_into(TIMES, &mut times)?;
        let Interval { from, to } = &mut self.accepted;
        for (k, one) in [from, to].into_iter().enumerate() {
            one.t = times[k];
            archive.f64_into(VALUES[k], &mut one.values)?;
            // A run that starts from this state may be the first with this heat.
            if self.dissipation.is_some() && archive.arrays().contains_key(PENDING[k]) {
                archive.f64_into(PENDING[k], &mut one.pending)?;
            }
        }
        Ok(())
    }

    /// Returns the values including pending heat.
    fn values_at(&mut self, t: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.problem.len()];
        self.mix_into(t, |state| &state.values, &mut values);
        if self.dissipation.is_some() {
            let mut pending = vec![0.0; values.len()];
            self.mix_into(t, |state| &state.pending, &mut pending);
            let capacity = self.problem.capacity().iter();
            for ((value, heat), capacity) in values.iter_mut().zip(&pending).zip(capacity) {
                *value += heat / capacity;
            }
        }
        values
    }

    /// Turns the energy that each point has dissipated in a step of the body into pending heat. Prescribed values are
    /// unaffected: their conditions take the heat.
    fn heat_up(&mut self, t: f64, dissipated: &[f64]) {
        let Some(dissipation) = &mut self.dissipation else {
            return;
        };
        let heat = |i: usize| dissipation.share * dissipated[i];
        let total = self.problem.domain().sum(dissipated.len(), heat);
        let Interval { from, to } = &mut self.accepted;
        for state in [from, to] {
            for (i, pending) in state.pending.iter_mut().enumerate() {
                if !self.problem.is_prescribed(i) {
                    *pending += heat(i);
                }
            }
            let flows = &mut state.flows;
            self.problem.book_prescribed(&|_| 0.0, &heat, flows);
        }
        dissipation.add(t, total);
        // Computed without this heat.
        self.ahead = None;
    }
}

impl SecondaryField for DiffusingField {
    fn name(&self) -> &'static str {
        "temperature"
    }

    fn start(&mut self, forces: &dyn Force) -> Result<()> {
        let mut state = self.shared.state();
        let what = "the points of the temperature field";
        let checked = check_length(what, state.problem.len(), forces.points());
        state.problem.domain().agreed(checked)?;
        state.problem.diffusion.read_bonds(forces);
        let t = state.accepted.to.t;
        let sampled = state.problem.sample(t)?;
        let mut values = state.accepted.to.values.clone();
        state.problem.prescribe(&sampled, &mut values);
        state.initial = state.problem.content(&values);
        state.accepted.from.values.copy_from_slice(&values);
        state.accepted.to.values = values;
        state.ahead = None;
        state.revision += 1;
        Ok(())
    }

    fn take_over(&mut self, archive: &Archive, t: f64) -> Result<()> {
        if !archive.arrays().contains_key(TIMES) {
            return Ok(());
        }
        let mut state = self.shared.state();
        state.problem.diffusion.forget_bonds();
        let mut first = state.accepted.to.clone();
        state.read_accepted(archive)?;
        // The end of a thermal step may lie beyond the end of the run.
        first.values = state.values_at(t);
        let (from, to) = (first.clone(), first);
        state.accepted = Interval { from, to };
        Ok(())
    }

    fn reads_dissipation(&self) -> bool {
        self.shared.state().dissipation.is_some()
    }

    fn end_step(&mut self, body: BodyStep<'_>) -> Result<()> {
        let BodyStep {
            t,
            forces,
            dissipated,
        } = body;
        let mut state = self.shared.state();
        if let Some(failure) = state.failure.take() {
            return Err(failure);
        }
        state.reach(t)?;
        if t > state.accepted.to.t
            && let Some(ahead) = state.ahead.take()
        {
            state.accepted = ahead;
        }
        state.heat_up(t, dissipated);
        if state.problem.diffusion.read_bonds(forces) {
            state.ahead = None;
        }
        state.revision += 1;
        Ok(())
    }

    fn set_new(&mut self, points: &[u32]) {
        let mut state = self.shared.state();
        let State {
            problem,
            accepted,
            new: Some(new),
            ..
        } = &mut *state
        else {
            return;
        };
        let free = points.iter().map(|&i| i as usize);
        let changed: Vec<(usize, f64)> = free
            .filter(|&i| !problem.is_prescribed(i))
            .filter_map(|i| Some((i, new.values[i]?)))
            .collect();
        let capacity = problem.capacity();
        let old = &accepted.to.values;
        let gain = |k: usize| {
            let (i, value) = changed[k];
            capacity[i] * (value - old[i])
        };
        new.content += problem.domain().sum(changed.len(), gain);
        for one in [&mut accepted.from, &mut accepted.to] {
            for &(i, value) in &changed {
                one.values[i] = value;
            }
        }
        state.ahead = None;
        state.revision += 1;
    }

    fn read_bonds(&mut self, forces: &dyn Force) {
        let mut state = self.shared.state();
        if state.problem.diffusion.read_bonds(forces) {
            state.ahead = None;
        }
    }

    fn values_into(&self, t: f64, out: &mut [f64]) {
        out.copy_from_slice(&self.shared.state().values_at(t));
    }

    fn flux_into(&self, t: f64, out: &mut [f64]) {
        let mut state = self.shared.state();
        let values = state.values_at(t);
        state.problem.diffusion.flux_into(&values, out);
    }
}

/// Names of arrays in checkpoints.
const TIMES: &str = "temperature/t";
const CONTENT: &str = "temperature/initial content";
const EFFORT: &str = "temperature/effort";
const NEW: &str = "temperature/content of new points";
const INTACT: &str = "temperature/intact bonds";
const VALUES: [&str; 2] = ["temperature/from", "temperature/to"];
const FLOWS: [&str; 2] = ["temperature/flows from", "temperature/flows to"];
const PENDING: [&str; 2] = ["temperature/pending from", "temperature/pending to"];

impl Checkpointed for DiffusingField {
    fn save(&self, archive: &mut Archive) {
        let state = self.shared.state();
        let Interval { from, to } = &state.accepted;
        archive.put(TIMES, Values::F64(vec![from.t, to.t]));
        archive.put(CONTENT, Values::F64(vec![state.initial]));
        let Effort { last, most, total } = to.effort;
        archive.put(EFFORT, Values::U64(vec![last, most, total]));
        state.problem.diffusion.save_intact(INTACT, archive);
        for (k, one) in [from, to].into_iter().enumerate() {
            let values = Values::F64(one.values.clone());
            archive.put_as(VALUES[k], values, Layout::Points);
            archive.put(FLOWS[k], Values::F64(one.flows.clone()));
        }
        if let Some(new) = &state.new {
            archive.put(NEW, Values::F64(vec![new.content]));
        }
        if let Some(dissipation) = state.dissipation {
            dissipation.save(archive);
            for (k, one) in [from, to].into_iter().enumerate() {
                let pending = Values::F64(one.pending.clone());
                archive.put_as(PENDING[k], pending, Layout::Points);
            }
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut state = self.shared.state();
        let state = &mut *state;
        archive.f64_into(CONTENT, std::slice::from_mut(&mut state.initial))?;
        state.read_accepted(archive)?;
        let Interval { from, to } = &mut state.accepted;
        for (k, one) in [from, to].into_iter().enumerate() {
            archive.f64_into(FLOWS[k], &mut one.flows)?;
        }
        let mut effort = [0; 3];
        archive.u64_into(EFFORT, &mut effort)?;
        let [last, most, total] = effort;
        state.accepted.to.effort = Effort { last, most, total };
        if let Some(dissipation) = &mut state.dissipation {
            dissipation.restore(archive)?;
        }
        if let Some(new) = &mut state.new {
            archive.f64_into(NEW, std::slice::from_mut(&mut new.content))?;
        }
        state.problem.diffusion.restore_intact(INTACT, archive)?;
        state.ahead = None;
        state.failure = None;
        state.revision += 1;
        Ok(())
    }
}
