//! Initial state, prescribed motions and probes of a model.

use std::path::Path as FilePath;

use pericles::boundary::PrescribedMotion;
use pericles::noise::uniform_in_ball;
use pericles::observe::Probe as PointProbe;
use pericles::space::PointCloud;
use pericles::time::State;
use pericles::{PericlesError, System};
use pericles_deck::{BuildError, Caution, Fault, KeyPath, ProbePlace, RandomVelocity, TimeHistory};

use super::assembler::Assembler;
use super::discretisation::{Discretisation, Sets};
use super::rejection::{at, at_path};
use super::resources::Resources;

impl Assembler<'_> {
    /// Builds the initial state of the points of a process: the velocities of pieces, then the entries of the deck; later entries
    /// for a point replace earlier ones.
    /// Returns the state before `[[initial]]`: that of another run, or a body at rest whose pieces may move. All processes
    /// must call it together.
    pub(super) fn first_state(
        &self,
        body: (&mut System, u64),
        cloud: &PointCloud,
        resources: &Resources<'_>,
    ) -> Result<State, BuildError> {
        let n = cloud.len();
        let mut state = State::at_rest(cloud.dimension() * n);
        if let Some(origin) = resources.start.origin() {
            let is_static = self.model.time.scheme.is_static();
            origin
                .hand_over(body, &mut state, is_static)
                .map_err(|error| at("body", error))?;
            return Ok(state);
        }
        let shape = self.model.body.solid().map(|solid| &solid.shape);
        let pieces = shape.map_or(&[][..], |shape| shape.pieces());
        for (i, c) in (0..n).flat_map(|i| (0..cloud.dimension()).map(move |c| (i, c))) {
            let velocity = pieces
                .get(cloud.piece(i) as usize)
                .and_then(|piece| piece.velocity);
            state.v[c * n + i] = velocity.map_or(0.0, |velocity| velocity[c]);
        }
        Ok(state)
    }

    /// Applies `[[initial]]` to a state.
    pub(super) fn add_initial(
        &self,
        cloud: &PointCloud,
        sets: &Sets,
        resources: &Resources<'_>,
        state: &mut State,
    ) -> Result<(), BuildError> {
        let (n, whole) = (cloud.len(), cloud.domain().whole_points());
        for (k, initial) in self.model.initial.iter().enumerate() {
            let path = KeyPath::from("initial").index(k);
            let points = self.members(sets, &initial.set, path.key("set"))?;
            if let Some(file) = &initial.file {
                let rows = self.initial_rows(&path, file, (cloud.dimension(), whole), resources)?;
                let columns = 2 * cloud.dimension();
                for &i in points {
                    let row = cloud.user_number(i as usize) * columns;
                    for c in 0..cloud.dimension() {
                        let at = c * n + i as usize;
                        state.u[at] = rows[row + c];
                        state.v[at] = rows[row + cloud.dimension() + c];
                    }
                }
            }
            let fields = [
                (&initial.displacement, &mut state.u),
                (&initial.velocity, &mut state.v),
            ];
            for (vector, field) in fields {
                let Some(vector) = vector else { continue };
                for c in 0..cloud.dimension() {
                    for &i in points {
                        let value = vector[c].value(cloud.point(i as usize), 0.0);
                        if !value.is_finite() {
                            return Err(self.no_value(&path, vector, c, cloud, i));
                        }
                        field[c * n + i as usize] = value;
                    }
                }
            }
            if let Some(random) = initial.random_velocity {
                if initial.velocity.is_none() && initial.file.is_none() {
                    for c in 0..cloud.dimension() {
                        for &i in points {
                            state.v[c * n + i as usize] = 0.0;
                        }
                    }
                }
                Self::add_random(random, cloud, points, whole, &mut state.v);
            }
        }
        Ok(())
    }

    /// Reads the initial state from a file: displacement, m, and velocity, m/s, of each point in the user's order.
    fn initial_rows(
        &self,
        path: &KeyPath,
        file: &FilePath,
        (dimension, points): (usize, usize),
        resources: &Resources<'_>,
    ) -> Result<Vec<f64>, BuildError> {
        const COLUMNS: [[&str; 3]; 2] = [["u_x", "u_y", "u_z"], ["v_x", "v_y", "v_z"]];
        let columns = COLUMNS.map(|names| names[..dimension].to_vec());
        let file = resources.beside(file);
        (resources.read_table)(&file, Some(points), &columns.concat(), resources.memory).map_err(
            |error| {
                let advice = format!(
                    "expected: one line for each of the {points} points, in the order of the field files (listed points: of their file), with displacement components in m, then velocity components in m/s; a relative path starts at the deck's folder"
                );
                let fault = error.fault(|reason| Fault::other("invalid", reason, advice));
                at_path(path.key("file"), fault)
            },
        )
    }

    /// Random velocities are drawn for the whole body in the user's order, independent of the set, so that the
    /// velocity of a point depends only on seed and number.
    fn add_random(
        random: RandomVelocity,
        cloud: &PointCloud,
        points: &[u32],
        whole: usize,
        velocity: &mut [f64],
    ) {
        let n = cloud.len();
        let drawn = uniform_in_ball(cloud.dimension(), random.radius, random.seed, whole);
        for &i in points {
            let vector = drawn[cloud.user_number(i as usize)];
            for c in 0..cloud.dimension() {
                velocity[c * n + i as usize] += vector[c];
            }
        }
    }

    pub(super) fn add_motions(
        &self,
        system: &mut System,
        discretisation: &Discretisation,
        state: &State,
        continues: bool,
    ) -> Result<(), BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        // The time function of static loads and displacements that the deck does not give.
        let usual = TimeHistory::Ramp {
            start: 0.0,
            duration: self.model.time.end,
        };
        let rises = continues && self.model.time.scheme.is_static();
        let mut names: Vec<String> = Vec::new();
        for (k, motion) in self.model.constraints.iter().enumerate() {
            // Several motions of one set (along different axes) need distinct names in tables.
            let mut name = motion.set.clone();
            let mut number = 1;
            while names.contains(&name) {
                number += 1;
                name = format!("{}_{number}", motion.set);
            }
            names.push(name.clone());
            let path = KeyPath::from("constraint").index(k);
            let points = self.members(sets, &motion.set, path.key("set"))?.clone();
            let function = motion
                .function
                .motion_function(motion.kind, self.model.time.end);
            let function = function.map_err(|fault| at_path(path.key("function"), fault))?;
            let add = || {
                let along = self.axis_motions(&path, motion, cloud, &points)?;
                let prescribed = PrescribedMotion::along(
                    name,
                    points,
                    motion.kind,
                    along,
                    function,
                    &state.u,
                    system.points(),
                );
                let mut prescribed = prescribed.map_err(|error| at(&path, error))?;
                prescribed.until = motion.until;
                if rises && motion.function == usual {
                    prescribed = prescribed.rising_from(&state.u, system.points());
                }
                let added = system.add_motion(prescribed);
                added.map_err(|error| match error {
                    PericlesError::PrescribedTwice {
                        point,
                        axis,
                        earlier,
                    } => {
                        let fault = Fault::other(
                            "conflict",
                            format!(
                                "the motion of point {point} along {axis} is already prescribed by [[constraint]] number {}, with other values",
                                earlier + 1
                            ),
                            "choose other points, set this component to \"free\", or give both tables the same value, function and `until`",
                        );
                        at_path(path.clone(), fault)
                    }
                    error => at(&path, error),
                })
            };
            discretisation.agreed(add())?;
        }
        Ok(())
    }

    pub(super) fn point_probes(
        &self,
        discretisation: &Discretisation,
    ) -> Result<Vec<PointProbe>, BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        let mut probes = Vec::new();
        for (k, probe) in self.model.probes.iter().enumerate() {
            let path = KeyPath::from("probe").index(k);
            let points = match &probe.place {
                ProbePlace::Set(set) => self.members(sets, set, path.key("set"))?.clone(),
                ProbePlace::At(place) => {
                    let (nearest, distance) = cloud.nearest_of_all(*place);
                    // Positions inside a cell are within half a diagonal of its centre.
                    let diagonal = (cloud.dimension() as f64).sqrt() * cloud.spacing();
                    if distance > 0.5 * diagonal * (1.0 + 1e-9) {
                        let name = probe.name.clone();
                        let caution = Caution::ProbeOutside { name, distance };
                        self.warn(path.key("at"), caution);
                    }
                    nearest.into_iter().collect()
                }
            };
            probes.push(PointProbe {
                name: probe.name.clone(),
                points,
            });
        }
        Ok(probes)
    }
}
