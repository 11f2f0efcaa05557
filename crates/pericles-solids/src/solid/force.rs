//! The force operator of state-based materials.

use std::sync::Arc;

use pericles::archive::{Laid, Layout};
use pericles::family::{BondCut, BondList, Crack, EndRule};
use pericles::lanes::{LANES, Row};
use pericles::material::{BondLimits, Materials};
use pericles::operator::pool::Pool;
use pericles::operator::{AssembledBonds, BondForm, InstructionSet};
use pericles::parallel::for_each_point;
use pericles::space::PointCloud;
use pericles::{PericlesError, Result, ThermalExpansion, YieldFactor, saved};

use super::Solid;
use super::body::SolidBody;
use super::bonds::Bonds;
use super::family::{Family, Point};
use super::heat::Heat;
use super::history::{BondWork, History, HistorySize};
use super::opposite::Opposites;
use super::shape::ShapeTensor;
use crate::error::SingularShape;

/// Force density of state-based materials, N/m³, in two loops over a bond list; see [`Solid`].
///
/// When a bond of a point breaks, [`Solid::shape`] is computed from the remaining bonds; if it is `None`, the point loses
/// all its bonds.
///
/// Memory: 11 bytes per directed bond, and 8 for each number that is stored per bond: those of the material, and three if
/// bonds break by their energy.
pub struct SolidForce<S: Solid<D>, const D: usize> {
    pub(super) cloud: Arc<PointCloud>,
    pub(super) bonds: Bonds,
    /// Materials with numbers by site.
    pub(super) materials: Materials<S>,
    pub(super) weakest: BondLimits,
    pub(super) shapes: Vec<Option<S::Shape>>,
    /// Shapes of the undamaged points; empty if no bond can break.
    pub(super) undamaged: Vec<Option<S::Shape>>,
    pub(super) history: History,
    pub(super) history_size: HistorySize,
    /// Place of the work of each bond among its stored numbers, if bonds break by their energy.
    pub(super) work: Option<BondWork>,
    /// Number of points that lost all bonds because the remaining ones did not determine a force state.
    pub(super) dropped: u64,
    /// First point whose volume was not positive at the end of the last step, and its dilatation.
    pub(super) inverted: Option<(usize, f64)>,
    /// Thermal expansion, if the body is heated.
    pub(super) expansion: Option<ThermalExpansion>,
    /// Elastic moduli of own points relative to those of their materials; empty if all are 1.
    pub(super) stiffness: Vec<f64>,
    /// Yield stresses of own points relative to those of their materials, if they vary within a material.
    pub(super) yields: Option<YieldFactor>,
    /// Reverse entries, for materials with values of bonds.
    pub(super) opposite: Opposites,
    pub(super) set: InstructionSet,
    pub(super) displaced: Pool<Vec<Row>>,
    pub(super) states: Pool<States>,
    pub(super) planes: Pool<Vec<Row>>,
}

saved! {
    impl<S: Solid<D>, const D: usize> Checkpointed for SolidForce<S, D> {
        bonds, history: part,
        dropped: by(Laid::new("operator/dropped", Layout::Count)),
        cloud, materials, weakest, undamaged, history_size, work, expansion, stiffness, yields, opposite,
        set: fixed,
        shapes: rebuilt,
        inverted: set(None),
        displaced, states, planes: scratch,
    } then |force| {
        force.rebuild_shapes();
        Ok(())
    }
}

