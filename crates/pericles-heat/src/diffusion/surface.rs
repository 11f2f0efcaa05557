//! Correction of incomplete families.

use pericles::parallel::for_each_point;
use pericles::solve::principal_axes;
use pericles::space::PointCloud;

/// Visits the bonds of a point: the other end, ghosts after own points, the reference vector ξ and κ V of the other end
/// for unit conductivity.
pub(super) type Visit<'a> = dyn FnMut(usize, [f64; 3], f64) + 'a;

/// Number of independent components of a symmetric tensor.
const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// Places of the components of a symmetric tensor: first the diagonal, then the other pairs of axes.
fn pairs(dimension: usize) -> impl Iterator<Item = (usize, usize)> {
    let diagonal = (0..dimension).map(|a| (a, a));
    diagonal.chain((0..dimension).flat_map(move |a| (a + 1..dimension).map(move |b| (a, b))))
}

/// Returns the coefficients c of a bond direction n with Σ c S = n·S n for the components S of a symmetric tensor.
pub(super) fn direction(dimension: usize, xi: [f64; 3]) -> [f64; 6] {
    let square: f64 = xi.iter().map(|x| x * x).sum();
    let mut coefficients = [0.0; 6];
    for (coefficient, (a, b)) in coefficients.iter_mut().zip(pairs(dimension)) {
        let both = if a == b { 1.0 } else { 2.0 };
        *coefficient = both * xi[a] * xi[b] / square;
    }
    coefficients
}

/// The correction of bonds between two points with incomplete families: a symmetric tensor S at each of them, so that the
/// conductance of a bond with the direction n is multiplied by the mean of n·S n of its ends.
///
/// S has the principal axes of the family. Along an axis on both sides of which there are neighbours, such as the tangents of a
/// surface, S makes the energy of a unit gradient equal to the energy of the continuum:
/// Σ_j κ_ij g_ij (ξ·e_a)² V_j = 2 with the factor g_ij of each bond. Along other axes, such as the normal of a surface,
/// S is the ratio of these energies without correction. Bonds of points with complete families have the factor 1, so that linear
/// fields are exact there.
pub(super) struct SurfaceFactors {
    dimension: usize,
    /// 1 at points with incomplete families, otherwise 0; ghosts after own points.
    incomplete: Vec<f64>,
    /// ½ (S − 1), one field per component, ghosts after own points.
    excess: Vec<Vec<f64>>,
}

impl SurfaceFactors {
    /// Returns the factor of a bond between two points with the coefficients of [`direction`].
    pub fn of_bond(&self, i: usize, j: usize, direction: &[f64; 6]) -> f64 {
        let fields = self.excess.iter().zip(direction);
        let excess: f64 = fields.map(|(field, c)| c * (field[i] + field[j])).sum();
        1.0 + self.incomplete[i] * self.incomplete[j] * excess
    }

    /// The marks of points with incomplete families, followed by the components of ½ (S − 1), one field each.
    pub fn fields(&self) -> impl Iterator<Item = &[f64]> {
        std::iter::once(&self.incomplete[..]).chain(self.excess.iter().map(|field| &field[..]))
    }

    /// Solves for S of all points with incomplete families; `None` if all families are complete.
    ///
    /// Prescribed points, which only continue the body beyond a surface, have no condition of their own: they take the
    /// factors of the nearest points with a computed value, so that a linear field across a layer as deep as the horizon is
    /// exact. All processes must call it together.
    pub fn new(
        cloud: &PointCloud,
        prescribed: &[bool],
        for_each_bond: &(dyn Fn(usize, &mut Visit<'_>) + Sync),
    ) -> Option<Self> {
        Families::new(cloud, prescribed, for_each_bond).map(Families::solve)
    }
}

/// An axis of a family.
#[derive(Clone, Copy)]
struct Axis {
    vector: [f64; 3],
    /// Factor along the axis.
    factor: f64,
    /// Whether there are neighbours along the axis.
    has_extent: bool,
    /// Whether the factor is solved for.
    is_solved: bool,
}

/// Families whose factors are computed.
struct Families<'a> {
    cloud: &'a PointCloud,
    for_each_bond: &'a (dyn Fn(usize, &mut Visit<'_>) + Sync),
    /// Axes of the points with incomplete families that are not prescribed.
    axes: Vec<Option<[Axis; 3]>>,
    /// Nearest points with a computed value, of prescribed points.
    nearest: Vec<Vec<usize>>,
    factors: SurfaceFactors,
}

/// Σ_j κ_ij ξ_a² V_j of a complete family for unit conductivity.
const COMPLETE: f64 = 2.0;

