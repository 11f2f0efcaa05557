//! Mirror symmetries of the data of a run, and the deviation of its state from them.
//!
//! A run is symmetric about the plane through the centre of its body if every point has an image of the same volume
//! and density, and if initial fields, loads, constraints, forces and failure are the same at both. Forces are
//! compared for random symmetric displacements, so that differences in materials, cracks or corrections are detected.
//! A bar may also be antisymmetric, for example with a pulse that travels to both sides.

use std::fmt;

use pericles::boundary::{AxisMotion, LoadDensity};
use pericles::noise::SplitMix64;
use pericles::operator::PointSubset;
use pericles::space::PointCloud;
use pericles::{Simulation, System};
use pericles_io::observers::impactors;
use rayon::slice::ParallelSliceMut;
use serde::Serialize;

use crate::units::significant;

/// Larger bodies are not checked: the images would need more memory than the forces.
const MOST_POINTS: usize = 1_000_000;
/// Tolerance for positions, relative to the spacing.
const SAME_PLACE: f64 = 1e-4;
/// Tolerance for fields, relative to their largest value.
const SAME_FIELD: f64 = 1e-9;
/// Tolerance for forces, whose sums have rounding errors.
const SAME_FORCE: f64 = 1e-8;
/// Times at which loads and constraints are compared, as fractions of the end time.
const MOMENTS: [f64; 5] = [0.0, 0.137, 0.41, 0.73, 1.0];
const AXES: [&str; 3] = ["x", "y", "z"];

/// A mirror symmetry.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Symmetry {
    axis: usize,
    /// −1 for antisymmetry.
    sign: f64,
}

/// The symmetries of the data of a run.
#[derive(Debug, Default)]
pub struct Symmetries(Vec<Symmetry>);

/// The deviation of a state from a mirror symmetry.
#[derive(Debug, Clone, Serialize)]
pub struct MirrorError {
    /// The axis normal to the mirror plane.
    pub axis: &'static str,
    /// Whether the run is antisymmetric.
    pub opposite: bool,
    /// Largest deviation of the displacements, relative to the largest displacement.
    pub error: f64,
}

impl fmt::Display for MirrorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            axis,
            opposite,
            error,
        } = self;
        let sign = if *opposite {
            "antisymmetry"
        } else {
            "symmetry"
        };
        let error = significant(*error, 2);
        write!(f, "Mirror {sign} about {axis} holds to {error} (relative).")
    }
}

/// Returns whether loads or prescribed motions are functions of a program, which are called at the times of the scheme
/// only.
fn has_functions(system: &System) -> bool {
    let mut loads = system.loads().iter();
    let mut axes = system
        .motions()
        .iter()
        .flat_map(|motion| motion.along.iter().flatten());
    loads.any(|load| match &load.density {
        LoadDensity::Values(values) => values.can_fail(),
        _ => false,
    }) || axes.any(|along| match along {
        AxisMotion::Values(values) => values.can_fail(),
        _ => false,
    })
}

impl Symmetries {
    /// Detects the symmetries of a simulation before its first step.
    pub fn of(simulation: &Simulation) -> Self {
        let system = simulation.system();
        // Absorbing boundaries, damping layers and impactors are not compared, nor are the parts of a divided body.
        let struck = impactors(system).next().is_some();
        let skipped = system.has_boundaries() || struck || has_functions(system);
        if system.points() > MOST_POINTS || skipped || system.domain().is_divided() {
            return Self::default();
        }
        let signs: &[f64] = if system.dimension() == 1 {
            &[1.0, -1.0]
        } else {
            &[1.0]
        };
        let mut found = Vec::new();
        for axis in 0..system.dimension() {
            let Some(mirror) = Mirror::across(axis, system.cloud()) else {
                continue;
            };
            let symmetries = signs.iter().map(|&sign| Symmetry { axis, sign });
            found.extend(
                symmetries
                    .clone()
                    .find(|symmetry| mirror.keeps(symmetry.sign, simulation)),
            );
        }
        Self(found)
    }