/// Values of own points and of their bonds.
pub(super) struct States {
    /// [`Solid::VALUES`] consecutive numbers per point.
    pub values: Vec<f64>,
    /// One number per entry with [`Solid::BOND_VALUES`], followed by those of ghosts.
    pub of_bonds: Vec<f64>,
    pub dilatation: Vec<f64>,
}

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Creates the force of a body on its bonds.
    pub(super) fn new(body: SolidBody<'_, S>, mut list: BondList) -> Result<Self> {
        let cloud = body.cloud.clone();
        assert_eq!(
            cloud.dimension(),
            D,
            "the dimension of the force equals the dimension of the cloud"
        );
        list.hold(body.no_fail);
        let mut all = body.materials.all().iter();
        let weakest = body.materials.weakest();
        let by_energy = weakest.energy.is_finite();
        let reads_influence =
            by_energy || all.any(|material| Solid::<D>::reads_influence(material));
        let influence = (body.influence, body.horizon);
        let bonds = Bonds::new(list, body.damage, influence, reads_influence);
        let sites = bonds.list().sites();
        let (n, site_count) = (cloud.len(), sites.len());
        let materials = body.materials.on_sites(sites);
        let sizes = materials.all().iter().map(Solid::history);
        let mut history_size = sizes.fold(HistorySize::default(), HistorySize::max);
        let work = by_energy.then(|| BondWork::behind(&mut history_size));
        let opposite = match S::BOND_VALUES {
            true => Opposites::new(bonds.list())?,
            false => Opposites::default(),
        };
        let places = opposite.places();
        let history = History::new(bonds.list(), history_size, materials.criteria().vary());
        let mut force = Self {
            weakest,
            materials,
            work,
            shapes: Vec::new(),
            undamaged: Vec::new(),
            history,
            history_size,
            dropped: 0,
            inverted: None,
            expansion: None,
            stiffness: Vec::new(),
            yields: None,
            opposite,
            set: InstructionSet::detect(),
            displaced: Pool::new(1, move || vec![Row::default(); site_count]),
            states: Pool::new(1, move || States {
                values: vec![0.0; n * S::VALUES],
                of_bonds: vec![0.0; places],
                dilatation: vec![0.0; n],
            }),
            planes: Pool::new(1, move || {
                vec![Row::default(); site_count * S::VALUES.div_ceil(4)]
            }),
            cloud,
            bonds,
        };
        for i in 0..n {
            let width = force.history_size.per_point;
            let material = force.materials.constants(force.bonds.list().site(i));
            let numbers = &mut force.history.points[i * width..(i + 1) * width];
            material.start_history(numbers);
        }
        force.rebuild_shapes();
        force.check_shapes()?;
        if force.can_lose_bonds() {
            force.undamaged = force.shapes.clone();
        }
        Ok(force)
    }

    /// Returns an error if a point has bonds that do not determine a force state.
    fn check_shapes(&self) -> Result<()> {
        let rows = self.undisplaced();
        for i in 0..self.cloud.len() {
            let family = self.family(i, &rows);
            if self.shapes[i].is_none() && family.count() > 0 {
                let tensor = ShapeTensor::of(&family);
                return Err(
                    SingularShape::new(&self.cloud, i, family.count(), tensor.condition()).into(),
                );
            }
        }
        Ok(())
    }

    /// Returns whether any bond can break.
    pub(super) fn can_lose_bonds(&self) -> bool {
        self.materials.can_break()
    }

    /// Returns the bytes of the intact bonds of a point.
    #[inline(always)]
    pub(super) fn bits(&self, i: usize) -> &[u8] {
        self.bonds.all.bits(i)
    }

    /// Returns the material of a point.
    #[inline(always)]
    pub(super) fn material(&self, i: usize) -> &S {
        self.materials.constants(self.bonds.list().site(i))
    }

    /// Returns the intact bonds of a point.
    #[inline(always)]
    pub(super) fn family<'a>(&'a self, i: usize, u: &'a [Row]) -> Family<'a, D> {
        Family::new(&self.bonds, i, self.bits(i), u)
    }

    /// Returns the bonds of a point whose bits are set.
    pub(super) fn family_with<'a>(
        &'a self,
        i: usize,
        bits: &'a [u8],
        u: &'a [Row],
    ) -> Family<'a, D> {
        Family::new(&self.bonds, i, bits, u)
    }

    /// Returns a point at time t; `None` if its bonds do not determine a force state.
    #[inline(always)]
    pub(super) fn point<'a>(
        &'a self,
        i: usize,
        t: f64,
        heat: &Heat,
        u: &'a [Row],
    ) -> Option<Point<'a, S::Shape, D>> {
        Some(Point {
            family: self.family(i, u),
            shape: self.shapes[i].as_ref()?,
            history: self.history.of_point(i),
            of_bonds: self.history.of_bonds(i),
            per_bond: self.history_size.per_bond,
            dt: self.history.since(i, t),
            thermal: heat.stretch(i),
            yields: heat.yield_scale(i, self.stiffness_of(i)),
        })
    }

    /// Returns the shape of a point for its intact bonds.
    pub(super) fn shape_of(&self, i: usize, rows: &[Row]) -> Option<S::Shape> {
        let family = self.family(i, rows);
        if family.count() == 0 {
            return None;
        }
        let before = self.undamaged.get(i).and_then(Option::as_ref);
        self.material(i).shape(&family, before)
    }

    fn rebuild_shapes(&mut self) {
        let rows = self.undisplaced();
        let shapes = for_each_point(self.cloud.len(), &|i| self.shape_of(i, &rows));
        self.shapes = shapes;
    }

    /// Returns rows of zero displacements.
    pub(super) fn undisplaced(&self) -> Vec<Row> {
        vec![Row::default(); self.bonds.list().sites().len()]
    }

    /// Returns the number of points that lost all bonds because the remaining ones did not determine a force state.
    pub fn dropped_points(&self) -> u64 {
        self.cloud.domain().count(self.dropped)
    }

    /// Returns the bonds.
    pub fn list(&self) -> &BondList {
        self.bonds.list()
    }

    /// Returns the shape of a point; `None` if its bonds do not determine a force state.
    pub fn shape(&self, i: usize) -> Option<&S::Shape> {
        self.shapes[i].as_ref()
    }

    /// Returns a stored number of the bond of an entry.
    pub fn bond_history(&self, entry: usize, number: usize) -> f64 {
        let group = entry / LANES * self.history_size.per_bond + number;
        self.history.bonds[group * LANES + entry % LANES]
    }

    /// Returns the stored numbers of a point.
    pub fn history_of(&self, i: usize) -> &[f64] {
        self.history.of_point(i)
    }
}

