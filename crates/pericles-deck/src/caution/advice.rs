//! What can be done about a caution.

use miette::Severity;

use super::Caution;
use crate::subject::Subject;

impl Subject for Caution {
    const SEVERITY: Severity = Severity::Warning;

    fn advice(&self) -> Option<String> {
        let advice = match self {
            Self::FormerTables { text, .. } => {
                return Some(format!("the present form, which means the same:\n\n{text}"));
            }
            Self::UnusedMaterial { .. } => {
                "assign it with [[assign]] set = …, material = …, or leave it out"
            }
            Self::CrackCutsNothing => {
                "it must pass between points of the body that lie within a horizon of each other"
            }
            Self::LargeStretch { .. } => {
                "brittle materials break below 20 %; is the fracture energy in J/m², the modulus in Pa, the horizon in m?"
            }
            Self::CrackOutside { .. } => {
                "places are in m unless they carry a unit; `origin` moves a body"
            }
            Self::SoftSolid { .. } => "is the modulus in Pa? \"70 GPa\" carries its unit",
            Self::HeavySolid { .. } => "is it in kg/m³? \"7.85 g/cm3\" carries its unit",
            Self::TinySpacing { .. } => "is it in m? \"1 mm\" carries its unit",
            Self::ClosePoints { .. } => {
                "remove one of them if it is a duplicate: the bond between them limits the time step"
            }
            Self::UnusedCoordinate { .. } => {
                "set the coordinate to 0, or give `dimension` so that all coordinates are used"
            }
            // Says itself what to do.
            Self::Mesh { .. } => return None,
            Self::FilledVolume { .. } => {
                "a smaller spacing or cells = \"partial\" comes nearer; volumes where surfaces overlap are enclosed twice but filled once"
            }
            Self::IdleHole => {
                "check its place and its size, which must exceed the spacing; lengths without a unit are in m"
            }
            Self::NothingBreaks { .. } => {
                "give `fracture_energy` or `critical_stretch`, or leave the key out"
            }
            Self::NothingActs => "add [[load]], [[prescribe]] or [[initial]]",
            Self::StiffnessError { .. } => {
                "modulus = \"lattice\" makes the bulk stiffness exact on a grid (\"continuum\" for spectral forces and Gauss nodes); a longer horizon brings it nearer"
            }
            Self::ShearStiffness { .. } => {
                "a horizon of one spacing joins a point to few neighbours off the axes; take three spacings"
            }
            Self::ShearAnisotropy { .. } => {
                "influence = { function = \"isotropic\" } makes it the material's in all directions; \"conical\" is nearer to it than \"constant\""
            }
            Self::FastWaves { .. } => "is the density in kg/m³ and the modulus in Pa?",
            Self::IdleClasses { .. } => "if this is meant, a shorter horizon says the same",
            Self::LoadedArea(_) => {
                "give `area`, or use a layer of one face, such as layer = { side = \"+x\", cells = 3 }, and one [[load]] for each face"
            }
            Self::LoadOnHeld { .. } => "take other points, or leave the load out",
            Self::Pieces { points: 1, .. } => {
                "a crack that passes through points takes all their bonds: shift it by half a cell; else look at holes and the horizon, unless loose points are meant"
            }
            Self::Pieces { .. } => {
                "look at cracks, holes and the horizon, unless loose pieces are meant"
            }
            Self::NoSupport { .. } => {
                "they only come to rest if the loads on them are in balance; [[prescribe]] holds points"
            }
            Self::Unbalanced { .. } => {
                "they accelerate and never come to rest: hold points by [[prescribe]], or balance the loads"
            }
            Self::ProbeOutside { .. } => "the nearest point is read instead",
            Self::UnstableStep { .. } => "it is used because of allow_unstable = true",
            Self::UncertainStep { .. } => "dt = \"auto\" stays below it",
            Self::ShortenedStep { .. } => {
                "give a dt that divides end, or an end that is a multiple of dt, to choose both"
            }
            Self::Surface(_) => "usual: 3 to 6 median edges",
            Self::ShortPeriod { .. } => {
                "a longer body, a shorter run or a smaller exact.window brings it down"
            }
            Self::ShortWaves { .. } => {
                "use a finer grid, a smoother time function or field, or a tuned influence function; `pericles dispersion` shows the speeds of all waves"
            }
            Self::GrowingWaves { .. } => {
                "a run of such a body gains energy without limit; use positive coefficients"
            }
            Self::PoorTuning { .. } => {
                "decay = 1 (the default) and method = \"least-squares\" do best; lower_bound limits what tuning can do"
            }
            Self::FastMotion { .. } => "check the value and its unit (m/s); use a lower speed",
            Self::TornAtOnce { .. } => {
                "check speeds, displacements and the critical stretch; use a ramp or a lower speed, or no_fail for the points near supports"
            }
            Self::EmptyClasses { .. } => {
                "use a positive lower_bound such as 0.5, or a shorter horizon"
            }
            Self::HistoricalKernels { .. } => {
                "method = \"discrete\" is exact, \"semi-discrete\" the same boundary with exact Green functions"
            }
            Self::ExactHistory { .. } => {
                "it costs memory that grows with the number of steps; history = \"blocked\" avoids the attempt, a larger tolerance may be met"
            }
            Self::FieldAtEnd { .. } => {
                "`exterior_data` continues the field beyond the end; or move the end outwards"
            }
            Self::EqualSteps => "a plain scheme does the same with less",
            Self::GrowingPredictor { .. } => {
                "predictor = \"structured\" is stable; or make dt smaller, or the run short"
            }
        };
        Some(advice.into())
    }

