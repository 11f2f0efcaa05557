//! Failure criteria of bonds of a linear peridynamic solid, and their calibration from the fracture energy.

use crate::error::{PericlesError, Result, positive};
use crate::family::VolumeCorrection;
use crate::kernel::Influence;
use crate::material::FractureCalibration;
use crate::material::crack_planes::CrackPlane;
use crate::material::lattice::{Cells, for_each_offset};

/// Deformation at which the fracture energy G₀ is evaluated. In a state-based solid the energy of a bond
/// depends on the dilatation of its end points, so that the critical stretch s₀ does not follow from G₀
/// alone.
///
/// With the constants A and B of the solid ([`LinearSolidConstants`](super::LinearSolidConstants)) and the
/// integrals P₁ = ∫ p dz and P₂ = ∫ p² dz over caps ([`CapIntegrals`](crate::kernel::CapIntegrals)):
///
/// | definition | G₀/s₀² |
/// |---|---|
/// | closing | B P₁ + A D P₂ |
/// | bond | B P₁ |
/// | isotropic | B P₁ + A D (2 P₁ − P₂) |
///
/// All definitions agree for A = 0 (ν = 1/4, in plane stress 1/3), where the solid is bond-based.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StretchDefinition {
    /// Only bonds across the crack are stretched, by s₀: two rigid halves of a body are pulled apart.
    #[default]
    Closing,
    /// Only the part of the energy that depends on the stretch of the bond itself.
    Bond,
    /// The whole body is stretched by s₀ in all directions, then cut. For low ν such a critical stretch may not exist.
    Isotropic,
}

/// Failure criterion of bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondFailure {
    /// Bonds never break.
    Unbreakable,
    /// Bonds break beyond this stretch.
    CriticalStretch(f64),
    /// Bonds break beyond the stretch that corresponds to a fracture energy.
    Stretch {
        /// The fracture energy G₀, J/m².
        fracture_energy: f64,
        /// Deformation at which the fracture energy is evaluated.
        definition: StretchDefinition,
        /// Calibration of the critical stretch.
        calibration: FractureCalibration,
    },
    /// Bonds break beyond the bond energy w_c that corresponds to a fracture energy (Foster, Silling & Chen,
    /// Int. J. Multiscale Comput. Eng. 9, 2011): an elongated bond breaks when the work ∫ (t_ij + t_ji) de of
    /// its force states since the start exceeds w_c.
    BondEnergy {
        /// The fracture energy G₀, J/m².
        fracture_energy: f64,
        /// Calibration of w_c.
        calibration: FractureCalibration,
    },
    /// Bonds break by stress or strain at their ends, with the criterion in
    /// [`LinearSolidConstants::criterion`](super::LinearSolidConstants::criterion), which has no fracture energy.
    ByCriterion,
}

/// Failure limits of a bond; infinite if a criterion does not apply. A bond breaks when one of the limits is exceeded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondLimits {
    /// Critical stretch s₀.
    pub stretch: f64,
    /// Critical bond energy w_c, J/m⁶.
    pub energy: f64,
}

impl BondLimits {
    /// Limits of unbreakable bonds.
    pub const NONE: Self = Self {
        stretch: f64::INFINITY,
        energy: f64::INFINITY,
    };

    /// Returns whether the bond can break.
    pub fn can_break(&self) -> bool {
        self.stretch.is_finite() || self.energy.is_finite()
    }

    /// Multiplies the critical stretch by a factor and the critical energy by its square.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            stretch: factor * self.stretch,
            energy: factor * factor * self.energy,
        }
    }

    /// Returns the lower one of each limit.
    #[must_use]
    pub fn weaker(self, other: Self) -> Self {
        Self {
            stretch: self.stretch.min(other.stretch),
            energy: self.energy.min(other.energy),
        }
    }
}