    /// Returns the deviations of the current state.
    ///
    /// The conditions of computed temperatures are not compared before the run: a symmetry that the temperatures do not have is not
    /// one of the data.
    pub fn errors(&self, simulation: &Simulation) -> Vec<MirrorError> {
        let system = simulation.system();
        let temperatures: Vec<Vec<f64>> = system
            .fields()
            .map(|field| {
                let mut values = vec![f64::NAN; system.points()];
                field.values_into(simulation.state().t, &mut values);
                values
            })
            .collect();
        let errors = self.0.iter().filter_map(|symmetry| {
            let mirror = Mirror::across(symmetry.axis, system.cloud())?;
            if !temperatures
                .iter()
                .all(|field| mirror.is_even_in_range(field))
            {
                return None;
            }
            Some(MirrorError {
                axis: AXES[symmetry.axis],
                opposite: symmetry.sign < 0.0,
                error: mirror.difference(symmetry.sign, &simulation.state().u),
            })
        });
        errors.collect()
    }
}

/// A mirror plane through the centre of a body.
struct Mirror {
    axis: usize,
    /// The image of every point.
    images: Vec<u32>,
}

impl Mirror {
    /// Creates the mirror plane normal to an axis, if every point has an image with the same volume.
    fn across(axis: usize, cloud: &PointCloud) -> Option<Self> {
        let [low, high] = cloud.bounds();
        let (grain, dimension) = (SAME_PLACE * cloud.spacing(), cloud.dimension());
        let sorted = |side: f64| {
            let mut places: Vec<([i64; 3], u32)> = (0..cloud.len())
                .map(|i| {
                    let mut place = [0; 3];
                    for (c, place) in place.iter_mut().enumerate().take(dimension) {
                        let from_middle = cloud.axis(c)[i] - 0.5 * (low[c] + high[c]);
                        let sign = if c == axis { side } else { 1.0 };
                        *place = (sign * from_middle / grain).round() as i64;
                    }
                    (place, i as u32)
                })
                .collect();
            places.par_sort_unstable();
            places
        };
        let mut images = vec![0; cloud.len()];
        for ((place, i), (image_place, image)) in sorted(1.0).into_iter().zip(sorted(-1.0)) {
            if place != image_place {
                return None;
            }
            images[i as usize] = image;
        }
        let mirror = Self { axis, images };
        mirror.is_even(cloud.volumes()).then_some(mirror)
    }

    /// Returns whether a scalar per point is symmetric.
    fn is_even(&self, values: &[f64]) -> bool {
        let mut pairs = values.iter().zip(&self.images);
        pairs.all(|(a, &image)| {
            let b = values[image as usize];
            (a - b).abs() <= SAME_FIELD * a.abs().max(b.abs())
        })
    }

