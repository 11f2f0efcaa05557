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
    /// What the words are, in messages.
    const WHAT: &'static str;

    /// Returns all words with their values; the first is the default of optional keys.
    fn words() -> Vec<(&'static str, Self)>;
}

macro_rules! words {
    ($($type:ty, $what:literal: $words:expr;)*) => {$(
        impl Worded for $type {
            const WHAT: &'static str = $what;

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

impl Worded for Option<HistoryForm> {
    const WHAT: &'static str = HistoryForm::WHAT;

    fn words() -> Vec<(&'static str, Self)> {
        let forms = [
            ("blocked", HistoryForm::Blocked),
            ("direct", HistoryForm::Direct),
            ("exponentials", HistoryForm::Exponentials),
        ];
        let given = forms.map(|(word, form)| (word, Some(form)));
        [("auto", None)].into_iter().chain(given).collect()
    }
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
    MotionKind, "kind of motion": [("displacement", MotionKind::Displacement), ("velocity", MotionKind::Velocity)];
    EndRule, "end rule": [("closed", EndRule::Closed), ("open", EndRule::Open)];
    VolumeCorrection, "volume correction": [
        ("extended", VolumeCorrection::Extended),
        ("linear", VolumeCorrection::Linear),
        ("none", VolumeCorrection::None),
    ];
    ActsOn, "argument": [("stretch", ActsOn::Stretch), ("displacement", ActsOn::Displacement)];
    Calibration, "calibration": [
        ("continuum", Calibration::Continuum),
        ("lattice", Calibration::Lattice),
        ("unmodified", Calibration::Unmodified),
    ];
    FractureCalibration, "fracture calibration": [
        ("lattice", FractureCalibration::Lattice),
        ("continuum", FractureCalibration::Continuum),
    ];
    Strains, "strains": [("finite", Strains::Finite), ("small", Strains::Small)];
    StretchDefinition, "definition of the critical stretch": [
        ("closing", StretchDefinition::Closing),
        ("bond", StretchDefinition::Bond),
        ("iso", StretchDefinition::Isotropic),
    ];
    ElasticLaw, "elastic law": [
        ("st-venant-kirchhoff", ElasticLaw::StVenantKirchhoff),
        ("neo-hooke", ElasticLaw::NeoHooke),
        ("neo-hooke-split", ElasticLaw::NeoHookeSplit),
        ("hencky", ElasticLaw::Hencky),
    ];
    Stabilisation, "stabilisation": [
        ("isotropic", Stabilisation::Isotropic),
        ("wan", Stabilisation::Wan),
        ("silling", Stabilisation::Silling),
        ("none", Stabilisation::None),
    ];
    InterfaceRule, "interface rule": [
        ("harmonic", InterfaceRule::Harmonic),
        ("arithmetic", InterfaceRule::Arithmetic),
        ("weaker", InterfaceRule::Weaker),
    ];
    // The word of `model`, followed by the word of `approximation`.
    PairLaw, "pair law": [
        ("linear", PairLaw::Linear),
        ("bond-stretch", PairLaw::BondStretch),
        ("green-strain", PairLaw::GreenStrain),
        ("cubic-softening", PairLaw::CubicSoftening),
        ("green-strain taylor-2", PairLaw::Approximated(CubicLaw::GreenStrain, Approximation::SecondOrder)),
        ("green-strain trapezoidal", PairLaw::Approximated(CubicLaw::GreenStrain, Approximation::Trapezoidal)),
        ("cubic-softening taylor-2", PairLaw::Approximated(CubicLaw::CubicSoftening, Approximation::SecondOrder)),
        ("cubic-softening trapezoidal", PairLaw::Approximated(CubicLaw::CubicSoftening, Approximation::Trapezoidal)),
    ];
    StressState, "stress state": [
        ("uniaxial", StressState::Uniaxial),
        ("plane-stress", StressState::PlaneStress),
        ("plane-strain", StressState::PlaneStrain),
        ("spatial", StressState::Spatial),
    ];
    SurfaceCorrection, "surface correction": [
        ("none", SurfaceCorrection::None),
        ("volume", SurfaceCorrection::Volume),
        ("energy", SurfaceCorrection::Energy),
        ("ghosts", SurfaceCorrection::Ghosts),
    ];
    Field, "field": Field::ALL.map(|field| (field.name(), field));
    Face, "side": ["-x", "+x", "-y", "+y", "-z", "+z"]
        .iter()
        .filter_map(|name| Some((*name, Face::named(name)?)))
        .collect::<Vec<_>>();
    ImplicitRule, "implicit rule": [ImplicitRule::Midpoint, ImplicitRule::Trapezoidal].map(|rule| (rule.name(), rule));
    Interpolant, "interpolant": [Interpolant::Hermite, Interpolant::Stages].map(|kind| (kind.name(), kind));
    LinearSolver, "linear solver": LinearSolver::ALL.map(|solver| (solver.name(), solver));
    Predictor, "predictor": [Predictor::Structured, Predictor::BackwardDifference].map(|kind| (kind.name(), kind));
    VelocityNorm, "norm": [VelocityNorm::Sum, VelocityNorm::Weighted, VelocityNorm::Largest]
        .map(|norm| (norm.name(), norm));
    Combination, "combination of wave types": Combination::ALL.map(|combination| (combination.name(), combination));
    Method, "tuning method": Method::ALL.map(|method| (method.name(), method));
    SurfaceBond, "bond": [("displacement", SurfaceBond::Displacement), ("chord", SurfaceBond::Chord)];
    Ball, "ball": [("geodesic", Ball::Geodesic), ("euclid", Ball::Euclid)];
    AreaRule, "area rule": [("barycentric", AreaRule::Barycentric), ("mixed-voronoi", AreaRule::MixedVoronoi)];
    HistoryForm, "history": [
        ("direct", HistoryForm::Direct),
        ("blocked", HistoryForm::Blocked),
        ("exponentials", HistoryForm::Exponentials),
    ];
    KernelMethod, "method": [KernelMethod::Discrete, KernelMethod::SemiDiscrete, KernelMethod::Historical]
        .map(|method| (method.name(), method));
    Side, "side": [Side::Left, Side::Right].map(|side| (side.name(), side));
    ForceForm, "force kernel": [
        ("fastest", ForceForm::Fastest),
        ("grid", ForceForm::Grid),
        ("grid-f32", ForceForm::FloatGrid),
        ("list", ForceForm::List),
        ("convolution", ForceForm::Convolution),
        ("spectral", ForceForm::Spectral),
    ];
    FunctionMethod, "method for matrix functions": FunctionMethod::ALL.map(|method| (method.name(), method));
    LoadRule, "load quadrature": [("gauss", LoadRule::Gauss), ("midpoint", LoadRule::Midpoint)];
}
