//! Contact of points with a rigid body as an interaction.

use rayon::prelude::*;

use pericles::boundary::Exchange;
use pericles::operator::{Force, PointSubset};
use pericles::parallel::BLOCK;
use pericles::sum::BinnedSum;
use pericles::{Configuration, Interaction, InteractionStep, PointScalar, Result, StepEnd};

use super::Impactor;
use super::motion::{Carriage, Moved};
use super::shape::Pose;
use crate::vector::{V3, cross, dot, minus, norm, plus, scaled};

/// A point in contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) point: usize,
    /// Position of the point, m.
    place: V3,
    /// Outer normal of the rigid body.
    normal: V3,
    /// Overlap g, m.
    pub(super) overlap: f64,
    /// Normal force with a potential, N.
    force: f64,
}

impl Impactor {
    /// Returns the points in contact in ascending order.
    pub(super) fn touches(&self, pose: &Pose, u: &[f64]) -> Vec<Touch> {
        let cloud = &self.touching.cloud;
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let (x, reach) = (cloud.positions(), self.shape.reach());
        let of_block = |block: usize| {
            let mut found = Vec::new();
            for i in block * BLOCK..((block + 1) * BLOCK).min(n) {
                let mut place = [0.0; 3];
                for c in 0..dimension {
                    place[c] = x[c * n + i] + u[c * n + i];
                }
                let half = 0.5 * self.touching.size[i];
                let away = minus(place, pose.centre);
                if dot(away, away) > (reach + half) * (reach + half) {
                    continue;
                }
                let (s, normal) = self.shape.distance(pose.into_frame(place));
                let overlap = half - s;
                if overlap > 0.0 {
                    let law = self.touching.law.law;
                    let stiffness = self.touching.wall_stiffness(i);
                    found.push(Touch {
                        point: i,
                        place,
                        normal: pose.turn(normal),
                        overlap,
                        force: law.force(stiffness, 2.0 * half, overlap),
                    });
                }
            }
            found
        };
        let blocks = (0..n.div_ceil(BLOCK)).into_par_iter().map(of_block);
        blocks.collect::<Vec<_>>().concat()
    }

    /// Position and orientation at time t: the prescribed one, or the position of the last accepted state.
    fn pose_at(&self, t: f64) -> Pose {
        match &self.course {
            None => self.state.pose(),
            Some(course) => Pose {
                centre: course.place(t),
                rotation: self.state.rotation,
            },
        }
    }

    /// Moves the body to the end of a step.
    fn advance(&mut self, step: &StepEnd<'_>) -> Moved {
        let mut moved = Moved {
            shift: [0.0; 3],
            turn: [0.0; 3],
        };
        match (&self.course, &self.mass) {
            (Some(course), _) => {
                let place = course.place(step.t);
                if step.dt > 0.0 {
                    moved.shift = minus(place, self.state.centre);
                }
                self.state.centre = place;
                self.state.velocity = course.velocity(step.t);
            }
            (None, Some(mass)) if step.dt > 0.0 => moved = self.state.advance(mass, step.dt),
            _ => {}
        }
        moved
    }

    /// Returns the force of dampers and friction on a point, N. `others` is the force density of everything else at the
    /// point, N/m³.
    fn drag_on(&self, touch: &Touch, body: V3, others: V3, step: &StepEnd<'_>) -> V3 {
        let law = &self.touching.law;
        let cloud = &self.touching.cloud;
        let (n, i) = (cloud.len(), touch.point);
        let point = self.touching.mass(i);
        let reduced = match &self.mass {
            None => point,
            Some(mass) => point * mass.mass / (point + mass.mass),
        };
        let mut velocity = [0.0; 3];
        for c in 0..cloud.dimension() {
            velocity[c] = step.mean_velocity(c * n + i);
        }
        let relative = minus(velocity, body);
        let damper = 2.0 * law.damping * (self.touching.wall_stiffness(i) * reduced).sqrt();
        let pressure = (touch.force - damper * dot(relative, touch.normal)).max(0.0);
        let mut drag = scaled(pressure - touch.force, touch.normal);
        if let Some(friction) = law.friction {
            // The tangential velocity of the next step without friction.
            let free = plus(
                relative,
                step.dt / self.touching.bodies.density.at(i),
                others,
            );
            let along = plus(free, -dot(free, touch.normal), touch.normal);
            let speed = norm(along);
            if speed > 0.0 {
                let stop = match step.dt > 0.0 {
                    true => point * speed / step.dt,
                    false => f64::INFINITY,
                };
                let size = (friction.coefficient * pressure).min(stop);
                drag = plus(drag, -size / speed, along);
            }
        }
        drag
    }

