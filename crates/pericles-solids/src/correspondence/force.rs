//! The force operator of correspondence materials on a bond list.

use std::sync::Arc;

use pericles::archive::{Laid, Layout};
use pericles::domain::Field;
use pericles::family::BondList;
use pericles::lanes::Row;
use pericles::neighbourhood::DamageMeasure;
use pericles::operator::PointSubset;
use pericles::operator::pool::{Lent, Pool};
use pericles::operator::records::pack_sites;
use pericles::operator::rows::Rows;
use pericles::parallel::{BLOCK, for_each_chunk_of};
use pericles::space::PointCloud;
use pericles::{Result, ThermalExpansion, saved};
use rayon::prelude::*;

use super::bonds::{Bond, Bonds, SiteState, Values, read_sites};
use super::classes::{CorrespondenceClasses, SiteLimits};
use super::control::Control;
use super::error::SingularShape;
use super::heat::Heat;
use super::plasticity::History;
use super::shape::Shape;
use super::tensor::{Matrix, combination, principal_axes, product, unit};

/// Force density of correspondence materials, N/m³, in two passes over a bond list.
///
/// With the weight ω = w b V_j (influence function, partial volume, volume): K_i = Σ ω ξ ⊗ ξ, F_i = I + (Σ ω
/// η ⊗ ξ) K_i⁻¹, P_i = ∂ψ/∂F, z = ξ + η − F_i ξ. The force state is T_ij = w (P_i K_i⁻¹ ξ + Z_i z), and f_i =
/// Σ_j b V_j (T_ij − T_ji) is the gradient of the energy Σ W V with W_i = ψ(F_i) + ½ Σ ω z·Z_i z. The pass
/// over points computes P K⁻¹ − Z (F − I) and Z.
///
/// When a bond of a point breaks, K, K⁻¹ and Z are recomputed from the remaining bonds. If fewer than D + 1
/// remain, or the condition number of K exceeds 10⁶, the point loses all its bonds.
///
/// Memory: 11 bytes per directed bond.
pub struct CorrespondenceForce<const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Bonds,
    pub(super) classes: CorrespondenceClasses,
    pub(super) limits: SiteLimits,
    pub(super) weakest: f64,
    /// c/δ V_δ/Σ w b V of each point, N/m⁷.
    spring: Vec<f64>,
    /// K⁻¹ and Z of every point.
    pub(super) shapes: Vec<PointShape<D>>,
    /// Plastic history, [`History::KEPT`] numbers per point; empty for materials that do not yield.
    pub(super) history: Vec<f64>,
    /// Number of points whose remaining bonds did not span the space.
    pub(super) dropped: u64,
    /// First point whose volume was not positive at the end of the last step, and its dilatation.
    pub(super) inverted: Option<(usize, f64)>,
    /// Largest principal value of K⁻¹ of each point at full stiffness; empty if no bond can break.
    pub(super) softest: Vec<f64>,
    /// Thermal expansion, if the body is heated.
    pub(super) expansion: Option<ThermalExpansion>,
    displaced: Pool<Vec<Row>>,
    sites: Pool<Vec<SiteState<D>>>,
    points: Pool<Vec<PointValues<D>>>,
}

saved! {
    impl<const D: usize> Checkpointed for CorrespondenceForce<D> {
        bonds: part,
        history: by(Laid::per_point("operator/plastic-history", cloud.len(), history.len())),
        dropped: by(Laid::new("operator/dropped", Layout::Count)),
        cloud, classes, limits, weakest, spring, softest, expansion: fixed,
        shapes: rebuilt,
        inverted: set(None),
        displaced, sites, points: scratch,
    } then |force| {
        force.rebuild_shapes();
        Ok(())
    }
}

/// Largest ratio of the stiffness of a damaged point to that of the intact one. The stiffness grows with the largest principal
/// value of K⁻¹: with few bonds, or bonds of similar directions, a point would oscillate faster than the time step allows. The
/// energy of a point whose K⁻¹ exceeds this ratio is multiplied by a factor that keeps the stiffness at it.
pub(super) const STIFFENING: f64 = 4.0;

