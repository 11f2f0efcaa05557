//! Butcher tableaux of Runge–Kutta methods.

use crate::error::{PericlesError, Result};
use crate::space::check_length;

/// An explicit Runge–Kutta method y₁ = y₀ + dt Σ b_i k_i, k_i = F(t + c_i dt, y₀ + dt Σ_j a_ij k_j).
///
/// For y = (u, v) and F = (v, a(u, t)) the stage velocities can be eliminated: with Ā = A² and b̄ = A'b the stages
/// are U_i = u + c_i dt v + dt² Σ ā_ij a_j, and the step ends at u + dt v + dt² Σ b̄_j a_j, v + dt Σ b_j a_j. This
/// is the same method with half of the arrays.
#[derive(Debug, Clone, PartialEq)]
pub struct Tableau {
    /// Name in decks.
    pub(super) name: &'static str,
    /// Order.
    pub(super) order: u32,
    /// c.
    pub(super) nodes: Vec<f64>,
    /// A, row by row; row i has i entries.
    pub(super) stages: Vec<Vec<f64>>,
    /// b.
    pub(super) weights: Vec<f64>,
    /// Weights of the embedded method of the order below.
    pub(super) embedded: Option<Vec<f64>>,
}

impl Tableau {
    /// Makes a method from its coefficients: `nodes` c, `stages` A row by row (row i has i entries), `weights` b.
    /// The order is not checked.
    ///
    /// ```
    /// use pericles::time::Tableau;
    ///
    /// // Heun's method of order three.
    /// let third = 1.0 / 3.0;
    /// let stages = vec![vec![], vec![third], vec![0.0, 2.0 * third]];
    /// let heun = Tableau::new("heun-3", 3, vec![0.0, third, 2.0 * third], stages, vec![0.25, 0.0, 0.75])?;
    /// assert!((heun.stability_limit() - 3f64.sqrt()).abs() < 1e-6);
    /// # Ok::<(), pericles::PericlesError>(())
    /// ```
    ///
    /// # Errors
    /// No stages; rows or weights of wrong length; nodes that are not the sums of their rows, on which the stages
    /// of second-order equations rely; weights that do not add up to one.
    pub fn new(
        name: &'static str,
        order: u32,
        nodes: Vec<f64>,
        stages: Vec<Vec<f64>>,
        weights: Vec<f64>,
    ) -> Result<Self> {
        const ROUNDING: f64 = 1e-12;
        let count = nodes.len();
        check_length(
            "the weights of a Runge–Kutta method",
            weights.len(),
            count.max(1),
        )?;
        check_length("the stages of a Runge–Kutta method", stages.len(), count)?;
        for (i, (node, row)) in nodes.iter().zip(&stages).enumerate() {
            check_length("a row of the stages of a Runge–Kutta method", row.len(), i)?;
            let off = node - row.iter().sum::<f64>();
            if off.is_nan() || off.abs() > ROUNDING {
                return Err(PericlesError::SchemeParameter {
                    parameter: "a node of the Runge–Kutta method minus the sum of its row",
                    value: off,
                    allowed: "0",
                });
            }
        }
        let sum = weights.iter().sum::<f64>();
        if sum.is_nan() || (sum - 1.0).abs() > ROUNDING {
            return Err(PericlesError::SchemeParameter {
                parameter: "the sum of the weights of the Runge–Kutta method",
                value: sum,
                allowed: "1",
            });
        }
        Ok(Self {
            name,
            order,
            nodes,
            stages,
            weights,
            embedded: None,
        })
    }

    /// Three stages with two nodes at 2/3: order three for every nonzero α (Ascher & Petzold 1998, the
    /// one-parameter family of three-stage methods); α = 3/4 is Heun's method.
    ///
    /// # Errors
    /// α is zero or not finite.
    pub fn rk3(alpha: f64) -> Result<Self> {
        if !(alpha.is_finite() && alpha != 0.0) {
            return Err(PericlesError::SchemeParameter {
                parameter: "α of the third-order Runge–Kutta method",
                value: alpha,
                allowed: "any number but 0 (3/4 is Heun's method)",
            });
        }
        let last = 0.25 / alpha;
        Ok(Self {
            name: "rk3",
            order: 3,
            nodes: vec![0.0, 2.0 / 3.0, 2.0 / 3.0],
            stages: vec![vec![], vec![2.0 / 3.0], vec![2.0 / 3.0 - last, last]],
            weights: vec![0.25, 0.75 - alpha, alpha],
            embedded: None,
        })
    }

