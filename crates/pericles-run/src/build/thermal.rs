//! Thermal expansion by a prescribed or computed temperature.

use std::sync::Arc;

use pericles::boundary::TimeFunction;
use pericles::material::{StressState, SurfaceCorrection};
use pericles::parallel::for_each_point;
use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles::{PointScalar, Temperature, ThermalExpansion};
use pericles_deck::{
    Body, BuildError, Component, Fault, KeyPath, MaterialThermal, Property, Scheme, Solid, Thermal,
};
use pericles_heat::DiffusingField;
use pericles_waves::AssembledForce;

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::properties::{FINITE, OfMaterial};
use super::rejection::{at, at_path};
use super::resources::Resources;

/// A temperature given by the deck: T₀ + g(t) (T − T₀).
#[derive(Debug)]
struct Prescribed {
    cloud: Arc<PointCloud>,
    value: Given,
    function: TimeFunction,
    reference: f64,
}

/// The temperature T.
#[derive(Debug)]
pub(super) enum Given {
    Formula(Component),
    OfPoints(Vec<f64>),
}

impl Temperature for Prescribed {
    fn temperatures_into(&self, t: f64, out: &mut [f64]) {
        match &self.value {
            Given::Formula(Component::Number(value)) => out.fill(*value),
            Given::Formula(value) => {
                let at = |i: usize| value.value(self.cloud.point(i), t);
                out.copy_from_slice(&for_each_point(out.len(), &at));
            }
            Given::OfPoints(values) => out.copy_from_slice(values),
        }
        if !matches!(self.function, TimeFunction::Constant) {
            let factor = self.function.value(t);
            for value in out {
                *value = self.reference + factor * (*value - self.reference);
            }
        }
    }

    fn is_steady(&self) -> bool {
        let varies = match &self.value {
            Given::Formula(value) => value.depends_on_time(),
            Given::OfPoints(_) => false,
        };
        !varies && matches!(self.function, TimeFunction::Constant)
    }
}