/// Lattice and family for which limits are calibrated.
#[derive(Clone, Copy)]
pub(super) struct Crossing<'a> {
    pub cells: Cells<'a>,
    pub section: f64,
    pub influence: &'a Influence,
    pub horizon: f64,
    pub correction: VolumeCorrection,
    /// The constants A and B of the solid, Pa.
    pub dilatational: f64,
    pub deviatoric: f64,
}

/// Integrals or sums over the bonds across a plane: ∫ p dz, ∫ p² dz (m) and ∫∫_cap dV dz (m⁴).
#[derive(Debug, Clone, Copy)]
struct Caps {
    share: f64,
    share_squared: f64,
    volume: f64,
}

/// Limits and the fracture energy that corresponds to them.
pub(super) struct Calibrated {
    pub limits: BondLimits,
    /// Fracture energy, J/m²; infinite for unbreakable bonds.
    pub fracture_energy: f64,
    pub calibration: Option<FractureCalibration>,
    pub crack_planes: Vec<CrackPlane>,
}

/// Ratio of the influence function to its largest value below which a bond carries no force. Functions that
/// vanish at the horizon do so only to within the rounding of lengths and a margin of 1e-6 of some horizons.
const WITHOUT_FORCE: f64 = 1e-5;

/// Quantity that a criterion limits.
#[derive(Clone, Copy)]
enum Measure {
    Stretch(StretchDefinition),
    Energy,
}

impl BondFailure {
    /// Returns the calibrated limits of bonds. For points without a lattice, integrals of the continuum
    /// replace lattice sums.
    pub(super) fn calibrated(
        self,
        crossing: &Crossing<'_>,
        on_lattice: bool,
    ) -> Result<Calibrated> {
        let (measure, energy, calibration) = match self {
            Self::Unbreakable | Self::ByCriterion => {
                return Ok(Calibrated {
                    limits: BondLimits::NONE,
                    fracture_energy: f64::INFINITY,
                    calibration: None,
                    crack_planes: Vec::new(),
                });
            }
            Self::CriticalStretch(_) => (Measure::Stretch(StretchDefinition::Closing), None, None),
            Self::Stretch {
                fracture_energy,
                definition,
                calibration,
            } => (
                Measure::Stretch(definition),
                Some(fracture_energy),
                Some(calibration),
            ),
            Self::BondEnergy {
                fracture_energy,
                calibration,
            } => (Measure::Energy, Some(fracture_energy), Some(calibration)),
        };
        let calibration = calibration.map(|wanted| match on_lattice {
            true => wanted,
            false => FractureCalibration::Continuum,
        });
        let planes = match on_lattice {
            true => crossing.planes(measure),
            false => Vec::new(),
        };
        let unit = match calibration {
            Some(FractureCalibration::Lattice) => CrackPlane::mean(&planes),
            _ => crossing.unit_energy(measure, crossing.of_the_continuum()),
        };
        // The limit and the factor of the unit energy: the square of a stretch, or the bond energy.
        let (limit, scale) = match (self, energy) {
            (Self::CriticalStretch(stretch), _) => {
                let stretch = positive("the critical stretch", stretch)?;
                (stretch, stretch * stretch)
            }
            (_, energy) => {
                let energy = positive("the fracture energy", energy.unwrap_or(f64::NAN))?;
                if unit <= 0.0 {
                    return Err(no_stretch(unit));
                }
                let scale = energy / unit;
                match measure {
                    Measure::Stretch(_) => (scale.sqrt(), scale),
                    Measure::Energy => (scale, scale),
                }
            }
        };
        let limits = match measure {
            Measure::Stretch(_) => BondLimits {
                stretch: limit,
                ..BondLimits::NONE
            },
            Measure::Energy => BondLimits {
                energy: limit,
                ..BondLimits::NONE
            },
        };
        let planes = planes.into_iter().map(|plane| plane.scaled(scale));
        Ok(Calibrated {
            limits,
            fracture_energy: unit * scale,
            calibration,
            crack_planes: planes.collect(),
        })
    }
}

