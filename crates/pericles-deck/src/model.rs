//! The model: everything that is simulated, as plain data.

use std::path::Path;

use pericles::material::StressState;
use serde::{Deserialize, Serialize};

use crate::assign::Assignment;
use crate::body::{SolidShape, SurfaceShape};
use crate::boundary::BoundaryCondition;
use crate::conditions::{Initial, Load, Prescribe, Probe};
use crate::crack::PreCrack;
use crate::damping::Damping;
use crate::exact::Exact;
use crate::interface::MaterialInterface;
use crate::material::{Material, NamedMaterial};
use crate::output::{Checkpoint, Output};
use crate::set::NamedSet;
use crate::surface::SurfaceBody;
use crate::thermal::Thermal;
use crate::time::Time;

/// What is simulated and what is written, as plain data in SI units: what a [`Deck`](crate::Deck) says, without its text.
///
/// A program can write a model itself, and serialise it, for example as JSON; keys and words are those of decks where decks have them.
/// What is wrong with it is refused, with the key that it concerns, when it is discretised and assembled ([`Model::check`]).
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
    /// A title for people.
    #[serde(default)]
    pub title: Option<String>,
    /// `[body]` and `[material]`, of a surface `[geodesics]` as well.
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
    /// `[[prescribe]]`
    #[serde(default)]
    pub prescribe: Vec<Prescribe>,
    /// `[[load]]`
    #[serde(default, rename = "load")]
    pub loads: Vec<Load>,
    /// `[[boundary]]`
    #[serde(default, rename = "boundary")]
    pub boundaries: Vec<BoundaryCondition>,
    /// `[[probe]]`
    #[serde(default, rename = "probe")]
    pub probes: Vec<Probe>,
    /// `[exact]`
    #[serde(default)]
    pub exact: Option<Exact>,
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
}

/// The body, with what it is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "a program has few models")]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Body {
    /// Points with volumes and bonds along straight lines.
    Solid(Solid),
    /// The vertices of a surface, with bonds along it.
    Surface(SurfaceBody),
}

/// A body of points with volumes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Where its points are.
    pub shape: SolidShape,
    /// Stress state, which follows from the dimension and, in two dimensions, from `plane`.
    #[serde(with = "crate::form")]
    pub state: StressState,
    /// `[material]`
    pub material: Material,
}

impl Body {
    /// The body, if it is one of points with volumes.
    pub fn solid(&self) -> Option<&Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// The body, if it is one of points with volumes, to change it.
    pub fn solid_mut(&mut self) -> Option<&mut Solid> {
        match self {
            Self::Solid(solid) => Some(solid),
            Self::Surface(_) => None,
        }
    }

    /// The surface, if it is one.
    pub fn surface(&self) -> Option<&SurfaceBody> {
        match self {
            Self::Solid(_) => None,
            Self::Surface(surface) => Some(surface),
        }
    }

    /// Dimension of the space that the body is in.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Solid(solid) => solid.shape.dimension(),
            Self::Surface(_) => 3,
        }
    }

    /// Horizon of the bonds, m.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Solid(solid) => solid.material.horizon(),
            Self::Surface(surface) => surface.material.horizon,
        }
    }

    /// Sets whose bonds never break.
    pub fn no_fail(&self) -> &[String] {
        match self {
            Self::Solid(solid) => &solid.material.no_fail,
            Self::Surface(surface) => &surface.no_fail,
        }
    }

    /// The file that the points come from.
    fn file(&self) -> Option<&Path> {
        match self {
            Self::Solid(solid) => solid.shape.file(),
            Self::Surface(SurfaceBody {
                shape: SurfaceShape::File { path, .. },
                ..
            }) => Some(path),
            Self::Surface(_) => None,
        }
    }
}

impl Model {
    /// A body at rest, over time, without conditions, and with the output of a deck that leaves it out.
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
            prescribe: Vec::new(),
            loads: Vec::new(),
            boundaries: Vec::new(),
            probes: Vec::new(),
            exact: None,
            thermal: None,
            damping: None,
            time,
            output: Output::default(),
            checkpoint: Checkpoint::default(),
        }
    }

    /// The files that the model names. A relative path starts at the folder of the deck.
    pub fn files(&self) -> Vec<&Path> {
        let initial = self.initial.iter();
        let initial = initial.filter_map(|initial| initial.file.as_deref());
        let cracks = self.cracks.iter();
        let cracks = cracks.filter_map(|crack| crack.surface.file());
        let body = self.body.file().into_iter();
        body.chain(initial).chain(cracks).collect()
    }
}