impl Assembler<'_> {
    /// Returns whether the forces depend on the temperature.
    pub(super) fn expands(&self) -> bool {
        let thermal = self.model.thermal.as_ref();
        let coefficient = thermal.is_some_and(|thermal| thermal.expansion.is_some());
        coefficient && self.model.time.scheme != Scheme::Thermal
    }

    /// Adds thermal expansion to the materials of a body, if the model has it.
    pub(super) fn heat(
        &self,
        parts: &mut BodyParts,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
        field: Option<&DiffusingField>,
    ) -> Result<(), BuildError> {
        let (Some(thermal), Body::Solid(solid)) = (&self.model.thermal, &self.model.body) else {
            return Ok(());
        };
        self.check_thermal_materials(thermal, solid)?;
        let Some(expansion) = thermal.expansion.as_ref().filter(|_| self.expands()) else {
            return Ok(());
        };
        if solid.material.surface_correction == SurfaceCorrection::Ghosts {
            let value = "\"ghosts\"".into();
            let allowed = "allowed: a correction without ghost points, which have no temperature, for bodies with thermal expansion".into();
            let fault = Fault::OutOfRange { value, allowed };
            return Err(at_path("material.surface_correction", fault));
        }
        let path = KeyPath::from("thermal");
        let Some(reference) = thermal.reference else {
            let (table, allowed) = ("[thermal]".into(), vec!["reference".into()]);
            return Err(at_path(path, Fault::MissingChoice { table, allowed }));
        };
        let cloud = &discretisation.cloud;
        let coefficient = self.coefficients((thermal, expansion), solid, parts, discretisation)?;
        let temperature: Arc<dyn Temperature> = match field {
            Some(field) => Arc::new(field.shared()),
            None => self.prescribed_temperature(thermal, discretisation, resources)?,
        };
        let expansion = ThermalExpansion::new(cloud.clone(), temperature, reference, coefficient);
        let expansion = expansion.map_err(|error| at("thermal", error))?;
        let AssembledForce { operator, .. } = &mut parts.bonds;
        operator
            .expand(expansion)
            .map_err(|error| at("thermal", error))
    }

    /// Returns the prescribed temperature, or the initial one of heat conduction.
    pub(super) fn prescribed_temperature(
        &self,
        thermal: &Thermal,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Arc<dyn Temperature>, BuildError> {
        let (cloud, path) = (&discretisation.cloud, KeyPath::from("thermal.function"));
        let function = thermal.function.function();
        let value = self.temperature(thermal, cloud, resources);
        Ok(Arc::new(Prescribed {
            cloud: cloud.clone(),
            value: discretisation.agreed(value)?,
            function: function.map_err(|fault| at_path(path, fault))?,
            // Functions of time require a reference temperature.
            reference: thermal.reference.unwrap_or_default(),
        }))
    }

    /// Returns the expansion coefficient of every point. In plane strain the out-of-plane strain is prevented, so
    /// that the in-plane thermal stretch is larger by the factor 1 + ν for bond-based and state-based materials.
    fn coefficients(
        &self,
        (thermal, expansion): (&Thermal, &Property),
        solid: &Solid,
        parts: &BodyParts,
        discretisation: &Discretisation,
    ) -> Result<PointScalar, BuildError> {
        let constants = parts.constants.iter().chain(&parts.others);
        let all = self.of_names(
            thermal,
            "expansion",
            (expansion, |own| own.expansion.as_ref()),
            solid,
        );
        let all = all
            .into_iter()
            .zip(constants)
            .map(|(own, constants)| OfMaterial {
                factor: in_plane(constants, solid.state),
                ..own
            });
        let all: Vec<OfMaterial<'_>> = all.collect();
        self.of_materials(&all, ("1/K", FINITE), solid, discretisation)
    }

    /// Returns a thermal property of all materials, the body's material first: their own one, or that of all materials.
    pub(super) fn of_names<'t>(
        &self,
        thermal: &'t Thermal,
        key: &'static str,
        (all, own): (&'t Property, fn(&MaterialThermal) -> Option<&Property>),
        solid: &Solid,
    ) -> Vec<OfMaterial<'t>> {
        let path = KeyPath::from("thermal");
        let of_name = |name: &str| {
            let mut given = thermal.materials.iter().enumerate();
            let found = given.find(|(_, material)| material.name == name);
            let found = found
                .and_then(|(k, material)| Some((path.key("material").index(k), own(material)?)));
            let (path, property) = found.unwrap_or((path.clone(), all));
            OfMaterial {
                path: path.key(key),
                property,
                factor: 1.0,
            }
        };
        self.material_names(solid)
            .into_iter()
            .map(of_name)
            .collect()
    }

    /// Returns the names of all materials, the body's material first.
    pub(super) fn material_names<'s>(&'s self, solid: &'s Solid) -> Vec<&'s str> {
        let others = self.model.materials.iter().map(|other| other.name.as_str());
        std::iter::once(solid.material.name())
            .chain(others)
            .collect()
    }

    /// Rejects constants of materials that do not exist.
    fn check_thermal_materials(&self, thermal: &Thermal, solid: &Solid) -> Result<(), BuildError> {
        let names = self.material_names(solid);
        for (k, own) in thermal.materials.iter().enumerate() {
            if !names.contains(&own.name.as_str()) {
                let fault = Fault::UnknownWord {
                    what: "material",
                    value: own.name.clone(),
                    nearest: None,
                    allowed: names.iter().map(|&name| name.to_owned()).collect(),
                };
                let key = KeyPath::from("thermal").key("material").index(k);
                return Err(at_path(key.key("name"), fault));
            }
        }
        Ok(())
    }

    /// Returns the temperature; rejects an expression that is not finite at a point at t = 0.
    pub(super) fn temperature(
        &self,
        thermal: &Thermal,
        cloud: &PointCloud,
        resources: &Resources<'_>,
    ) -> Result<Given, BuildError> {
        let path = KeyPath::from("thermal");
        let (n, memory) = (cloud.len(), resources.memory);
        let points = cloud.domain().whole_points();
        let formula = match (&thermal.temperature, &thermal.file) {
            (_, Some(file)) => {
                let file = resources.beside(file);
                let rows = (resources.read_table)(&file, Some(points), &["temperature"], memory);
                let rows = rows.map_err(|error| {
                    let advice = format!(
                        "expected: one line for each of the {points} points, in the order of the field files (listed points: of their file), with the temperature in K; a relative path starts at the deck's folder"
                    );
                    let wrong = |reason| Fault::other("invalid", reason, advice);
                    at_path(path.key("file"), error.fault(wrong))
                })?;
                let of_point = (0..n).map(|i| rows[cloud.user_number(i)]);
                return Ok(Given::OfPoints(of_point.collect()));
            }
            (Some(formula), None) => formula,
            (None, None) => {
                let allowed = ["temperature", "file"].map(String::from).into();
                let table = "[thermal]".into();
                return Err(at_path(path, Fault::MissingChoice { table, allowed }));
            }
        };
        let value = |i: usize| formula.value(cloud.point(i), 0.0);
        let Some(i) = (0..n).find(|&i| !value(i).is_finite()) else {
            return Ok(Given::Formula(formula.clone()));
        };
        let text = match formula {
            Component::Expression(expression) => expression.text().to_owned(),
            Component::Number(number) => number.to_string(),
        };
        let [x, y, z] = cloud.point(i).map(|x| quantity(x, "m"));
        let reason = format!(
            "the value at ({x}, {y}, {z}) and t = 0 is NaN or infinite; it must be finite at every point"
        );
        let fault = Fault::bad_expression(text, reason);
        Err(at_path(path.key("temperature"), fault))
    }
}

/// Returns the thermal stretch of bonds relative to α ΔT.
fn in_plane(constants: &MaterialConstants, state: StressState) -> f64 {
    let nu = match (constants, state) {
        (MaterialConstants::Bonds(_), StressState::PlaneStrain) => state.poisson_ratio(),
        (MaterialConstants::StateBased(solid), StressState::PlaneStrain) => {
            Some(solid.elastic.poisson_ratio())
        }
        _ => None,
    };
    1.0 + nu.unwrap_or(0.0)
}
