//! Critical stretches of bonds of a lattice body by the materials of their ends.

use crate::lanes::LANES;
use crate::material::{MaterialPairs, PairForce};
use crate::neighbourhood::Lattice;
use crate::operator::CriticalStretches;
use crate::operator::thresholds::PairThresholds;

/// Thresholds by the materials at the places of the padded rows.
pub(super) struct PlaceThresholds {
    pairs: PairThresholds,
    places: usize,
    /// Smallest threshold of the bonds of each chunk.
    smallest: Vec<f64>,
}

impl PlaceThresholds {
    /// Creates thresholds from the materials of the sites.
    pub fn new<L: PairForce>(classes: &MaterialPairs, bonds: &Lattice) -> Self {
        let (layout, stencil) = (bonds.layout(), bonds.stencil());
        let of_site = classes.of_point();
        let of_place = layout.at_places(|site| of_site[site]);
        let strengths = match classes.strengths() {
            [] => Vec::new(),
            strengths => layout.at_places(|site| strengths[site]),
        };
        let pairs = PairThresholds::of::<L>(classes.at(of_place, strengths));
        let smallest = layout.chunks().iter().map(|chunk| {
            let mut smallest = f64::INFINITY;
            for (&shift, &cell) in stencil.shifts().iter().zip(stencil.cells()) {
                let there = layout.neighbours(chunk, cell);
                for lane in (0..LANES).filter(|lane| there >> lane & 1 == 1) {
                    let here = chunk.place as usize * LANES + lane;
                    let threshold = pairs.threshold(here, here.wrapping_add_signed(shift));
                    smallest = smallest.min(threshold);
                }
            }
            smallest
        });
        Self {
            smallest: smallest.collect(),
            places: layout.places(),
            pairs,
        }
    }

    /// Returns the smallest threshold of the bonds of `count` chunks from `first` on.
    #[inline(always)]
    pub fn smallest(&self, first: usize, count: usize) -> f64 {
        self.smallest[first].min(self.smallest[first + count - 1])
    }

    /// Returns the thresholds of eight bonds from a place on with the shift to their other ends; arbitrary
    /// for places without a site.
    #[inline(never)]
    pub fn of_lanes(&self, place: usize, shift: isize) -> [f64; LANES] {
        self.ends(place, shift)
            .map(|[a, b]| self.pairs.threshold(a, b))
    }

    /// Returns the thresholds for a fraction of the critical stretches.
    #[inline(never)]
    pub fn of_part<L: PairForce>(&self, part: f64, place: usize, shift: isize) -> [f64; LANES] {
        self.ends(place, shift)
            .map(|[a, b]| L::threshold(part * self.pairs.critical_stretch(a, b)))
    }

    /// Returns the critical stretches as data.
    pub fn data(&self) -> CriticalStretches {
        self.pairs.data()
    }

    /// Returns the critical stretch of a bond between two places.
    pub fn critical_stretch(&self, [a, b]: [usize; 2]) -> f64 {
        self.pairs.critical_stretch(a, b)
    }

    /// Returns the places of both ends of eight bonds; for ends beyond the rows, which have no bonds, the
    /// place itself.
    fn ends(&self, place: usize, shift: isize) -> [[usize; 2]; LANES] {
        std::array::from_fn(|lane| {
            let here = place + lane;
            let there = here.checked_add_signed(shift);
            [
                here,
                there.filter(|&there| there < self.places).unwrap_or(here),
            ]
        })
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        self.places + size_of_val(&self.smallest[..])
    }
}