    /// Adds the energy that dampers and friction dissipated in a step: minus the mean of their forces at both ends times
    /// the motion of the points relative to the body. All processes must call it together.
    fn dissipate(&mut self, drag: Vec<f64>, sum: [V3; 2], step: &StepEnd<'_>, moved: &Moved) {
        let domain = self.touching.cloud.domain();
        let of_points = domain.sum(drag.len(), |entry| match drag[entry] + self.drag[entry] {
            0.0 => 0.0,
            both => both * step.mean_velocity(entry),
        });
        let [force, torque] = [0, 1].map(|k| plus(sum[k], 1.0, self.drag_sum[k]));
        let of_body = dot(force, moved.shift) + dot(torque, moved.turn);
        self.dissipated -= 0.5 * (step.dt * of_points - of_body);
        self.drag = drag;
        self.drag_sum = sum;
    }

    /// Returns the sums of vectors over the points in contact of all processes: exact ones, so that every process moves the
    /// body identically, for every division. All processes must call it together.
    fn totals<const N: usize>(&self, vectors: &[[V3; N]]) -> [V3; N] {
        let domain = self.touching.cloud.domain();
        std::array::from_fn(|k| {
            domain.totals(std::array::from_fn(|c| {
                BinnedSum::of(vectors.len(), |point| vectors[point][k][c])
            }))
        })
    }
}

impl Interaction for Impactor {
    fn name(&self) -> &str {
        &self.name
    }

    fn check(&self, forces: &dyn Force) -> Result<()> {
        self.touching.check_forces(forces)
    }

    fn add_force(&self, at: &Configuration<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let cloud = &self.touching.cloud;
        let touches = self.touches(&self.pose_at(at.t), at.u);
        let list: Vec<u32> = touches.iter().map(|one| one.point as u32).collect();
        on.common(&list, |k, i| {
            let push = touches[k].force / cloud.volumes()[i];
            for c in 0..cloud.dimension() {
                out[c * cloud.len() + i] += push * touches[k].normal[c];
            }
        });
    }

    fn energy(&self, at: &Configuration<'_>) -> f64 {
        let touches = self.touches(&self.pose_at(at.t), at.u);
        let law = self.touching.law.law;
        let domain = self.touching.cloud.domain();
        domain.sum(touches.len(), |k| {
            law.energy(touches[k].force, touches[k].overlap)
        })
    }

