//! Bond-based bodies with cells of several sizes or materials of different horizons.
//!
//! A uniform strain is not in equilibrium within one horizon of the interface between two grids, as at a free
//! surface; momentum is conserved to round-off.

use std::sync::Arc;

use super::assemble::fastest_form;
use super::by_law::{ByLaw, by_law};
use super::grid::lattice;
use super::limits::{Feature, Features, Limit};
use super::{
    AssembledBonds, BondForce, BondForm, Breaking, DamageMeasure, Force, GridForce, VectorLaw,
};
use crate::error::{PericlesError, Result};
use crate::family::{BondCut, BondList, Crack, EndRule};
use crate::kernel::Influence;
use crate::material::{
    BondConstants, BondMaterial, InterfaceRule, MaterialInterface, MaterialPairs, StressState,
    check_materials,
};
use crate::neighbourhood::Neighbourhood;
use crate::space::{PointCloud, Sites, check_length};

/// Several materials of a body with the same law, influence function and partial volumes, but different
/// horizons.
#[derive(Debug, Clone, Copy)]
pub struct Materials<'a> {
    /// All materials; the first is the material of the body.
    pub all: &'a [BondMaterial],
    /// Index of the material of each point.
    pub of_point: &'a [u8],
    /// Interfaces between two materials. Other pairs have the harmonic mean of both stiffnesses and the
    /// smaller critical stretch.
    pub interfaces: &'a [([u8; 2], MaterialInterface)],
}

/// A body of grids with different spacings, each with the same ratio of horizon to spacing, or of materials
/// with different horizons.
///
/// Points i and j are bonded if |ξ| < max(δ_i, δ_j). The force of the bond is the mean of the laws of its
/// ends, each of which vanishes beyond its own horizon:
///
/// f_ij = ½ (c_i α(ξ/δ_i) κ_i + c_j α(ξ/δ_j) κ_j) s n,
///
/// so that the forces on both ends are equal and opposite and momentum is conserved to round-off. A uniform
/// strain is in equilibrium inside each grid. Within a horizon of an interface there is a spurious force,
/// because a point has different grids on its two sides. As at a free surface, the error decreases with the
/// spacing relative to the length of interest.
///
/// δ_i is the horizon of the material of i divided by the ratio of its grid. With several materials c_i is
/// the constant of bonds between the materials of i and j, for the horizon of i and the grid of i.
///
/// **Breaking.** The critical stretch s_g of a fracture energy differs between grids. Bonds between two grids
/// g and h break at the stretch at which they store, in total, the mean energy of both laws: s² = (w_g
/// s_g² + w_h s_h²)/(w_g + w_h), with the sums w of c α κ |ξ| V_i V_j over these bonds by the law of each
/// grid. A crack along an interface then dissipates the mean of the energies of both grids.
#[derive(Debug, Clone)]
pub struct GradedBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// Refinement ratio of each grid, see [`GradedCloud`](crate::space::GradedCloud).
    pub ratios: &'a [u32],
    /// Index of the grid of each point.
    pub grid_of_point: &'a [u8],
    /// The material with the horizon of the large cells.
    pub material: &'a BondMaterial,
    /// Several materials; `None` if all points have the material of the body.
    pub materials: Option<Materials<'a>>,
    /// The state of stress.
    pub state: StressState,
    /// Pre-cracks.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Stiffness of each point relative to the material; empty if uniform. A bond has the mean stiffness of
    /// its ends.
    pub stiffness: &'a [f64],
    /// Definition of damage.
    pub damage: DamageMeasure,
}

/// Points of one grid and one horizon.
struct Kind {
    grid: usize,
    /// The horizon on this grid, m.
    horizon: f64,
}

/// The laws of the kinds of points.
struct Laws {
    kinds: Vec<Kind>,
    /// Classes of points by kind and material, materials fastest.
    classes: MaterialPairs,
    /// The number of materials.
    materials: u8,
}

impl Laws {
    fn kind_of(&self, class: u8) -> usize {
        usize::from(class / self.materials)
    }

    /// Returns the horizon of the points of a class, m.
    fn horizon_of(&self, class: u8) -> f64 {
        self.kinds[self.kind_of(class)].horizon
    }

    /// Returns the classes that two points would have if both were of the kind of the first.
    fn as_kind_of(&self, [a, b]: [u8; 2]) -> [u8; 2] {
        [a, a - a % self.materials + b % self.materials]
    }
}

