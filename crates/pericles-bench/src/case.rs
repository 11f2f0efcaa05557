//! Benchmark problems.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    BondConstants, BondFailure, BondMaterial, Calibration, ElasticModulus, Fracture,
    GivenConstants, LinearSolid, Modulus, PairLaw, StateInfluence, StressState,
};
use pericles::operator::{
    BondBody, BondForm, DamageMeasure, Force, InstructionSet, LinearSolidBody,
};
use pericles::space::{Grid, PointCloud, Shape};
use pericles::time::State;
use pericles::{PointScalar, Result, System};

use crate::StoredList;

/// A benchmark problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name in the results, see [`Case::named`].
    pub name: String,
    /// Cells of the box along each axis, for one to three axes.
    pub cells: Vec<usize>,
    /// Form of the operator.
    pub form: BondForm,
    /// Instruction set of the loops, if the machine supports it.
    pub instruction_set: InstructionSet,
    /// Critical stretch; the named cases do not reach it.
    pub critical_stretch: f64,
    /// Whether every point is displaced from its lattice node, so that no two bonds are equal.
    pub moved: bool,
    /// Whether the reference loop is timed instead of an operator of the engine, see
    /// [`StoredList`](crate::StoredList).
    pub scalar: bool,
    /// Whether the material is a linear peridynamic solid (two passes) instead of bond-based.
    pub state_based: bool,
}

/// Default cases.
const NAMES: [&str; 14] = [
    "block-46",
    "block-46-avx2",
    "block-46-f32",
    "block-46-f32-avx2",
    "block-46-list",
    "block-46-list-avx2",
    "block-46-list-moved",
    "block-46-lps",
    "block-46-lps-list",
    "block-100",
    "plate-512",
    "plate-512-list",
    "plate-512-scalar",
    "bar-1e6",
];

/// Spacing of all cases, m.
const SPACING: f64 = 1e-3;

/// Density of all cases, kg/m³.
const DENSITY: f64 = 2235.0;

impl Case {
    /// Returns the default cases.
    pub fn all() -> Vec<Self> {
        NAMES.into_iter().filter_map(Self::named).collect()
    }

    /// Creates a box of cells on its lattice, with the best instruction set of the machine.
    pub fn new(name: &str, cells: Vec<usize>, form: BondForm) -> Self {
        Self {
            name: name.to_owned(),
            cells,
            form,
            instruction_set: InstructionSet::detect(),
            critical_stretch: 0.015,
            moved: false,
            scalar: false,
            state_based: false,
        }
    }

    /// Returns the case with this name: `bar-N`, `plate-N` or `block-N` with N cells along every axis and the
    /// grid operator; then any of the suffixes `-list` (list operator), `-f32` (grid operator in single
    /// precision), `-scalar` (reference loop), `-lps` (linear peridynamic solid), `-avx2` (without AVX-512)
    /// and `-moved` (points displaced from the lattice, hence a list). Returns `None` for an unknown name.
    pub fn named(name: &str) -> Option<Self> {
        let mut words = name.split('-');
        let dimension = match words.next()? {
            "bar" => 1,
            "plate" => 2,
            "block" => 3,
            _ => return None,
        };
        let count: f64 = words.next()?.parse().ok()?;
        if count.fract() != 0.0 || !(1.0..1e12).contains(&count) {
            return None;
        }
        let mut case = Self::new(name, vec![count as usize; dimension], BondForm::Grid);
        for word in words {
            match word {
                "list" => case.form = BondForm::List,
                "f32" => case.form = BondForm::FloatGrid,
                "lps" => case.state_based = true,
                "scalar" => (case.form, case.scalar) = (BondForm::List, true),
                "avx2" => case.instruction_set = InstructionSet::Avx2,
                "moved" => (case.form, case.moved) = (BondForm::List, true),
                _ => return None,
            }
        }
        let pairs_only = case.scalar || case.form == BondForm::FloatGrid;
        (!(case.state_based && pairs_only)).then_some(case)
    }