    fn label(&self) -> &'static str {
        match self {
            Self::FormerTables { .. } => "former form",
            Self::CrackCutsNothing | Self::UnusedMaterial { .. } => "no effect",
            Self::CrackOutside { .. } => "outside the body",
            Self::Pieces { .. } => "in pieces",
            Self::LargeStretch { .. } => "very strong",
            Self::SoftSolid { .. } => "very soft",
            Self::HeavySolid { .. } => "very heavy",
            Self::TinySpacing { .. } => "very small",
            Self::ClosePoints { .. } => "very close points",
            Self::UnusedCoordinate { .. } => "not used",
            Self::IdleHole | Self::NothingBreaks { .. } => "no effect",
            Self::Mesh { .. } => "unusual mesh",
            Self::FilledVolume { .. } => "another volume",
            Self::NothingActs => "at rest",
            Self::StiffnessError { .. } => "another stiffness",
            Self::ShearStiffness { .. } => "little shear stiffness",
            Self::ShearAnisotropy { .. } => "anisotropic shear",
            Self::FastWaves { .. } => "very light",
            Self::IdleClasses { .. } => "no stiffness",
            Self::LoadedArea(_) => "which area?",
            Self::LoadOnHeld { .. } => "held",
            Self::NoSupport { .. } => "loose parts",
            Self::Unbalanced { .. } => "not in balance",
            Self::Surface(_) => "unusual horizon",
            Self::ProbeOutside { .. } => "outside the body",
            Self::UnstableStep { .. } | Self::UncertainStep { .. } => "large step",
            Self::ShortenedStep { .. } => "shortened",
            Self::ShortPeriod { .. } => "short period",
            Self::ShortWaves { .. } => "short waves",
            Self::GrowingWaves { .. } => "unstable",
            Self::PoorTuning { .. } => "poorly tuned",
            Self::EmptyClasses { .. } => "no stiffness",
            Self::FastMotion { .. } | Self::TornAtOnce { .. } => "breaks at once",
            Self::HistoricalKernels { .. } => "historical",
            Self::ExactHistory { .. } => "exact history",
            Self::FieldAtEnd { .. } => "field at the end",
            Self::EqualSteps => "no effect",
            Self::GrowingPredictor { .. } => "growing waves",
        }
    }
}
