//! The force operator of correspondence materials on a bond list.

use std::sync::Arc;

use pericles::domain::Field;
use pericles::lanes::{LANES, Row};
use pericles::operator::pool::{Lent, Pool};
use pericles::operator::records::pack_sites;
use pericles::operator::rows::Rows;
use pericles::operator::{DamageMeasure, On};
use pericles::parallel::{BLOCK, components_mut, for_each_block, for_each_chunk};
use pericles::space::PointCloud;
use pericles::sum::BinnedSum;
use pericles::{Result, ThermalExpansion, saved};
use rayon::prelude::*;

use super::bonds::{Bond, Bonds, SiteState, Values, read_sites};
use super::classes::{CorrespondenceClasses, SiteLimits};
use super::control::Control;
use super::error::SingularShape;
use super::heat::Heat;
use super::plasticity::History;
use super::shape::Shape;
use super::tensor::{Matrix, combination, product, unit};

/// The force density of correspondence materials, N/m³, in two passes over a bond list.
///
/// With the weight ω = w b V_j of influence function, partial volume and volume: K_i = Σ ω ξ ⊗ ξ, F_i = I + (Σ ω η ⊗ ξ) K_i⁻¹, P_i = ∂ψ/∂F, z = ξ + η − F_i ξ, the force state is T_ij = w (P_i K_i⁻¹ ξ + Z_i z) and
/// f_i = Σ_j b V_j (T_ij − T_ji), the gradient of Σ W V with W_i = ψ(F_i) + ½ Σ ω z·Z_i z. The pass over points leaves P K⁻¹ − Z (F − I) and Z.
///
/// When a bond of a point breaks, its K, K⁻¹ and Z are computed from the bonds that are left. Where these are fewer than D + 1, or the principal values of K differ by more than a factor of 10⁶, the point loses all of
/// its bonds.
///
/// Memory: 11 bytes per directed bond.
pub struct CorrespondenceForce<const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Bonds,
    pub(super) classes: CorrespondenceClasses,
    pub(super) limits: SiteLimits,
    pub(super) weakest: f64,
    /// Bits of the bonds that may break; all of them if none.
    pub(super) breakable: Option<Vec<u8>>,
    pub(super) damage: DamageMeasure,
    /// c/δ V_δ/Σ w b V of each point, N/m⁷.
    spring: Vec<f64>,
    /// Bonds that are left, one byte a group.
    pub(super) intact: Vec<u8>,
    /// K⁻¹ and Z of every point.
    pub(super) shapes: Vec<PointShape<D>>,
    /// What points remember of their plastic flow, [`History::KEPT`] numbers each; empty of materials that do not yield.
    pub(super) history: Vec<f64>,
    /// Energy dissipated by breaking and by plastic flow, J.
    pub(super) dissipated: BinnedSum,
    pub(super) plastic_work: BinnedSum,
    /// Directed bonds broken.
    pub(super) broken: u64,
    /// Points whose bonds that were left did not span the space.
    pub(super) dropped: u64,
    /// The first point whose volume was not positive at the end of the last step, and its dilatation.
    pub(super) inverted: Option<(usize, f64)>,
    /// Thermal expansion, if the body is heated.
    pub(super) expansion: Option<ThermalExpansion>,
    displaced: Pool<Vec<Row>>,
    sites: Pool<Vec<SiteState<D>>>,
    points: Pool<Vec<PointValues<D>>>,
}

saved! {
    impl<const D: usize> Saved for CorrespondenceForce<D> {
        intact: array("operator/intact"),
        history: array("operator/plastic-history"),
        broken, dropped: array("operator/broken"),
        dissipated: under("operator/dissipated"),
        plastic_work: under("operator/plastic-work"),
        cloud, bonds, classes, limits, weakest, breakable, damage, spring, expansion: fixed,
        shapes: rebuilt,
        inverted: set(None),
        displaced, sites, points: scratch,
    } then |force| {
        force.rebuild_shapes();
        Ok(())
    }
}

/// K⁻¹ and Z of a point; zero where its bonds do not span the space.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointShape<const D: usize> {
    pub inverse: Matrix<D>,
    pub control: Control<D>,
}

