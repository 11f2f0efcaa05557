//! Motion of rigid bodies: prescribed, or free under the forces of the points.

use pericles::boundary::{MotionKind, TimeFunction};

use super::mass::{Inertia, MassProperties};
use super::shape::Pose;
use crate::vector::{
    M3, V3, dot, minus, norm, plus, product, rotation_about, scaled, times, transposed_times,
};

/// Motion of a rigid body.
#[derive(Debug, Clone)]
pub enum ImpactorMotion {
    /// Free motion under the forces of the points.
    Free {
        /// Mass and inertia.
        inertia: Inertia,
        /// Initial velocity of the centre of mass, m/s.
        velocity: [f64; 3],
        /// Initial angular velocity in space, rad/s.
        spin: [f64; 3],
    },
    /// Displacement or velocity amplitude · g(t), without rotation.
    Prescribed {
        /// Displacement or velocity.
        kind: MotionKind,
        /// Amplitude, m or m/s.
        amplitude: [f64; 3],
        /// Time function g(t).
        function: TimeFunction,
    },
}

/// A body moved by a function of time.
#[derive(Debug, Clone)]
pub(super) struct Course {
    pub(super) kind: MotionKind,
    pub(super) amplitude: V3,
    pub(super) function: TimeFunction,
    /// Position at t = 0 without displacement, m.
    pub(super) start: V3,
}

impl Course {
    /// Position at time t, m.
    pub(super) fn place(&self, t: f64) -> V3 {
        let factor = match self.kind {
            MotionKind::Displacement => self.function.value(t),
            MotionKind::Velocity => self.function.integral(t),
        };
        plus(self.start, factor, self.amplitude)
    }

    /// Velocity at time t, m/s.
    pub(super) fn velocity(&self, t: f64) -> V3 {
        let factor = match self.kind {
            MotionKind::Displacement => self.function.derivative(t),
            MotionKind::Velocity => self.function.value(t),
        };
        scaled(factor, self.amplitude)
    }
}

/// State of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Carriage {
    /// Position of the centre of mass, m.
    pub(super) centre: V3,
    /// Rotation of the frame of the shape.
    pub(super) rotation: M3,
    /// Velocity, m/s.
    pub(super) velocity: V3,
    /// Angular momentum about the centre in space, kg m²/s.
    pub(super) angular: V3,
    /// Force of the points on the body, N.
    pub(super) force: V3,
    /// Torque of the points about the centre, N m.
    pub(super) torque: V3,
}

/// Motion of a body within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moved {
    /// Displacement of the centre, m.
    pub(super) shift: V3,
    /// Rotation vector in space, rad.
    pub(super) turn: V3,
}

impl Carriage {
    pub(super) fn pose(&self) -> Pose {
        Pose {
            centre: self.centre,
            rotation: self.rotation,
        }
    }

    /// Angular velocity in space, rad/s.
    pub(super) fn spin(&self, mass: &MassProperties) -> V3 {
        self.turning(mass, self.angular)
    }

    /// Returns I⁻¹ L for a vector in space.
    fn turning(&self, mass: &MassProperties, angular: V3) -> V3 {
        let frame = product(&self.rotation, &mass.axes);
        let own = transposed_times(&frame, angular);
        times(&frame, std::array::from_fn(|c| own[c] / mass.moments[c]))
    }

    /// Kinetic energy, J.
    pub(super) fn kinetic(&self, mass: &MassProperties) -> f64 {
        0.5 * (mass.mass * dot(self.velocity, self.velocity) + dot(self.angular, self.spin(mass)))
    }

    /// Difference between ½ V(t − dt/2)·M V(t + dt/2), the same for the rotation, and the kinetic energy, J.
    pub(super) fn correction(&self, mass: &MassProperties, dt: f64) -> f64 {
        let (force, torque) = (self.force, self.torque);
        let square = dot(force, force) / mass.mass + dot(torque, self.turning(mass, torque));
        -0.125 * dt * dt * square
    }

