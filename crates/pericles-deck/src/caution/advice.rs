//! Advice and labels of warnings.

use miette::Severity;

use super::Caution;
use crate::subject::Subject;

impl Subject for Caution {
    const SEVERITY: Severity = Severity::Warning;

    fn advice(&self) -> Option<String> {
        let advice = match self {
            Self::UnusedMaterial { .. } => {
                "assign it with [[assign]] set = …, material = …, or remove it"
            }
            Self::CrackCutsNothing => {
                "a crack must pass between points of the body whose distance is below the horizon; check its position and unit"
            }
            Self::LargeStretch { .. } => {
                "usual: below 20 %; check `fracture_energy`, the modulus and the horizon, and their units (J/m², Pa, m)"
            }
            Self::CrackOutside { .. } => {
                "check its coordinates and their unit (default: m); `origin` moves the body"
            }
            Self::SoftSolid { .. } => {
                "check the modulus and its unit (default: Pa), such as \"70 GPa\""
            }
            Self::HeavySolid { .. } => "check its unit (default: kg/m³), such as \"7.85 g/cm3\"",
            Self::TinySpacing { .. } => "check its unit (default: m), such as \"1 mm\"",
            Self::ClosePoints { .. } => {
                "remove one of them if it is a duplicate; the bond between them limits the time step"
            }
            Self::UnusedCoordinate { .. } => {
                "set the coordinate to 0, or set `dimension` so that all coordinates are used"
            }
            Self::LongExodusNames { .. } => {
                "use names of at most 32 bytes (arrays `Set_NAME`: 28), or another format"
            }
            // The message contains the advice.
            Self::Mesh { .. } | Self::ImplausibleHeat { .. } => return None,
            Self::FilledVolume { .. } => {
                "use a smaller spacing or cells = \"partial\"; where surfaces overlap, the enclosed volume counts twice but is filled once"
            }
            Self::IdleHole => {
                "check its position, its size, which must exceed the spacing, and their unit (default: m)"
            }
            Self::NothingBreaks { .. } => {
                "set `fracture_energy` or `critical_stretch`, or remove the key"
            }
            Self::NothingDissipates { moves: true } => {
                "set `fracture_energy`, `critical_stretch`, `softening`, `yield_stress` or `viscosity` in [material], or remove the key"
            }
            Self::NothingDissipates { moves: false } => {
                "use another scheme than \"thermal\" in [time], or remove the key"
            }
            Self::NothingActs => {
                "add [[load]], [[constraint]] or [[initial]]; `pericles modes` does not need them"
            }
            Self::StiffnessError { .. } => {
                "use modulus = \"lattice\", which is exact on a grid (\"continuum\" for spectral forces and Gauss nodes), or a larger horizon ratio"
            }
            Self::ShearStiffness { .. } => {
                "use a horizon of three spacings; one spacing gives a point few neighbours off the axes"
            }
            Self::ShearAnisotropy { .. } => {
                "use influence = { function = \"isotropic\" }, which is exact in all directions; \"conical\" has a smaller error than \"constant\""
            }
            Self::FastWaves { .. } => {
                "check the density and the modulus, and their units (default: kg/m³, Pa)"
            }
            Self::IdleClasses { .. } => "a shorter horizon is equivalent, if this is intended",
            Self::LoadedArea(_) => {
                "set `area`, or use a layer on one face, such as layer = { side = \"+x\", cells = 3 }, and one [[load]] per face"
            }
            Self::LoadOnHeld { .. } => "choose other points, or remove the load",
            Self::Pieces { points: 1, .. } => {
                "a crack through points cuts all their bonds: shift it by half a cell; otherwise check holes and the horizon, unless isolated points are intended"
            }
            Self::Pieces { .. } => {
                "check cracks, holes and the horizon, unless separate parts are intended"
            }
            Self::NoContact { .. } => {
                "add [contact], or [contact] with pairs = \"pieces\" for the pieces only"
            }
            Self::Contact(caution) => return Some(caution.advice()),
            Self::NoSupport { .. } => {
                "constrain them with [[constraint]]; without supports, a static state exists only if the loads on them are in equilibrium"
            }
            Self::Unbalanced { .. } => {
                "constrain points with [[constraint]], or balance the loads; otherwise these points accelerate and no static state exists"
            }
            Self::ProbeOutside { .. } => {
                "the probe records the nearest point; check the coordinates of `at` and their unit (default: m)"
            }
            Self::UnstableStep { .. } => {
                "it is used because allow_unstable = true; dt = \"auto\" chooses a stable step"
            }
            Self::UncertainStep { .. } => "use dt = \"auto\", which stays below this limit",
            Self::ShortenedStep { .. } => {
                "choose a dt that divides time.end to keep the given step"
            }
            Self::Surface(_) => "recommended: 3 to 6 median edge lengths",
            Self::ThinBody { .. } => {
                "use surface_correction = \"energy\", or a smaller horizon with a smaller spacing"
            }
            Self::BridgedLayer { .. } => {
                "add [[crack]] with `layer` = its set, which removes these bonds, or use a horizon smaller than the layer is thick"
            }
            Self::MeshDependence { .. } => {
                "use a smaller `alpha`, more edge lengths per horizon, or p = 2 with bond = \"displacement\", where `self_interaction` adds it; compare results of two meshes"
            }
            Self::ShortPeriod { .. } => {
                "use a longer body, a shorter run or a smaller exact.window"
            }
            Self::ShortWaves { .. } => {
                "use a finer grid, a smoother time function or field, or a tuned influence function; `pericles dispersion` shows the speeds of all waves"
            }
            Self::GrowingWaves { .. } => {
                "use positive coefficients; the energy of this body grows without bound"
            }
            Self::PoorTuning { .. } => {
                "use decay = 1 (the default) and method = \"least-squares\"; a positive lower_bound limits the improvement"
            }
            Self::FastMotion { .. } => {
                "check the value and its unit (default: m/s), or use a lower speed"
            }
            Self::TornAtOnce { .. } => {
                "check speeds, displacements and the critical stretch; use a ramp, a lower speed, or no_fail for the points near supports"
            }
            Self::NoHistory => {
                "this is correct for a body that was elastic until then; otherwise compute its history in this run"
            }
            Self::EmptyClasses { .. } => {
                "use a positive lower_bound such as 0.5, or a shorter horizon"
            }
            Self::HistoricalKernels { .. } => {
                "use method = \"discrete\", which is exact for the scheme, or \"semi-discrete\", the same boundary with exact Green functions"
            }
            Self::ExactHistory { .. } => {
                "use a larger tolerance, or history = \"blocked\" to skip the fit; the memory of the blocked history grows with the number of steps"
            }
            Self::FieldAtEnd { .. } => {
                "set `exterior_extent` to continue the field beyond the boundary, or move the boundary outwards"
            }
            Self::EqualSteps => {
                "use ratio > 1, or a scheme with one time step, which is less expensive"
            }
            Self::GrowingPredictor { .. } => {
                "use predictor = \"structured\", which is stable, or a smaller dt"
            }
        };
        Some(advice.into())
    }

