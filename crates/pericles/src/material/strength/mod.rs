//! Strength of materials whose bonds soften: the onset of softening from a tensile strength, and the strength of a
//! material in uniaxial and multiaxial tension.
//!
//! In a homogeneous deformation ε the stretch n·ε n of a bond depends on its direction n only, not on its length, the
//! influence function or the horizon. The stress is
//!
//! σ = ½ c V Σ κ α |ξ| g(n·ε n) n ⊗ n, or N ⟨g n ⊗ n⟩ by integrals,
//!
//! with the softening curve g and N = E (bar), 3E (plane stress), 3.2E (plane strain), 6E (3D). With x = s/s_e the curve
//! g/s_e depends on A = (s₀/s_e)² only, so that one function Φ per law and state of stress gives the strength, the
//! largest stress of a homogeneous body under growing uniaxial tension:
//!
//! f_t = E s_e Φ(A).
//!
//! The fracture energy fixes s₀, and s_e is the root of E s₀ Φ(A)/√A = f_t. The left side decreases from its value at
//! A = 1, the strength of the brittle material; a larger strength needs a smaller horizon, because s₀² ~ 1/δ.
//!
//! Bonds along the tension soften first, while oblique bonds still carry load, so that Φ > 1: with s_e = f_t/E the
//! material would be up to 1.4 times (2D) and 1.8 times (3D) as strong as f_t.

mod fan;
mod loading;
mod path;
mod root;

use super::lattice::Cells;
use super::{
    BondConstants, BondMaterial, Calibration, CrackPlane, Fracture, FractureCalibration, Softening,
    SofteningCurve, SofteningLaw, StressState,
};
use crate::error::{PericlesError, Result, UnreachableStrength, positive};
use crate::space::PointCloud;
use fan::Fan;
use path::{Loaded, Loading};

/// A tensile strength from which the onset of softening follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TensileStrength {
    /// Strength f_t, Pa.
    pub strength: f64,
    /// Bonds that give the strength: those of the lattice, so that f_t is the mean over tension normal to the planes of
    /// [`CrackPlane::mean`], or integrals over all directions. Always integrals for bodies without a lattice.
    pub calibration: FractureCalibration,
}

/// The bonds of a point in a homogeneous body of one material.
#[derive(Debug, Clone)]
pub struct HomogeneousBonds {
    state: StressState,
    young: f64,
    horizon: f64,
    critical_stretch: f64,
    /// Whether the critical stretch follows from a fracture energy.
    by_energy: bool,
    fracture_energy: f64,
    lattice: Option<LatticeBonds>,
    /// Modulus of the bonds by integrals over E.
    ratio: f64,
}

#[derive(Debug, Clone)]
struct LatticeBonds {
    fan: Fan,
    planes: Vec<CrackPlane>,
    sides: Vec<f64>,
}

