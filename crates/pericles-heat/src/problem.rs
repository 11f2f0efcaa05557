//! A diffusion problem: capacity, conductances and conditions.

use pericles::domain::Domain;
use pericles::space::{check_length, check_points};
use pericles::{Result, positive};

use crate::condition::{Condition, Kind};
use crate::diffusion::Diffusion;
use crate::error::HeatError;

/// Capacity, conductances and conditions of a field that diffuses, on the own points of a process. All processes have the same
/// conditions, each on its own points, which may be none.
pub struct Problem {
    pub(crate) diffusion: Diffusion,
    /// Capacity of each point, J/K for heat.
    capacity: Vec<f64>,
    conditions: Vec<Condition>,
    /// Whether the value of a point is prescribed.
    is_prescribed: Vec<bool>,
    /// Σ_j G_ij of each point with all bonds intact, W/K for heat. The stable step follows from it, whichever bonds have
    /// broken: otherwise it would have to be evaluated after each break.
    rates: Vec<f64>,
}

/// Values of all conditions at a time, point by point.
pub(crate) struct Sampled {
    values: Vec<Vec<f64>>,
}

impl Problem {
    /// Makes a problem; capacities (J/K for heat) are given per point. All processes must call it together.
    ///
    /// # Errors
    /// Capacities that are not positive, or not one per point; conditions on points that do not exist; two prescribed
    /// values at a point.
    pub fn new(
        diffusion: Diffusion,
        capacity: Vec<f64>,
        conditions: Vec<Condition>,
    ) -> Result<Self> {
        let is_prescribed = prescribed_points(&diffusion, &capacity, &conditions);
        let is_prescribed = diffusion.cloud().domain().agreed(is_prescribed)?;
        Ok(Self {
            rates: diffusion.diagonal(),
            diffusion,
            capacity,
            conditions,
            is_prescribed,
        })
    }

    /// The domain: how the body is divided among processes.
    pub(crate) fn domain(&self) -> &Domain {
        self.diffusion.cloud().domain()
    }

    /// Number of own points.
    pub fn len(&self) -> usize {
        self.capacity.len()
    }

    /// Returns whether this process owns no points.
    pub fn is_empty(&self) -> bool {
        self.capacity.is_empty()
    }

    /// Returns the conductances.
    pub fn diffusion(&self) -> &Diffusion {
        &self.diffusion
    }

    /// Returns the capacity of each point, J/K for heat.
    pub fn capacity(&self) -> &[f64] {
        &self.capacity
    }

    /// Returns the conditions.
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// Returns whether the value of a point is prescribed.
    pub fn is_prescribed(&self, i: usize) -> bool {
        self.is_prescribed[i]
    }

    /// Returns the content Σ C_i T_i of the whole body, J for heat. All processes must call it together.
    pub fn content(&self, values: &[f64]) -> f64 {
        self.domain()
            .sum(values.len(), |i| self.capacity[i] * values[i])
    }

    /// Evaluates all conditions at a time. All processes must call it together.
    pub(crate) fn sample(&self, t: f64) -> Result<Sampled> {
        let of_condition = |condition: &Condition| -> Result<Vec<f64>> {
            let value = condition.value();
            let values: Vec<f64> = condition
                .points
                .iter()
                .map(|&i| value(i as usize, t))
                .collect();
            match values.iter().position(|value| !value.is_finite()) {
                None => Ok(values),
                Some(k) => {
                    let point = self
                        .diffusion
                        .cloud()
                        .user_number(condition.points[k] as usize);
                    let what = condition.quantity();
                    Err(HeatError::NotFinite { what, point, t }.into())
                }
            }
        };
        let values = self
            .conditions
            .iter()
            .map(of_condition)
            .collect::<Result<_>>();
        let values = self.domain().agreed(values)?;
        Ok(Sampled { values })
    }

    /// Sets prescribed values.
    pub(crate) fn prescribe(&self, sampled: &Sampled, values: &mut [f64]) {
        for (condition, prescribed) in self.conditions.iter().zip(&sampled.values) {
            if condition.is_prescribed() {
                for (&i, &value) in condition.points.iter().zip(prescribed) {
                    values[i as usize] = value;
                }
            }
        }
    }

    /// Adds the inflow of all conditions into each point (W for heat) to `out`, and the inflow of each condition into the whole
    /// body times `duration` to its entry of `booked`. All processes must call it together, with the same duration.
    pub(crate) fn add_inflow(
        &self,
        sampled: &Sampled,
        values: &[f64],
        out: &mut [f64],
        (booked, duration): (&mut [f64], f64),
    ) {
        for ((condition, sample), booked) in self.conditions.iter().zip(&sampled.values).zip(booked)
        {
            let points = &condition.points;
            let target = (&mut *out, &mut *booked, duration);
            match &condition.kind {
                Kind::Prescribed(_) => {}
                Kind::Inflow { measure, .. } => {
                    self.add(points, target, |k| sample[k] * measure[k]);
                }
                Kind::Exchange {
                    law,
                    coefficient,
                    area,
                    ..
                } => self.add(points, target, |k| {
                    let value = values[points[k] as usize];
                    let difference = law.value(sample[k]) - law.value(value);
                    coefficient * area[k] * difference
                }),
            }
        }
    }

