//! Rigid bodies that touch the points.
//!
//! Every process has a copy of each rigid body. Forces and moments are exact sums over the points of all processes,
//! so that all copies move identically. Moments about the centre use the positions of the points, not the nearest
//! positions on the surface of the body: the energy is then invariant under rotations, and angular momentum is
//! conserved to rounding.

mod contact;
mod mass;
mod mesh;
mod motion;
mod shape;
mod tree;

pub use mass::{Inertia, MassProperties};
pub use mesh::ClosedMesh;
pub use motion::ImpactorMotion;
pub use shape::{Pose, Shape};

use std::sync::Arc;

use pericles::Result;
use pericles::space::PointCloud;

use crate::bodies::{ContactBodies, Touching};
use crate::error::ContactError;
use crate::law::ContactLaw;
use crate::vector::{V3, cross, plus, scaled};
use motion::{Carriage, Course};

/// Largest allowed difference of a rotation matrix from an orthogonal one.
const ROUNDING: f64 = 1e-9;

/// A rigid body in contact with the points of a body.
///
/// A point with the size h of its cell touches at the signed distance s < h/2 from the body:
///
/// ```text
/// g = h/2 − s > 0:   F = k_w h (g/h)^p,   k_w = 2 k_i
/// ```
///
/// half of the contact of the point with its mirror image. Friction is Coulomb's law, capped by the force that stops the
/// point: F_t = −min(μ F_n, m |v*|/dt) v*/|v*| with the tangential velocity v* that all other forces would give. The body
/// gets the opposite forces, and their moments about its centre with the points themselves as points of action, so that
/// angular momentum is conserved.
pub struct Impactor {
    name: String,
    shape: Shape,
    touching: Touching,
    mass: Option<MassProperties>,
    course: Option<Course>,
    state: Carriage,
    /// Impulse on the points so far, N s.
    impulse: V3,
    /// Work of the prescribed motion so far, J.
    work: f64,
    /// Energy dissipated by dampers and friction so far, J.
    dissipated: f64,
    /// Forces of dampers and friction on the points at the last accepted state, N, component-major; empty without them.
    drag: Vec<f64>,
    /// Sum and moment of these forces.
    drag_sum: [V3; 2],
    /// Number of points in contact at the last accepted state.
    points: u64,
    /// Largest overlap at the last accepted state, m, and relative to the cell.
    overlap: [f64; 2],
}

/// The state of a rigid body for output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Position of the centre of mass (of the origin of the shape's frame for bodies with prescribed motion), m.
    pub centre: [f64; 3],
    /// Rotation matrix of the shape's frame by rows.
    pub rotation: [[f64; 3]; 3],
    /// Velocity of the centre, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity in space, rad/s.
    pub spin: [f64; 3],
    /// Force of the points on the body, N.
    pub force: [f64; 3],
    /// Torque of the points about the centre, N m.
    pub torque: [f64; 3],
    /// Impulse on the points so far, N s.
    pub impulse: [f64; 3],
    /// Work of the prescribed motion on the points so far, J; zero for free bodies.
    pub work: f64,
    /// Energy dissipated by dampers and friction so far, J.
    pub dissipated: f64,
    /// Kinetic energy, J; zero for bodies with prescribed motion.
    pub kinetic: f64,
    /// Number of points in contact.
    pub points: u64,
    /// Largest overlap of a point with the body, m.
    pub overlap: f64,
}

impl Impactor {
    /// Makes a rigid body for a body of points. If the points are divided among processes, all of them must call it together;
    /// the state of the rigid body is the same on all of them.
    ///
    /// # Errors
    /// [`ContactError::Body`] and [`ContactError::Impactor`]: sizes and masses that are not positive, a rotation matrix
    /// that is not orthogonal, a free half-space, a triangle mesh in one or two dimensions, motion along or rotation about
    /// axes that the body of points does not have, points that lie deeper in the body than half of their cell; errors of
    /// the contact law.
    pub fn new(
        name: impl Into<String>,
        shape: Shape,
        pose: Pose,
        motion: ImpactorMotion,
        cloud: Arc<PointCloud>,
        law: ContactLaw,
        bodies: ContactBodies,
    ) -> Result<Self> {
        let name = name.into();
        let dimension = cloud.dimension();
        check_shape(&name, &shape, dimension)?;
        let reject = |reason: &str| ContactError::Impactor {
            name: name.clone(),
            reason: reason.to_owned(),
        };
        if pose.error() > ROUNDING || !pose.centre.iter().all(|x| x.is_finite()) {
            return Err(
                reject("its pose is not a position and a rotation (an orthogonal matrix with determinant 1)").into(),
            );
        }
        let shape = shape.extended(dimension);
        let mut state = Carriage {
            centre: pose.centre,
            rotation: pose.rotation,
            velocity: [0.0; 3],
            angular: [0.0; 3],
            force: [0.0; 3],
            torque: [0.0; 3],
        };
        let off_plane = |v: V3| v[dimension..].iter().any(|x| *x != 0.0);
        let (mut mass, mut course, mut shape) = (None, None, shape);
        match motion {
            ImpactorMotion::Prescribed {
                kind,
                amplitude,
                function,
            } => {
                if off_plane(amplitude) {
                    return Err(reject("it moves along an axis that the points do not have").into());
                }
                let start = pose.centre;
                let along = Course {
                    kind,
                    amplitude,
                    function,
                    start,
                };
                state.centre = along.place(0.0);
                state.velocity = along.velocity(0.0);
                course = Some(along);
            }
            ImpactorMotion::Free {
                inertia,
                velocity,
                spin,
            } => {
                let turns = match dimension {
                    1 => spin != [0.0; 3],
                    2 => spin[0] != 0.0 || spin[1] != 0.0,
                    _ => false,
                };
                if off_plane(velocity) || turns {
                    return Err(reject(
                        "it moves along or turns about an axis that the points do not have",
                    )
                    .into());
                }
                let solid = mass::solid(&shape, dimension, cloud.section());
                let found = inertia.of(solid, dimension).ok_or_else(|| {
                    reject(
                        "it moves freely, but its mass and inertia are not positive and finite; allowed: a density or a \
                         mass above 0 for a shape with a volume, or a prescribed motion",
                    )
                })?;
                if let Shape::Mesh(mesh) = shape {
                    // The frame of a free body has its origin at the centre of mass.
                    let centre = mesh.solid().centre;
                    state.centre = plus(state.centre, 1.0, pose.turn(centre));
                    shape = Shape::Mesh(mesh.moved(scaled(-1.0, centre)));
                }
                state.velocity = velocity;
                state.angular = found.momentum(&state, spin);
                mass = Some(found);
            }
        }
        let touching = Touching::new(cloud, law, bodies)?;
        let entries = match law.is_conservative() {
            true => 0,
            false => dimension * touching.cloud.len(),
        };
        let impactor = Self {
            name,
            shape,
            touching,
            mass,
            course,
            state,
            impulse: [0.0; 3],
            work: 0.0,
            dissipated: 0.0,
            drag: vec![0.0; entries],
            drag_sum: [[0.0; 3]; 2],
            points: 0,
            overlap: [0.0; 2],
        };
        impactor.check_start()?;
        Ok(impactor)
    }