    /// First half of a step of velocity Verlet: half of the impulse, then free motion over dt.
    pub(super) fn advance(&mut self, mass: &MassProperties, dt: f64) -> Moved {
        self.push(mass, dt);
        let shift = scaled(dt, self.velocity);
        self.centre = plus(self.centre, 1.0, shift);
        let before = self.spin(mass);
        self.turn(mass, dt);
        let after = self.spin(mass);
        Moved {
            shift,
            turn: scaled(0.5 * dt, plus(before, 1.0, after)),
        }
    }

    /// Adds half of the impulse of the present force over dt.
    pub(super) fn push(&mut self, mass: &MassProperties, dt: f64) {
        self.velocity = plus(self.velocity, 0.5 * dt / mass.mass, self.force);
        self.angular = plus(self.angular, 0.5 * dt, self.torque);
    }

    /// Free rotation over dt as a product of rotations about the principal axes (x, y, z, y, x), which keeps the angular
    /// momentum in space to rounding and is of second order (McLachlan 1993; Dullweber et al. 1997).
    fn turn(&mut self, mass: &MassProperties, dt: f64) {
        let mut frame = product(&self.rotation, &mass.axes);
        let mut own = transposed_times(&frame, self.angular);
        if norm(own) == 0.0 {
            return;
        }
        for (axis, part) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
            let angle = part * dt * own[axis] / mass.moments[axis];
            let m = rotation_about(axis, angle);
            own = transposed_times(&m, own);
            frame = product(&frame, &m);
        }
        let axes = &mass.axes;
        let back: M3 = std::array::from_fn(|r| std::array::from_fn(|c| axes[c][r]));
        self.rotation = product(&frame, &back);
    }

    /// Velocity of the body at a point of space that moved with `moved` in a step of length dt, m/s.
    pub(super) fn velocity_at(&self, y: V3, moved: &Moved, dt: f64) -> V3 {
        if dt == 0.0 {
            return self.velocity;
        }
        let lever = minus(y, self.centre);
        let moved = plus(moved.shift, 1.0, crate::vector::cross(moved.turn, lever));
        scaled(1.0 / dt, moved)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::UNIT;

    fn top() -> (Carriage, MassProperties) {
        let mass = MassProperties {
            mass: 1.0,
            moments: [1.0, 2.0, 3.0],
            axes: UNIT,
        };
        let body = Carriage {
            centre: [0.0; 3],
            rotation: UNIT,
            velocity: [0.0; 3],
            angular: [1.0, 0.5, -0.8],
            force: [0.0; 3],
            torque: [0.0; 3],
        };
        (body, mass)
    }

    #[test]
    fn free_rotation_repeats_an_independent_computation() {
        // Ten turns of 0.1 with the same splitting in an independent program.
        let (mut body, mass) = top();
        for _ in 0..10 {
            body.advance(&mass, 0.1);
        }
        let own = transposed_times(&body.rotation, body.angular);
        let expected = [1.02958499026, -0.0983685459622, -0.905692208757];
        for c in 0..3 {
            assert!((own[c] - expected[c]).abs() < 1e-11, "{own:?}");
        }
    }

    #[test]
    fn free_rotation_conserves_angular_momentum_and_its_energy_error_is_of_second_order() {
        let drift = |dt: f64| {
            let (mut body, mass) = top();
            let first = body.kinetic(&mass);
            let mut most: f64 = 0.0;
            for _ in 0..(200.0 / dt) as usize {
                body.advance(&mass, dt);
                most = most.max((body.kinetic(&mass) - first).abs());
            }
            let own = transposed_times(&body.rotation, body.angular);
            assert!((norm(own) - norm([1.0, 0.5, -0.8])).abs() < 1e-13);
            most
        };
        // Independent computation to t = 200: 3.8e-5, 9.5e-6, 2.4e-6.
        let errors = [0.1, 0.05, 0.025].map(drift);
        for (error, expected) in errors.iter().zip([3.8e-5, 9.5e-6, 2.4e-6]) {
            assert!((error / expected - 1.0).abs() < 0.2, "{errors:?}");
        }
    }
}