/// What the pass over points finds.
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
    /// The force of materials on the bonds of a body. Bonds of the points `no_fail` never break.
    ///
    /// # Errors
    /// [`SingularShape`]: a point with bonds that do not span the space.
    ///
    /// # Panics
    /// If the cloud has another dimension than D.
    pub fn new(
        cloud: Arc<PointCloud>,
        list: pericles::family::BondList,
        classes: CorrespondenceClasses,
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Result<Self> {
        assert_eq!(cloud.dimension(), D, "a force of the cloud's dimension");
        let constants = classes.constants(0);
        let bonds = Bonds::new(list, &constants.solid.influence, constants.solid.horizon);
        let n = cloud.len();
        let (sites, yields) = (bonds.list.sites().len(), classes.yields());
        let mut history = vec![0.0; if yields { n * History::KEPT } else { 0 }];
        for kept in history.chunks_mut(History::KEPT) {
            History::default().keep(kept);
        }
        let mut force = Self {
            limits: classes.on_sites(bonds.list.sites()),
            weakest: classes.weakest(),
            breakable: breakable(&bonds.list, no_fail),
            damage,
            spring: Vec::new(),
            intact: bonds.list.present().to_vec(),
            shapes: Vec::new(),
            history,
            dissipated: BinnedSum::default(),
            plastic_work: BinnedSum::default(),
            broken: 0,
            dropped: 0,
            inverted: None,
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
        Ok(force)
    }

    /// c/δ V_δ/Σ w b V over the bonds of a point that exist at the start.
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

    /// The bytes of a point's bonds that are left.
    #[inline(always)]
    pub(super) fn bits(&self, i: usize) -> &[u8] {
        &self.intact[self.bonds.list.groups(i)]
    }

    /// Whether an entry's bond is still there.
    pub fn is_intact(&self, entry: usize) -> bool {
        self.intact[entry / LANES] >> (entry % LANES) & 1 == 1
    }

    /// Points that lost all of their bonds because those that were left did not span the space.
    pub fn dropped_points(&self) -> u64 {
        self.cloud.domain().count(self.dropped)
    }

    /// Plastic work since the start, J.
    pub fn plastic_work(&self) -> f64 {
        self.cloud.domain().total(self.plastic_work)
    }

    /// The accumulated plastic strain of a point; zero of materials that do not yield.
    pub fn plastic_strain(&self, i: usize) -> f64 {
        self.history_of(i).accumulated
    }

    pub(super) fn history_of(&self, i: usize) -> History {
        match &self.history[..] {
            [] => History::default(),
            kept => History::of(&kept[i * History::KEPT..]),
        }
    }

    /// K of the bonds of a point that are left.
    pub(super) fn shape(&self, i: usize) -> Shape<D> {
        let mut shape = Shape::default();
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            shape.add(bond.weight, &bond.xi);
        });
        shape
    }

    /// K⁻¹ and Z of the bonds of a point that are left.
    pub(super) fn shape_of(&self, i: usize) -> PointShape<D> {
        let Some(inverse) = self.shape(i).inverse() else {
            return PointShape {
                inverse: [[0.0; D]; D],
                control: Control::NONE,
            };
        };
        let stabilisation = self.classes.stabilisation();
        let control = stabilisation.control(self.classes.solid(i), &inverse, self.spring[i]);
        PointShape { inverse, control }
    }

    fn rebuild_shapes(&mut self) {
        self.shapes = (0..self.cloud.len()).map(|i| self.shape_of(i)).collect();
    }

    /// Rows of displacements by sites.
    pub(super) fn packed(&self, u: Field<'_>) -> Lent<'_, Vec<Row>> {
        let mut rows = self.displaced.take();
        pack_sites::<D>(u, self.bonds.list.sites(), &mut rows);
        rows
    }

    /// The states of all sites.
    pub(super) fn states(&self, values: Field<'_>) -> Lent<'_, Vec<SiteState<D>>> {
        let mut states = self.sites.take();
        let count = self.value_count();
        read_sites(values, count, self.bonds.list.sites(), &mut states);
        states
    }

    /// How many values the pass over points leaves.
    pub(super) fn value_count(&self) -> usize {
        Values::count::<D>(self.classes.stabilisation().is_tensor())
    }

    /// η of a bond of a site.
    #[inline(always)]
    pub(super) fn eta(rows: &[Row], here: usize, bond: &Bond<D>) -> [f64; D] {
        let (from, to) = (&rows[here], &rows[bond.site]);
        std::array::from_fn(|c| to[c] - from[c])
    }

    /// η of the bonds of a point, from rows of displacements.
    pub(super) fn etas<'a>(
        &'a self,
        i: usize,
        rows: &'a [Row],
    ) -> impl Fn(&Bond<D>) -> [f64; D] + 'a {
        let here = self.bonds.list.site(i);
        move |bond| Self::eta(rows, here, bond)
    }

    /// H = F − I of a point with the inverse shape tensor given, from η of its bonds.
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

    /// The values of a point.
    fn values_of(&self, i: usize, rows: &[Row], heat: &Heat) -> PointValues<D> {
        let etas = self.etas(i, rows);
        let (state, gradient) = self.state_of(i, &self.shapes[i], &etas, heat);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        PointValues {
            state,
            dilatation: super::tensor::determinant(&super::tensor::in_space(&f, 1.0)) - 1.0,
        }
    }

    /// What the bonds of a point with a shape read of it, and H.
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
        let state = SiteState {
            push: combination(1.0, &push, -1.0, &shape.control.times(&gradient)),
            control: shape.control,
        };
        (state, gradient)
    }

    /// W of a point with a shape, J/m³.
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
        solid.stress(&f, &self.history_of(i)).energy + 0.5 * penalty
    }

    /// Sets the values of the points named by `on` to those that `of` computes.
    pub(super) fn set_values(
        &self,
        on: &On<'_>,
        out: &mut [f64],
        of: &(dyn Fn(usize) -> (SiteState<D>, f64) + Sync),
    ) {
        let n = self.cloud.len();
        let mut points = self.points.take();
        for_each_chunk(&mut points, &|first, chunk| {
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
        out.par_chunks_mut(n)
            .enumerate()
            .for_each(|(slot, values)| {
                on.for_each(n, |i| {
                    let PointValues { state, dilatation } = &points[i];
                    values[i] = Values::slot(state, *dilatation, slot);
                });
            });
    }

    /// Sets the values of the points named by `on`.
    pub(super) fn all_values(&self, t: f64, u: Field<'_>, on: &On<'_>, out: &mut [f64]) {
        let (rows, heat) = (self.packed(u), self.heat_at(t));
        self.set_values(on, out, &|i| {
            let values = self.values_of(i, &rows, &heat);
            (values.state, values.dilatation)
        });
    }

    /// Adds Σ ω [(push of both ends) ξ + (control of both ends) η] for the points named by `on`.
    pub(super) fn add_bonds(
        &self,
        on: &On<'_>,
        out: &mut [f64],
        of_bond: &(impl Fn(usize, &Bond<D>, &mut [f64; D]) + Sync),
    ) {
        let n = self.cloud.len();
        // A vector of nothing takes no memory.
        let mut nothing = vec![(); n.div_ceil(BLOCK)];
        let out = components_mut::<D>(out, n);
        for_each_block(out, &mut nothing, &|first, mut out, ()| {
            let Some(rows) = Rows::of_block(on, first, out[0].len()) else {
                return;
            };
            for k in 0..rows.count() {
                let i = rows.at(k);
                let here = self.bonds.list.site(i);
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

/// One bit for each entry whose bond may break: those between points other than `no_fail`; none if all may.
fn breakable(list: &pericles::family::BondList, no_fail: &[u32]) -> Option<Vec<u8>> {
    let sites = list.sites();
    if sites.cloud().domain().all(no_fail.is_empty()) {
        return None;
    }
    let mut held = vec![false; list.len()];
    for &i in no_fail {
        held[i as usize] = true;
    }
    let held = sites.spread_marks(&held);
    let mut bits = vec![0u8; list.geometric().len()];
    for i in (0..list.len()).filter(|&i| !held[list.site(i)]) {
        for (entry, _) in list.family(i).filter(|&(_, site)| !held[site]) {
            bits[entry / LANES] |= 1 << (entry % LANES);
        }
    }
    Some(bits)
}
