//! The model: a complete simulation as plain data.

use std::path::Path;

use pericles::material::StressState;
use serde::{Deserialize, Serialize};

use crate::activation::Activation;
use crate::assign::Assignment;
use crate::body::{SolidShape, SurfaceShape, piece_path};
use crate::boundary::BoundaryCondition;
use crate::conditions::{Constraint, Initial, Load, Probe};
use crate::contact::Contact;
use crate::crack::{CrackSurface, PreCrack};
use crate::damping::Damping;
use crate::exact::Exact;
use crate::impactor::Impactor;
use crate::interface::MaterialInterface;
use crate::key_path::KeyPath;
use crate::material::{Material, NamedMaterial};
use crate::output::{Checkpoint, Output};
use crate::processor::Processor;
use crate::set::NamedSet;
use crate::surface::SurfaceBody;
use crate::thermal::Thermal;
use crate::time::Time;

/// A simulation and its output as plain data in SI units: the content of a [`Deck`](crate::Deck), without its text.
///
/// Programs can construct models themselves and serialise them, for example as JSON; keys and words are those
/// of decks where they exist there. Errors are reported with their keys when a model is discretised and
/// assembled ([`Model::check`]).
///
/// ```
/// use pericles::family::VolumeCorrection;
/// use pericles::kernel::Influence;
/// use pericles::material::{
///     BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
/// };
/// use pericles::space::{Face, Grid, Region, Shape};
/// use pericles_deck::{Body, Initial, Members, Model, NamedSet, Solid, SolidShape, Time};
///
/// // A steel bar of 1 m whose left end is pushed.
/// let grid = Grid {
///     shape: Shape::Box { origin: [0.0; 3], size: vec![1.0] },
///     spacing: 0.01,
///     section: 4e-4,
///     holes: vec![],
/// };
/// let steel = BondMaterial {
///     law: PairLaw::Linear,
///     density: 7850.0,
///     modulus: Modulus {
///         value: ElasticModulus::Young(210e9),
///         calibration: Calibration::Continuum,
///     },
///     horizon: 0.03,
///     influence: Influence::default(),
///     volume_correction: VolumeCorrection::default(),
///     fracture: Fracture::Unbreakable,
/// };
/// let bar = Solid {
///     shape: SolidShape::Lattice(grid.into()),
///     state: StressState::Uniaxial,
///     material: steel.into(),
/// };
/// let mut model = Model::new(Body::Solid(bar), Time::to(1e-3));
/// let face = Face { axis: 0, upper: false };
/// model.sets.push(NamedSet {
///     name: "left".into(),
///     members: Members::Region(Region::Layer { face, depth: 0.01 }),
/// });
/// model.initial.push(Initial {
///     set: "left".into(),
///     displacement: None,
///     velocity: Some([1.0.into(), 0.0.into(), 0.0.into()]),
///     file: None,
///     random_velocity: None,
/// });
///
/// let json = serde_json::to_string_pretty(&model)?;
/// assert!(json.contains("\"youngs_modulus\": 210000000000.0"));
/// let again: Model = serde_json::from_str(&json)?;
/// assert_eq!(again, model);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Title of the run.
    #[serde(default)]
    pub title: Option<String>,
    /// `[body]` and `[material]`, for 2-manifolds also `[geodesics]`.
    pub body: Body,
    /// `[materials]`, without the body's own material.
    #[serde(default)]
    pub materials: Vec<NamedMaterial>,
    /// `[[assign]]`
    #[serde(default, rename = "assign")]
    pub assignments: Vec<Assignment>,
    /// `[[interface]]`
    #[serde(default, rename = "interface")]
    pub interfaces: Vec<MaterialInterface>,
    /// `[sets]`, without the set "all" of all points.
    #[serde(default)]
    pub sets: Vec<NamedSet>,
    /// `[[crack]]`
    #[serde(default, rename = "crack")]
    pub cracks: Vec<PreCrack>,
    /// `[[initial]]`
    #[serde(default)]
    pub initial: Vec<Initial>,
    /// `[[constraint]]`
    #[serde(default, rename = "constraint")]
    pub constraints: Vec<Constraint>,
    /// `[[load]]`
    #[serde(default, rename = "load")]
    pub loads: Vec<Load>,
    /// `[[boundary]]`
    #[serde(default, rename = "boundary")]
    pub boundaries: Vec<BoundaryCondition>,
    /// `[[activation]]`
    #[serde(default, rename = "activation", skip_serializing_if = "Vec::is_empty")]
    pub activations: Vec<Activation>,
    /// `[[probe]]`
    #[serde(default, rename = "probe")]
    pub probes: Vec<Probe>,
    /// `[exact]`
    #[serde(default)]
    pub exact: Option<Exact>,
    /// `[contact]`: contact between points; none if points do not interact by contact.
    #[serde(default)]
    pub contact: Option<Contact>,
    /// `[[impactor]]`
    #[serde(default)]
    pub impactors: Vec<Impactor>,
    /// `[thermal]`
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal: Option<Thermal>,
    /// `[damping]`
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Damping>,
    /// `[time]`
    pub time: Time,
    /// `[output]`
    #[serde(default)]
    pub output: Output,
    /// `[checkpoint]`
    #[serde(default)]
    pub checkpoint: Checkpoint,
    /// `[run]`
    #[serde(default, skip_serializing_if = "Processor::is_usual")]
    pub run: Processor,
}

