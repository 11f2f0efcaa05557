//! Conductances of all bonds of a body: the linear operator of diffusion.

mod frame;
mod grid;
mod kernels;
mod list;
mod surface;

use std::borrow::Cow;
use std::sync::Arc;

use pericles::archive::{Archive, Layout};
use pericles::domain::Domain;
use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::lanes::InstructionSet;
use pericles::operator::Force;
use pericles::parallel::for_each_point;
use pericles::space::{PointCloud, check_length};
use pericles::{PericlesError, PointScalar, Result, Values, positive};

use crate::calibration::PairConductivity;
use grid::GridBonds;
use list::ListBonds;
use surface::{SurfaceFactors, Visit};

/// Mean of the conductivities of the two ends of a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interface {
    /// 2 k₁ k₂/(k₁ + k₂): conductors in series.
    #[default]
    Harmonic,
    /// (k₁ + k₂)/2.
    Arithmetic,
}

impl Interface {
    fn mean(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Harmonic if a > 0.0 && b > 0.0 => 2.0 / (1.0 / a + 1.0 / b),
            Self::Harmonic => 0.0,
            Self::Arithmetic => 0.5 * (a + b),
        }
    }
}

/// Description of a body that conducts. If it is divided among processes, each of them describes its own points, with a uniform
/// conductivity on all of them or on none.
#[derive(Debug, Clone)]
pub struct DiffusionBody {
    /// The points.
    pub cloud: Arc<PointCloud>,
    /// Influence function.
    pub influence: Influence,
    /// Horizon, m; the largest if there are several.
    pub horizon: f64,
    /// Horizon of each point, m, if they differ.
    pub horizons: Option<Vec<f64>>,
    /// Volume correction.
    pub correction: VolumeCorrection,
    /// Conductivity k of the points, W/(m K) for heat.
    pub conductivity: PointScalar,
    /// Mean conductivity of bonds between different materials.
    pub interface: Interface,
    /// Whether bonds of points with incomplete families conduct more, so that unit gradients along each axis have the energy
    /// of the continuum.
    pub surface_correction: bool,
    /// Points with prescribed values, which continue the body beyond a surface: their families are not corrected.
    pub prescribed: Vec<u32>,
    /// Part of its conductance that a broken bond keeps, 0 … 1.
    pub broken_share: f64,
}

/// A bond seen from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bond {
    /// The other end, ghosts after own points; a point can be a neighbour several times through periodic faces.
    pub neighbour: usize,
    /// Reference vector to the other end, m.
    pub xi: [f64; 3],
    /// Present conductance G, W/K.
    pub conductance: f64,
}

/// Bonds that conduct.
trait Bonds: Send + Sync {
    fn add_flow(&self, values: &[f64], set: InstructionSet, out: &mut [f64]);
    fn for_each_bond(&self, i: usize, visit: &mut dyn FnMut(Bond));
    /// Sets the intact bonds of a point by a function of the other end.
    fn set_intact(&mut self, i: usize, is_intact: &dyn Fn(usize) -> bool);
    /// Returns the intact bonds as bits with their layout in checkpoints.
    fn intact(&self) -> (Vec<u8>, Layout);
    /// Restores the intact bonds from these bits.
    fn restore_intact(&mut self, bits: &[u8]) -> Result<()>;
    fn directed_bonds(&self) -> u64;
    fn bytes(&self) -> usize;
}

/// The conductances of all bonds: T ↦ Σ_j G_ij (T_j − T_i), the flow into each point (W for heat).
///
/// Every point adds the flows of its bonds in a fixed order, so that results do not depend on the number of threads and processes.
/// On a body divided among processes, values and flows belong to own points; the values of ghosts are exchanged.
pub struct Diffusion {
    cloud: Arc<PointCloud>,
    bonds: Box<dyn Bonds>,
    set: InstructionSet,
    /// Directed broken bonds in each range of points when bonds were last read.
    read: Vec<u64>,
    /// Number of changes of bonds so far.
    changes: u64,
}

