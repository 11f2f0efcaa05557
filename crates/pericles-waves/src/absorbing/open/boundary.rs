//! The boundary of a plate with open sides.

use std::ops::Range;

use pericles::archive::Laid;
use pericles::boundary::{Boundary, Exchange, Stage};
use pericles::domain::Domain;
use pericles::space::{Face, PointCloud};
use pericles::time::State;
use pericles::{StepEnd, StepKind, System};
use rayon::prelude::*;

use super::body::{OwnNodes, probe, shape_of, speed_of};
use super::error::OpenError;
use super::exchange::ZoneExchange;
use super::filter::Filter;
use super::placed::{PlacedLayer, layers_of, stretched};
use super::plate::{Line, Zone};
use super::sides::{OpenOptions, OpenSides};
use super::weights::LatticeWeights;

/// Largest initial field in the layers relative to the largest one of the body. A tail of this size changes the motion of the
/// interior by much less, because the layers absorb it as well.
const AT_REST: f64 = 1e-3;

/// Layers at the open sides of a plate; see the [module](super).
pub struct OpenBoundary {
    lines: [Line; 2],
    zone: Zone,
    exchange: ZoneExchange,
    weights: LatticeWeights,
    /// The layers normal to x, then those normal to y.
    layers: Vec<PlacedLayer>,
    filter: Filter,
    options: OpenOptions,
    speed: f64,
    dt: f64,
    /// A field on the zone, by component, each followed by a zero.
    field: Vec<f64>,
    /// Accelerations in the layers, m/s², as [`OpenBoundary::field`].
    acceleration: Vec<f64>,
    own: OwnNodes,
    /// Accelerations of own points in the zone by the boundary, m/s², at the end and at the start of the step.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
    domain: Domain,
}

impl OpenBoundary {
    /// Opens sides of a plate for steps of length `dt` (s) from an initial state. All processes must call it together.
    ///
    /// # Errors
    /// Every property of the body that the layers do not support ([`OpenError`]).
    pub fn new(
        system: &System,
        sides: &OpenSides,
        options: OpenOptions,
        dt: f64,
        start: &State,
    ) -> Result<Self, OpenError> {
        let cloud = system.cloud();
        let shape = shape_of(cloud)?;
        // Before the reach is known.
        sides.check(shape, 1)?;
        let lines = sides.lines(shape);
        let weights = LatticeWeights::of(system, probe(cloud, &lines))?;
        let reach = weights.reach();
        sides.check(shape, reach)?;
        let speed = speed_of(&weights, cloud.spacing())?;
        let zone = Zone::new(lines, 2 * reach - 1);
        let exchange = ZoneExchange::new(&zone, cloud);
        if exchange.points() < zone.len() {
            return Err(OpenError::Holes {
                missing: zone.len() - exchange.points(),
                nodes: zone.len(),
            });
        }
        let passes = OpenOptions::passes(dt * speed);
        let interval = dt * speed / passes as f64;
        let filter = Filter::new(&zone, passes, |node| {
            let rates = sides.open_sides().map(|(Face { axis, upper }, cells)| {
                let depth = lines[axis].depth(usize::from(upper), node[axis]);
                depth.map_or(0.0, |depth| options.filter_at(depth, cells))
            });
            1.0 - (-interval * rates.sum::<f64>()).exp()
        });
        let own = OwnNodes::new(system, &exchange, &zone, reach - 1);
        let mut boundary = Self {
            layers: layers_of(sides, &lines, &weights, (options, speed)),
            field: vec![0.0; 2 * (zone.len() + 1)],
            acceleration: vec![0.0; 2 * (zone.len() + 1)],
            pull: vec![0.0; 2 * own.points.len()],
            pull_before: vec![0.0; 2 * own.points.len()],
            domain: cloud.domain().clone(),
            lines,
            zone,
            exchange,
            weights,
            filter,
            options,
            speed,
            dt,
            own,
        };
        boundary.check_uniform(system)?;
        boundary.check_free(system)?;
        boundary.check_rest(cloud, start)?;
        Ok(boundary)
    }

    /// Speed of long longitudinal waves, cells/s.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// The weights of the lattice.
    pub fn weights(&self) -> &LatticeWeights {
        &self.weights
    }

    /// The parameters of the layers.
    pub fn options(&self) -> &OpenOptions {
        &self.options
    }

    /// Numbers of memory that every process stores.
    pub fn numbers(&self) -> usize {
        let layers = self.layers.iter().map(|one| &one.layer);
        layers.map(|layer| layer.memory.len()).sum()
    }