/// The body with its material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(
    clippy::large_enum_variant,
    reason = "programs hold few models at a time"
)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Body {
    /// Points with volumes and straight bonds.
    Solid(Solid),
    /// Vertices of a 2-manifold, with bonds along the surface.
    Surface(SurfaceBody),
}

/// A body of points with volumes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Source of the points.
    pub shape: SolidShape,
    /// Stress state, from the dimension and, in 2D, `plane`.
    #[serde(with = "crate::form")]
    pub state: StressState,
    /// `[material]`
    pub material: Material,
}

impl Body {
    /// Returns the body, if it consists of points with volumes.
    pub fn solid(&self) -> Option<&Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// Returns the body mutably, if it consists of points with volumes.
    pub fn solid_mut(&mut self) -> Option<&mut Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// Returns the 2-manifold, if it is one.
    pub fn surface(&self) -> Option<&SurfaceBody> {
        match self {
            Self::Solid(_) => None,
            Self::Surface(surface) => Some(surface),
        }
    }

    /// Returns the dimension of space.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Solid(solid) => solid.shape.dimension(),
            Self::Surface(_) => 3,
        }
    }

    /// Returns the horizon, m.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Solid(solid) => solid.material.horizon(),
            Self::Surface(surface) => surface.material.horizon,
        }
    }

    /// Returns the sets whose bonds never break.
    pub fn no_fail(&self) -> &[String] {
        match self {
            Self::Solid(solid) => &solid.material.no_fail,
            Self::Surface(surface) => &surface.material.no_fail,
        }
    }

    /// Returns the paths of the files of the points.
    fn files(&self) -> Vec<&Path> {
        match self {
            Self::Solid(solid) => solid.shape.files(),
            Self::Surface(SurfaceBody {
                shape: SurfaceShape::File(file),
                ..
            }) => vec![&file.path],
            Self::Surface(_) => Vec::new(),
        }
    }
}

impl Model {
    /// Creates a model of a body at rest, without conditions and with default output.
    pub fn new(body: Body, time: Time) -> Self {
        Self {
            title: None,
            body,
            materials: Vec::new(),
            assignments: Vec::new(),
            interfaces: Vec::new(),
            sets: Vec::new(),
            cracks: Vec::new(),
            initial: Vec::new(),
            constraints: Vec::new(),
            loads: Vec::new(),
            boundaries: Vec::new(),
            activations: Vec::new(),
            probes: Vec::new(),
            exact: None,
            contact: None,
            impactors: Vec::new(),
            thermal: None,
            damping: None,
            time,
            output: Output::default(),
            checkpoint: Checkpoint::default(),
            run: Processor::default(),
        }
    }

    /// Returns whether bonds do not cross the layer of a set, because of a `[[crack]]` with `layer`.
    pub fn has_layer(&self, set: &str) -> bool {
        self.cracks
            .iter()
            .any(|crack| matches!(&crack.surface, CrackSurface::Layer(layer) if layer == set))
    }

    /// Returns the materials of pieces and of `[[assign]]`, with their paths and sets; later ones take precedence.
    pub fn assigned_materials(&self) -> Vec<(KeyPath, &[String], &str)> {
        let pieces = self
            .body
            .solid()
            .map_or(&[][..], |solid| solid.shape.pieces());
        let of_pieces = pieces.iter().enumerate().filter_map(|(k, piece)| {
            let path = piece_path(k).key("material");
            Some((
                path,
                std::slice::from_ref(&piece.name),
                piece.material.as_deref()?,
            ))
        });
        let assigned = self.assignments.iter().enumerate();
        let assigned = assigned.filter_map(|(k, one)| {
            let path = KeyPath::from("assign").index(k);
            Some((path, &one.sets[..], one.material.as_deref()?))
        });
        of_pieces.chain(assigned).collect()
    }

    /// Returns the paths of all input files of the model; relative paths start at the deck's folder.
    pub fn files(&self) -> Vec<&Path> {
        let initial = self.initial.iter();
        let initial = initial.filter_map(|initial| initial.file.as_deref());
        let cracks = self.cracks.iter();
        let cracks = cracks.filter_map(|crack| crack.surface.file());
        let thermal = self.thermal.iter();
        let thermal = thermal.filter_map(|thermal| thermal.file.as_deref());
        let body = self.body.files().into_iter();
        let impactors = self.impactors.iter().filter_map(Impactor::file);
        let activations = self.activations.iter().filter_map(Activation::file);
        body.chain(initial)
            .chain(cracks)
            .chain(thermal)
            .chain(impactors)
            .chain(activations)
            .collect()
    }
}
