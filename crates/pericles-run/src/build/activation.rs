//! Times at which points become part of the body.

use pericles::System;
use pericles::parallel::for_each_point;
use pericles_deck::{Activation, ActivationStart, BuildError, Component, Fault, KeyPath};
use pericles_heat::DiffusingField;

use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::rejection::{at, at_path};
use super::resources::Resources;

impl Assembler<'_> {
    /// Returns the time from which each own point is active, s; `None` if all are from the start. Sets the temperatures that
    /// they take then.
    pub(super) fn activation(
        &self,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
        field: Option<&mut DiffusingField>,
    ) -> Result<Option<Vec<f64>>, BuildError> {
        let cloud = &*discretisation.cloud;
        if self.model.activations.is_empty() {
            return Ok(None);
        }
        let mut times = vec![f64::NEG_INFINITY; cloud.len()];
        let mut temperatures = vec![None; cloud.len()];
        for (k, one) in self.model.activations.iter().enumerate() {
            let path = KeyPath::from("activation").index(k);
            if one.temperature.is_some() && field.is_none() {
                let value = "temperature".into();
                let allowed =
                    "allowed: in bodies with heat conduction (`conductivity` in [thermal])".into();
                let fault = Fault::OutOfRange { value, allowed };
                return Err(at_path(path.key("temperature"), fault));
            }
            let points = self.members(&discretisation.sets, &one.set, path.key("set"))?;
            let found = self.start_times(&path, one, points, discretisation, resources);
            for (&i, time) in points.iter().zip(discretisation.agreed(found)?) {
                times[i as usize] = time;
                temperatures[i as usize] = one.temperature;
            }
        }
        if let Some(field) = field {
            let set = field.set_new_values(temperatures);
            set.map_err(|error| at("activation", error))?;
        }
        Ok(Some(times))
    }

    /// Returns the time from which each point of a table is active, s.
    fn start_times(
        &self,
        path: &KeyPath,
        one: &Activation,
        points: &[u32],
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Vec<f64>, BuildError> {
        let cloud = &*discretisation.cloud;
        let place = |i: u32| cloud.point(i as usize);
        match &one.start {
            ActivationStart::ActiveFrom(time) => {
                let times: Vec<f64> = points.iter().map(|&i| time.value(place(i), 0.0)).collect();
                match times.iter().position(|time| time.is_nan()) {
                    None => Ok(times),
                    Some(k) => {
                        let none = Component::Number(0.0);
                        let field = [time.clone(), none.clone(), none];
                        Err(self.no_value(&path.key("active_from"), &field, 0, cloud, points[k]))
                    }
                }
            }
            ActivationStart::Path { path: file, radius } => {
                let track = self.track(path, file, cloud.dimension(), resources)?;
                Ok(for_each_point(points.len(), &|k| {
                    track.arrival(place(points[k]), *radius)
                }))
            }
        }
    }

    /// Reads the path of a source of material.
    fn track(
        &self,
        path: &KeyPath,
        file: &std::path::Path,
        dimension: usize,
        resources: &Resources<'_>,
    ) -> Result<Track, BuildError> {
        let columns = &["t", "x", "y", "z"][..=dimension];
        let advice = format!(
            "expected: lines with {} (s, m), in the order of time; a relative path starts at the deck's folder",
            columns.join(", ")
        );
        let key = path.key("path");
        let wrong = |reason: String| Fault::other("invalid", reason, advice.clone());
        let place = resources.beside(file);
        let rows = (resources.read_table)(&place, None, columns, resources.memory);
        let numbers = rows.map_err(|error| at_path(&key, error.fault(wrong)))?;
        let rows = numbers.chunks_exact(columns.len()).map(|row| {
            let mut at = [0.0; 3];
            at[..dimension].copy_from_slice(&row[1..]);
            (row[0], at)
        });
        let track = Track(rows.collect());
        let reason = match track.0.windows(2).position(|ends| ends[1].0 < ends[0].0) {
            Some(k) => format!(
                "{}: the time {} follows the later time {}",
                place.display(),
                track.0[k + 1].0,
                track.0[k].0
            ),
            None if track.0.is_empty() => format!("{}: no numbers", place.display()),
            None => return Ok(track),
        };
        Err(at_path(&key, wrong(reason)))
    }

    /// Makes the body grow with its points.
    pub(super) fn activate(
        &self,
        (system, times): (&mut System, Option<Vec<f64>>),
        resources: &Resources<'_>,
    ) -> Result<(), BuildError> {
        let Some(times) = times else {
            return Ok(());
        };
        let model = self.model;
        let conduction = model
            .thermal
            .as_ref()
            .and_then(|own| own.conduction.as_ref());
        let rejections = [
            (
                resources.start.continues() || resources.start.origin().is_some(),
                "runs of several steps, and runs that start from another run, have the same points from their start",
                "use one step whose conditions depend on time",
            ),
            (
                model.contact.is_some() || !model.impactors.is_empty(),
                "contact does not distinguish points that are not active",
                "remove [contact] and [[impactor]], or [[activation]]",
            ),
            (
                conduction.is_some_and(|own| own.broken_conductance > 0.0),
                "bonds that do not exist yet would conduct as broken ones",
                "set broken_conductance = 0 in [thermal]",
            ),
        ];
        for (is_met, reason, advice) in rejections {
            if is_met {
                let fault = Fault::other("not supported", reason.into(), advice);
                return Err(at_path("activation", fault));
            }
        }
        (system.add_activation(times)).map_err(|error| at("activation", error))
    }
}