    /// Computes the accelerations in the layers for displacements of own points (m), and advances the memory by `dt`, s.
    fn advance(&mut self, dt: f64, u: &[f64]) {
        let own = self.own.values(u);
        self.exchange.spread(own, &mut self.field);
        let (zone, lines, field) = (&self.zone, &self.lines, &self.field);
        let width = zone.len() + 1;
        let value = |c: usize, node: [usize; 2]| {
            let number = zone.number(node);
            number.map_or(0.0, |number| field[c * width + number])
        };
        let columns = lines[0].nodes;
        let first_along_y = self.layers.iter().take_while(|one| one.axis == 0).count();
        let (along_x, along_y) = self.layers.split_at_mut(first_along_y);
        for PlacedLayer { end, layer, .. } in along_x.iter_mut() {
            layer.advance(dt, &|n, c, lane, out| {
                let x = lines[0].index(*end, n);
                for (y, out) in (lane..lines[1].nodes).zip(out) {
                    *out = value(c, [x, y]);
                }
            });
        }
        let along_x = &*along_x;
        for PlacedLayer { end, layer, .. } in along_y {
            layer.advance(dt, &|n, c, lane, out| {
                let y = lines[1].index(*end, n);
                for (field, out) in (lane..).zip(out) {
                    *out = if field < columns {
                        value(c, [field, y])
                    } else {
                        stretched(along_x, field - columns, c, y)
                    };
                }
            });
        }
        self.add_up();
    }

    /// Computes the accelerations in the layers from the continued shifts.
    fn add_up(&mut self) {
        let reach = self.weights.reach() as isize;
        let all = self.layers.iter();
        let rows = all.flat_map(|placed| {
            let depths = 1 - reach..=placed.layer.cells() as isize;
            depths.map(move |n| (placed, n))
        });
        let rows: Vec<_> = rows.collect();
        let rows: Vec<_> = rows
            .into_par_iter()
            .map(|(placed, n)| (placed, n, placed.force.at(&placed.layer, n)))
            .collect();
        let width = self.zone.len() + 1;
        for (placed, n, values) in rows {
            let Range { start, end } = placed.force.targets;
            let depth = self.lines[placed.axis].index(placed.end, n);
            for along in start..end {
                let mut node = [along; 2];
                node[placed.axis] = depth;
                if let Some(number) = self.zone.number(node) {
                    for c in 0..2 {
                        let value = values[c * (end - start) + along - start];
                        self.acceleration[c * width + number] = value;
                    }
                }
            }
        }
    }

    /// Checks that the forces near the interface are those of the uniform lattice.
    fn check_uniform(&mut self, system: &System) -> Result<(), OpenError> {
        /// Relative difference; forces in single precision differ by rounding.
        const TOLERANCE: f64 = 1e-5;
        let (n, cloud) = (system.points(), system.cloud());
        let columns = self.lines[0].nodes;
        let node_of = |i: usize| {
            cloud
                .lattice()
                .map_or(0, |lattice| lattice.node[i] as usize)
        };
        // Displacements without structure that do not depend on the division.
        let noise = |entry: usize| {
            let number = 2 * node_of(entry % n) + entry / n;
            ((number as f64 * 12.9898).sin() * 43758.5453).fract()
        };
        let u: Vec<f64> = (0..2 * n).map(noise).collect();
        let mut expected = u.clone();
        system.vibration_into(&vec![0.0; 2 * n], &u, &mut expected);
        self.advance(0.0, &u);
        let reach = self.weights.reach() as isize;
        let inside = |i: usize| {
            let node = [node_of(i) % columns, node_of(i) / columns];
            (0..2).all(|axis| {
                (0..2).all(|end| {
                    let line = &self.lines[axis];
                    let depth = line.depth(end, node[axis]);
                    let cells = line.cells(end).unwrap_or(0) as isize;
                    depth.is_none_or(|depth| depth <= cells - 2 * reach)
                })
            })
        };
        let width = self.zone.len() + 1;
        let (mut largest, mut worst) = (0.0_f64, (0.0_f64, None));
        for (k, &(i, number)) in self.exchange.own.iter().enumerate() {
            let point = i as usize;
            if !self.own.is_replaced[k] || !inside(point) {
                continue;
            }
            for c in 0..2 {
                let found = -expected[c * n + point];
                let difference = (self.acceleration[c * width + number as usize] - found).abs();
                largest = largest.max(found.abs());
                if difference > worst.0 {
                    worst = (difference, Some(point));
                }
            }
        }
        let largest = self.domain.max(largest);
        let share = if largest > 0.0 {
            worst.0 / largest
        } else {
            0.0
        };
        let most = self.domain.max(share);
        let number = |point: usize| cloud.user_number(point) as f64;
        let point = worst.1.filter(|_| share == most).map_or(-1.0, number);
        let point = self.domain.max(point).max(0.0) as usize;
        match most > TOLERANCE {
            true => Err(OpenError::NotUniform { point, share: most }),
            false => Ok(()),
        }
    }

