//! Bonds of a lattice body as springs between nodes, for the computation of the highest frequency.

/// A bond of a lattice, linearised at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeSpring {
    /// Position of the neighbour relative to the node, in spacings.
    pub offset: [i32; 3],
    /// Stiffness c α κ V/|ξ|: force density per elongation, N/m⁴.
    pub stiffness: f64,
}

/// Springs of an infinite lattice that contains a body: each bond of the body is a bond of the lattice and at
/// most as stiff as the lattice bond of the same offset. All stiffnesses are non-negative, and all points
/// have the same volume.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeSprings {
    dimension: usize,
    half: Vec<LatticeSpring>,
}

/// Number of springs above which plane waves are more expensive than products with the operator.
const MOST: usize = 20_000;

impl LatticeSprings {
    /// Keeps one of each pair ±offset of the given springs. Returns `None` if a stiffness is negative, NaN or
    /// infinite, or if plane waves would be expensive because of the number of springs.
    pub fn new(dimension: usize, springs: impl IntoIterator<Item = LatticeSpring>) -> Option<Self> {
        let mut half = Vec::new();
        for spring in springs {
            if !(spring.stiffness >= 0.0 && spring.stiffness.is_finite()) {
                return None;
            }
            // The first nonzero component is positive.
            if spring.offset > [0; 3] && spring.stiffness > 0.0 {
                if half.len() == MOST {
                    return None;
                }
                half.push(spring);
            }
        }
        (!half.is_empty()).then_some(Self { dimension, half })
    }

    /// Returns the dimension, 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Returns one spring of each pair ±offset.
    pub fn half(&self) -> &[LatticeSpring] {
        &self.half
    }
}