    fn label(&self) -> &'static str {
        match self {
            Self::CrackCutsNothing | Self::UnusedMaterial { .. } => "no effect",
            Self::CrackOutside { .. } => "outside the body",
            Self::Pieces { .. } => "disconnected",
            Self::NoContact { .. } => "no contact",
            Self::Contact(caution) => caution.label(),
            Self::LargeStretch { .. } => "large critical stretch",
            Self::SoftSolid { .. } => "low modulus",
            Self::HeavySolid { .. } => "large density",
            Self::TinySpacing { .. } => "small spacing",
            Self::ClosePoints { .. } => "close points",
            Self::UnusedCoordinate { .. } => "not used",
            Self::ImplausibleHeat { .. } => "unlikely",
            Self::LongExodusNames { .. } => "name shortened",
            Self::IdleHole | Self::NothingBreaks { .. } | Self::NothingDissipates { .. } => {
                "no effect"
            }
            Self::Mesh { .. } => "unusual mesh",
            Self::FilledVolume { .. } => "volume differs",
            Self::NothingActs => "no load",
            Self::StiffnessError { .. } => "stiffness error",
            Self::ShearStiffness { .. } => "low shear stiffness",
            Self::ShearAnisotropy { .. } => "anisotropic shear",
            Self::FastWaves { .. } => "high wave speed",
            Self::IdleClasses { .. } => "no stiffness",
            Self::LoadedArea(_) => "ambiguous area",
            Self::LoadOnHeld { .. } => "constrained",
            Self::NoSupport { .. } => "no support",
            Self::Unbalanced { .. } => "not in equilibrium",
            Self::Surface(_) => "unusual horizon",
            Self::MeshDependence { .. } => "mesh-dependent",
            Self::ThinBody { .. } => "surface effect",
            Self::BridgedLayer { .. } => "bridged layer",
            Self::ProbeOutside { .. } => "outside the body",
            Self::UnstableStep { .. } | Self::UncertainStep { .. } => "large time step",
            Self::ShortenedStep { .. } => "shortened",
            Self::ShortPeriod { .. } => "short period",
            Self::ShortWaves { .. } => "short waves",
            Self::GrowingWaves { .. } => "unstable",
            Self::PoorTuning { .. } => "poorly tuned",
            Self::NoHistory => "incomplete state",
            Self::EmptyClasses { .. } => "no stiffness",
            Self::FastMotion { .. } | Self::TornAtOnce { .. } => "fast motion",
            Self::HistoricalKernels { .. } => "growing error",
            Self::ExactHistory { .. } => "exact history",
            Self::FieldAtEnd { .. } => "field at the boundary",
            Self::EqualSteps => "no effect",
            Self::GrowingPredictor { .. } => "weakly unstable",
        }
    }
}
