//! Words of decks for values of the engine, used by the reader, its messages, the schema and the serialised model.

use pericles::boundary::MotionKind;
use pericles::family::{EndRule, VolumeCorrection};
use pericles::kernel::ActsOn;
use pericles::material::{
    Approximation, Calibration, CubicLaw, FractureCalibration, InterfaceRule, PairLaw, Strains,
    StressState, StretchDefinition, SurfaceCorrection,
};
use pericles::observe::Field;
use pericles::space::Face;
use pericles::time::{ImplicitRule, Interpolant, LinearSolver, Predictor, VelocityNorm};
use pericles_dispersion::tuning::{Combination, Method};
use pericles_manifold::SurfaceBond;
use pericles_manifold::geodesic::Ball;
use pericles_manifold::surface::AreaRule;
use pericles_solids::correspondence::{ElasticLaw, Stabilisation};
use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{KernelMethod, Side};
use pericles_waves::{ForceForm, FunctionMethod, LoadRule};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

use crate::form::Described;

/// Types whose values are words in decks.
pub(crate) trait Worded: Copy + PartialEq + 'static {
    /// Returns all words with their values; the first is the default of optional keys.
    fn words() -> Vec<(&'static str, Self)>;
}

macro_rules! words {
    ($($type:ty: $words:expr;)*) => {$(
        impl Worded for $type {
            fn words() -> Vec<(&'static str, Self)> {
                $words.into()
            }
        }

        impl Described for $type {
            fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                write(*self, serializer)
            }

            fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                read(deserializer)
            }
        }
    )*};
}

fn write<T: Worded, S: Serializer>(value: T, serializer: S) -> Result<S::Ok, S::Error> {
    let words = T::words();
    let word = words.iter().find(|(_, known)| *known == value);
    let (word, _) =
        word.ok_or_else(|| serde::ser::Error::custom("this value has no word in decks"))?;
    serializer.serialize_str(word)
}

fn read<'de, T: Worded, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let word = String::deserialize(deserializer)?;
    let words = T::words();
    let found = words.iter().find(|(known, _)| *known == word);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let allowed: Vec<&str> = words.iter().map(|(known, _)| *known).collect();
        let allowed = allowed.join(", ");
        D::Error::custom(format!("unknown word `{word}`; allowed: {allowed}"))
    })
}