impl GradedBody<'_> {
    /// Features that are not supported on such bodies.
    pub const LIMITS: &'static [Limit] = &[Limit::new(
        Feature::SurfaceCorrection,
        "points near an interface have families of two grids or horizons, which the correction would treat as families at a surface; omit `surface_correction`",
    )];

    /// Checks that bonds between cells of several sizes support these features.
    ///
    /// # Errors
    /// [`PericlesError::Graded`] with the reason.
    pub fn check(features: Features) -> Result<()> {
        let exceeded = Self::LIMITS.iter().find(|one| features.has(one.feature));
        match exceeded {
            None => Ok(()),
            Some(limit) => Err(PericlesError::Graded {
                what: limit.feature.words(),
                reason: limit.reason,
            }),
        }
    }

    /// Returns the constants of a material for the horizon and grid of a kind of points.
    fn constants(&self, material: &BondMaterial, kind: &Kind) -> Result<BondConstants> {
        let cloud = self.cloud;
        let own = BondMaterial {
            horizon: kind.horizon,
            ..material.clone()
        };
        if self.ratios.len() == 1 {
            return own.constants(cloud, self.state);
        }
        let ratio = f64::from(self.ratios[kind.grid]);
        let sides = vec![cloud.spacing() / ratio; cloud.dimension()];
        own.constants_on(&sides, cloud.section(), self.state)
    }

    fn laws(&self) -> Result<Laws> {
        let own = [self.material.clone()];
        let (all, interfaces) = match &self.materials {
            Some(materials) => (materials.all, materials.interfaces),
            None => (&own[..], &[][..]),
        };
        if let Some(materials) = &self.materials {
            check_materials(materials.of_point, all.len())?;
        }
        // Rejects tables per class of lattice bonds: this body is not a single lattice.
        self.material.constants(self.cloud, self.state)?;
        let mut horizons: Vec<f64> = Vec::new();
        for material in all {
            if !horizons.contains(&material.horizon) {
                horizons.push(material.horizon);
            }
        }
        let count = self.ratios.len() * horizons.len() * all.len();
        if count > 255 {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of combinations of material, cell size and horizon",
                value: count as f64,
                allowed: "at most 255",
            });
        }
        let kind = |grid: usize, horizon: f64| Kind {
            grid,
            horizon: horizon / f64::from(self.ratios[grid]),
        };
        let grids = 0..self.ratios.len();
        let kinds: Vec<Kind> = grids
            .flat_map(|grid| horizons.iter().map(move |&horizon| kind(grid, horizon)))
            .collect();
        let of_kinds = kinds
            .iter()
            .flat_map(|kind| all.iter().map(move |material| (material, kind)));
        let constants = of_kinds
            .map(|(material, kind)| self.constants(material, kind))
            .collect::<Result<Vec<_>>>()?;
        let (materials, lengths) = (all.len() as u8, horizons.len() as u8);
        let horizon_of = |material: &BondMaterial| {
            let place = horizons.iter().position(|&one| one == material.horizon);
            place.unwrap_or(0) as u8
        };
        let horizon_of: Vec<u8> = all.iter().map(horizon_of).collect();
        let class = |i: usize| {
            let material = self.materials.map_or(0, |materials| materials.of_point[i]);
            let kind = self.grid_of_point[i] * lengths + horizon_of[usize::from(material)];
            kind * materials + material
        };
        let of_point = (0..self.cloud.len()).map(class).collect();
        let mut classes = MaterialPairs::new(of_point, &constants, InterfaceRule::default())?;
        for (pair, interface) in interfaces {
            let last = pair[0].max(pair[1]);
            if last >= materials {
                return Err(PericlesError::OutOfRange {
                    quantity: "the index of a material of a pair",
                    value: f64::from(last),
                    allowed: "indices of the given materials, from 0",
                });
            }
            let material = &all[usize::from(pair[0])];
            // Critical stretches between two kinds of points follow from the values of each kind.
            for (number, kind) in kinds.iter().enumerate() {
                let pair = pair.map(|material| number as u8 * materials + material);
                classes.set_interface(pair, interface, material, |across| {
                    self.constants(across, kind)
                })?;
            }
        }
        Ok(Laws {
            kinds,
            classes,
            materials,
        })
    }

    /// Returns the features of the body that not every kernel supports.
    pub fn features(&self) -> Features {
        let materials = self.materials.map_or(&[][..], |materials| materials.all);
        let differ = |two: &[BondMaterial]| two[0].horizon != two[1].horizon;
        Features::of_points(self.material.law, self.cloud)
            .with(Feature::PreCracks, !self.cracks.is_empty())
            .with(Feature::SeveralMaterials, !materials.is_empty())
            .with(Feature::SeveralHorizons, materials.windows(2).any(differ))
            .with(Feature::Inclusions, !self.stiffness.is_empty())
            .with(Feature::SeveralSpacings, self.ratios.len() > 1)
    }

    /// Returns the operator: a list, or a stencil of the largest horizon if all cells have the same size.
    ///
    /// # Errors
    /// Errors of [`BondMaterial::constants`]; a kernel that does not support the body; a horizon without
    /// neighbours, an invalid crack.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        let features = self.features();
        form.check(features)?;
        let form = match form {
            BondForm::Fastest => fastest_form(self.cloud, features),
            chosen => chosen,
        };
        by_law(
            self.material.law,
            self.cloud.dimension(),
            OfBody(self, form),
        )
    }

    fn make<L: VectorLaw, const D: usize>(&self, form: BondForm) -> Result<AssembledBonds> {
        let points = self.cloud.len();
        check_length("the grids of the points", self.grid_of_point.len(), points)?;
        if let [_, ..] = self.stiffness {
            let given = self.stiffness.len();
            check_length("the stiffnesses of the points", given, points)?;
        }
        let laws = self.laws()?;
        let (cloud, material) = (self.cloud, self.material);
        let horizon = |&class: &u8| laws.horizon_of(class);
        let horizons: Vec<f64> = laws.classes.of_point().iter().map(horizon).collect();
        let bonds = BondList::with_horizons(cloud, horizons.clone(), material.volume_correction)?;
        let classes = self.with_stretches_between(&laws, &bonds)?;
        match form {
            BondForm::List | BondForm::Fastest => self.list::<L, D>(&laws, classes, bonds),
            BondForm::Grid | BondForm::FloatGrid => {
                drop(bonds);
                self.grid::<L, D>(&laws, &classes, &horizons, form)
            }
        }
    }

    /// Returns the classes with critical stretches of bonds between two kinds.
    fn with_stretches_between(&self, laws: &Laws, bonds: &BondList) -> Result<MaterialPairs> {
        let mut classes = laws.classes.clone();
        let ends = self.ends(laws, bonds.sites());
        let weighted = |bonds: &BondList, a: usize, b: usize| {
            let factor = bonds.end_factor(a, b);
            ends.inclusion(a, b) * ends.by_first(a, b, bonds.vector(a, b), factor)
        };
        for (pair, stretch) in self.between_grids(laws, bonds, (&ends.class, &weighted)) {
            classes.set_critical_stretch(pair, stretch)?;
        }
        Ok(classes)
    }

    fn ends<'a>(&'a self, laws: &'a Laws, sites: &Sites) -> Ends<'a> {
        Ends {
            laws,
            influence: &self.material.influence,
            class: laws.classes.on_sites(sites).of_point().to_vec(),
            inclusions: sites.spread(self.stiffness).into_owned(),
        }
    }

    fn list<L: VectorLaw, const D: usize>(
        &self,
        laws: &Laws,
        classes: MaterialPairs,
        mut bonds: BondList,
    ) -> Result<AssembledBonds> {
        let cuts: Vec<BondCut> = self
            .cracks
            .iter()
            .map(|(crack, rule)| bonds.cut(crack, *rule))
            .collect::<Result<_>>()?;
        let ends = self.ends(laws, bonds.sites());
        let force = BondForce::<L, D>::with_weighted_stiffness(
            Arc::clone(self.cloud),
            bonds,
            &|bonds, i, j| {
                let factors = [bonds.end_factor(i, j), bonds.end_factor(j, i)];
                ends.of_bond(i, j, bonds.vector(i, j), factors)
            },
            Breaking {
                critical_stretch: classes.smallest_critical_stretch(),
                no_fail: self.no_fail,
            },
            self.damage,
        )?;
        let operator: Box<dyn Force> = match classes.has_one_critical_stretch() {
            true => Box::new(force),
            false => Box::new(force.with_critical_stretches(classes)?),
        };
        Ok(AssembledBonds {
            operator,
            cuts,
            form: BondForm::List,
        })
    }

    /// Returns a stencil of unit stiffness and the largest horizon, whose factors are the stiffnesses of the
    /// bonds.
    fn grid<L: VectorLaw, const D: usize>(
        &self,
        laws: &Laws,
        classes: &MaterialPairs,
        horizons: &[f64],
        form: BondForm,
    ) -> Result<AssembledBonds> {
        let (cloud, correction) = (self.cloud, self.material.volume_correction);
        let largest = horizons.iter().copied().fold(0.0, f64::max);
        let largest = cloud.domain().max(largest);
        let horizons = (largest, Some(horizons));
        let bonds = lattice::<D>(cloud, horizons, correction, self.cracks, self.no_fail)?;
        let bonds = Neighbourhood::new(bonds, self.damage);
        let stretch = classes.smallest_critical_stretch();
        let grid = GridForce::<L, D>::of(bonds, &|_| 1.0, stretch);
        let ends = self.ends(laws, grid.sites());
        let spacing = cloud.spacing();
        let grid = grid.with_factors(&|a, b, xi| {
            let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            let factor = |horizon: f64| match r <= correction.reach(horizon, spacing) {
                true => correction.factor(r, horizon, spacing),
                false => 0.0,
            };
            let of_ends = [a, b].map(|site| factor(laws.horizon_of(ends.class[site])));
            ends.of_bond(a, b, xi, of_ends) / factor(largest)
        });
        let grid = grid.with_critical_stretches(classes);
        let grid = match form {
            BondForm::FloatGrid => grid.in_floats(),
            _ => grid,
        };
        Ok(AssembledBonds {
            cuts: grid.cuts().to_vec(),
            operator: Box::new(grid),
            form,
        })
    }

    /// Returns the critical stretches of bonds between grids with different critical stretches, from the
    /// classes of sites and the stiffness by the law of the first end.
    fn between_grids(
        &self,
        laws: &Laws,
        bonds: &BondList,
        (class, end): (&[u8], &OfBond<'_>),
    ) -> Vec<([u8; 2], f64)> {
        let (cloud, classes) = (self.cloud, &laws.classes);
        // Σ of c α κ |ξ| V V over the bonds between two classes, by the law of the first.
        let weight = |[a, b]: [u8; 2]| {
            cloud.domain().sum(cloud.len(), |i| {
                let here = bonds.site(i);
                if class[here] != a {
                    return 0.0;
                }
                let family = bonds.family(i).filter(|(_, site)| class[*site] == b);
                let each = family.map(|(_, site)| {
                    let volumes = bonds.volume(here) * bonds.volume(site);
                    end(bonds, here, site) * bonds.length(here, site) * volumes
                });
                each.sum()
            })
        };
        let all = pairs((laws.kinds.len() as u8) * laws.materials);
        let between = all.filter(|[a, b]| laws.kind_of(*a) != laws.kind_of(*b));
        let found = between.filter_map(|[a, b]| {
            let own =
                [[a, b], [b, a]].map(|pair| classes.pair_critical_stretch(laws.as_kind_of(pair)));
            if own[0] == own[1] {
                return Some(([a, b], own[0]));
            }
            let weights = [weight([a, b]), weight([b, a])];
            let sum = weights[0] + weights[1];
            let square = weights[0] * own[0] * own[0] + weights[1] * own[1] * own[1];
            (sum > 0.0).then(|| ([a, b], (square / sum).sqrt()))
        });
        found.collect()
    }
}

