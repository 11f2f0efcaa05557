//! Bonds that are elastic until the stress of one of their ends reaches the strength of the material.
//!
//! The stress of a point is that of its bonds, multiplied by a correction for the bonds that are missing at free surfaces:
//! T = M M_i⁻¹ with the fourth moments M_i = Σ α κ V |ξ| n ⊗ n ⊗ n ⊗ n of the family of the point, pre-cracks not removed,
//! and the mean M of whole families without surface correction. It is exact for a uniform strain.

use super::kernels::Softened;
use super::stress::{NUMBERS, VOIGT, stress_rows};
use crate::archive::{Laid, Layout};
use crate::domain::Domain;
use crate::lanes::LANES;
use crate::material::Strength;
use crate::operator::PointSubset;
use crate::operator::fast_law::VectorLaw;
use crate::operator::list::BondForce;
use crate::parallel::for_each_point;

/// A linear map of symmetric tensors in Voigt's order.
type Map = [[f64; 6]; 6];

/// Strengths of the materials of a body, and factors of the stiffness of a bond between two sites.
pub(in crate::operator) struct PointStrengths<'a> {
    /// One per material.
    pub materials: &'a [Strength],
    /// The constant c of the materials of the sites, and the factor by surface correction, for a vector ξ.
    pub constants: &'a (dyn Fn(usize, usize, [f64; 3]) -> [f64; 2] + Sync),
}

/// State of bonds that the strength keeps elastic.
pub(super) struct Gate {
    materials: Vec<Strength>,
    /// Stretch at which each entry softens; infinite for bonds that are elastic at any stretch.
    pub(super) onsets: Vec<f64>,
    /// Their layout.
    layout: Layout,
    /// 1 for points whose stress has reached the strength, 0 for others.
    reached: Vec<f64>,
    /// Corrections of the stress; `None` for whole families.
    corrections: Vec<Option<Box<Map>>>,
    /// Σ c α κ V |ξ| of the families with the bonds that pre-cracks cut.
    whole: Vec<f64>,
}

crate::saved! {
    impl Checkpointed for Gate {
        onsets: by(Laid::new("softening/onset", layout.clone())),
        reached: points("softening/reached"),
        materials, layout, corrections, whole: fixed,
    }
}

/// State of the closed bonds between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mark {
    /// They are elastic.
    Elastic,
    /// A point has lost a tenth of its stiffness: they soften from half of their critical stretch.
    Damaged,
    /// The stress of a point has reached the strength: they soften or break.
    Reached,
}

/// States of points as numbers, which processes exchange; the larger one of both ends is that of a bond.
const ELASTIC: f64 = 0.0;
const DAMAGED: f64 = 1.0;
const REACHED: f64 = 2.0;

/// States of all own points and ghosts.
pub(super) struct Marks(Vec<f64>);

impl Marks {
    /// Gathers the states of own points; `None` if all bonds of the body are elastic. All processes must call it together.
    pub fn of(domain: &Domain, states: &[f64]) -> Option<Self> {
        let all_elastic = domain.all(states.iter().all(|state| *state == ELASTIC));
        (!all_elastic).then(|| Self(domain.with_ghosts(states).into_owned()))
    }

    /// Returns the state of the bonds between two points.
    pub fn of_bond(&self, [i, j]: [usize; 2]) -> Mark {
        match self.0[i].max(self.0[j]) {
            ELASTIC => Mark::Elastic,
            DAMAGED => Mark::Damaged,
            _ => Mark::Reached,
        }
    }
}

impl Gate {
    /// Returns the smallest onset of a bond between points of two materials.
    pub fn least_onset(&self, [a, b]: [usize; 2]) -> f64 {
        self.materials[a]
            .least_onset
            .min(self.materials[b].least_onset)
    }

