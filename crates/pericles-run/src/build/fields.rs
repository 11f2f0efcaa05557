//! Loads and prescribed motions given as expressions.

use std::sync::Arc;

use pericles::boundary::{AxisMotion, FieldFunction, LoadDensity, MotionKind, Trajectory};
use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles_deck::{
    BuildError, Component, Constraint, Course, Expression, Fault, KeyPath, TimeHistory, VectorField,
};

use super::assembler::Assembler;
use super::rejection::at_path;

/// A vector of the deck as a field of the engine.
#[derive(Debug)]
struct Field(VectorField);

impl FieldFunction for Field {
    fn value(&self, c: usize, place: [f64; 3], t: f64) -> f64 {
        self.0[c].value(place, t)
    }
}

/// A displacement given as an expression, or by its velocity.
#[derive(Debug)]
struct Motion {
    course: Course,
    /// Order of the time derivative of the displacement that the expression gives.
    ahead: i32,
}

impl Trajectory for Motion {
    fn derivative(&self, order: usize, place: [f64; 3], t: f64) -> f64 {
        self.course.at(order as i32 - self.ahead, place, t)
    }
}

impl Assembler<'_> {
    /// Returns the amplitude of a load, `factor` times a field.
    pub(super) fn load_density(
        &self,
        path: &KeyPath,
        field: &VectorField,
        factor: f64,
        cloud: &PointCloud,
        points: &[u32],
    ) -> Result<LoadDensity, BuildError> {
        if let [Some(x), Some(y), Some(z)] = field.each_ref().map(Component::number) {
            return Ok([x, y, z].map(|number| factor * number).into());
        }
        let mut densities = Vec::with_capacity(3 * points.len());
        for (c, component) in field.iter().enumerate() {
            for &i in points {
                let value = factor * component.value(cloud.point(i as usize), 0.0);
                if !value.is_finite() {
                    return Err(self.no_value(path, field, c, cloud, i));
                }
                densities.push(value);
            }
        }
        if !field.iter().any(Component::depends_on_time) {
            return Ok(LoadDensity::PerPoint(densities));
        }
        Ok(LoadDensity::Field {
            field: Arc::new(Field(field.clone())),
            factor,
            places: points.iter().map(|&i| cloud.point(i as usize)).collect(),
        })
    }

    /// Returns the prescribed motion along each axis.
    pub(super) fn axis_motions(
        &self,
        path: &KeyPath,
        motion: &Constraint,
        cloud: &PointCloud,
        points: &[u32],
    ) -> Result<[Option<AxisMotion>; 3], BuildError> {
        let place = |i: &u32| cloud.point(*i as usize);
        let mut along = [None, None, None];
        for (c, component) in motion.amplitude.iter().enumerate() {
            along[c] = match component {
                None => None,
                Some(Component::Number(amplitude)) => Some(AxisMotion::Uniform(*amplitude)),
                Some(Component::Expression(expression)) if expression.depends_on_time() => {
                    if motion.function != TimeHistory::Constant {
                        let fault = Fault::TwoCourses {
                            text: expression.text().into(),
                        };
                        return Err(at_path(path.key("function"), fault));
                    }
                    let places: Vec<[f64; 3]> = points.iter().map(place).collect();
                    Some(AxisMotion::Trajectory {
                        trajectory: Arc::new(self.trajectory(
                            path,
                            motion.kind,
                            expression,
                            &places,
                        )?),
                        places,
                    })
                }
                Some(Component::Expression(expression)) => {
                    let values = points.iter().map(|i| expression.value(place(i), 0.0));
                    Some(AxisMotion::PerPoint(values.collect()))
                }
            };
            if let Some(AxisMotion::PerPoint(values)) = &along[c]
                && let Some(k) = values.iter().position(|value| !value.is_finite())
            {
                let field = motion.amplitude.clone();
                let field = field.map(|entry| entry.unwrap_or(Component::Number(0.0)));
                return Err(self.no_value(path, &field, c, cloud, points[k]));
            }
        }
        Ok(along)
    }

    fn trajectory(
        &self,
        path: &KeyPath,
        kind: MotionKind,
        expression: &Expression,
        places: &[[f64; 3]],
    ) -> Result<Motion, BuildError> {
        let ahead = match kind {
            MotionKind::Displacement => 0,
            MotionKind::Velocity => 1,
        };
        let course = Course::new(expression.clone());
        if kind == MotionKind::Displacement && !course.is_smooth() {
            return Err(at_path(path, course.rough()));
        }
        let places = match expression.depends_on_place() {
            true => places,
            false => &places[..places.len().min(1)],
        };
        for place in places {
            let checked = course.check_jumps(*place, self.model.time.end);
            checked.map_err(|fault| at_path(path, fault))?;
        }
        Ok(Motion { course, ahead })
    }

    /// Creates the error for an expression that is NaN or infinite at a point.
    pub(super) fn no_value(
        &self,
        path: &KeyPath,
        field: &VectorField,
        c: usize,
        cloud: &PointCloud,
        point: u32,
    ) -> BuildError {
        let place = cloud.point(point as usize);
        let text = match &field[c] {
            Component::Expression(expression) => expression.text().to_owned(),
            Component::Number(number) => number.to_string(),
        };
        let [x, y, z] = place.map(|x| quantity(x, "m"));
        let reason = format!(
            "the value at ({x}, {y}, {z}) and t = 0 is NaN or infinite; it must be finite at every point of the set"
        );
        at_path(path, Fault::bad_expression(text, reason))
    }
}
