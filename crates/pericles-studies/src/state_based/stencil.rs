//! Bonds of a lattice node, for sums evaluated from their definition.

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;

/// Bond of a node: its vector in spacings of 1 m, its length, volume b and ω = w b.
pub(super) struct Bond {
    pub xi: [i32; 3],
    pub length: f64,
    pub volume: f64,
    pub weight: f64,
}

/// All bonds of a node in a given dimension.
pub(super) fn bonds(
    dimension: usize,
    influence: &Influence,
    horizon: f64,
    correction: VolumeCorrection,
) -> Vec<Bond> {
    let reach = correction.reach(horizon, 1.0);
    let most = reach.floor() as i32;
    let range = |c: usize| if c < dimension { -most..=most } else { 0..=0 };
    let mut bonds = Vec::new();
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                let xi = [x, y, z];
                let vector = xi.map(f64::from);
                let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
                if xi != [0; 3] && length <= reach {
                    let volume = correction.factor(length, horizon, 1.0);
                    bonds.push(Bond {
                        xi,
                        length,
                        volume,
                        weight: volume * influence.alpha_of(vector, horizon),
                    });
                }
            }
        }
    }
    bonds
}

/// Weighted volume m = Σ ω r².
pub(super) fn weighted_volume(bonds: &[Bond]) -> f64 {
    let terms = bonds.iter();
    terms
        .map(|bond| bond.weight * bond.length * bond.length)
        .sum()
}
