//! The bonds of a point in batches of eight.

use pericles::lanes::{F64x8, LANES, Lanes, Row};
use pericles::operator::Kinematics;

use super::bonds::Bonds;
use super::heat::YieldScale;
use crate::tensor::Matrix;

/// The bonds of a point, at a displacement.
#[derive(Clone, Copy)]
pub struct Family<'a, const D: usize> {
    pub(super) bonds: &'a Bonds,
    pub(super) i: usize,
    here: usize,
    /// First group of the point in the list.
    first: usize,
    intact: &'a [u8],
    u: &'a [Row],
}

/// Eight bonds of a point. Missing and broken bonds have zero weight and zero ξ and η.
#[derive(Debug, Clone, Copy)]
pub struct Bond<T, const D: usize> {
    /// ξ, m.
    pub xi: [T; D],
    /// η, m.
    pub eta: [T; D],
    /// ω = w b V of the other end, m³ for a dimensionless w.
    pub weight: T,
    /// |ξ|², m²; 1 for missing and broken bonds.
    pub square: T,
    /// 1/|ξ|².
    pub inverse_square: T,
}

impl<T: Lanes, const D: usize> Bond<T, D> {
    /// Returns the stretch e/|ξ|.
    #[inline(always)]
    pub fn stretch<K: Kinematics>(&self) -> T {
        K::exact_stretch(K::strain(self.xi, self.eta, self.inverse_square))
    }

    /// Returns a force of the given magnitude per length |ξ| in the direction of the bond: magnitude · |ξ| y/|y|.
    #[inline(always)]
    pub fn along<K: Kinematics>(&self, magnitude: T) -> [T; D] {
        let t = K::strain(self.xi, self.eta, self.inverse_square);
        let pull = K::exact_pull(t, magnitude, T::splat(0.0));
        let mut force = K::direction(self.xi, self.eta);
        for c in 0..D {
            force[c] = pull * force[c];
        }
        force
    }

    /// Returns the change of the stretch for η that changes by `moved`.
    #[inline(always)]
    pub fn stretch_change<K: Kinematics>(&self, moved: [T; D]) -> T {
        let direction = K::direction(self.xi, self.eta);
        let mut along = direction[0] * moved[0];
        for c in 1..D {
            along = direction[c].mul_add(moved[c], along);
        }
        let t = K::strain(self.xi, self.eta, self.inverse_square);
        along * K::contraction(t) * self.inverse_square
    }

    /// Returns the change of [`Bond::along`] for a magnitude that changes by `change` and η that changes by `moved`.
    #[inline(always)]
    pub fn along_change<K: Kinematics>(&self, magnitude: T, change: T, moved: [T; D]) -> [T; D] {
        let zero = T::splat(0.0);
        let t = K::strain(self.xi, self.eta, self.inverse_square);
        let stretch = self.stretch_change::<K>(moved);
        let pull = K::pull_change(t, magnitude, zero, stretch, change);
        let mut force = K::direction(self.xi, self.eta);
        for c in 0..D {
            force[c] = pull * force[c];
        }
        if !K::LINEAR {
            let turn = K::exact_pull(t, magnitude, zero);
            for c in 0..D {
                force[c] = turn.mul_add(moved[c], force[c]);
            }
        }
        force
    }
}

impl<'a, const D: usize> Family<'a, D> {
    /// The bonds of point i whose bits are set in `intact`, for displacements by site.
    #[inline(always)]
    pub(super) fn new(bonds: &'a Bonds, i: usize, intact: &'a [u8], u: &'a [Row]) -> Self {
        let list = bonds.list();
        assert!(
            u.len() == bonds.reference().len(),
            "a displacement for every site"
        );
        Self {
            bonds,
            i,
            here: list.site(i),
            first: list.start()[i],
            intact,
            u,
        }
    }

    /// Returns the number of batches.
    #[inline(always)]
    pub fn batches(&self) -> usize {
        self.intact.len()
    }

    /// Returns the bits of the intact bonds of a batch.
    #[inline(always)]
    pub fn intact(&self, batch: usize) -> u8 {
        self.intact[batch]
    }

    /// Returns the number of intact bonds.
    pub fn count(&self) -> usize {
        let ones = self.intact.iter().map(|byte| byte.count_ones() as usize);
        ones.sum()
    }

    /// Returns the sites of the other ends of a batch.
    #[inline(always)]
    pub(super) fn others(&self, batch: usize) -> [usize; LANES] {
        self.bonds.list().group(self.first + batch)
    }

    /// Returns the rows of the other ends of a batch; there must be a row for every site.
    #[inline(always)]
    pub(super) fn gather<T: Lanes>(&self, batch: usize, rows: &[Row]) -> [T; 4] {
        assert!(
            rows.len() == self.bonds.reference().len(),
            "a row for every site"
        );
        // SAFETY: neighbours of a list are below the number of sites, which is the number of rows.
        unsafe { T::gather(rows, self.others(batch)) }
    }

    /// Returns η of a batch, m; zero for missing and broken bonds.
    #[inline(always)]
    pub fn eta<T: Lanes>(&self, batch: usize) -> [T; D] {
        let there = self.gather::<T>(batch, self.u);
        let mut eta = [T::splat(0.0); D];
        for c in 0..D {
            let component = there[c] - T::splat(self.u[self.here][c]);
            eta[c] = component.masked(self.intact[batch]);
        }
        eta
    }