/// A property of the bond between two sites.
type OfBond<'a> = dyn Fn(&BondList, usize, usize) -> f64 + Sync + 'a;

/// Returns all pairs of `count` numbers, each once.
fn pairs(count: u8) -> impl Iterator<Item = [u8; 2]> {
    (0..count).flat_map(move |a| (a..count).map(move |b| [a, b]))
}

/// Data at the ends of bonds that determine their stiffness.
struct Ends<'a> {
    laws: &'a Laws,
    influence: &'a Influence,
    /// Classes of the sites.
    class: Vec<u8>,
    inclusions: Vec<f64>,
}

impl Ends<'_> {
    /// Returns c α κ of a bond with the vector ξ, m, by the law of its first end; κ is zero beyond the
    /// horizon of that end.
    fn by_first(&self, a: usize, b: usize, xi: [f64; 3], factor: f64) -> f64 {
        if factor == 0.0 {
            return 0.0;
        }
        let pair = self.laws.as_kind_of([self.class[a], self.class[b]]);
        let micromodulus = self.laws.classes.pair_micromodulus(pair);
        let horizon = self.laws.horizon_of(self.class[a]);
        factor * micromodulus * self.influence.alpha_of(xi, horizon)
    }

    fn inclusion(&self, a: usize, b: usize) -> f64 {
        match &self.inclusions[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[a] + stiffness[b]),
        }
    }

    /// Returns the mean of the laws of both ends, each with its own κ.
    fn of_bond(&self, a: usize, b: usize, xi: [f64; 3], factors: [f64; 2]) -> f64 {
        let back = xi.map(|x| -x);
        let ends = self.by_first(a, b, xi, factors[0]) + self.by_first(b, a, back, factors[1]);
        self.inclusion(a, b) * 0.5 * ends
    }
}

/// Constructs the operator of a body with a kernel.
struct OfBody<'a>(&'a GradedBody<'a>, BondForm);

impl ByLaw for OfBody<'_> {
    type Output = AssembledBonds;

    fn of_law<L: VectorLaw, const D: usize>(self) -> Result<AssembledBonds> {
        self.0.make::<L, D>(self.1)
    }
}