    /// Creates the points.
    ///
    /// # Errors
    /// Returns an error for a box with no or too many cells.
    pub fn cloud(&self) -> Result<Arc<PointCloud>> {
        let size = self.cells.iter().map(|&count| count as f64 * SPACING);
        let grid = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: size.collect(),
            },
            spacing: SPACING,
            section: if self.cells.len() == 3 { 1.0 } else { SPACING },
            holes: vec![],
        };
        let points = grid.points()?;
        if !self.moved {
            return Ok(Arc::new(points));
        }
        let moved = |(k, x): (usize, &f64)| x + 0.3 * SPACING * (1e3 * (k as f64).sin()).sin();
        Ok(Arc::new(PointCloud::new(
            points.dimension(),
            points.positions().iter().enumerate().map(moved).collect(),
            points.volumes().to_vec(),
            points.section(),
        )?))
    }

    /// Returns the stress state for the dimension of the case.
    fn stress_state(&self) -> StressState {
        match self.cells.len() {
            1 => StressState::Uniaxial,
            2 => StressState::PlaneStrain,
            _ => StressState::Spatial,
        }
    }

    /// Returns glass with a horizon of 3.015 spacings, linear partial volumes and the critical stretch of the
    /// case.
    pub fn material(&self) -> BondMaterial {
        BondMaterial {
            law: PairLaw::BondStretch,
            density: DENSITY,
            modulus: Modulus {
                value: ElasticModulus::Young(65e9),
                calibration: Calibration::Continuum,
            },
            horizon: 3.015 * SPACING,
            influence: Influence::default(),
            volume_correction: VolumeCorrection::Linear,
            fracture: Fracture::CriticalStretch(self.critical_stretch),
        }
    }

    /// Returns the constants of the material in the dimension of the case.
    ///
    /// # Errors
    /// Returns an error if the horizon contains no neighbours.
    pub fn constants(&self, cloud: &PointCloud) -> Result<BondConstants> {
        self.material().constants(cloud, self.stress_state())
    }

    /// Returns the same glass as a linear peridynamic solid, with the influence function of LAMMPS
    /// (peri/lps), one over the bond length.
    pub fn solid(&self) -> LinearSolid {
        LinearSolid {
            density: DENSITY,
            elastic: GivenConstants {
                young: Some(65e9),
                poisson_ratio: Some(0.22),
                ..GivenConstants::default()
            },
            horizon: 3.015 * SPACING,
            influence: StateInfluence::Function(InfluenceFunction::Inverse),
            volume_correction: VolumeCorrection::Linear,
            failure: BondFailure::CriticalStretch(self.critical_stretch),
        }
    }

    /// Creates the operator on the points of the case.
    fn operator(&self, cloud: &Arc<PointCloud>) -> Result<Box<dyn Force>> {
        let damage = DamageMeasure {
            count: true,
            ..DamageMeasure::default()
        };
        if self.state_based {
            let solid = self.solid();
            let constants = solid.constants(cloud, self.stress_state())?;
            let body = LinearSolidBody {
                damage,
                ..LinearSolidBody::new(cloud, &constants, solid.volume_correction)
            };
            return Ok(body.operator(self.form)?.operator);
        }
        let (material, constants) = (self.material(), self.constants(cloud)?);
        let body = BondBody {
            damage,
            ..BondBody::new(cloud, &material, &constants)
        };
        Ok(body.operator(self.form)?.operator)
    }

    /// Creates the body with its operator and a smooth initial velocity.
    ///
    /// # Errors
    /// The same as for [`Case::cloud`].
    pub fn system(&self) -> Result<(System, State)> {
        let cloud = self.cloud()?;
        let mut operator = self.operator(&cloud)?;
        operator.use_instruction_set(self.instruction_set);
        let start = moving(&cloud);
        let system = System::new(cloud, operator, PointScalar::Uniform(DENSITY))?;
        Ok((system, start))
    }

    /// Creates the same body and motion for the reference loop.
    ///
    /// # Errors
    /// The same as for [`Case::cloud`].
    pub fn stored_list(&self) -> Result<(StoredList, State)> {
        let cloud = self.cloud()?;
        let list = StoredList::new(&cloud, &self.material(), &self.constants(&cloud)?);
        Ok((list, moving(&cloud)))
    }

    /// Returns the number of bonds of an interior point.
    pub(crate) fn family(&self) -> f64 {
        [6.0, 28.0, 122.0][self.cells.len() - 1]
    }
}

/// Returns a state at rest with a long-wave initial velocity.
fn moving(cloud: &PointCloud) -> State {
    let (n, dimension) = (cloud.len(), cloud.dimension());
    let mut start = State::at_rest(n * dimension);
    for i in 0..n {
        for c in 0..dimension {
            let wave = 300.0 * cloud.point(i)[(c + 1) % dimension];
            start.v[c * n + i] = 0.3 * wave.sin();
        }
    }
    start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_define_the_case() {
        assert_eq!(Case::all().len(), NAMES.len());
        let case = Case::named("plate-30-list-avx2").unwrap();
        assert_eq!((case.cells, case.form), (vec![30; 2], BondForm::List));
        assert_eq!(case.instruction_set, InstructionSet::Avx2);
        assert_eq!(Case::named("bar-1e6").unwrap().cells, [1_000_000]);
        let solid = Case::named("block-4-lps-list").unwrap();
        assert!(solid.state_based && solid.form == BondForm::List);
        let (system, _) = Case::named("block-4-lps").unwrap().system().unwrap();
        assert!(system.operator().capabilities().dilatation.is_some());
        for wrong in [
            "",
            "block",
            "block-0",
            "block-1.5",
            "cube-3",
            "block-4-fast",
            "block--1",
            "block-4-lps-f32",
            "block-4-scalar-lps",
        ] {
            assert_eq!(Case::named(wrong), None, "{wrong}");
        }
    }
}