/// Strengths of a material with softening bonds: largest stresses of a homogeneous body, Pa.
#[derive(Debug, Clone, PartialEq)]
pub struct Strengths {
    /// A = (s₀/s_e)².
    pub ratio: f64,
    /// Strength in uniaxial tension by the calibration of the tensile strength, E s_e Φ(A).
    pub tensile: f64,
    /// Strength in uniaxial tension along directions of the lattice: the angle from the first axis in degrees in two
    /// dimensions (0, 22.5, 45) and in a bar (0), or the direction in three (100, 110, 111). Equal values for bodies
    /// without a lattice.
    pub by_direction: Vec<(&'static str, f64)>,
    /// Largest stress under equal tensions along two axes; `None` for a bar.
    pub equibiaxial: Option<f64>,
    /// Largest shear stress in pure shear along two axes: principal stresses τ, −τ; `None` for a bar.
    pub shear: Option<f64>,
    /// Largest stress under equal tensions along three axes; `None` in one and two dimensions.
    pub hydrostatic: Option<f64>,
    /// Stress at which the curve of uniaxial tension departs from the straight line.
    pub linear_limit: f64,
    /// Largest horizon at which softening gives this strength with this modulus and fracture energy, m:
    /// δ (E s₀ Φ(1)/f_t)².
    pub largest_horizon: f64,
    /// Irwin length E G/f_t², m.
    pub irwin_length: f64,
}

impl HomogeneousBonds {
    /// Returns the bonds of a material in the interior of a body with these points. `constants` are those of the material
    /// on the body.
    pub fn new(
        material: &BondMaterial,
        constants: &BondConstants,
        cloud: &PointCloud,
        state: StressState,
    ) -> Self {
        let (dimension, section) = (cloud.dimension(), cloud.section());
        let lattice = cloud.cell_sides().map(|sides| {
            let cells = Cells::new(sides);
            let stiffness = constants.micromodulus * section / constants.young;
            LatticeBonds {
                fan: Fan::of_lattice(material, cells, stiffness),
                planes: CrackPlane::all(cells),
                sides: sides.to_vec(),
            }
        });
        let ratio = match material.modulus.calibration {
            Calibration::Continuum | Calibration::Lattice => 1.0,
            // The influence function contains the modulus.
            calibration @ Calibration::Unmodified => {
                let (influence, horizon) = (&material.influence, material.horizon);
                influence.moment(dimension as f64, horizon)
                    / calibration.moment(dimension, horizon, influence, f64::NAN)
            }
        };
        Self {
            state,
            young: constants.young,
            horizon: material.horizon,
            critical_stretch: constants.critical_stretch,
            by_energy: matches!(material.fracture, Fracture::Energy { .. }),
            fracture_energy: constants.fracture_energy,
            lattice,
            ratio,
        }
    }

    /// Returns the softening with which the material has a tensile strength.
    ///
    /// # Errors
    /// A strength that is not positive or above that of the brittle material ([`UnreachableStrength`]); bonds that never
    /// break; the errors of [`Softening::curve`].
    pub fn softening(&self, law: SofteningLaw, given: TensileStrength) -> Result<Softening> {
        /// Largest relative error of A.
        const TOLERANCE: f64 = 1e-10;
        let strength = positive("the tensile strength", given.strength)?;
        // Errors of the law, and of bonds that never break.
        let onset = match self.critical_stretch.is_finite() {
            true => 0.5 * self.critical_stretch,
            false => strength / self.young,
        };
        Softening { law, onset }.curve(self.critical_stretch)?;
        let loaded = self.tension(given.calibration);
        let brittle = positive(
            "the strength of the lattice without softening, which needs a horizon of at least two spacings,",
            self.young * self.critical_stretch * loaded.at_onset(),
        )?;
        if strength >= brittle {
            return Err(PericlesError::Strength(UnreachableStrength {
                strength,
                brittle,
                critical_stretch: self.critical_stretch,
                by_energy: self.by_energy,
                horizon: self.horizon,
                largest_horizon: self.horizon * (brittle / strength).powi(2),
            }));
        }
        let elastic = self.young * self.critical_stretch / strength;
        // ln of E s₀ Φ(A)/(√A f_t) as a function of ln A.
        let value = |logarithm: f64| {
            let curve = curve_of(law, logarithm.exp());
            curve.map_or(f64::NAN, |curve| {
                (elastic * loaded.factor(&curve)).ln() - 0.5 * logarithm
            })
        };
        let mut high = 2.0 * (4.0 * brittle / strength).ln();
        let mut at_high = value(high);
        while at_high > 0.0 {
            high *= 2.0;
            at_high = value(high);
        }
        let at_low = (brittle / strength).ln();
        let logarithm = root::root(value, [0.0, high], [at_low, at_high], TOLERANCE);
        Ok(Softening {
            law,
            onset: self.critical_stretch * (-0.5 * logarithm).exp(),
        })
    }

