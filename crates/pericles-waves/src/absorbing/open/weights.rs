//! Weights of the uniform lattice, measured from the tangent of the forces.

use pericles::System;

use super::error::OpenError;

/// Largest distance of interacting nodes along an axis, in cells.
const LARGEST: usize = 12;

/// Accelerations of a lattice: u_n'' = Σ_ξ W_ξ (u_{n+ξ} − u_n), with 2 × 2 matrices W_ξ, 1/s².
#[derive(Debug, Clone)]
pub struct LatticeWeights {
    reach: usize,
    /// W_ξ by row and column of the square of the reach; zero for ξ = 0.
    window: Vec<[[f64; 2]; 2]>,
}

impl LatticeWeights {
    /// Makes the lattice with the reach K (cells) and the weights `weight(ξ)`, 1/s².
    pub fn new(reach: usize, weight: impl Fn([isize; 2]) -> [[f64; 2]; 2]) -> Self {
        let k = reach as isize;
        let window = (-k..=k).flat_map(|y| (-k..=k).map(move |x| [x, y]));
        let of = |shift: [isize; 2]| match shift {
            [0, 0] => [[0.0; 2]; 2],
            _ => weight(shift),
        };
        Self {
            reach,
            window: window.map(of).collect(),
        }
    }

    /// Measures the weights of a body from the accelerations that the displacement of one node causes; `place(point)` is the
    /// position of a point relative to this node, in cells. All processes must call it together.
    pub(super) fn of(
        system: &System,
        place: impl Fn(usize) -> [isize; 2],
    ) -> Result<Self, OpenError> {
        const SIDE: usize = 2 * LARGEST + 1;
        let (n, domain) = (system.points(), system.domain());
        let mut window = [vec![f64::NEG_INFINITY; 4 * SIDE * SIDE], vec![0.0]].concat();
        let last = window.len() - 1;
        let own: Vec<[isize; 2]> = (0..n).map(place).collect();
        let rest = vec![0.0; 2 * n];
        for b in 0..2 {
            let (mut unit, mut answer) = (rest.clone(), rest.clone());
            if let Some(i) = own.iter().position(|place| *place == [0, 0]) {
                unit[b * n + i] = 1.0;
            }
            system.vibration_into(&rest, &unit, &mut answer);
            for (i, place) in own.iter().enumerate() {
                // The node that moved is at ξ = −place from the node that is pulled.
                let near = place.iter().all(|x| x.unsigned_abs() <= LARGEST);
                for a in 0..2 {
                    let weight = -answer[a * n + i];
                    if near {
                        let [x, y] = place.map(|x| (LARGEST as isize - x) as usize);
                        window[4 * (y * SIDE + x) + 2 * a + b] = weight;
                    } else {
                        window[last] = f64::max(window[last], weight.abs());
                    }
                }
            }
        }
        domain.comm().max(&mut window);
        let largest = window[..last].iter().fold(0.0, |most: f64, w| {
            if w.is_finite() {
                most.max(w.abs())
            } else {
                most
            }
        });
        // The values of convolutions contain rounding errors everywhere.
        let least = 1e-11 * largest;
        if window[last] > least {
            return Err(OpenError::Reach { largest: LARGEST });
        }
        let at = |[x, y]: [isize; 2]| {
            let [x, y] = [x, y].map(|x| (LARGEST as isize + x) as usize);
            let entry = |k: usize| {
                let weight = window[4 * (y * SIDE + x) + k];
                if weight.is_finite() && weight.abs() > least {
                    weight
                } else {
                    0.0
                }
            };
            [[entry(0), entry(1)], [entry(2), entry(3)]]
        };
        let full = Self::new(LARGEST, at);
        let reach = (1..=LARGEST).rev().find(|&reach| {
            full.shifts()
                .any(|(shift, _)| shift.iter().any(|x| x.unsigned_abs() == reach))
        });
        match reach {
            Some(reach) => Ok(Self::new(reach, at)),
            None => Err(OpenError::NoForces),
        }
    }

    /// K: the largest distance of interacting nodes along an axis, in cells.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// W_ξ, 1/s²; zero beyond the reach.
    pub fn at(&self, [x, y]: [isize; 2]) -> [[f64; 2]; 2] {
        let k = self.reach as isize;
        let inside = x.abs() <= k && y.abs() <= k;
        let place = || ((y + k) * (2 * k + 1) + x + k) as usize;
        if inside {
            self.window[place()]
        } else {
            [[0.0; 2]; 2]
        }
    }

    /// All ξ with weights that are not zero.
    pub fn shifts(&self) -> impl Iterator<Item = ([isize; 2], [[f64; 2]; 2])> + '_ {
        let k = self.reach as isize;
        let window = (-k..=k).flat_map(move |y| (-k..=k).map(move |x| [x, y]));
        let all = window.zip(self.window.iter().copied());
        all.filter(|(_, weight)| weight.iter().flatten().any(|w| *w != 0.0))
    }

    /// Speed of long longitudinal waves along an axis, cells/s: c² = ½ Σ W_aa ξ_a².
    pub fn longitudinal_speed(&self, axis: usize) -> f64 {
        let terms = self
            .shifts()
            .map(|(shift, weight)| weight[axis][axis] * (shift[axis] as f64).powi(2));
        (0.5 * terms.sum::<f64>()).sqrt()
    }
}