/// The path of a source of material: times, s, and places, m.
struct Track(Vec<(f64, [f64; 3])>);

impl Track {
    /// Returns the time at which the source is first within a distance of a place; infinite if it stays farther away.
    fn arrival(&self, place: [f64; 3], radius: f64) -> f64 {
        let relative = |at: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|c| at[c] - place[c]) };
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let is_near = |at: &[f64; 3]| dot(&relative(at), &relative(at)) <= radius * radius;
        if let Some((time, _)) = self.0.first().filter(|(_, at)| is_near(at)) {
            return *time;
        }
        for ends in self.0.windows(2) {
            let [(from, start), (to, end)] = [ends[0], ends[1]];
            let (begin, way) = (relative(&start), std::array::from_fn(|c| end[c] - start[c]));
            // |begin + s way|² = radius² for the share s of the segment; a jump has its end only.
            let (square, slope) = (dot(&way, &way), dot(&begin, &way));
            let root = slope * slope - square * (dot(&begin, &begin) - radius * radius);
            let share = (-slope - root.max(0.0).sqrt()) / square;
            if to > from && root >= 0.0 && (0.0..=1.0).contains(&share) {
                return from + share * (to - from);
            }
            if is_near(&end) {
                return to;
            }
        }
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_arrive_when_they_come_within_the_radius() {
        let track = Track(vec![
            (1.0, [0.0; 3]),
            (2.0, [10.0, 0.0, 0.0]),
            (2.0, [0.0, 5.0, 0.0]),
            (4.0, [10.0, 5.0, 0.0]),
        ]);
        let arrival = |x: f64, y: f64| track.arrival([x, y, 0.0], 0.5);
        assert_eq!(arrival(0.3, 0.0), 1.0);
        assert!((arrival(5.0, 0.3) - (1.0 + (5.0 - 0.4) / 10.0)).abs() < 1e-12);
        assert!((arrival(5.0, 5.0) - (2.0 + 2.0 * 4.5 / 10.0)).abs() < 1e-12);
        // The source jumps over this place.
        assert_eq!(arrival(5.0, 2.5), f64::INFINITY);
        assert_eq!(arrival(0.0, 5.2), 2.0);
    }
}