    fn work_between(&self, from: &Configuration<'_>, to: &Configuration<'_>) -> f64 {
        let Some(course) = &self.course else {
            return 0.0;
        };
        let shift = minus(course.place(to.t), course.place(from.t));
        if shift == [0.0; 3] {
            return 0.0;
        }
        let sum = |at: &Configuration<'_>| {
            let touches = self.touches(&self.pose_at(at.t), at.u);
            let push = |touch: &Touch| [scaled(touch.force, touch.normal)];
            let pushes: Vec<[V3; 1]> = touches.iter().map(push).collect();
            self.totals(&pushes)[0]
        };
        dot(scaled(0.5, plus(sum(from), 1.0, sum(to))), shift)
    }

    fn add_tangent(&self, at: &Configuration<'_>, direction: &[f64], out: &mut [f64]) {
        /// Step of the difference quotient of the normal, relative to the cell.
        const STEP: f64 = 1e-5;
        let cloud = &self.touching.cloud;
        let (n, pose) = (cloud.len(), self.pose_at(at.t));
        for touch in self.touches(&pose, at.u) {
            let i = touch.point;
            let mut d = [0.0; 3];
            for c in 0..cloud.dimension() {
                d[c] = direction[c * n + i];
            }
            let size = norm(d);
            if size == 0.0 {
                continue;
            }
            let slope = self.touching.law.law.slope(touch.force, touch.overlap);
            let normal = touch.normal;
            let part = STEP * self.touching.size[i] / size;
            let [after, before] = [part, -part].map(|part| {
                let q = pose.into_frame(plus(touch.place, part, d));
                pose.turn(self.shape.distance(q).1)
            });
            let bent = scaled(0.5 * touch.force / part, minus(after, before));
            let change = plus(bent, -slope * dot(normal, d), normal);
            for c in 0..cloud.dimension() {
                out[c * n + i] += change[c] / cloud.volumes()[i];
            }
        }
    }

    fn end_step(&mut self, end: &InteractionStep<'_>, out: &mut [f64]) -> Exchange {
        let step = end.step;
        let moved = self.advance(step);
        let touches = self.touches(&self.state.pose(), step.u);
        let cloud = self.touching.cloud.clone();
        let (n, dimension, volumes) = (cloud.len(), cloud.dimension(), cloud.volumes());
        // The same on all processes, also on one without points.
        let with_drag = !self.touching.law.is_conservative();
        let mut drag = vec![0.0; self.drag.len()];
        // Force and moment on the points, and the force and moment of dampers and friction.
        let mut acting = Vec::with_capacity(touches.len());
        for touch in &touches {
            let i = touch.point;
            let mut push = scaled(touch.force, touch.normal);
            let lever = minus(touch.place, self.state.centre);
            let mut own = [0.0; 3];
            if with_drag {
                let mut others = [0.0; 3];
                for c in 0..dimension {
                    others[c] = out[c * n + i];
                }
                let body = self.state.velocity_at(touch.place, &moved, step.dt);
                own = self.drag_on(touch, body, others, step);
                own[dimension..].fill(0.0);
                for c in 0..dimension {
                    drag[c * n + i] = own[c];
                }
                push = plus(push, 1.0, own);
            }
            push[dimension..].fill(0.0);
            for c in 0..dimension {
                out[c * n + i] += push[c] / volumes[i];
            }
            acting.push([push, cross(lever, push), own, cross(lever, own)]);
        }
        let [sum, moment, drag_force, drag_moment] = self.totals(&acting);
        if with_drag {
            self.dissipate(drag, [drag_force, drag_moment], step, &moved);
        }
        // Forces on the points at both ends of the step; those on the body have the opposite sign.
        let mean = scaled(0.5, minus(sum, self.state.force));
        let impulse = scaled(step.dt, mean);
        let work = match &self.course {
            Some(_) => dot(mean, moved.shift),
            None => 0.0,
        };
        self.state.force = scaled(-1.0, sum);
        self.state.torque = scaled(-1.0, moment);
        if let Some(mass) = &self.mass {
            self.state.push(mass, step.dt);
        }
        self.impulse = plus(self.impulse, 1.0, impulse);
        self.work += work;
        self.points = cloud.domain().count(touches.len() as u64);
        self.overlap = touches.iter().fold([0.0; 2], |[most, relative], one| {
            let of_cell = one.overlap / self.touching.size[one.point];
            [one.overlap.max(most), of_cell.max(relative)]
        });
        cloud.domain().max_each(&mut self.overlap);
        Exchange { work, impulse }
    }

    fn add_drag(&self, out: &mut [f64]) {
        let (n, volumes) = (self.touching.cloud.len(), self.touching.cloud.volumes());
        for (entry, drag) in self.drag.iter().enumerate() {
            out[entry] += drag / volumes[entry % n];
        }
    }

    fn dissipated(&self) -> f64 {
        self.dissipated
    }

    fn kinetic(&self) -> f64 {
        let mass = self.mass.as_ref();
        mass.map_or(0.0, |mass| self.state.kinetic(mass))
    }

    fn scheme_correction(&self, dt: f64) -> f64 {
        let mass = self.mass.as_ref();
        mass.map_or(0.0, |mass| self.state.correction(mass, dt))
    }

    fn momentum(&self) -> [f64; 3] {
        let mass = self.mass.as_ref();
        mass.map_or([0.0; 3], |mass| scaled(mass.mass, self.state.velocity))
    }

    fn contact_frequency(&self, density: &PointScalar) -> f64 {
        let inverse = self.mass.as_ref().map_or(0.0, |mass| 1.0 / mass.mass);
        let exponent = self.touching.law.law.exponent();
        let square = |i: usize| {
            let mass = density.at(i) * self.touching.cloud.volumes()[i];
            exponent * self.touching.wall_stiffness(i) * (1.0 / mass + inverse)
        };
        let points = 0..self.touching.cloud.len();
        let most = points.map(square).fold(0.0, f64::max);
        self.touching.cloud.domain().max(most).sqrt()
    }

    fn is_conservative(&self) -> bool {
        self.touching.law.is_conservative()
    }

    fn has_free_bodies(&self) -> bool {
        self.mass.is_some()
    }

    fn overlap(&self) -> f64 {
        self.overlap[1]
    }
}

pericles::saved! {
    impl Entry<Number = f64> for Carriage { centre, rotation, velocity, angular, force, torque }
}

pericles::saved! {
    impl Checkpointed for Impactor {
        state: array("impactor/{name}/state"),
        impulse, work, dissipated: array("impactor/{name}/account"),
        drag: points("impactor/{name}/drag"),
        drag_sum: array("impactor/{name}/drag sum"),
        points: array("impactor/{name}/points"),
        overlap: array("impactor/{name}/overlap"),
        name, shape, touching, mass, course: fixed,
    }
}