words! {
    MotionKind: [("displacement", MotionKind::Displacement), ("velocity", MotionKind::Velocity)];
    EndRule: [("closed", EndRule::Closed), ("open", EndRule::Open)];
    VolumeCorrection: [
        ("extended", VolumeCorrection::Extended),
        ("linear", VolumeCorrection::Linear),
        ("none", VolumeCorrection::None),
    ];
    ActsOn: [("stretch", ActsOn::Stretch), ("displacement", ActsOn::Displacement)];
    Calibration: [
        ("continuum", Calibration::Continuum),
        ("lattice", Calibration::Lattice),
        ("unmodified", Calibration::Unmodified),
    ];
    FractureCalibration: [
        ("lattice", FractureCalibration::Lattice),
        ("continuum", FractureCalibration::Continuum),
    ];
    Strains: [("finite", Strains::Finite), ("small", Strains::Small)];
    StretchDefinition: [
        ("closing", StretchDefinition::Closing),
        ("bond", StretchDefinition::Bond),
        ("iso", StretchDefinition::Isotropic),
    ];
    ElasticLaw: [
        ("st-venant-kirchhoff", ElasticLaw::StVenantKirchhoff),
        ("neo-hooke", ElasticLaw::NeoHooke),
        ("neo-hooke-split", ElasticLaw::NeoHookeSplit),
        ("hencky", ElasticLaw::Hencky),
    ];
    Stabilisation: [
        ("isotropic", Stabilisation::Isotropic),
        ("wan", Stabilisation::Wan),
        ("silling", Stabilisation::Silling),
        ("none", Stabilisation::None),
    ];
    InterfaceRule: [
        ("harmonic", InterfaceRule::Harmonic),
        ("arithmetic", InterfaceRule::Arithmetic),
        ("weaker", InterfaceRule::Weaker),
    ];
    // The word of `model`, followed by the word of `approximation`.
    PairLaw: [
        ("linear", PairLaw::Linear),
        ("bond-stretch", PairLaw::BondStretch),
        ("green-strain", PairLaw::GreenStrain),
        ("cubic-softening", PairLaw::CubicSoftening),
        ("green-strain taylor-2", PairLaw::Approximated(CubicLaw::GreenStrain, Approximation::SecondOrder)),
        ("green-strain trapezoidal", PairLaw::Approximated(CubicLaw::GreenStrain, Approximation::Trapezoidal)),
        ("cubic-softening taylor-2", PairLaw::Approximated(CubicLaw::CubicSoftening, Approximation::SecondOrder)),
        ("cubic-softening trapezoidal", PairLaw::Approximated(CubicLaw::CubicSoftening, Approximation::Trapezoidal)),
    ];
    StressState: [
        ("uniaxial", StressState::Uniaxial),
        ("plane-stress", StressState::PlaneStress),
        ("plane-strain", StressState::PlaneStrain),
        ("spatial", StressState::Spatial),
    ];
    SurfaceCorrection: [
        ("none", SurfaceCorrection::None),
        ("volume", SurfaceCorrection::Volume),
        ("energy", SurfaceCorrection::Energy),
        ("ghosts", SurfaceCorrection::Ghosts),
    ];
    Field: Field::ALL.map(|field| (field.name(), field));
    Face: ["-x", "+x", "-y", "+y", "-z", "+z"]
        .iter()
        .filter_map(|name| Some((*name, Face::named(name)?)))
        .collect::<Vec<_>>();
    ImplicitRule: [ImplicitRule::Midpoint, ImplicitRule::Trapezoidal].map(|rule| (rule.name(), rule));
    Interpolant: [Interpolant::Hermite, Interpolant::Stages].map(|kind| (kind.name(), kind));
    LinearSolver: LinearSolver::ALL.map(|solver| (solver.name(), solver));
    Predictor: [Predictor::Structured, Predictor::BackwardDifference].map(|kind| (kind.name(), kind));
    VelocityNorm: [VelocityNorm::Sum, VelocityNorm::Weighted, VelocityNorm::Largest]
        .map(|norm| (norm.name(), norm));
    Combination: Combination::ALL.map(|combination| (combination.name(), combination));
    Method: Method::ALL.map(|method| (method.name(), method));
    SurfaceBond: [("displacement", SurfaceBond::Displacement), ("chord", SurfaceBond::Chord)];
    Ball: [("geodesic", Ball::Geodesic), ("euclid", Ball::Euclid)];
    AreaRule: [("barycentric", AreaRule::Barycentric), ("mixed-voronoi", AreaRule::MixedVoronoi)];
    HistoryForm: [
        ("direct", HistoryForm::Direct),
        ("blocked", HistoryForm::Blocked),
        ("exponentials", HistoryForm::Exponentials),
    ];
    KernelMethod: [KernelMethod::Discrete, KernelMethod::SemiDiscrete, KernelMethod::Historical]
        .map(|method| (method.name(), method));
    Side: [Side::Left, Side::Right].map(|side| (side.name(), side));
    ForceForm: [
        ("fastest", ForceForm::Fastest),
        ("grid", ForceForm::Grid),
        ("grid-f32", ForceForm::FloatGrid),
        ("list", ForceForm::List),
        ("convolution", ForceForm::Convolution),
        ("spectral", ForceForm::Spectral),
    ];
    FunctionMethod: FunctionMethod::ALL.map(|method| (method.name(), method));
    LoadRule: [("gauss", LoadRule::Gauss), ("midpoint", LoadRule::Midpoint)];
}