fn no_stretch(unit: f64) -> PericlesError {
    PericlesError::ElasticConstants {
        reason: format!(
            "no critical stretch corresponds to the fracture energy with this stretch definition and Poisson's ratio: \
             the energy of a crack would be {unit:.3e} J/m² at unit stretch, but must be positive; use the closing \
             definition or the bond energy"
        ),
    }
}

impl Crossing<'_> {
    /// Returns the fracture energy at s₀ = 1 or w_c = 1, J/m².
    fn unit_energy(&self, measure: Measure, caps: Caps) -> f64 {
        let dimension = self.cells.sides().len() as f64;
        let dilatational = self.dilatational * dimension;
        let bond = self.deviatoric * caps.share;
        match measure {
            Measure::Energy => caps.volume,
            Measure::Stretch(StretchDefinition::Bond) => bond,
            Measure::Stretch(StretchDefinition::Closing) => {
                bond + dilatational * caps.share_squared
            }
            Measure::Stretch(StretchDefinition::Isotropic) => {
                bond + dilatational * (2.0 * caps.share - caps.share_squared)
            }
        }
    }

    fn of_the_continuum(&self) -> Caps {
        let dimension = self.cells.sides().len();
        let caps = self.influence.cap_integrals(dimension, self.horizon);
        Caps {
            share: caps.share,
            share_squared: caps.share_squared,
            volume: self.section * caps.volume,
        }
    }

    /// Returns the largest value of the influence function on the bonds of a point.
    fn largest_influence(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for_each_offset(self.cells, self.horizon, self.correction, |_, xi, _| {
            largest = largest.max(self.influence.alpha_of(xi, self.horizon));
        });
        largest
    }

    /// Returns the planes of the lattice with the energy per area of a crack along each. For bond energies,
    /// only bonds that carry force are counted.
    ///
    /// Points beside a crack form layers. The points of the k-th layer have the share p_k of their family at
    /// least k lattice planes away; the volume of a layer per area is the reciprocal of the number of planes
    /// per length.
    fn planes(&self, measure: Measure) -> Vec<CrackPlane> {
        let (cells, size) = (self.cells, self.cells.size());
        let planes = CrackPlane::all(cells);
        // Weighted volume and volume of the bonds of a point by the number of crossed planes.
        let mut by_number: Vec<Vec<[f64; 2]>> = vec![Vec::new(); planes.len()];
        let mut whole = 0.0;
        let largest = self.largest_influence();
        for_each_offset(cells, self.horizon, self.correction, |offset, xi, r| {
            let influence = self.influence.alpha_of(xi, self.horizon);
            let factor = self.correction.factor(r, self.horizon, size);
            let weighted = factor * influence * r * r;
            // A bond without force does no work and does not reach an energy limit.
            let carries = influence > WITHOUT_FORCE * largest;
            let volume = if carries { factor } else { 0.0 };
            whole += weighted;
            for (plane, sums) in planes.iter().zip(&mut by_number) {
                let crossed = plane.crossed(offset).max(0) as usize;
                if crossed >= sums.len() {
                    sums.resize(crossed + 1, [0.0; 2]);
                }
                sums[crossed][0] += weighted;
                sums[crossed][1] += volume;
            }
        });
        let cell = self.section * cells.volume();
        let energy = |plane: &CrackPlane, sums: &[[f64; 2]]| {
            let distance = 1.0 / plane.per_length(cells);
            let mut caps = Caps {
                share: 0.0,
                share_squared: 0.0,
                volume: 0.0,
            };
            let (mut share, mut volume) = (0.0, 0.0);
            // From the layer farthest from the crack.
            for [weighted, bonds] in sums[1..].iter().rev() {
                share += weighted / whole;
                volume += bonds * cell;
                caps.share += distance * share;
                caps.share_squared += distance * share * share;
                caps.volume += distance * volume;
            }
            self.unit_energy(measure, caps)
        };
        let with_energy = planes.into_iter().zip(&by_number);
        with_energy
            .map(|(plane, sums)| {
                let energy = energy(&plane, sums);
                plane.with_energy(energy)
            })
            .collect()
    }
}
