//! Points, sets and bonds of a model, before loads and time.

use std::sync::Arc;

use pericles::material::{BondConstants, Fracture, PairLaw, SurfaceCorrection};
use pericles::observe::TrackedCrack;
use pericles::operator::{BondBody, CompositeBody};
use pericles::space::{GradedCloud, PointCloud, PointSet};
use pericles::{PericlesError, PointScalar};
use pericles_manifold::surface::Surface;
use pericles_waves::AssembledForce;
use pericles_waves::ForceForm;

use super::graded::Grids;
use super::parts::Composition;
use super::{Resources, Sets};
use crate::caution::Caution;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Warning;
use crate::material::Inclusion;
use crate::reader::Path;
use crate::set::ALL;
use crate::surface::SurfaceDeck;

/// What differs between bodies on a grid and surfaces.
pub(super) struct Assembled {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) surface: Option<Arc<Surface>>,
    pub(super) sets: Sets,
    pub(super) constants: BondConstants,
    pub(super) parts: Vec<BondConstants>,
    pub(super) bonds: AssembledForce,
    pub(super) cracks: Vec<TrackedCrack>,
    pub(super) density: PointScalar,
}

impl Deck {
    /// Of a body on a grid or of listed points.
    pub(super) fn assemble_grid(
        &self,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Assembled, DeckError> {
        self.check_periodic()?;
        let GradedCloud {
            cloud,
            ratios,
            grid_of_point,
        } = self.points(resources, warnings)?;
        let cloud = Arc::new(cloud);
        let sets = self.select(&cloud)?;
        let material = &self.material.bonds;
        let constants = self
            .constants_of(material, &cloud)
            .map_err(|error| self.at_material(error))?;
        warnings.extend(self.judge_speed(&constants));
        warnings.extend(self.judge_classes(&constants));
        warnings.extend(self.judge_solid(&constants));
        let no_fail = self.union_of(&sets, &self.material.no_fail)?;
        let stiffness = self.stiffness_of(&self.material.inclusions, &cloud, &sets)?;
        let Composition {
            classes,
            density,
            parts,
        } = self.parts(&cloud, &sets, &constants, warnings)?;
        let body = BondBody {
            cloud: &cloud,
            material,
            constants: &constants,
            cracks: &[],
            no_fail: &no_fail,
            stiffness: &stiffness,
            damage: self.material.damage,
        };
        let grids = Grids {
            ratios: &ratios,
            of_point: &grid_of_point,
        };
        let composite = CompositeBody {
            body,
            classes: classes.as_ref(),
            correction: self.material.surface_correction,
        };
        let (bonds, cracks) = self.bonds(composite, grids, warnings)?;
        if self.output.wants_tensors() && bonds.operator.as_bonds().is_none() {
            let reason = if self.body.periodic {
                "periodic bodies keep no list of bonds"
            } else {
                "they are sums over single bonds; use bonds = \"list\", \"grid\" or \"fastest\""
            };
            return Err(self.at_path(&self.tensor_key(), Fault::NoTensors { reason }));
        }
        Ok(Assembled {
            surface: None,
            sets,
            bonds,
            cracks,
            density,
            constants,
            parts,
            cloud,
        })
    }

    /// Of a surface.
    pub(super) fn assemble_surface(
        &self,
        deck: &SurfaceDeck,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Assembled, DeckError> {
        let (surface, cloud) = self.surface_points(deck, resources)?;
        let cloud = Arc::new(cloud);
        let sets = self.select(&cloud)?;
        self.refuse_body_forces()?;
        let operator = self.surface_operator(deck, &surface, &cloud, &sets, resources.cache)?;
        let neighbours = operator.directed_bonds() as f64 / cloud.len() as f64;
        for caution in surface.cautions(deck.material.horizon, neighbours) {
            warnings.push(self.finding(&"material.horizon".into(), Caution::Surface(caution)));
        }
        Ok(Assembled {
            surface: Some(Arc::new(surface)),
            sets,
            bonds: AssembledForce {
                operator,
                cuts: Vec::new(),
                form: ForceForm::List,
            },
            cracks: Vec::new(),
            density: PointScalar::Uniform(deck.material.density),
            constants: BondConstants {
                young: f64::NAN,
                micromodulus: f64::NAN,
                critical_stretch: deck.material.critical_stretch,
                fracture_energy: f64::NAN,
                fracture_calibration: None,
                crack_planes: Vec::new(),
                stiffness_error: f64::NAN,
                shear_error: f64::NAN,
            },
            parts: Vec::new(),
            cloud,
        })
    }

    /// Refuses everything at once that a periodic body cannot have.
    fn check_periodic(&self) -> Result<(), DeckError> {
        let material = &self.material;
        let spectral = material.form == ForceForm::Spectral;
        let law = material.bonds.law;
        let right_law = law == PairLaw::Linear || (law == PairLaw::GreenStrain && spectral);
        let breaks = material.bonds.fracture != Fracture::Unbreakable;
        let listed = matches!(
            material.form,
            ForceForm::List | ForceForm::Grid | ForceForm::FloatGrid
        );
        let corrected = material.surface_correction != SurfaceCorrection::None;
        let conflicts: Vec<String> = [
            (
                !right_law,
                format!("model = {}", self.given("material.model")),
            ),
            (
                breaks,
                "bonds that break (`fracture_energy`, `critical_stretch`)".into(),
            ),
            (listed, format!("bonds = \"{}\"", material.form.name())),
            (!self.cracks.is_empty(), "pre-cracks ([[crack]])".into()),
            (
                !material.inclusions.is_empty(),
                "[[material.inclusion]]".into(),
            ),
            (!material.parts.is_empty(), "[[material.part]]".into()),
            (corrected, "a surface correction".into()),
        ]
        .into_iter()
        .filter_map(|(found, what)| found.then_some(what))
        .collect();
        if !self.body.periodic || conflicts.is_empty() {
            return Ok(());
        }
        Err(self.at_path(&"body.periodic".into(), Fault::NotPeriodic { conflicts }))
    }

    /// The value of a key as the deck is read, defaults included.
    fn given(&self, key: &str) -> String {
        let value = self.record.value(&key.into());
        value.map(ToString::to_string).unwrap_or_default()
    }

    /// The key that asks for stress or strain.
    fn tensor_key(&self) -> Path {
        match self
            .output
            .pictures
            .iter()
            .position(|picture| picture.field.is_tensor())
        {
            Some(k) if !self.output.names.iter().any(|field| field.is_tensor()) => {
                Path::from("output.picture").index(k)
            }
            _ => "output.fields.names".into(),
        }
    }

    fn select(&self, cloud: &PointCloud) -> Result<Sets, DeckError> {
        let mut sets = vec![(ALL.to_owned(), (0..cloud.len() as u32).collect())];
        let mut problems = Vec::new();
        for set in &self.sets {
            let points = set.members.of(cloud);
            if points.is_empty() {
                let fault = Fault::EmptySet {
                    set: set.name.clone(),
                };
                problems.push(self.finding(&Path::from("sets").key(&set.name), fault));
            }
            sets.push((set.name.clone(), points));
        }
        if problems.is_empty() {
            Ok(sets)
        } else {
            Err(DeckError::refused(problems))
        }
    }

    /// The points of the sets whose bonds never break.
    pub(super) fn union_of(&self, sets: &Sets, names: &[String]) -> Result<PointSet, DeckError> {
        let mut points = PointSet::new();
        for name in names {
            points.extend(self.members(sets, name, &"material.no_fail".into())?);
        }
        points.sort_unstable();
        points.dedup();
        Ok(points)
    }

    /// Stiffness of each point over the material's; empty without inclusions.
    pub(super) fn stiffness_of(
        &self,
        inclusions: &[Inclusion],
        cloud: &PointCloud,
        sets: &Sets,
    ) -> Result<Vec<f64>, DeckError> {
        let mut stiffness = vec![
            1.0;
            if inclusions.is_empty() {
                0
            } else {
                cloud.len()
            }
        ];
        for (k, inclusion) in inclusions.iter().enumerate() {
            let path = Path::from("material.inclusion").index(k);
            for &i in self.members(sets, &inclusion.set, &path)? {
                stiffness[i as usize] = inclusion.stiffness;
            }
        }
        Ok(stiffness)
    }

    /// The operator, and what the pre-cracks took from it.
    fn bonds(
        &self,
        composite: CompositeBody<'_>,
        grids: Grids<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(AssembledForce, Vec<TrackedCrack>), DeckError> {
        let crack = |k| Path::from("crack").index(k);
        for (k, pre_crack) in self.cracks.iter().enumerate() {
            // The library tells what is wrong with a crack, not with which.
            pre_crack
                .surface
                .cutter(pre_crack.ends, 0.0)
                .map_err(|error| self.at_path(&crack(k), error.into()))?;
        }
        let cloud = composite.body.cloud;
        let surfaces: Vec<_> = self
            .cracks
            .iter()
            .map(|crack| (crack.surface.clone(), crack.ends))
            .collect();
        let composite = CompositeBody {
            body: BondBody {
                cracks: &surfaces,
                ..composite.body
            },
            ..composite
        };
        let assembled = if grids.ratios.len() > 1 {
            self.graded_bonds(&composite, grids)?
        } else {
            let form = match self.material.form {
                ForceForm::Fastest if self.output.wants_tensors() && !self.body.periodic => {
                    ForceForm::List
                }
                ForceForm::Fastest if self.time.scheme.has_two_steps() && !self.body.periodic => {
                    composite.fastest_form().into()
                }
                ForceForm::FloatGrid if !self.time.scheme.bears_rounding() => {
                    return Err(self.at_material(PericlesError::FormNotUsable {
                        form: ForceForm::FloatGrid.name(),
                        reason: "this scheme needs forces in double precision; use \"grid\", or a Verlet or Runge–Kutta scheme with one step",
                    }));
                }
                form => form,
            };
            pericles_waves::assemble(&composite, form).map_err(|error| self.at_material(error))?
        };
        let mut tracked = Vec::new();
        for (k, ((surface, _), cut)) in surfaces.iter().zip(&assembled.cuts).enumerate() {
            if cut.bonds == 0 {
                let caution = Self::useless_crack(surface, cloud);
                warnings.push(self.finding(&crack(k), caution));
            }
            tracked.push(TrackedCrack {
                crack: surface.clone(),
                points: cut.points.clone(),
            });
        }
        Ok((assembled, tracked))
    }
}