    /// Adds `inflow(k)` to the entry of the k-th of `points`, and the sum over the whole body times a duration to `booked`.
    fn add(
        &self,
        points: &[u32],
        (out, booked, duration): (&mut [f64], &mut f64, f64),
        inflow: impl Fn(usize) -> f64 + Sync,
    ) {
        for (k, &i) in points.iter().enumerate() {
            out[i as usize] += inflow(k);
        }
        if duration != 0.0 {
            *booked += duration * self.domain().sum(points.len(), inflow);
        }
    }

    /// Adds −∂(inflow)/∂T of each point, which is not negative, to `out`.
    pub(crate) fn add_exchange_slope(&self, values: &[f64], out: &mut [f64]) {
        for condition in &self.conditions {
            if let Kind::Exchange {
                law,
                coefficient,
                area,
                ..
            } = &condition.kind
            {
                for (&i, area) in condition.points.iter().zip(area) {
                    let slope = law.derivative(values[i as usize]);
                    out[i as usize] += coefficient * area * slope;
                }
            }
        }
    }

    /// Returns whether conditions depend on the values nonlinearly.
    pub(crate) fn is_nonlinear(&self) -> bool {
        let nonlinear = |condition: &Condition| match &condition.kind {
            Kind::Exchange { law, .. } => *law != crate::condition::Exchange::Linear,
            _ => false,
        };
        self.conditions.iter().any(nonlinear)
    }

    /// Adds to `booked` the inflow that prescribed values cause: the change of content of each of their points minus
    /// what flows into it by bonds and other conditions, `inflow` (J). All processes must call it together.
    pub(crate) fn book_prescribed(
        &self,
        change: &(dyn Fn(usize) -> f64 + Sync),
        inflow: &(dyn Fn(usize) -> f64 + Sync),
        booked: &mut [f64],
    ) {
        let domain = self.domain();
        for (condition, booked) in self.conditions.iter().zip(booked) {
            if condition.is_prescribed() {
                let points = &condition.points;
                *booked += domain.sum(points.len(), |k| {
                    let i = points[k] as usize;
                    self.capacity[i] * change(i) - inflow(i)
                });
            }
        }
    }

    /// Returns the largest stable step of the explicit scheme at given values with all bonds intact, s:
    /// 1/max_i (Σ_j G_ij + h_i)/C_i, at most 2/λ by Gershgorin's theorem. Values then remain between the extremes of their
    /// neighbours, also after bonds have broken. All processes must call it together.
    pub fn explicit_limit(&self, values: &[f64]) -> f64 {
        let mut rates = self.rates.clone();
        self.add_exchange_slope(values, &mut rates);
        let free = (0..self.len()).filter(|&i| !self.is_prescribed[i]);
        let largest = free
            .map(|i| rates[i] / self.capacity[i])
            .fold(0.0, f64::max);
        1.0 / self.domain().max(largest)
    }

    /// Returns the number of points of the whole body whose steady value no condition determines. All processes must call it
    /// together.
    pub(crate) fn undetermined_points(&self) -> usize {
        let (n, domain) = (self.len(), self.domain());
        let mut reached = vec![false; n + domain.ghost_points()];
        let mut waiting: Vec<u32> = Vec::new();
        let determining = self.conditions.iter().filter(|one| one.determines_level());
        for &i in determining.flat_map(|one| &one.points) {
            if !std::mem::replace(&mut reached[i as usize], true) {
                waiting.push(i);
            }
        }
        loop {
            while let Some(i) = waiting.pop() {
                self.diffusion.for_each_bond(i as usize, &mut |bond| {
                    let is_new = !std::mem::replace(&mut reached[bond.neighbour], true);
                    // The owner of a ghost continues from it.
                    if is_new && bond.neighbour < n {
                        waiting.push(bond.neighbour as u32);
                    }
                });
            }
            waiting = domain.merge_ghost_marks(&mut reached);
            if domain.all(waiting.is_empty()) {
                break;
            }
        }
        let left = reached[..n].iter().filter(|reached| !**reached);
        domain.count(left.count() as u64) as usize
    }
}

/// Returns whether the value of each point is prescribed; checks capacities and conditions of own points.
fn prescribed_points(
    diffusion: &Diffusion,
    capacity: &[f64],
    conditions: &[Condition],
) -> Result<Vec<bool>> {
    let n = diffusion.cloud().len();
    check_length("the heat capacities of the points", capacity.len(), n)?;
    for &value in capacity {
        positive("the heat capacity", value)?;
    }
    let mut is_prescribed = vec![false; n];
    for condition in conditions {
        check_points("the points of a thermal condition", &condition.points, n)?;
        match &condition.kind {
            Kind::Prescribed(_) => {
                for &i in &condition.points {
                    if std::mem::replace(&mut is_prescribed[i as usize], true) {
                        let point = diffusion.cloud().user_number(i as usize);
                        return Err(HeatError::PrescribedTwice { point }.into());
                    }
                }
            }
            Kind::Inflow { measure, .. } | Kind::Exchange { area: measure, .. } => {
                let what = "the areas of a thermal condition";
                check_length(what, measure.len(), condition.points.len())?;
            }
        }
    }
    Ok(is_prescribed)
}