impl<'a> Families<'a> {
    fn new(
        cloud: &'a PointCloud,
        prescribed: &[bool],
        for_each_bond: &'a (dyn Fn(usize, &mut Visit<'_>) + Sync),
    ) -> Option<Self> {
        let (n, d) = (cloud.len(), cloud.dimension());
        let domain = cloud.domain();
        let moments = for_each_point(n, &|i| Moments::of(i, d, for_each_bond));
        let flags = |of: &dyn Fn(usize) -> bool| -> Vec<f64> {
            (0..n).map(|i| f64::from(u8::from(of(i)))).collect()
        };
        let incomplete = flags(&|i| !prescribed[i] && !moments[i].are_complete(d));
        if domain.all(incomplete.iter().all(|flag| *flag == 0.0)) {
            return None;
        }
        let is_prescribed = flags(&|i| prescribed[i]);
        let is_prescribed = domain.with_ghosts(&is_prescribed);
        let axes = for_each_point(n, &|i| {
            (incomplete[i] > 0.0).then(|| moments[i].axes(i, d, for_each_bond))
        });
        let nearest = for_each_point(n, &|i| match prescribed[i] {
            true => nearest_of(for_each_bond, i, &|j| is_prescribed[j] == 0.0),
            false => Vec::new(),
        });
        let mut families = Self {
            cloud,
            for_each_bond,
            axes,
            nearest,
            factors: SurfaceFactors {
                dimension: d,
                incomplete: Vec::new(),
                excess: vec![vec![0.0; n]; components(d)],
            },
        };
        let marks = families.continued(&incomplete);
        families.factors.incomplete = marks.into_iter().map(f64::ceil).collect();
        Some(families)
    }

    /// Multiplies the factors by the ratio of the wanted to the present energies until they agree. The iteration keeps all
    /// factors positive; its matrix is a mean over the points of a family in which the point itself has half of the weight.
    fn solve(mut self) -> SurfaceFactors {
        const MOST: usize = 300;
        const TOLERANCE: f64 = 1e-11;
        self.update();
        for _ in 0..MOST {
            let energies = for_each_point(self.cloud.len(), &|i| self.energies(i));
            let mut largest: f64 = 0.0;
            for (axes, energies) in self.axes.iter_mut().zip(energies) {
                let Some(axes) = axes else { continue };
                for (axis, [fixed, scaled]) in axes.iter_mut().zip(energies) {
                    let ratio = (COMPLETE - fixed) / scaled;
                    if axis.is_solved && ratio.is_finite() && ratio > 0.0 {
                        largest = largest.max((ratio - 1.0).abs());
                        axis.factor *= ratio;
                    }
                }
            }
            self.update();
            if self.cloud.domain().max(largest) < TOLERANCE {
                break;
            }
        }
        self.factors
    }

    /// Returns Σ_j κ_ij g_ij (ξ·e_a)² V_j along the axes of a point: the sums over bonds of complete and of other families.
    fn energies(&self, i: usize) -> [[f64; 2]; 3] {
        let mut energies = [[0.0; 2]; 3];
        let Some(axes) = &self.axes[i] else {
            return energies;
        };
        let d = self.factors.dimension;
        (self.for_each_bond)(i, &mut |j, xi, weight| {
            let is_scaled = self.factors.incomplete[j] > 0.0;
            let weight = weight * self.factors.of_bond(i, j, &direction(d, xi));
            for (energy, axis) in energies.iter_mut().zip(axes) {
                let along: f64 = (0..d).map(|c| xi[c] * axis.vector[c]).sum();
                energy[usize::from(is_scaled)] += weight * along * along;
            }
        });
        energies
    }

    /// Sets the tensors from the factors along the axes.
    fn update(&mut self) {
        let (n, d) = (self.cloud.len(), self.factors.dimension);
        for (component, (a, b)) in pairs(d).enumerate() {
            let mut field = vec![0.0; n];
            for (value, axes) in field.iter_mut().zip(&self.axes) {
                let axes = axes.iter().flat_map(|axes| &axes[..d]);
                let excess = axes.map(|axis| (axis.factor - 1.0) * axis.vector[a] * axis.vector[b]);
                *value = 0.5 * excess.sum::<f64>();
            }
            self.factors.excess[component] = self.continued(&field);
        }
    }

    /// Returns a field of own points continued to prescribed points, by the mean of the nearest points, and ghosts.
    fn continued(&self, own: &[f64]) -> Vec<f64> {
        let domain = self.cloud.domain();
        let all = domain.with_ghosts(own);
        let value = |i: usize| match &self.nearest[i][..] {
            [] => own[i],
            nearest => nearest.iter().map(|&j| all[j]).sum::<f64>() / nearest.len() as f64,
        };
        let continued: Vec<f64> = (0..own.len()).map(value).collect();
        domain.with_ghosts(&continued).into_owned()
    }
}

/// Sums over a family for unit conductivity.
struct Moments {
    /// Σ_j κ_ij ξ ⊗ ξ V_j.
    second: [[f64; 3]; 3],
    /// Σ_j κ_ij |ξ| ξ V_j: zero if there are as many neighbours on both sides.
    first: [f64; 3],
}