impl DiffusionBody {
    /// Makes the operator: a stencil for lattices, a neighbour list for other bodies. All processes must call it together.
    ///
    /// # Errors
    /// Invalid horizons, influence functions, conductivities and shares.
    pub fn build(&self) -> Result<Diffusion> {
        self.build_as(self.cloud.lattice().is_some() && self.horizons.is_none())
    }

    /// Makes the operator with a neighbour list, for comparison.
    ///
    /// # Errors
    /// The errors of [`DiffusionBody::build`].
    pub fn build_list(&self) -> Result<Diffusion> {
        self.build_as(false)
    }

    fn build_as(&self, on_grid: bool) -> Result<Diffusion> {
        let cloud = &self.cloud;
        cloud.domain().agreed(self.check())?;
        let bonds: Box<dyn Bonds> = match on_grid {
            true => Box::new(GridBonds::new(self, self.calibration(self.horizon)?)?),
            false => {
                let list = match &self.horizons {
                    None => BondList::new(cloud, self.horizon, self.correction)?,
                    Some(horizons) => {
                        BondList::with_horizons(cloud, horizons.clone(), self.correction)?
                    }
                };
                Box::new(ListBonds::new(self, list)?)
            }
        };
        Ok(Diffusion {
            cloud: Arc::clone(cloud),
            bonds,
            set: InstructionSet::detect(),
            read: Vec::new(),
            changes: 0,
        })
    }

    /// Checks the constants of own points.
    fn check(&self) -> Result<()> {
        let points = self.cloud.len();
        let within = |quantity, value: f64, holds: bool, allowed| match holds {
            true => Ok(()),
            false => Err(PericlesError::OutOfRange {
                quantity,
                value,
                allowed,
            }),
        };
        if let PointScalar::PerPoint(values) = &self.conductivity {
            check_length("the conductivities of the points", values.len(), points)?;
        }
        for i in 0..points {
            let k = self.conductivity.at(i);
            within(
                "the conductivity",
                k,
                k.is_finite() && k >= 0.0,
                "zero or positive",
            )?;
        }
        if let Some(horizons) = &self.horizons {
            check_length("the horizons of the points", horizons.len(), points)?;
            for &horizon in horizons {
                positive("the horizon", horizon)?;
            }
        }
        let share = self.broken_share;
        let allowed = "from 0 to 1";
        within(
            "the conductance of broken bonds",
            share,
            (0.0..=1.0).contains(&share),
            allowed,
        )
    }

    /// Returns the correction of incomplete families, if there are any and they are corrected. All processes must call it
    /// together.
    fn surface_factors(
        &self,
        for_each_bond: &(dyn Fn(usize, &mut Visit<'_>) + Sync),
    ) -> Option<SurfaceFactors> {
        if !self.surface_correction {
            return None;
        }
        let mut prescribed = vec![false; self.cloud.len()];
        for &i in &self.prescribed {
            prescribed[i as usize] = true;
        }
        SurfaceFactors::new(&self.cloud, &prescribed, for_each_bond)
    }

    /// Returns the pair conductivity for a horizon: by sums over the lattice where there is one.
    fn calibration(&self, horizon: f64) -> Result<PairConductivity> {
        PairConductivity::of_lattice(&self.influence, horizon, self.correction, &self.cloud)
    }
}

/// Returns a constant of own points and ghosts. All processes must call it together.
fn with_ghosts<'a>(domain: &Domain, own: &'a PointScalar) -> Cow<'a, PointScalar> {
    match own {
        PointScalar::PerPoint(values) if domain.is_divided() => Cow::Owned(PointScalar::PerPoint(
            domain.with_ghosts(values).into_owned(),
        )),
        _ => Cow::Borrowed(own),
    }
}

impl Diffusion {
    /// Returns the points.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// Selects another instruction set for the loops, for tests and benchmarks.
    pub fn use_instruction_set(&mut self, set: InstructionSet) {
        if InstructionSet::available().contains(&set) {
            self.set = set;
        }
    }

    /// Adds the flow into each point (W for heat) to `out`. All processes must call it together.
    pub fn add_flow(&self, values: &[f64], out: &mut [f64]) {
        self.bonds.add_flow(values, self.set, out);
    }