    /// Rejects bodies that contain points deeper than half of their cell at the start. All processes must call it together.
    fn check_start(&self) -> Result<()> {
        let none = vec![0.0; self.touching.cloud.dimension() * self.touching.cloud.len()];
        let found = self.touches(&self.state.pose(), &none);
        let deep = found
            .iter()
            .find(|one| one.overlap > 0.5 * self.touching.size[one.point]);
        let cloud = &self.touching.cloud;
        // The first one of the whole body, so that all processes report the same.
        let [number, user] = deep.map_or([f64::INFINITY; 2], |one| {
            [
                cloud.domain().number(one.point),
                cloud.user_number(one.point),
            ]
            .map(|k| k as f64)
        });
        let [number, user] = cloud.domain().of_largest(-number, [number, user]);
        if number.is_infinite() {
            return Ok(());
        }
        Err(ContactError::Impactor {
            name: self.name.clone(),
            reason: format!(
                "at the start it contains point {user} of the body; allowed: free surfaces that touch or are apart"
            ),
        }
        .into())
    }

    /// Shape, without its ends along axes that the points do not have. The frame of a free mesh has its origin at the
    /// centre of mass.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Position and orientation at the last accepted state.
    pub fn pose(&self) -> Pose {
        self.state.pose()
    }

    /// Mass and inertia of a free body.
    pub fn mass(&self) -> Option<&MassProperties> {
        self.mass.as_ref()
    }

    /// Returns the state at the last accepted state of the points.
    pub fn reading(&self) -> Reading {
        let Carriage {
            centre,
            rotation,
            velocity,
            force,
            torque,
            ..
        } = self.state;
        Reading {
            centre,
            rotation,
            velocity,
            spin: self
                .mass
                .as_ref()
                .map_or([0.0; 3], |mass| self.state.spin(mass)),
            force,
            torque,
            impulse: self.impulse,
            work: self.work,
            dissipated: self.dissipated,
            kinetic: self
                .mass
                .as_ref()
                .map_or(0.0, |mass| self.state.kinetic(mass)),
            points: self.points,
            overlap: self.overlap[0],
        }
    }

    /// Angular momentum of a free body about the origin, kg m²/s.
    pub fn angular_momentum(&self) -> [f64; 3] {
        self.mass.as_ref().map_or([0.0; 3], |mass| {
            let orbital = cross(self.state.centre, scaled(mass.mass, self.state.velocity));
            plus(self.state.angular, 1.0, orbital)
        })
    }
}

impl MassProperties {
    /// Angular momentum of a body in a state with an angular velocity in space.
    fn momentum(&self, state: &Carriage, spin: V3) -> V3 {
        let frame = crate::vector::product(&state.rotation, &self.axes);
        let own = crate::vector::transposed_times(&frame, spin);
        crate::vector::times(&frame, std::array::from_fn(|c| own[c] * self.moments[c]))
    }
}

fn check_shape(name: &str, shape: &Shape, dimension: usize) -> Result<()> {
    let sizes: Vec<(&'static str, f64)> = match shape {
        Shape::Ball { radius } => vec![("the radius", *radius)],
        Shape::Box { half } => half[..dimension]
            .iter()
            .map(|half| ("half of a side", *half))
            .collect(),
        Shape::Cylinder {
            radius,
            half_height,
        } => {
            let mut sizes = vec![("the radius", *radius)];
            if dimension == 3 {
                sizes.push(("half of the height", *half_height));
            }
            sizes
        }
        Shape::HalfSpace => Vec::new(),
        Shape::Mesh(_) if dimension < 3 => {
            return Err(ContactError::Impactor {
                name: name.to_owned(),
                reason: format!(
                    "a triangle mesh needs a body in three dimensions, but the points have {dimension}; use a ball, box, \
                     cylinder or half-space"
                ),
            }
            .into());
        }
        Shape::Mesh(_) => Vec::new(),
    };
    for (what, value) in sizes {
        if !(value > 0.0 && value.is_finite()) {
            return Err(ContactError::Body {
                name: name.to_owned(),
                what,
                value,
                unit: "m",
                allowed: "above 0",
            }
            .into());
        }
    }
    Ok(())
}
