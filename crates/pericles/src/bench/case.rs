//! The problems that are timed.

use std::sync::Arc;

use crate::error::Result;
use crate::family::VolumeCorrection;
use crate::kernel::Influence;
use crate::material::{
    BondConstants, BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw,
    StressState,
};
use crate::operator::{BondBody, BondForm, DamageMeasure, InstructionSet};
use crate::scalar::PointScalar;
use crate::space::{Grid, PointCloud, Shape};
use crate::system::System;
use crate::time::State;

use super::StoredList;

/// A problem to be timed.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name, as in the results: see [`Case::named`].
    pub name: String,
    /// Cells of the box along each axis; one to three.
    pub cells: Vec<usize>,
    /// Form of the operator.
    pub form: BondForm,
    /// What the loops are compiled for, if the machine has it.
    pub instruction_set: InstructionSet,
    /// Critical stretch; no case that is timed by name reaches it.
    pub critical_stretch: f64,
    /// Every point is moved off its lattice node, so that no two bonds are alike.
    pub moved: bool,
    /// Not an operator of this library but the plain loop that it is set against: see [`StoredList`](super::StoredList).
    pub scalar: bool,
}

/// Cases that are timed if none is asked for.
const NAMES: [&str; 12] = [
    "block-46",
    "block-46-avx2",
    "block-46-f32",
    "block-46-f32-avx2",
    "block-46-list",
    "block-46-list-avx2",
    "block-46-list-moved",
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
    /// The cases that are timed if none is asked for.
    pub fn all() -> Vec<Self> {
        NAMES.into_iter().filter_map(Self::named).collect()
    }

    /// A box of cells on its lattice, with the best instructions of the machine.
    pub fn new(name: &str, cells: Vec<usize>, form: BondForm) -> Self {
        Self {
            name: name.to_owned(),
            cells,
            form,
            instruction_set: InstructionSet::detect(),
            critical_stretch: 0.015,
            moved: false,
            scalar: false,
        }
    }

    /// The case of this name: `bar-N`, `plate-N` or `block-N` with N cells along every axis, by the grid operator; then any of `-list` (by the list operator), `-f32` (by the grid operator in floats), `-scalar` (by
    /// the plain loop), `-avx2` (without AVX-512) and `-moved` (points off the lattice, hence a list).
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
                "scalar" => (case.form, case.scalar) = (BondForm::List, true),
                "avx2" => case.instruction_set = InstructionSet::Avx2,
                "moved" => (case.form, case.moved) = (BondForm::List, true),
                _ => return None,
            }
        }
        Some(case)
    }

    /// The points.
    ///
    /// # Errors
    /// A box without or with too many cells.
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

    /// Glass with a horizon of 3.015 spacings, linear partial volumes and the case's critical stretch.
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

    /// The constants of the material in the case's dimension.
    ///
    /// # Errors
    /// A horizon of no neighbours.
    pub fn constants(&self, cloud: &PointCloud) -> Result<BondConstants> {
        let state = match cloud.dimension() {
            1 => StressState::Uniaxial,
            2 => StressState::PlaneStrain,
            _ => StressState::Spatial,
        };
        self.material().constants(cloud, state)
    }

    /// The body with its operator, moving smoothly.
    ///
    /// # Errors
    /// See [`Case::cloud`].
    pub fn system(&self) -> Result<(System, State)> {
        let cloud = self.cloud()?;
        let material = self.material();
        let constants = self.constants(&cloud)?;
        let body = BondBody {
            damage: DamageMeasure {
                count: true,
                ..DamageMeasure::default()
            },
            ..BondBody::new(&cloud, &material, &constants)
        };
        let mut operator = body.operator(self.form)?.operator;
        operator.use_instruction_set(self.instruction_set);
        let start = moving(&cloud);
        let system = System::new(cloud, operator, PointScalar::Uniform(DENSITY))?;
        Ok((system, start))
    }

    /// The same body as a plain loop over stored numbers, moving likewise.
    ///
    /// # Errors
    /// See [`Case::cloud`].
    pub fn stored_list(&self) -> Result<(StoredList, State)> {
        let cloud = self.cloud()?;
        let list = StoredList::new(&cloud, &self.material(), &self.constants(&cloud)?);
        Ok((list, moving(&cloud)))
    }

    /// Bonds of a point inside the body.
    pub(super) fn family(&self) -> f64 {
        [6.0, 28.0, 122.0][self.cells.len() - 1]
    }
}

/// A state at rest that starts to move in long waves.
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
    fn names_say_what_is_timed() {
        assert_eq!(Case::all().len(), NAMES.len());
        let case = Case::named("plate-30-list-avx2").unwrap();
        assert_eq!((case.cells, case.form), (vec![30; 2], BondForm::List));
        assert_eq!(case.instruction_set, InstructionSet::Avx2);
        assert_eq!(Case::named("bar-1e6").unwrap().cells, [1_000_000]);
        for wrong in [
            "",
            "block",
            "block-0",
            "block-1.5",
            "cube-3",
            "block-4-fast",
            "block--1",
        ] {
            assert_eq!(Case::named(wrong), None, "{wrong}");
        }
    }
}