    /// Returns Σ_j G_ij of each point, W/K for heat.
    pub fn diagonal(&self) -> Vec<f64> {
        for_each_point(self.cloud.len(), &|i| {
            let mut sum = 0.0;
            self.for_each_bond(i, &mut |bond| {
                if bond.neighbour != i {
                    sum += bond.conductance;
                }
            });
            sum
        })
    }

    /// Sets `out` (component-major) to the flux −½ Σ_j κ_ij V_j ξ (T_j − T_i), W/m² for heat: −k ∇T of a linear field.
    /// All processes must call it together.
    pub fn flux_into(&self, values: &[f64], out: &mut [f64]) {
        let (n, d) = (self.cloud.len(), self.cloud.dimension());
        let volumes = self.cloud.volumes();
        let values = &*self.cloud.domain().with_ghosts(values);
        let of_points = for_each_point(n, &|i| {
            let mut flux = [0.0; 3];
            self.for_each_bond(i, &mut |bond| {
                let flow = bond.conductance * (values[bond.neighbour] - values[i]);
                for c in 0..d {
                    flux[c] -= 0.5 * flow * bond.xi[c];
                }
            });
            flux.map(|component| component / volumes[i])
        });
        for (i, flux) in of_points.iter().enumerate() {
            for c in 0..d {
                out[c * n + i] = flux[c];
            }
        }
    }

    /// Calls `visit` for each bond of a point that conducts.
    pub(crate) fn for_each_bond(&self, i: usize, visit: &mut dyn FnMut(Bond)) {
        self.bonds.for_each_bond(i, &mut |bond| {
            if bond.conductance > 0.0 {
                visit(bond);
            }
        });
    }

    /// Reads from the forces of the body which bonds are intact; returns whether bonds changed on any process. All processes must
    /// call it together.
    pub fn read_bonds(&mut self, forces: &dyn Force) -> bool {
        let Some(bonds) = forces.bond_set() else {
            return false;
        };
        let mut changed = Vec::new();
        let (mut k, first) = (0, self.read.is_empty());
        let read = &mut self.read;
        bonds.for_each_change_count(&mut |range, count| {
            if k == read.len() {
                read.push(0);
            }
            // Bonds cut by pre-cracks do not count as broken, so every point is read at the start.
            if first || read[k] != count {
                changed.push(range);
                read[k] = count;
            }
            k += 1;
        });
        let any = !changed.is_empty();
        let mut near = Vec::new();
        for i in changed.into_iter().flatten() {
            near.clear();
            bonds.for_each_intact_of(i, &mut |j| near.push(j));
            near.sort_unstable();
            // A bond to an image of the point itself does not break.
            let is_intact = |j: usize| j == i || near.binary_search(&j).is_ok();
            self.bonds.set_intact(i, &is_intact);
        }
        let any = !self.cloud.domain().all(!any);
        self.changes += u64::from(any);
        any
    }

    /// Makes [`Diffusion::read_bonds`] read all bonds, because their state was replaced.
    pub fn forget_bonds(&mut self) {
        self.read.clear();
    }

    /// Returns a number that changes when bonds change.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Adds the intact bonds to a checkpoint.
    pub fn save_intact(&self, name: &str, archive: &mut Archive) {
        let (bits, layout) = self.bonds.intact();
        archive.put_as(name, Values::U8(bits), layout);
    }

    /// Restores the intact bonds.
    ///
    /// # Errors
    /// Bonds of another body.
    pub fn restore_intact(&mut self, name: &str, archive: &Archive) -> Result<()> {
        self.read.clear();
        self.changes += 1;
        self.bonds.restore_intact(archive.numbers(name)?)
    }

    /// Returns the number of bonds of the whole body, each counted from both ends. All processes must call it together.
    pub fn directed_bonds(&self) -> u64 {
        self.cloud.domain().count(self.bonds.directed_bonds())
    }

    /// Returns the memory use of this process, bytes.
    pub fn bytes(&self) -> usize {
        self.bonds.bytes()
    }
}
