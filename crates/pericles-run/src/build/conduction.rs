//! Heat conduction: conductances, capacities and conditions of the computed temperature.

use std::sync::Arc;

use pericles::boundary::TimeFunction;
use pericles::parallel::for_each_point;
use pericles::space::PointCloud;
use pericles::units::precise;
use pericles::{PointScalar, System};
use pericles_deck::{
    Body, BuildError, Caution, Component, ConductionScheme, ConductivityMean, Fault, KeyPath,
    MaterialModel, Property, Solid, SolidShape, Thermal, ThermalAmplitude, ThermalCondition,
};
use pericles_heat::{
    Condition, DiffusingField, DiffusionBody, Exchange, FieldOptions, Interface, Kind, Problem,
    Scheme, Value,
};

use super::area::{self, LoadedCells};
use super::assembler::Assembler;
use super::body::BodyParts;
use super::discretisation::Discretisation;
use super::loads::volume_of;
use super::plausible_heat::check_radiation;
use super::properties::{NOT_NEGATIVE, OfMaterial, POSITIVE};
use super::rejection::{at, at_path};
use super::resources::Resources;
use super::thermal::Given;

/// Stefan–Boltzmann constant, W/(m² K⁴).
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

impl Assembler<'_> {
    /// Builds the computed temperature of own points, if the model has heat conduction. All processes must call it together.
    pub(super) fn conduct(
        &self,
        parts: &BodyParts,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<Option<DiffusingField>, BuildError> {
        let (Some(thermal), Body::Solid(solid)) = (&self.model.thermal, &self.model.body) else {
            return Ok(None);
        };
        let Some(conduction) = &thermal.conduction else {
            return Ok(None);
        };
        let cloud = &discretisation.cloud;
        let conductivity = self.of_names(
            thermal,
            "conductivity",
            (&conduction.conductivity, |own| own.conductivity.as_ref()),
            solid,
        );
        let conductivity = self.of_materials(
            &conductivity,
            ("W/m/K", NOT_NEGATIVE),
            solid,
            discretisation,
        )?;
        let specific_heat = self.of_names(
            thermal,
            "specific_heat",
            (&conduction.specific_heat, |own| own.specific_heat.as_ref()),
            solid,
        );
        let specific_heat =
            self.of_materials(&specific_heat, ("J/kg/K", POSITIVE), solid, discretisation)?;
        let horizons = self.conducting_horizons(solid, discretisation)?;
        let influence = match (&solid.material.model, &parts.constants) {
            (MaterialModel::Bonds(bonds), _) => bonds.influence.clone(),
            (_, constants) => constants
                .as_ref()
                .and_then(|constants| constants.influence().cloned())
                .unwrap_or_default(),
        };
        let conditions = conduction
            .conditions
            .iter()
            .enumerate()
            .map(|(k, condition)| {
                let path = KeyPath::from("thermal").key("condition").index(k);
                self.thermal_condition(&path, (thermal, condition), discretisation)
            });
        let conditions = conditions.collect::<Result<Vec<_>, _>>()?;
        let is_prescribed = |condition: &&Condition| matches!(condition.kind, Kind::Prescribed(_));
        let prescribed = conditions.iter().filter(is_prescribed);
        let body = DiffusionBody {
            cloud: cloud.clone(),
            influence,
            horizon: solid.material.horizon(),
            horizons,
            correction: solid.material.volume_correction(),
            conductivity,
            interface: match conduction.interface {
                ConductivityMean::Harmonic => Interface::Harmonic,
                ConductivityMean::Arithmetic => Interface::Arithmetic,
            },
            surface_correction: conduction.surface_correction,
            prescribed: prescribed
                .flat_map(|condition| condition.points.iter().copied())
                .collect(),
            broken_share: conduction.broken_conductance,
        };
        let diffusion = body
            .build()
            .map_err(|error| at("thermal.conductivity", error))?;
        let capacity = |i: usize| parts.density.at(i) * specific_heat.at(i) * cloud.volumes()[i];
        let capacity = (0..cloud.len()).map(capacity).collect();
        let problem = Problem::new(diffusion, capacity, conditions);
        let problem = problem.map_err(|error| at("thermal.condition", error))?;
        let options = FieldOptions {
            scheme: match conduction.scheme {
                ConductionScheme::Explicit => Scheme::Explicit,
                ConductionScheme::Trapezoidal => Scheme::Trapezoidal,
                ConductionScheme::BackwardEuler => Scheme::BackwardEuler,
                ConductionScheme::Steady => Scheme::Steady,
            },
            step: conduction.step,
            dissipation: conduction.dissipation,
        };
        let start = self.temperature(thermal, cloud, resources);
        let start = match discretisation.agreed(start)? {
            Given::OfPoints(values) => values,
            Given::Formula(value) => {
                for_each_point(cloud.len(), &|i| value.value(cloud.point(i), 0.0))
            }
        };
        let checked = check_radiation(thermal, cloud, &start);
        self.warnings.extend(discretisation.agreed(checked)?);
        let field = DiffusingField::new(problem, options, 0.0, start);
        field.map(Some).map_err(|error| at("thermal", error))
    }

    /// Rejects heat conduction that would need very many of its own steps within a step of the run, `dt` (s): a step cannot
    /// be interrupted. All processes must call it together.
    pub(super) fn check_thermal_steps(&self, system: &System, dt: f64) -> Result<(), BuildError> {
        const MOST: f64 = 1e5;
        let mut fields = system.fields();
        let Some(field) = fields.find_map(|field| field.downcast_ref::<DiffusingField>()) else {
            return Ok(());
        };
        let field = field.shared();
        let own = field.options().step;
        let explicit = field.options().scheme == Scheme::Explicit;
        let limit = explicit.then(|| field.explicit_limit(0.0));
        let whole = own.map_or(dt, |own| own.max(dt));
        let shortest = [own, limit].into_iter().flatten();
        let shortest = shortest.fold(f64::INFINITY, f64::min);
        if whole / shortest <= MOST {
            return Ok(());
        }
        let fault = Fault::OutOfRange {
            value: format!("a thermal step of {}", precise(shortest, "s")),
            allowed: format!(
                "allowed: at least {}, as a step of the run can contain {MOST:e} thermal steps; use a smaller dt, a \
                 longer thermal step or an implicit scheme",
                precise(whole / MOST, "s")
            ),
        };
        Err(at_path("thermal.scheme", fault))
    }

    /// Returns the horizon of each point, if they differ: the horizons of the materials, divided by refinement ratios.
    fn conducting_horizons(
        &self,
        solid: &Solid,
        discretisation: &Discretisation,
    ) -> Result<Option<Vec<f64>>, BuildError> {
        let others = self
            .model
            .materials
            .iter()
            .map(|other| other.model.horizon());
        let all: Vec<Property> = std::iter::once(solid.material.horizon())
            .chain(others)
            .map(Property::from)
            .collect();
        let all: Vec<OfMaterial<'_>> = all.iter().map(OfMaterial::plain).collect();
        let of_material = self.of_materials(&all, ("m", POSITIVE), solid, discretisation)?;
        let grids = &discretisation.grids;
        if matches!(of_material, PointScalar::Uniform(_)) && grids.ratios.len() == 1 {
            return Ok(None);
        }
        let ratio = |i: usize| f64::from(grids.ratios[usize::from(grids.of_point[i])]);
        let points = 0..discretisation.cloud.len();
        Ok(Some(points.map(|i| of_material.at(i) / ratio(i)).collect()))
    }

    fn thermal_condition(
        &self,
        path: &KeyPath,
        (thermal, condition): (&Thermal, &ThermalCondition),
        discretisation: &Discretisation,
    ) -> Result<Condition, BuildError> {
        let cloud = &discretisation.cloud;
        let points = self
            .members(&discretisation.sets, &condition.set, path.key("set"))?
            .clone();
        let function = condition.function.function();
        let function = function.map_err(|fault| at_path(path.key("function"), fault))?;
        // Time functions multiply the difference to the reference temperature.
        let temperature = |value: &Component| {
            of_time(
                cloud,
                value,
                &function,
                thermal.reference.unwrap_or_default(),
            )
        };
        let density = |value: &Component| of_time(cloud, value, &function, 0.0);
        let volumes: Vec<f64> = points
            .iter()
            .map(|&i| cloud.volumes()[i as usize])
            .collect();
        let areas = || -> Result<Vec<f64>, BuildError> {
            let area = self.heated_area(path, condition, discretisation, &points)?;
            let volume = volume_of(cloud, &points);
            let areas = volumes.iter().map(|one| area * one / volume);
            Ok(areas.collect())
        };
        let kind = match &condition.amplitude {
            ThermalAmplitude::Temperature(value) => Kind::Prescribed(temperature(value)),
            ThermalAmplitude::Flux(value) => Kind::Inflow {
                density: density(value),
                measure: areas()?,
            },
            ThermalAmplitude::Source(value) => Kind::Inflow {
                density: density(value),
                measure: volumes.clone(),
            },
            ThermalAmplitude::Convection {
                coefficient,
                ambient,
            } => Kind::Exchange {
                law: Exchange::Linear,
                coefficient: *coefficient,
                ambient: temperature(ambient),
                area: areas()?,
            },
            ThermalAmplitude::Radiation {
                emissivity,
                ambient,
            } => Kind::Exchange {
                law: Exchange::FourthPower,
                coefficient: emissivity * STEFAN_BOLTZMANN,
                ambient: temperature(ambient),
                area: areas()?,
            },
        };
        Ok(Condition {
            name: condition.set.clone(),
            points,
            kind,
        })
    }

    /// Returns the area through which a condition acts, m²: given in the deck, of a face set of the mesh, or of the face
    /// of a layer.
    fn heated_area(
        &self,
        path: &KeyPath,
        condition: &ThermalCondition,
        discretisation: &Discretisation,
        points: &[u32],
    ) -> Result<f64, BuildError> {
        let cloud = &*discretisation.cloud;
        let known = condition
            .area
            .or_else(|| self.face_area(&discretisation.meshes, &condition.set));
        if let Some(area) = known {
            return Ok(area);
        }
        let reject = |reason| Err(at_path(path.key("area"), Fault::UnknownArea { reason }));
        let shape = self.model.body.solid().map(|solid| &solid.shape);
        let has_no_faces =
            matches!(shape, Some(SolidShape::Mesh(_))) || shape.is_some_and(SolidShape::is_listed);
        if has_no_faces && cloud.dimension() > 1 {
            return reject("the set is neither a face set of a mesh nor a layer of a lattice");
        }
        let named = self
            .model
            .sets
            .iter()
            .find(|named| named.name == condition.set);
        let region = named.and_then(|named| named.members.region());
        let along_bar = [cloud.dimension() == 1, false, false];
        let Ok(axis) = area::normal_axis(region, &along_bar) else {
            return reject("the set is not a layer at a face of the body");
        };
        let heated = LoadedCells::new(cloud, points);
        if !area::is_layer(region)
            && let Some(caution) = heated.caution(axis)
        {
            self.warn(path, Caution::LoadedArea(caution));
        }
        Ok(heated.seen_along(axis))
    }
}

/// Returns reference + g(t) (value − reference) at each point.
fn of_time(
    cloud: &Arc<PointCloud>,
    value: &Component,
    function: &TimeFunction,
    reference: f64,
) -> Value {
    let (cloud, value, function) = (cloud.clone(), value.clone(), function.clone());
    Arc::new(move |i, t| {
        let value = value.value(cloud.point(i), t);
        match function {
            TimeFunction::Constant => value,
            _ => reference + function.value(t) * (value - reference),
        }
    })
}