    /// Returns whether a computed scalar is symmetric to the accuracy of iterative solvers.
    fn is_even_in_range(&self, values: &[f64]) -> bool {
        /// Tolerance relative to the range of the values.
        const SOLVED: f64 = 1e-5;
        let range = |[low, high]: [f64; 2], x: &f64| [low.min(*x), high.max(*x)];
        let [low, high] = values
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], range);
        let rounding = SAME_FIELD * low.abs().max(high.abs());
        let allowed = rounding.max(SOLVED * (high - low));
        let mut pairs = values.iter().zip(&self.images);
        pairs.all(|(a, &image)| (a - values[image as usize]).abs() <= allowed)
    }

    /// Returns the sign of a component in the image.
    fn sign(&self, component: usize, sign: f64) -> f64 {
        if component == self.axis { -sign } else { sign }
    }

    /// Returns the largest difference between a vector field and its image, relative to its largest entry. The images
    /// of NaN entries must be NaN.
    fn difference(&self, sign: f64, field: &[f64]) -> f64 {
        let (mut most, mut largest) = (0.0f64, 0.0f64);
        for (c, component) in field.chunks(self.images.len()).enumerate() {
            let sign = self.sign(c, sign);
            for (a, &image) in component.iter().zip(&self.images) {
                let b = sign * component[image as usize];
                match (a.is_nan(), b.is_nan()) {
                    (true, true) => {}
                    (false, false) => {
                        most = most.max((a - b).abs());
                        largest = largest.max(a.abs());
                    }
                    _ => return f64::INFINITY,
                }
            }
        }
        if most == 0.0 { 0.0 } else { most / largest }
    }

    /// Returns whether a simulation before its first step is symmetric.
    fn keeps(&self, sign: f64, simulation: &Simulation) -> bool {
        let (system, state) = (simulation.system(), simulation.state());
        let alike = |field: &[f64]| self.difference(sign, field) <= SAME_FIELD;
        let density: Vec<f64> = (0..system.points())
            .map(|i| system.density().at(i))
            .collect();
        let end = simulation.dt() * simulation.steps() as f64;
        self.is_even(&density)
            && alike(&state.u)
            && alike(&state.v)
            && MOMENTS
                .iter()
                .all(|moment| self.acts_alike(sign, system, moment * end))
            && self.resists_alike(sign, system, &state.u)
    }

    /// Returns whether loads and constraints are symmetric at a time.
    fn acts_alike(&self, sign: f64, system: &System, t: f64) -> bool {
        let entries = system.dimension() * system.points();
        let alike = |fill: &dyn Fn(&mut [f64]), elsewhere: f64| {
            let mut field = vec![elsewhere; entries];
            fill(&mut field);
            self.difference(sign, &field) <= SAME_FIELD
        };
        if let Some(thermal) = system.operator().capabilities().thermal
            && system.fields().next().is_none()
        {
            let mut temperatures = vec![0.0; system.points()];
            thermal.temperatures_into(t, &mut temperatures);
            if !self.is_even(&temperatures) {
                return false;
            }
        }
        // Unconstrained entries stay NaN.
        alike(&|field| system.load_density_into(t, field), 0.0)
            && alike(
                &|field| system.place_on(t, &PointSubset::All, field),
                f64::NAN,
            )
            && alike(
                &|field| system.drive_on(t, &PointSubset::All, field),
                f64::NAN,
            )
    }

    /// Returns whether forces and failure are symmetric for symmetric displacements.
    fn resists_alike(&self, sign: f64, system: &System, start: &[f64]) -> bool {
        let (n, operator) = (system.points(), system.operator());
        let amplitude = 1e-3 * system.cloud().spacing();
        let mut generator = SplitMix64::new(1);
        let noise: Vec<f64> = start.iter().map(|_| generator.signed()).collect();
        let moved = |amplitude: f64| -> Vec<f64> {
            let image = |entry: usize| {
                let (c, i) = (entry / n, entry % n);
                self.sign(c, sign) * noise[c * n + self.images[i] as usize]
            };
            (0..start.len())
                .map(|entry| start[entry] + 0.5 * amplitude * (noise[entry] + image(entry)))
                .collect()
        };
        let u = moved(amplitude);
        let mut force = vec![0.0; u.len()];
        operator.add_force(0.0, &u, PointSubset::All, &mut force);
        let rounding = operator.rounding(&u).unwrap_or(0.0);
        if self.difference(sign, &force) > SAME_FORCE.max(100.0 * rounding) {
            return false;
        }
        if !operator.can_break() {
            return true;
        }
        let Some(breaking) = operator.capabilities().breaking else {
            return false;
        };
        // Stretches from well below to well above the critical ones.
        [0.01, 0.1, 1.0, 10.0, 100.0].iter().all(|times| {
            let mut marks = vec![false; n];
            breaking.mark_endangered(&moved(times * amplitude), 1.0, &mut marks);
            let mut pairs = marks.iter().zip(&self.images);
            pairs.all(|(mark, &image)| *mark == marks[image as usize])
        })
    }
}