    /// The classical fourth-order method (Kutta 1901).
    pub fn rk4() -> Self {
        Self {
            name: "rk4",
            order: 4,
            nodes: vec![0.0, 0.5, 0.5, 1.0],
            stages: vec![vec![], vec![0.5], vec![0.0, 0.5], vec![0.0, 0.0, 1.0]],
            weights: vec![1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
            embedded: None,
        }
    }

    /// The Dormand–Prince method of order five with an embedded method of order four (1980). The last stage is the
    /// end of the step.
    pub fn dormand_prince() -> Self {
        let weights = vec![
            35.0 / 384.0,
            0.0,
            500.0 / 1113.0,
            125.0 / 192.0,
            -2187.0 / 6784.0,
            11.0 / 84.0,
        ];
        Self {
            name: "dormand-prince",
            order: 5,
            nodes: vec![0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0],
            stages: vec![
                vec![],
                vec![0.2],
                vec![3.0 / 40.0, 9.0 / 40.0],
                vec![44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
                vec![
                    19372.0 / 6561.0,
                    -25360.0 / 2187.0,
                    64448.0 / 6561.0,
                    -212.0 / 729.0,
                ],
                vec![
                    9017.0 / 3168.0,
                    -355.0 / 33.0,
                    46732.0 / 5247.0,
                    49.0 / 176.0,
                    -5103.0 / 18656.0,
                ],
                weights.clone(),
            ],
            weights: [weights, vec![0.0]].concat(),
            embedded: Some(vec![
                5179.0 / 57600.0,
                0.0,
                7571.0 / 16695.0,
                393.0 / 640.0,
                -92097.0 / 339200.0,
                187.0 / 2100.0,
                1.0 / 40.0,
            ]),
        }
    }

    /// Number of stages.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns false: every method has stages.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Returns x'A for a row x with one number per stage.
    pub(super) fn times_stages(&self, row: &[f64]) -> Vec<f64> {
        (0..row.len())
            .map(|j| {
                (j + 1..row.len())
                    .map(|i| row[i] * self.stages[i][j])
                    .sum::<f64>()
            })
            .collect()
    }

    /// Returns Ā = A².
    pub(super) fn displacement_stages(&self) -> Vec<Vec<f64>> {
        self.stages
            .iter()
            .map(|row| self.times_stages(row))
            .collect()
    }

    /// Coefficients of the stability polynomial R(z) = 1 + z b'(1 − zA)⁻¹1, lowest power first.
    pub fn stability_polynomial(&self) -> Vec<f64> {
        let mut coefficients = vec![1.0];
        let mut row = self.weights.clone();
        for _ in 0..self.len() {
            coefficients.push(row.iter().sum());
            row = self.times_stages(&row);
        }
        coefficients
    }

    /// Largest y with |R(ix)| ≤ 1 for all 0 ≤ x ≤ y: the limit of ω dt for undamped oscillations.
    pub fn stability_limit(&self) -> f64 {
        let polynomial = self.stability_polynomial();
        let growth = |y: f64| {
            let (mut re, mut im) = (0.0, 0.0);
            for (power, coefficient) in polynomial.iter().enumerate() {
                let term = coefficient * y.powi(power as i32);
                match power % 4 {
                    0 => re += term,
                    1 => im += term,
                    2 => re -= term,
                    _ => im -= term,
                }
            }
            re * re + im * im - 1.0
        };
        /// Round-off of the evaluation near y = 0.
        const ROUND_OFF: f64 = 1e-13;
        const STRIDE: f64 = 1e-3;
        let mut low = 0.0;
        while growth(low + STRIDE) <= ROUND_OFF && low < 10.0 {
            low += STRIDE;
        }
        let mut high = low + STRIDE;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if growth(middle) <= ROUND_OFF {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the order conditions of all rooted trees up to order five (Hairer, Nørsett & Wanner, table II.2.2).
    fn order_of(tableau: &Tableau, weights: &[f64]) -> u32 {
        let s = tableau.len();
        let c = &tableau.nodes;
        let a = |x: &dyn Fn(usize) -> f64, i: usize| -> f64 {
            (0..i).map(|j| tableau.stages[i][j] * x(j)).sum()
        };
        let one = |_: usize| 1.0;
        let c1 = |i: usize| c[i];
        let ac = |i: usize| a(&c1, i);
        let ac2 = |i: usize| a(&|j| c[j].powi(2), i);
        let aac = |i: usize| a(&ac, i);
        type Tree<'a> = (u32, f64, Box<dyn Fn(usize) -> f64 + 'a>);
        let trees: Vec<Tree<'_>> = vec![
            (1, 1.0, Box::new(one)),
            (2, 1.0 / 2.0, Box::new(c1)),
            (3, 1.0 / 3.0, Box::new(|i| c[i].powi(2))),
            (3, 1.0 / 6.0, Box::new(ac)),
            (4, 1.0 / 4.0, Box::new(|i| c[i].powi(3))),
            (4, 1.0 / 8.0, Box::new(move |i| c[i] * ac(i))),
            (4, 1.0 / 12.0, Box::new(ac2)),
            (4, 1.0 / 24.0, Box::new(aac)),
            (5, 1.0 / 5.0, Box::new(|i| c[i].powi(4))),
            (5, 1.0 / 10.0, Box::new(move |i| c[i].powi(2) * ac(i))),
            (5, 1.0 / 20.0, Box::new(move |i| ac(i).powi(2))),
            (5, 1.0 / 15.0, Box::new(move |i| c[i] * ac2(i))),
            (5, 1.0 / 20.0, Box::new(move |i| a(&|j| c[j].powi(3), i))),
            (5, 1.0 / 30.0, Box::new(move |i| c[i] * aac(i))),
            (5, 1.0 / 40.0, Box::new(move |i| a(&|j| c[j] * ac(j), i))),
            (5, 1.0 / 60.0, Box::new(move |i| a(&ac2, i))),
            (5, 1.0 / 120.0, Box::new(move |i| a(&aac, i))),
        ];
        let holds = |(_, value, phi): &Tree<'_>| {
            let sum: f64 = (0..s).map(|i| weights[i] * phi(i)).sum();
            (sum - value).abs() < 1e-13
        };
        let failed = trees.iter().filter(|tree| !holds(tree)).map(|tree| tree.0);
        failed.min().map_or(5, |order| order - 1)
    }

    #[test]
    fn methods_satisfy_the_conditions_of_their_order() {
        for alpha in [0.75, 0.25, 1.0, -2.0] {
            let rk3 = Tableau::rk3(alpha).unwrap();
            assert_eq!(order_of(&rk3, &rk3.weights), 3, "{alpha}");
        }
        assert_eq!(order_of(&Tableau::rk4(), &Tableau::rk4().weights), 4);
        let pair = Tableau::dormand_prince();
        assert_eq!(order_of(&pair, &pair.weights), 5);
        assert_eq!(order_of(&pair, pair.embedded.as_ref().unwrap()), 4);
        for tableau in [Tableau::rk3(0.6).unwrap(), Tableau::rk4(), pair] {
            for (node, row) in tableau.nodes.iter().zip(&tableau.stages) {
                assert!((row.iter().sum::<f64>() - node).abs() < 1e-14);
            }
        }
        assert!(Tableau::rk3(0.0).is_err() && Tableau::rk3(f64::NAN).is_err());
    }

    #[test]
    fn stability_limits_on_the_imaginary_axis() {
        let rk3 = Tableau::rk3(0.75).unwrap().stability_limit();
        assert!((rk3 - 3f64.sqrt()).abs() < 1e-9, "{rk3}");
        let rk4 = Tableau::rk4().stability_limit();
        assert!((rk4 - 8f64.sqrt()).abs() < 1e-9, "{rk4}");
        // |R(iy)|² − 1 = −y⁶/1800 + …: stable for small y, unstable beyond y ≈ 1.
        let pair = Tableau::dormand_prince().stability_limit();
        assert!((0.9..1.1).contains(&pair), "{pair}");
    }

    #[test]
    fn displacement_form_of_rk4_equals_its_closed_form() {
        let rk4 = Tableau::rk4();
        let form = rk4.displacement_stages();
        assert_eq!(form[2], [0.25, 0.0]);
        assert_eq!(form[3], [0.0, 0.5, 0.0]);
        let b = rk4.times_stages(&rk4.weights);
        for (found, expected) in b.iter().zip([1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 0.0]) {
            assert!((found - expected).abs() < 1e-16);
        }
    }
}