impl Moments {
    fn of(i: usize, d: usize, for_each_bond: &dyn Fn(usize, &mut Visit<'_>)) -> Self {
        let (mut second, mut first) = ([[0.0; 3]; 3], [0.0; 3]);
        for_each_bond(i, &mut |_, xi, weight| {
            let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            for a in 0..d {
                first[a] += weight * r * xi[a];
                for b in 0..d {
                    second[a][b] += weight * xi[a] * xi[b];
                }
            }
        });
        Self { second, first }
    }

    fn are_complete(&self, d: usize) -> bool {
        /// Deviations within rounding are complete families.
        const ROUNDING: f64 = 1e-10;
        pairs(d).all(|(a, b)| {
            let complete = if a == b { COMPLETE } else { 0.0 };
            (self.second[a][b] - complete).abs() <= ROUNDING * COMPLETE
        })
    }

    /// Returns the principal axes, the axes of the body's dimensions first, with the factors that would complete the energy if all
    /// bonds had them.
    fn axes(&self, i: usize, d: usize, for_each_bond: &dyn Fn(usize, &mut Visit<'_>)) -> [Axis; 3] {
        /// Share of the energy of a complete family below which the points are treated as one row or layer.
        const LEAST: f64 = 1e-2;
        /// Share of the largest energy below which the body is thin along an axis.
        const THIN: f64 = 0.5;
        /// First moment relative to the second one above which the family is on one side. A point at a plane surface has
        /// more than 0.5, one without neighbours at the end of the horizon 0.1 to 0.2.
        const ONE_SIDED: f64 = 0.25;
        let mut padded = self.second;
        for (a, row) in padded.iter_mut().enumerate().skip(d) {
            row[a] = -1.0;
        }
        let is_diagonal = pairs(d).all(|(a, b)| a == b || padded[a][b].abs() < 1e-10 * COMPLETE);
        let vectors = match is_diagonal {
            true => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            false => {
                let outside = |axis: &[f64; 3]| axis[d..].iter().map(|x| x * x).sum::<f64>();
                let mut axes = principal_axes(padded);
                axes.sort_by(|a, b| outside(a).total_cmp(&outside(b)));
                axes
            }
        };
        let energy = |vector: &[f64; 3]| -> f64 {
            let product = |a: usize| -> f64 { (0..d).map(|b| self.second[a][b] * vector[b]).sum() };
            (0..d).map(|a| vector[a] * product(a)).sum()
        };
        let largest = vectors.iter().map(energy).fold(0.0, f64::max);
        let mut axes = vectors.map(|vector| {
            let energy = energy(&vector);
            let side: f64 = (0..d).map(|a| vector[a] * self.first[a]).sum();
            Axis {
                vector,
                factor: 1.0,
                has_extent: energy > LEAST * COMPLETE,
                is_solved: energy > THIN * largest && side.abs() < ONE_SIDED * energy,
            }
        });
        let mut fourth = [[0.0; 3]; 3];
        for_each_bond(i, &mut |_, xi, weight| {
            let square: f64 = xi.iter().map(|x| x * x).sum();
            let along = |axis: &Axis| (0..d).map(|c| xi[c] * axis.vector[c]).sum::<f64>().powi(2);
            let squares = [0, 1, 2].map(|a| along(&axes[a]));
            for a in 0..3 {
                for b in 0..3 {
                    fourth[a][b] += weight * squares[a] * squares[b] / square;
                }
            }
        });
        complete(&mut axes, &fourth);
        axes
    }
}

/// Sets the factors of the axes with which a family is complete if all its bonds have them, by the iteration of
/// [`Families::solve`]: Σ_b m_ab S_b = 2 with the sums m_ab = Σ_j κ_ij (ξ·e_a)² (ξ·e_b)²/|ξ|² V_j.
fn complete(axes: &mut [Axis; 3], sums: &[[f64; 3]; 3]) {
    const TIMES: usize = 100;
    /// Larger factors along the normal of a thin body would exceed the energy of its tangents.
    const LARGEST: f64 = 4.0;
    for _ in 0..TIMES {
        let energy = |a: usize| -> f64 { (0..3).map(|b| sums[a][b] * axes[b].factor).sum() };
        let energies = [0, 1, 2].map(energy);
        for (axis, energy) in axes.iter_mut().zip(energies) {
            if axis.has_extent {
                let most = if axis.is_solved {
                    f64::INFINITY
                } else {
                    LARGEST
                };
                axis.factor = (axis.factor * COMPLETE / energy).min(most);
            }
        }
    }
}

/// Returns the nearest points of a family for which `is_wanted` holds: one, or several at equal distances.
fn nearest_of(
    for_each_bond: &dyn Fn(usize, &mut Visit<'_>),
    i: usize,
    is_wanted: &dyn Fn(usize) -> bool,
) -> Vec<usize> {
    /// Distances that differ less are equal.
    const EQUAL: f64 = 1.0 + 1e-9;
    let mut found: Vec<(f64, usize)> = Vec::new();
    for_each_bond(i, &mut |j, xi, _| {
        if is_wanted(j) {
            found.push((xi.iter().map(|x| x * x).sum(), j));
        }
    });
    let least = found
        .iter()
        .map(|(square, _)| *square)
        .fold(f64::INFINITY, f64::min);
    found.retain(|(square, _)| *square <= least * EQUAL);
    found.into_iter().map(|(_, j)| j).collect()
}