    /// Returns the bytes of its arrays.
    pub fn bytes(&self) -> usize {
        let numbers = self.onsets.len() + self.reached.len() + self.whole.len();
        let maps = self.corrections.iter().flatten().count() * size_of::<Map>();
        8 * numbers + size_of_val(&self.corrections[..]) + maps
    }

    /// Creates the state of a list in which no bond softens. All processes must call it together.
    pub fn new<L: VectorLaw, const D: usize>(
        list: &BondForce<L, D>,
        strengths: &PointStrengths<'_>,
    ) -> Self {
        let families = list.bonds.form();
        let n = list.cloud.len();
        let bonds = list.view();
        let found: Vec<Moments> = for_each_point(n, &|i| {
            let mut found = Moments::default();
            let here = families.site(i);
            for (entry, there) in families.family(i) {
                let xi: [f64; D] = bonds.vector(here, there);
                let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                let in_space = std::array::from_fn(|c| if c < D { xi[c] } else { 0.0 });
                let [constant, correction] = (strengths.constants)(here, there, in_space);
                let stiffness = list.stiffness_of(entry, i, there);
                found.stiffness += stiffness * length;
                found.volume += families.volume_factor(here, there) * families.volume(there);
                let weight = stiffness / constant / length.powi(3);
                for (row, [a, b]) in VOIGT.into_iter().enumerate() {
                    for (column, [c, d]) in VOIGT.into_iter().enumerate() {
                        if b < D && d < D {
                            let product = weight * xi[a] * xi[b] * xi[c] * xi[d];
                            found.moment[row][column] += product;
                            found.uncorrected[row][column] += product / correction;
                        }
                    }
                }
            }
            found
        });
        let mean = mean_of_whole(list, &found);
        let corrections = found.iter().map(|own| correction(D, &mean, &own.moment));
        let entries = families.present().len() * LANES;
        Self {
            materials: strengths.materials.to_vec(),
            onsets: vec![f64::INFINITY; entries],
            layout: Layout::rows(families.start(), entries),
            reached: vec![0.0; n],
            corrections: corrections.collect(),
            whole: found.iter().map(|own| own.stiffness).collect(),
        }
    }
}

/// Sums over the family of a point.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    /// The fourth moment.
    moment: Map,
    /// The fourth moment without surface correction.
    uncorrected: Map,
    /// Σ c α κ V |ξ|.
    stiffness: f64,
    /// Σ κ V.
    volume: f64,
}

/// Returns the mean moment of whole families. Families of a lattice are whole if they have all bonds, others if they have
/// nearly the largest volume.
fn mean_of_whole<L: VectorLaw, const D: usize>(list: &BondForce<L, D>, found: &[Moments]) -> Map {
    const NEARLY: f64 = 0.95;
    const ROUND_OFF: f64 = 1e-9;
    let domain = list.cloud.domain();
    let least = match list.cloud.lattice() {
        Some(_) => 1.0 - ROUND_OFF,
        None => NEARLY,
    };
    let largest = found.iter().map(|own| own.volume).fold(0.0, f64::max);
    let largest = domain.max(largest);
    let is_whole = |i: usize| found[i].volume >= least * largest;
    let n = found.len();
    let count = domain.sum(n, |i| f64::from(u8::from(is_whole(i))));
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let term = |i: usize| match is_whole(i) {
                true => found[i].uncorrected[row][column],
                false => 0.0,
            };
            domain.sum(n, term) / count
        })
    })
}

/// Returns the correction of the stress of a family; `None` if the family has the mean moment, or if its bonds do not
/// determine the stress.
fn correction(dimension: usize, mean: &Map, moment: &Map) -> Option<Box<Map>> {
    /// Relative difference of moments up to which a family is whole.
    const EQUAL: f64 = 1e-9;
    let axes: Vec<usize> = (0..6).filter(|&k| VOIGT[k][1] < dimension).collect();
    let entries = || axes.iter().flat_map(|&a| axes.iter().map(move |&b| [a, b]));
    let size = entries().map(|[a, b]| mean[a][b].abs()).fold(0.0, f64::max);
    let difference = entries().map(|[a, b]| (mean[a][b] - moment[a][b]).abs());
    if difference.fold(0.0, f64::max) <= EQUAL * size {
        return None;
    }
    let inverse = inverse_of(&axes, moment)?;
    let mut map = [[0.0; 6]; 6];
    for &a in &axes {
        for &b in &axes {
            map[a][b] = axes.iter().map(|&c| mean[a][c] * inverse[c][b]).sum();
        }
    }
    Some(Box::new(map))
}