    /// Checks that loads and constraints act outside of the layers.
    fn check_free(&self, system: &System) -> Result<(), OpenError> {
        let loads = system.loads().iter().map(|load| ("a load", &load.points));
        let motions = system.motions().iter();
        let motions = motions.map(|motion| ("a prescribed motion", &motion.points));
        for (what, points) in loads.chain(motions) {
            let own = self.own.points.iter().zip(&self.own.is_replaced);
            let mut inside =
                own.filter(|(i, replaced)| **replaced && points.binary_search(i).is_ok());
            let number = |i: u32| system.cloud().user_number(i as usize) as f64;
            let found = inside.next().map_or(-1.0, |(&i, _)| number(i));
            let found = self.domain.max(found);
            if found >= 0.0 {
                let point = found as usize;
                return Err(OpenError::ActedOn { what, point });
            }
        }
        Ok(())
    }

    /// Checks that the body is at rest in the layers. Velocities count as the displacements in the time Δx/c_P.
    fn check_rest(&self, cloud: &PointCloud, start: &State) -> Result<(), OpenError> {
        let (n, time) = (cloud.len(), 1.0 / self.speed);
        let fields = [
            ("displacement", &start.u, 1.0),
            ("velocity", &start.v, time),
        ];
        let largest = fields.map(|(_, values, scale)| scale * pericles::sum::max_norm(values));
        let largest = self.domain.max(largest[0].max(largest[1]));
        for (field, values, scale) in fields {
            let mut found = (0.0_f64, 0);
            for (&i, replaced) in self.own.points.iter().zip(&self.own.is_replaced) {
                let size = |c: usize| scale * values[c * n + i as usize].abs();
                let size = size(0).max(size(1));
                if *replaced && size > found.0 {
                    found = (size, i as usize);
                }
            }
            let most = self.domain.max(found.0);
            if most > AT_REST * largest {
                let is_first = found.0 == most;
                let number = cloud.user_number(found.1) as f64;
                let point = self.domain.max(if is_first { number } else { -1.0 });
                return Err(OpenError::NotAtRest {
                    field,
                    point: point as usize,
                    share: most / largest,
                    allowed: AT_REST,
                });
            }
        }
        Ok(())
    }
}

impl Boundary for OpenBoundary {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        std::mem::swap(&mut self.pull, &mut self.pull_before);
        self.advance(self.dt, step.u);
        Exchange::default()
    }

    fn after_stage(&mut self, stage: &Stage<'_>, acceleration: &mut [f64]) {
        let count = self.own.points.len();
        let (n, width, dt) = (acceleration.len() / 2, self.zone.len() + 1, self.dt);
        let mut kicked = vec![0.0; 2 * count];
        for c in 0..2 {
            for (k, &(i, number)) in self.exchange.own.iter().enumerate() {
                let entry = c * n + i as usize;
                let replaced = match self.own.is_replaced[k] {
                    true => self.acceleration[c * width + number as usize],
                    false => acceleration[entry],
                };
                self.pull[c * count + k] = replaced - acceleration[entry];
                kicked[c * count + k] = stage.v[entry] + dt * replaced;
            }
        }
        self.exchange.spread(kicked.clone(), &mut self.field);
        for component in self.field.chunks_mut(width) {
            self.filter.apply(component);
        }
        for c in 0..2 {
            for (k, &(i, number)) in self.exchange.own.iter().enumerate() {
                let own = c * count + k;
                let filtered = self.field[c * width + number as usize];
                self.pull[own] += (filtered - kicked[own]) / dt;
                acceleration[c * n + i as usize] += self.pull[own];
            }
        }
    }

    fn account(&mut self, step: &StepEnd<'_>) -> Exchange {
        let count = self.own.points.len();
        let n = step.u.len() / 2;
        let impulse = |c: usize, k: usize| {
            let pull = self.pull[c * count + k] + self.pull_before[c * count + k];
            0.5 * self.own.masses[k] * pull * step.dt
        };
        let mut exchange = Exchange::default();
        for c in 0..2 {
            exchange.impulse[c] = self.domain.sum(count, |k| impulse(c, k));
            exchange.work += self.domain.sum(count, |k| {
                impulse(c, k) * step.mean_velocity(c * n + self.own.points[k] as usize)
            });
        }
        exchange
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        &[StepKind::EndOfStep]
    }
}

pericles::saved! {
    impl Checkpointed for OpenBoundary {
        layers: under("open"),
        pull: by(Laid::on("open/pull", &own.points)),
        lines, zone, exchange, weights, filter, options, speed, dt, own, domain: fixed,
        field, acceleration, pull_before: scratch,
    }
}
