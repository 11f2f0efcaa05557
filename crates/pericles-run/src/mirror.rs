//! Mirror images: which a body, with all that acts on it, has at its start, and by how much its state at the end is not one.
//!
//! A run is its own image across the plane through the middle of its body if every point has an image of the same volume and density, and if initial fields, loads,
//! supports, forces and breaking are the same at both. Forces are compared on displacements that are images of each other and random otherwise: whatever makes
//! bonds different, materials, cracks, corrections, shows in them. A bar may also be the image with the opposite sign, as a hump that goes to both sides is.

use std::fmt;

use pericles::noise::SplitMix64;
use pericles::operator::On;
use pericles::space::PointCloud;
use pericles::{Simulation, System};
use rayon::slice::ParallelSliceMut;
use serde::Serialize;

use crate::units::significant;

/// Bodies of more points are not looked at: the images would take more memory than the forces do.
const MOST_POINTS: usize = 1_000_000;
/// Places that differ by less of a spacing are the same.
const SAME_PLACE: f64 = 1e-4;
/// Fields that differ by less of their largest value are the same.
const SAME_FIELD: f64 = 1e-9;
/// Forces differ by rounding, and they are sums.
const SAME_FORCE: f64 = 1e-8;
/// Moments at which loads and supports are compared, as parts of the time a run takes.
const MOMENTS: [f64; 5] = [0.0, 0.137, 0.41, 0.73, 1.0];
const AXES: [&str; 3] = ["x", "y", "z"];

/// What is an image of itself.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Symmetry {
    axis: usize,
    /// −1 for the image with the opposite sign.
    sign: f64,
}

/// The symmetries of a run, as found at its start.
#[derive(Debug, Default)]
pub struct Symmetries(Vec<Symmetry>);

/// How far a state is from its image.
#[derive(Debug, Clone, Serialize)]
pub struct MirrorError {
    /// The mirror is across it.
    pub axis: &'static str,
    /// Whether the image has the opposite sign.
    pub opposite: bool,
    /// Largest difference of displacements over the largest displacement.
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
            " with the opposite sign"
        } else {
            ""
        };
        let error = significant(*error, 2);
        write!(
            f,
            "mirror image in {axis}{sign}: displacements are their own, but for {error} of the largest"
        )
    }
}

impl Symmetries {
    /// Those of a simulation before its first step.
    pub fn of(simulation: &Simulation) -> Self {
        let system = simulation.system();
        // What leaves through ends and layers is not asked for its image.
        if system.points() > MOST_POINTS || system.has_boundaries() {
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

    /// How far the state is from them.
    pub fn errors(&self, simulation: &Simulation) -> Vec<MirrorError> {
        let errors = self.0.iter().filter_map(|symmetry| {
            let mirror = Mirror::across(symmetry.axis, simulation.system().cloud())?;
            Some(MirrorError {
                axis: AXES[symmetry.axis],
                opposite: symmetry.sign < 0.0,
                error: mirror.difference(symmetry.sign, &simulation.state().u),
            })
        });
        errors.collect()
    }
}

/// A mirror through the middle of a body.
struct Mirror {
    axis: usize,
    /// The image of every point.
    images: Vec<u32>,
}

impl Mirror {
    /// The mirror across an axis, if every point has an image with the same volume.
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

    /// Whether a number per point is the same at the images.
    fn is_even(&self, values: &[f64]) -> bool {
        let mut pairs = values.iter().zip(&self.images);
        pairs.all(|(a, &image)| {
            let b = values[image as usize];
            (a - b).abs() <= SAME_FIELD * a.abs().max(b.abs())
        })
    }

    /// What the sign of a component is in the image.
    fn sign(&self, component: usize, sign: f64) -> f64 {
        if component == self.axis { -sign } else { sign }
    }

    /// Largest difference between a vector field and its image, over its largest entry. The images of NaN entries are NaN.
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

    /// Whether a simulation before its first step is its own image.
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

    /// Whether loads and supports of a moment are their own images.
    fn acts_alike(&self, sign: f64, system: &System, t: f64) -> bool {
        let entries = system.dimension() * system.points();
        let alike = |fill: &dyn Fn(&mut [f64]), elsewhere: f64| {
            let mut field = vec![elsewhere; entries];
            fill(&mut field);
            self.difference(sign, &field) <= SAME_FIELD
        };
        // What is not held keeps what is no number.
        alike(&|field| system.load_density_into(t, field), 0.0)
            && alike(&|field| system.place_on(t, &On::All, field), f64::NAN)
            && alike(&|field| system.drive_on(t, &On::All, field), f64::NAN)
    }

    /// Whether forces, and what is about to break, are images under displacements that are.
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
        operator.add_force(0.0, &u, On::All, &mut force);
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
        // Stretches from well below to well above those that break anything.
        [0.01, 0.1, 1.0, 10.0, 100.0].iter().all(|times| {
            let mut marks = vec![false; n];
            breaking.mark_endangered(&moved(times * amplitude), 1.0, &mut marks);
            let mut pairs = marks.iter().zip(&self.images);
            pairs.all(|(mark, &image)| *mark == marks[image as usize])
        })
    }
}