/// K⁻¹ and Z of a point; zero if its bonds do not span the space.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointShape<const D: usize> {
    pub inverse: Matrix<D>,
    pub control: Control<D>,
    /// Factor of the energy of the point, at most 1; see [`STIFFENING`]. The control includes it.
    pub share: f64,
}

/// Result of the pass over points.
#[derive(Debug, Clone, Copy)]
struct PointValues<const D: usize> {
    state: SiteState<D>,
    dilatation: f64,
}

impl<const D: usize> Default for PointValues<D> {
    fn default() -> Self {
        Self {
            state: SiteState::default(),
            dilatation: 0.0,
        }
    }
}

impl<const D: usize> CorrespondenceForce<D> {
    /// Creates the force of materials on the bonds of a body. Bonds of the points `no_fail` never break.
    ///
    /// # Errors
    /// [`SingularShape`]: a point whose bonds do not span the space.
    ///
    /// # Panics
    /// If the dimension of the cloud is not D.
    pub fn new(
        cloud: Arc<PointCloud>,
        mut list: BondList,
        classes: CorrespondenceClasses,
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Result<Self> {
        assert_eq!(
            cloud.dimension(),
            D,
            "the dimension of the force equals the dimension of the cloud"
        );
        let constants = classes.constants(0);
        list.hold(no_fail);
        let bonds = Bonds::new(
            list,
            damage,
            &constants.solid.influence,
            constants.solid.horizon,
        );
        let n = cloud.len();
        let (sites, yields) = (bonds.list().sites().len(), classes.yields());
        let mut history = vec![0.0; if yields { n * History::KEPT } else { 0 }];
        for kept in history.chunks_mut(History::KEPT) {
            History::default().keep(kept);
        }
        let mut force = Self {
            limits: classes.on_sites(bonds.list().sites()),
            weakest: classes.weakest(),
            spring: Vec::new(),
            shapes: Vec::new(),
            history,
            dropped: 0,
            inverted: None,
            softest: Vec::new(),
            expansion: None,
            displaced: Pool::new(1, move || vec![Row::default(); sites]),
            sites: Pool::new(1, move || vec![SiteState::default(); sites]),
            points: Pool::new(1, move || vec![PointValues::default(); n]),
            cloud,
            bonds,
            classes,
        };
        force.spring = (0..n).map(|i| force.spring_of(i)).collect();
        for i in 0..n {
            let shape = force.shape(i);
            if shape.bonds > 0 && !shape.is_regular() {
                return Err(
                    SingularShape::new(&force.cloud, i, shape.bonds, shape.condition()).into(),
                );
            }
        }
        force.rebuild_shapes();
        if force.weakest.is_finite() || force.limits.has_criteria() {
            let limit = |shape: &PointShape<D>| STIFFENING * largest(&shape.inverse);
            force.softest = force.shapes.iter().map(limit).collect();
        }
        Ok(force)
    }

    /// Returns c/δ V_δ/Σ w b V over the initial bonds of a point.
    fn spring_of(&self, i: usize) -> f64 {
        let mut weight = 0.0;
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            weight += bond.weight;
        });
        match weight > 0.0 {
            true => self.classes.constants(i).spring() / weight,
            false => 0.0,
        }
    }

    /// Returns the bytes of the intact bonds of a point.
    #[inline(always)]
    pub(super) fn bits(&self, i: usize) -> &[u8] {
        self.bonds.all.bits(i)
    }

    /// Returns the number of points that lost all bonds because the remaining ones did not span the space.
    pub fn dropped_points(&self) -> u64 {
        self.cloud.domain().count(self.dropped)
    }

    /// Returns the accumulated plastic strain of a point; zero for materials that do not yield.
    pub fn plastic_strain(&self, i: usize) -> f64 {
        self.history_of(i).accumulated
    }

    pub(super) fn history_of(&self, i: usize) -> History {
        match &self.history[..] {
            [] => History::default(),
            kept => History::of(&kept[i * History::KEPT..]),
        }
    }

    /// Returns K of the intact bonds of a point.
    pub(super) fn shape(&self, i: usize) -> Shape<D> {
        let mut shape = Shape::default();
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            shape.add(bond.weight, &bond.xi);
        });
        shape
    }

    /// Returns K⁻¹ and Z of the intact bonds of a point.
    pub(super) fn shape_of(&self, i: usize) -> PointShape<D> {
        let Some(inverse) = self.shape(i).inverse() else {
            return PointShape {
                inverse: [[0.0; D]; D],
                control: Control::NONE,
                share: 1.0,
            };
        };
        let stabilisation = self.classes.stabilisation();
        let control = stabilisation.control(self.classes.solid(i), &inverse, self.spring[i]);
        let limit = self.softest.get(i).copied().unwrap_or(f64::INFINITY);
        let share = (limit / largest(&inverse)).min(1.0);
        PointShape {
            inverse,
            control: control.scaled(share),
            share,
        }
    }

    fn rebuild_shapes(&mut self) {
        self.shapes = (0..self.cloud.len()).map(|i| self.shape_of(i)).collect();
    }

    /// Returns rows of displacements by site.
    pub(super) fn packed(&self, u: Field<'_>) -> Lent<'_, Vec<Row>> {
        let mut rows = self.displaced.take();
        pack_sites::<D>(u, self.bonds.list().sites(), &mut rows);
        rows
    }

    /// Returns the states of all sites.
    pub(super) fn states(&self, values: Field<'_>) -> Lent<'_, Vec<SiteState<D>>> {
        let mut states = self.sites.take();
        let count = self.value_count();
        read_sites(values, count, self.bonds.list().sites(), &mut states);
        states
    }

    /// Returns the number of values per point.
    pub(super) fn value_count(&self) -> usize {
        Values::count::<D>(self.classes.stabilisation().is_tensor())
    }

    /// Returns η of a bond of a site.
    #[inline(always)]
    pub(super) fn eta(rows: &[Row], here: usize, bond: &Bond<D>) -> [f64; D] {
        let (from, to) = (&rows[here], &rows[bond.site]);
        std::array::from_fn(|c| to[c] - from[c])
    }

    /// Returns a function that gives η of the bonds of a point from rows of displacements.
    pub(super) fn etas<'a>(
        &'a self,
        i: usize,
        rows: &'a [Row],
    ) -> impl Fn(&Bond<D>) -> [f64; D] + 'a {
        let here = self.bonds.list().site(i);
        move |bond| Self::eta(rows, here, bond)
    }

    /// Returns H = F − I of a point from its inverse shape tensor and η of its bonds.
    pub(super) fn gradient(
        &self,
        i: usize,
        inverse: &Matrix<D>,
        eta: &impl Fn(&Bond<D>) -> [f64; D],
    ) -> Matrix<D> {
        let mut moment = [[0.0; D]; D];
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            let eta = eta(&bond);
            for a in 0..D {
                for b in 0..D {
                    moment[a][b] += bond.weight * eta[a] * bond.xi[b];
                }
            }
        });
        product(&moment, inverse)
    }

    /// Returns the values of a point.
    fn values_of(&self, i: usize, rows: &[Row], heat: &Heat) -> PointValues<D> {
        let etas = self.etas(i, rows);
        let (state, gradient) = self.state_of(i, &self.shapes[i], &etas, heat);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        PointValues {
            state,
            dilatation: super::tensor::determinant(&super::tensor::in_space(&f, 1.0)) - 1.0,
        }
    }

    /// Returns the state of a point with a shape, which its bonds read, and H.
    pub(super) fn state_of(
        &self,
        i: usize,
        shape: &PointShape<D>,
        eta: &impl Fn(&Bond<D>) -> [f64; D],
        heat: &Heat,
    ) -> (SiteState<D>, Matrix<D>) {
        let gradient = self.gradient(i, &shape.inverse, eta);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let solid = self.classes.solid(i).expanded(heat.factor(i));
        let stress = solid.stress(&f, &self.history_of(i)).stress;
        let push = product(&stress, &shape.inverse);
        let push = push.map(|row| row.map(|entry| shape.share * entry));
        let state = SiteState {
            push: combination(1.0, &push, -1.0, &shape.control.times(&gradient)),
            control: shape.control,
        };
        (state, gradient)
    }

    /// Returns W of a point with a shape, J/m³.
    pub(super) fn energy_of(
        &self,
        i: usize,
        shape: &PointShape<D>,
        rows: &[Row],
        heat: &Heat,
    ) -> f64 {
        let etas = self.etas(i, rows);
        let gradient = self.gradient(i, &shape.inverse, &etas);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let mut penalty = 0.0;
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            let eta = etas(&bond);
            let bent = super::tensor::apply(&gradient, &bond.xi);
            let z: [f64; D] = std::array::from_fn(|c| eta[c] - bent[c]);
            let pull = shape.control.apply(&z);
            penalty += bond.weight * (0..D).map(|c| z[c] * pull[c]).sum::<f64>();
        });
        let solid = self.classes.solid(i).expanded(heat.factor(i));
        shape.share * solid.stress(&f, &self.history_of(i)).energy + 0.5 * penalty
    }

    /// Sets the values of the points `on` to the results of `of`.
    pub(super) fn set_values(
        &self,
        on: &PointSubset<'_>,
        out: &mut [f64],
        of: &(dyn Fn(usize) -> (SiteState<D>, f64) + Sync),
    ) {
        let n = self.cloud.len();
        let mut points = self.points.take();
        for_each_chunk_of(&mut points, self.bonds.list().cost(on), &|first, chunk| {
            let Some(rows) = Rows::of_block(on, first, chunk.len()) else {
                return;
            };
            for k in 0..rows.count() {
                let i = rows.at(k);
                let (state, dilatation) = of(i);
                chunk[i - first] = PointValues { state, dilatation };
            }
        });
        let points = &points;
        out.par_chunks_mut(n.max(1))
            .enumerate()
            .for_each(|(slot, values)| {
                on.for_each(n, |i| {
                    let PointValues { state, dilatation } = &points[i];
                    values[i] = Values::slot(state, *dilatation, slot);
                });
            });
    }

    /// Sets the values of the points `on`.
    pub(super) fn all_values(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        self.values_with(&self.heat_at(t), u, on, out);
    }

    /// Sets the values of the points `on` with given thermal stretches.
    pub(super) fn values_with(
        &self,
        heat: &Heat,
        u: Field<'_>,
        on: &PointSubset<'_>,
        out: &mut [f64],
    ) {
        let rows = self.packed(u);
        self.set_values(on, out, &|i| {
            let values = self.values_of(i, &rows, heat);
            (values.state, values.dilatation)
        });
    }

    /// Adds Σ ω [(sum of both pushes) ξ + (sum of both controls) η] for the points `on`.
    pub(super) fn add_bonds(
        &self,
        on: &PointSubset<'_>,
        out: &mut [f64],
        of_bond: &(impl Fn(usize, &Bond<D>, &mut [f64; D]) + Sync),
    ) {
        let cost = self.bonds.list().cost(on);
        self.bonds
            .all
            .for_each_block::<D>(cost, out, |block, _, out| {
                let first = block * BLOCK;
                let Some(rows) = Rows::of_block(on, first, out[0].len()) else {
                    return;
                };
                for k in 0..rows.count() {
                    let i = rows.at(k);
                    let here = self.bonds.list().site(i);
                    let mut sum = [0.0; D];
                    self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                        of_bond(here, &bond, &mut sum);
                    });
                    for (out, sum) in out.iter_mut().zip(sum) {
                        out[i - first] += sum;
                    }
                }
            });
    }
}

/// Returns the largest principal value of a tensor.
fn largest<const D: usize>(tensor: &Matrix<D>) -> f64 {
    let (values, _) = principal_axes(tensor);
    values.into_iter().fold(0.0, f64::max)
}