    /// Returns the eight bonds of a batch.
    #[inline(always)]
    pub fn bond<T: Lanes>(&self, batch: usize) -> Bond<T, D> {
        let (reference, unit) = (self.bonds.reference(), self.bonds.unit());
        let there = self.gather::<T>(batch, reference);
        let (mut xi, bits) = ([T::splat(0.0); D], self.intact[batch]);
        for c in 0..D {
            let component = there[c] - T::splat(reference[self.here][c]);
            xi[c] = (component * T::splat(unit[c])).masked(bits);
        }
        let mut square = xi[0] * xi[0];
        for c in 1..D {
            square = xi[c].mul_add(xi[c], square);
        }
        let square = square + T::splat(1.0).masked(!bits);
        Bond {
            xi,
            eta: self.eta(batch),
            weight: self.bonds.weight::<T>(self.first + batch).masked(bits),
            square,
            inverse_square: T::splat(1.0) / square,
        }
    }

    /// Returns Σ ω η ⊗ ξ, with η of `moved`, the same bonds at another displacement or in a direction.
    #[inline(always)]
    pub fn moment<T: Lanes>(&self, moved: &Self) -> Matrix<D> {
        let mut sums = [[T::splat(0.0); D]; D];
        for batch in 0..self.batches() {
            if self.intact(batch) == 0 {
                continue;
            }
            let bond = self.bond::<T>(batch);
            let eta = moved.eta::<T>(batch);
            for a in 0..D {
                let weighted = bond.weight * eta[a];
                for b in 0..D {
                    sums[a][b] = weighted.mul_add(bond.xi[b], sums[a][b]);
                }
            }
        }
        let mut moment = [[0.0; D]; D];
        for a in 0..D {
            for b in 0..D {
                moment[a][b] = F64x8(sums[a][b].to_array()).sum();
            }
        }
        moment
    }

    /// Returns the influence function w of a batch; zero if the material does not read it
    /// ([`Solid::reads_influence`](super::Solid::reads_influence)).
    #[inline(always)]
    pub fn influence<T: Lanes>(&self, batch: usize) -> T {
        self.bonds.influence(self.first + batch)
    }

    /// Calls `visit` for each intact bond.
    pub(super) fn for_each(&self, mut visit: impl FnMut(&SingleBond<D>)) {
        for (batch, &bits) in self.intact.iter().enumerate() {
            self.for_each_of(batch, bits, &mut visit);
        }
    }

    /// Calls `visit` for the bonds of a batch whose bits are set.
    pub(super) fn for_each_of(
        &self,
        batch: usize,
        bits: u8,
        mut visit: impl FnMut(&SingleBond<D>),
    ) {
        if bits == 0 {
            return;
        }
        let (bond, others) = self.batch_in_lanes(batch);
        for lane in (0..LANES).filter(|lane| bits >> lane & 1 == 1) {
            visit(&SingleBond {
                entry: (self.first + batch) * LANES + lane,
                site: others[lane],
                xi: bond.xi.map(|x| x.0[lane]),
                eta: bond.eta.map(|x| x.0[lane]),
                weight: bond.weight.0[lane],
            });
        }
    }

    /// Returns the bonds of a batch and the sites of their other ends; compiled once for all loops over single bonds.
    #[inline(never)]
    fn batch_in_lanes(&self, batch: usize) -> (Bond<F64x8, D>, [usize; LANES]) {
        (self.bond(batch), self.others(batch))
    }

    /// The same bonds at another displacement.
    #[inline(always)]
    pub(super) fn at(self, u: &'a [Row]) -> Self {
        assert!(u.len() == self.u.len(), "a displacement for every site");
        Self { u, ..self }
    }

    /// Returns the site of the point.
    pub(super) fn site(&self) -> usize {
        self.here
    }
}

/// One bond of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct SingleBond<const D: usize> {
    /// Entry of the bond in the list.
    pub entry: usize,
    /// Site of the other end.
    pub site: usize,
    /// ξ, m.
    pub xi: [f64; D],
    /// η, m.
    pub eta: [f64; D],
    /// ω
    pub weight: f64,
}

/// A point with its bonds and what is stored for them.
pub struct Point<'a, S, const D: usize> {
    /// The bonds.
    pub family: Family<'a, D>,
    /// [`Solid::Shape`](super::Solid::Shape) of the point.
    pub shape: &'a S,
    /// Stored numbers of the point at the end of the last step.
    pub history: &'a [f64],
    /// Stored numbers of its bonds.
    pub(super) of_bonds: &'a [f64],
    /// Stored numbers per bond.
    pub(super) per_bond: usize,
    /// Time since the last stored numbers, s.
    pub dt: f64,
    /// Thermal stretch τ: the stress-free length of a bond is (1 + τ) |ξ|.
    pub thermal: f64,
    /// Yield stress and hardening modulus relative to those of the material.
    pub yields: YieldScale,
}

impl<S, const D: usize> Clone for Point<'_, S, D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const D: usize> Copy for Point<'_, S, D> {}

impl<S, const D: usize> Point<'_, S, D> {
    /// Returns a stored number of the bonds of a batch at the end of the last step.
    #[inline(always)]
    pub fn bond_history<T: Lanes>(&self, batch: usize, number: usize) -> T {
        T::load(self.of_bonds, (batch * self.per_bond + number) * LANES)
    }

    /// Returns the position of the point, m.
    pub fn position(&self) -> [f64; 3] {
        self.family
            .bonds
            .list()
            .sites()
            .cloud()
            .point(self.family.i)
    }
}

/// Stores eight numbers as the batch of this number.
#[inline(always)]
pub(super) fn store<T: Lanes>(numbers: &mut [f64], batch: usize, values: T) {
    numbers[batch * LANES..(batch + 1) * LANES].copy_from_slice(&values.to_array());
}
