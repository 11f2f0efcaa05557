//! Force operator and material of a body.

use pericles::material::BondMaterial;
use pericles::observe::{Field, FieldNeed, TrackedCrack};
use pericles::operator::{BondBody, CompositeBody, Feature, Features};
use pericles::space::PointSet;
use pericles::{Need, PericlesError, PointScalar, System};
use pericles_deck::{
    BuildError, Caution, ContactPairs, Fault, KeyPath, MaterialModel, ModelWarning, PointNumber,
    Remark, Solid, SurfaceBody,
};
use pericles_manifold::PowerMaterial;
use pericles_manifold::surface::Surface;
use pericles_waves::{AssembledForce, ForceForm};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::discretisation::{Discretisation, Grids, Sets, is_on_grid};
use super::graded::have_several_horizons;
use super::materials::{Between, Composition};
use super::rejection::{at_material, at_path};
use super::resources::Resources;
use super::softening::{MaterialSoftening, strengths_of};
use crate::composition::has_need;

/// Force operator and material of a body.
pub(super) struct BodyParts {
    pub(super) constants: Option<MaterialConstants>,
    pub(super) others: Vec<MaterialConstants>,
    pub(super) bonds: AssembledForce,
    pub(super) cracks: Vec<TrackedCrack>,
    pub(super) density: PointScalar,
    /// Softening of all materials, the body's material first; empty without bond-based materials.
    pub(super) softening: Vec<Option<MaterialSoftening>>,
}