/// Returns the inverse of a symmetric positive map on some components by Gauss–Jordan elimination; `None` if it is
/// nearly singular.
fn inverse_of(axes: &[usize], map: &Map) -> Option<Map> {
    /// Smallest ratio of a pivot to its diagonal entry.
    const SINGULAR: f64 = 1e-3;
    let (mut left, mut right) = (*map, [[0.0; 6]; 6]);
    for &a in axes {
        right[a][a] = 1.0;
    }
    for &pivot in axes {
        let scale = left[pivot][pivot];
        if scale.is_nan() || scale <= SINGULAR * map[pivot][pivot] {
            return None;
        }
        for &b in axes {
            left[pivot][b] /= scale;
            right[pivot][b] /= scale;
        }
        for &a in axes.iter().filter(|&&a| a != pivot) {
            let factor = left[a][pivot];
            for &b in axes {
                left[a][b] -= factor * left[pivot][b];
                right[a][b] -= factor * right[pivot][b];
            }
        }
    }
    Some(right)
}

impl Gate {
    /// Returns the states of own points at the end of a step, as [`Marks`] has them. All processes must call it together.
    pub fn states<L: VectorLaw, const D: usize>(
        &self,
        list: &BondForce<L, D>,
        kept: &Softened<'_>,
        (t, u): (f64, &[f64]),
    ) -> Vec<f64> {
        let n = list.cloud.len();
        let heat = list.heat_at(t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let mut numbers = vec![0.0; NUMBERS * n];
        list.with_packed(u, &PointSubset::All, |u| {
            list.sweep::<NUMBERS>(&PointSubset::All, &mut numbers, |intact, rows, out| {
                let set = list.instruction_set;
                stress_rows::<L, D>(set, &bonds, kept, u, intact, rows, out);
            });
        });
        /// Fraction of the stiffness of a point whose loss makes its bonds fail by their stretch.
        const LOST: f64 = 0.1;
        let families = list.bonds.form();
        for_each_point(n, &|i| {
            let (number, factor) = kept.curves.of_point(families.site(i));
            let stress = self.stress_of(i, n, &numbers, factor);
            if self.reached[i] != 0.0 || self.materials[number].surface.is_reached(D, stress) {
                REACHED
            } else if numbers[6 * n + i] < (1.0 - LOST) * self.whole[i] {
                DAMAGED
            } else {
                ELASTIC
            }
        })
    }

    /// Stores which points have reached the strength.
    pub fn note(&mut self, states: &[f64]) {
        for (reached, state) in self.reached.iter_mut().zip(states) {
            *reached = f64::from(u8::from(*state == REACHED));
        }
    }

    /// Returns the corrected stress of a point over the factor of its strength, Pa.
    fn stress_of(&self, i: usize, n: usize, numbers: &[f64], factor: f64) -> [[f64; 3]; 3] {
        let raw: [f64; 6] = std::array::from_fn(|k| numbers[k * n + i] / factor);
        let voigt = match &self.corrections[i] {
            None => raw,
            Some(map) => map.map(|row| row.iter().zip(&raw).map(|(m, s)| m * s).sum()),
        };
        let mut stress = [[0.0; 3]; 3];
        for ([a, b], value) in VOIGT.into_iter().zip(voigt) {
            stress[a][b] = value;
            stress[b][a] = value;
        }
        stress
    }
}