impl<S> SolidBody<'_, S> {
    /// Creates the force operator, and returns it with the bonds removed by each pre-crack.
    ///
    /// # Errors
    /// A horizon without neighbours; an invalid crack; materials for another number of points; points whose bonds do not
    /// determine a force state ([`SingularShape`](crate::SingularShape)).
    ///
    /// # Panics
    /// If the dimension of the body is not D.
    pub fn force<const D: usize>(self) -> Result<(SolidForce<S, D>, Vec<BondCut>)>
    where
        S: Solid<D>,
    {
        if !self.materials.covers(self.cloud.len()) {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of points of the body",
                value: self.cloud.len() as f64,
                allowed: "the number of points with a material",
            });
        }
        let mut bonds = BondList::new(self.cloud, self.horizon, self.volume_correction)?;
        let cut = |(crack, rule): &(Crack, EndRule)| bonds.cut(crack, *rule);
        let cuts = self.cracks.iter().map(cut).collect::<Result<Vec<_>>>()?;
        Ok((SolidForce::new(self, bonds)?, cuts))
    }

    /// Creates the force operator in D dimensions as a trait object.
    ///
    /// # Errors
    /// The errors of [`SolidBody::force`].
    pub fn operator<const D: usize>(self) -> Result<AssembledBonds>
    where
        S: Solid<D>,
    {
        let (force, cuts) = self.force::<D>()?;
        Ok(AssembledBonds {
            operator: Box::new(force),
            cuts,
            form: BondForm::List,
        })
    }
}