impl Assembler<'_> {
    /// Builds the parts of a body on a grid or of listed points.
    pub(super) fn grid_parts(
        &self,
        solid: &Solid,
        discretisation: &Discretisation,
    ) -> Result<BodyParts, BuildError> {
        let place = discretisation;
        match &solid.material.model {
            MaterialModel::Bonds(material) => self.bond_based_parts(solid, material, place),
            MaterialModel::StateBased(material) => self.state_based_parts(solid, material, place),
            MaterialModel::Correspondence(material) => {
                self.correspondence_parts(solid, material, place)
            }
        }
    }

    fn bond_based_parts(
        &self,
        solid: &Solid,
        material: &BondMaterial,
        discretisation: &Discretisation,
    ) -> Result<BodyParts, BuildError> {
        let Discretisation {
            cloud, grids, sets, ..
        } = discretisation;
        let constants = self
            .constants_of(solid, material, cloud)
            .map_err(at_material)?;
        let known = MaterialConstants::Bonds(constants.clone());
        self.warnings.extend(self.check_speed(solid, &known));
        self.warnings
            .extend(self.check_classes(material, &constants));
        self.warnings.extend(self.check_solid(solid, &known));
        let no_fail = self.unbreakable(solid, sets, cloud)?;
        let stiffness = self.stiffness_of(cloud, sets)?;
        let Composition {
            classes,
            materials,
            interfaces,
            density,
            others,
            softening,
        } = self.materials(solid, (material, &constants), discretisation)?;
        let body = BondBody {
            cloud,
            material,
            constants: &constants,
            cracks: &[],
            no_fail: &no_fail,
            stiffness: &stiffness,
            damage: solid.material.damage.unwrap_or_default(),
        };
        let strengths = strengths_of(&softening);
        let composite = CompositeBody {
            body,
            classes: classes.as_ref(),
            correction: solid.material.surface_correction,
            softening: self.softening_of_body(solid, &softening)?,
            strengths: &strengths,
        };
        let all = (&materials[..], &interfaces[..]);
        let (bonds, cracks) = self.bonds(solid, composite, (grids, all), discretisation)?;
        let rejected = bonds.form.rejection(Feature::Tensors.into());
        if let Some(reason) = rejected {
            self.reject_needing(FieldNeed::Bonds, reason)?;
        }
        Ok(BodyParts {
            bonds,
            cracks,
            density,
            constants: Some(known),
            others: others.into_iter().map(MaterialConstants::Bonds).collect(),
            softening,
        })
    }

    /// Builds the parts of a surface.
    pub(super) fn surface_parts(
        &self,
        body: &SurfaceBody,
        surface: &Surface,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
    ) -> Result<BodyParts, BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        self.reject_body_forces()?;
        let operator = self.surface_operator(body, surface, cloud, sets, resources.cache)?;
        let neighbours = operator.directed_bonds() as f64 / cloud.len() as f64;
        for caution in surface.cautions(body.material.horizon, neighbours) {
            self.warn("material.horizon", Caution::Surface(caution));
        }
        self.warnings
            .extend(mesh_dependence(&body.material.power(), surface));
        Ok(BodyParts {
            bonds: AssembledForce {
                operator,
                cuts: Vec::new(),
                form: ForceForm::List,
            },
            cracks: Vec::new(),
            density: PointScalar::Uniform(body.material.density),
            constants: None,
            others: Vec::new(),
            softening: Vec::new(),
        })
    }

    /// Rejects output of fields that the body does not have.
    pub(super) fn reject_fields(&self, system: &System) -> Result<(), BuildError> {
        for need in FieldNeed::ALL
            .into_iter()
            .filter(|need| !need.is_met(system))
        {
            let reason = match need {
                FieldNeed::Bonds => {
                    "only bodies with volume whose forces are sums over single bonds have them"
                }
                FieldNeed::Dilatation => {
                    "only state-based and correspondence materials (model = \"state-based\" or \"correspondence\") have a dilatation"
                }
                FieldNeed::Plasticity => {
                    "only materials with a `yield_stress` have a plastic strain"
                }
                FieldNeed::Conduction => {
                    "only bodies with heat conduction have a heat flux; set `conductivity` and `specific_heat` in [thermal]"
                }
                FieldNeed::Temperature => {
                    "only bodies with thermal expansion have a temperature; add [thermal]"
                }
            };
            self.reject_needing(need, reason)?;
        }
        Ok(())
    }

    /// Rejects output of fields that need a property of the body.
    fn reject_needing(&self, need: FieldNeed, reason: &'static str) -> Result<(), BuildError> {
        let fields = self.model.output.needing(need);
        let names: Vec<&str> = fields.iter().map(|field| field.name()).collect();
        let fields = match &names[..] {
            [] => return Ok(()),
            [name] => format!("the field {name} is"),
            [first @ .., last] => format!("the fields {} and {last} are", first.join(", ")),
        };
        Err(at_path(
            self.field_key(need),
            Fault::NoFields { fields, reason },
        ))
    }

    /// Rejects `cells = true` for a body without cells.
    pub(super) fn check_cells(&self, discretisation: &Discretisation) -> Result<(), BuildError> {
        let has_cells = !discretisation.meshes.all.is_empty()
            || discretisation.surface.is_some()
            || is_on_grid(self.model, &discretisation.cloud);
        match self.model.output.cells {
            Some(true) if !has_cells => {
                let fault = Fault::OutOfRange {
                    value: "true".into(),
                    allowed: "allowed: \"auto\" and false; the points of this body have no cells"
                        .into(),
                };
                Err(at_path("output.cells", fault))
            }
            _ => Ok(()),
        }
    }

    /// Rejects `Set_<name>` of an unknown set.
    pub(super) fn check_point_numbers(&self, sets: &Sets) -> Result<(), BuildError> {
        for number in &self.model.output.fields.names.numbers {
            if let PointNumber::Set(name) = number {
                self.members(sets, name, "output.fields.names")?;
            }
        }
        Ok(())
    }

    /// Returns the key that requests fields which need a property of the body.
    fn field_key(&self, need: FieldNeed) -> KeyPath {
        let is_meant = |field: Field| field.need() == Some(need);
        let output = &self.model.output;
        let named = &output.fields.names.fields;
        let all = KeyPath::from("output.fields.names");
        if named.iter().any(|field| is_meant(*field)) {
            return all;
        }
        let picture = output.pictures.iter().position(|one| is_meant(one.field));
        if let Some(k) = picture {
            return KeyPath::from("output.picture").index(k);
        }
        let profile = output.profiles.iter().position(|one| is_meant(one.field));
        profile.map_or(all, |k| KeyPath::from("output.profile").index(k))
    }

    /// Returns the points of the sets whose bonds do not break.
    pub(super) fn union_of(&self, sets: &Sets, names: &[String]) -> Result<PointSet, BuildError> {
        let mut points = PointSet::new();
        for name in names {
            points.extend(self.members(sets, name, "material.no_fail")?);
        }
        points.sort_unstable();
        points.dedup();
        Ok(points)
    }

    /// Returns a force kernel that supports thermal expansion and activation, for models that have them.
    pub(super) fn form_of_model(&self, form: ForceForm) -> Result<ForceForm, BuildError> {
        let grows = !self.model.activations.is_empty();
        let features = Features::default()
            .with(Feature::ThermalExpansion, self.expands())
            .with(Feature::Activation, grows);
        form.check(features).map_err(at_material)?;
        Ok(match form {
            ForceForm::Fastest if grows => ForceForm::List,
            form => form,
        })
    }

    /// Returns the force kernel of a model, or one compatible with its scheme and output.
    fn form(
        &self,
        solid: &Solid,
        composite: &CompositeBody<'_>,
        is_graded: bool,
    ) -> Result<ForceForm, BuildError> {
        let scheme = &self.model.time.scheme;
        let needs_bonds = !self.model.output.needing(FieldNeed::Bonds).is_empty()
            || self.expands()
            || self.touches_without_bonds()
            || composite.body.cloud.domain().is_divided()
            || has_need(scheme, Need::FiniteReach);
        match self.form_of_model(solid.material.form)? {
            ForceForm::Fastest if needs_bonds && !is_graded => Ok(composite.fastest_form().into()),
            ForceForm::FloatGrid if has_need(scheme, Need::DoublePrecision) => {
                Err(at_material(PericlesError::FormNotUsable {
                    form: ForceForm::FloatGrid.name(),
                    reason: "this scheme needs forces in double precision; use \"grid\", or an explicit scheme",
                }))
            }
            form => Ok(form),
        }
    }

    /// Returns whether the bonds decide which points may touch.
    fn touches_without_bonds(&self) -> bool {
        let pairs = self.model.contact.as_ref().map(|contact| contact.pairs);
        pairs == Some(ContactPairs::Unbonded)
    }

    /// Builds the operator; also returns the bonds cut by pre-cracks.
    fn bonds(
        &self,
        solid: &Solid,
        composite: CompositeBody<'_>,
        (grids, (materials, interfaces)): (&Grids, (&[BondMaterial], &[Between])),
        discretisation: &Discretisation,
    ) -> Result<(AssembledForce, Vec<TrackedCrack>), BuildError> {
        let surfaces = self.cracks;
        let composite = CompositeBody {
            body: BondBody {
                cracks: surfaces,
                ..composite.body
            },
            ..composite
        };
        let is_graded = grids.ratios.len() > 1
            || composite.classes.is_some() && have_several_horizons(materials);
        let form = self.form(solid, &composite, is_graded)?;
        let assembled = if is_graded {
            self.graded_bonds(
                (form, solid.state),
                &composite,
                grids,
                (materials, interfaces),
            )?
        } else {
            pericles_waves::assemble(&composite, form).map_err(at_material)?
        };
        let tracked = self.tracked_cracks(&assembled.cuts, discretisation);
        Ok((assembled, tracked))
    }
}

/// Warns of a surface force that depends on the mesh, because the self-interaction is not available for its law.
fn mesh_dependence(material: &PowerMaterial, surface: &Surface) -> Option<ModelWarning> {
    const LARGE: f64 = 0.1;
    let share = material.self_interaction_share(surface.area() / surface.len() as f64);
    let is_available = PowerMaterial::supports_self_interaction(material.p, material.bond);
    (!is_available && share > LARGE)
        .then(|| Remark::new("material.alpha", Caution::MeshDependence { share }))
}