    /// Returns the strengths of the material with a softening law; `calibration` selects the bonds that give the mean
    /// tensile strength.
    ///
    /// # Errors
    /// The errors of [`Softening::curve`].
    pub fn strengths(
        &self,
        softening: &Softening,
        calibration: FractureCalibration,
    ) -> Result<Strengths> {
        softening.curve(self.critical_stretch)?;
        let ratio = (self.critical_stretch / softening.onset).powi(2);
        let curve = curve_of(softening.law, ratio)?;
        let unit = self.young * softening.onset;
        let mean = self.tension(calibration);
        let tensile = unit * mean.factor(&curve);
        let dimension = self.state.dimension();
        let strength =
            |loading: &Loading, fan: &Fan| unit * Loaded::new(fan, loading).strength(&curve);
        let by_direction = directions(dimension).iter().map(|(name, along)| {
            let strength = match &self.lattice {
                Some(lattice) => strength(&loading::uniaxial(*along, dimension), &lattice.fan),
                None => tensile,
            };
            (*name, strength)
        });
        let continuum = |of: fn(StressState, f64) -> Fan| of(self.state, self.ratio);
        let lattice = self.lattice.as_ref().map(|lattice| &lattice.fan);
        let of_axes = |loading: &Loading, of: fn(StressState, f64) -> Fan| match lattice {
            Some(fan) => strength(loading, fan),
            None => strength(loading, &continuum(of)),
        };
        let brittle = self.young * self.critical_stretch * mean.at_onset();
        Ok(Strengths {
            ratio,
            tensile,
            by_direction: by_direction.collect(),
            equibiaxial: (dimension > 1)
                .then(|| of_axes(&loading::equibiaxial(dimension), Fan::axial)),
            shear: (dimension > 1).then(|| of_axes(&loading::shear(dimension), Fan::orthotropic)),
            hydrostatic: (dimension > 2).then(|| of_axes(&loading::dilation(3), Fan::axial)),
            linear_limit: unit * mean.at_onset(),
            largest_horizon: self.horizon * (brittle / tensile).powi(2),
            irwin_length: self.young * self.fracture_energy / tensile.powi(2),
        })
    }

    /// Returns the uniaxial tensions whose mean strength is the tensile strength.
    fn tension(&self, calibration: FractureCalibration) -> Tension {
        let dimension = self.state.dimension();
        match (&self.lattice, calibration) {
            (Some(lattice), FractureCalibration::Lattice) => {
                let loaded = lattice.planes.iter().map(|plane| {
                    let along = plane.normal(&lattice.sides);
                    Loaded::new(&lattice.fan, &loading::uniaxial(along, dimension))
                });
                Tension {
                    loaded: loaded.collect(),
                    planes: lattice.planes.clone(),
                }
            }
            _ => Tension {
                loaded: vec![Loaded::new(
                    &Fan::axial(self.state, self.ratio),
                    &loading::axial(dimension),
                )],
                planes: Vec::new(),
            },
        }
    }
}

/// Uniaxial tensions normal to planes of a lattice, or one tension without a lattice.
struct Tension {
    loaded: Vec<Loaded>,
    planes: Vec<CrackPlane>,
}

impl Tension {
    /// Returns Φ(A) of a curve whose onset is 1.
    fn factor(&self, curve: &SofteningCurve) -> f64 {
        self.mean(&|loaded| loaded.strength(curve))
    }

    /// Returns Φ(1): the stress over E at the stretch 1 of the first bond.
    fn at_onset(&self) -> f64 {
        self.mean(&Loaded::at_onset)
    }

    fn mean(&self, value: &dyn Fn(&Loaded) -> f64) -> f64 {
        match &self.planes[..] {
            [] => value(&self.loaded[0]),
            planes => CrackPlane::mean_of(planes, |k| value(&self.loaded[k])),
        }
    }
}

/// Returns the curve with the onset 1 and the area A/2.
fn curve_of(law: SofteningLaw, ratio: f64) -> Result<SofteningCurve> {
    Softening { law, onset: 1.0 }.curve(ratio.sqrt())
}

/// Returns the directions of tension in reports, with their names.
fn directions(dimension: usize) -> &'static [(&'static str, [f64; 3])] {
    const EIGHTH: [f64; 3] = [0.923_879_532_511_286_7, 0.382_683_432_365_089_8, 0.0];
    const ALONG: [f64; 3] = [1.0, 0.0, 0.0];
    const DIAGONAL: [f64; 3] = [1.0, 1.0, 0.0];
    match dimension {
        1 => &[("0", ALONG)],
        2 => &[("0", ALONG), ("22.5", EIGHTH), ("45", DIAGONAL)],
        _ => &[("100", ALONG), ("110", DIAGONAL), ("111", [1.0; 3])],
    }
}
