//! The bonds of a lattice body as springs between nodes, all that the highest frequency needs to know of them.

/// A bond of a lattice, linearised at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeSpring {
    /// Neighbour minus node, in spacings.
    pub offset: [i32; 3],
    /// c α κ V/|ξ|: force density per elongation, N/m⁴.
    pub stiffness: f64,
}

/// Springs of an infinite lattice of which a body is a part: the body has no bond that the lattice lacks, and no bond of the body is stiffer than the
/// lattice's bond of the same offset. All stiffnesses are at least zero, and all points have the same volume.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeSprings {
    dimension: usize,
    half: Vec<LatticeSpring>,
}

/// Springs above which plane waves are no longer cheaper than products with the operator.
const MOST: usize = 20_000;

impl LatticeSprings {
    /// The springs given, of which one of each pair ±offset is kept; `None` where a stiffness is negative or not finite, or where there are too many springs for plane
    /// waves to be cheap.
    pub fn new(dimension: usize, springs: impl IntoIterator<Item = LatticeSpring>) -> Option<Self> {
        let mut half = Vec::new();
        for spring in springs {
            if !(spring.stiffness >= 0.0 && spring.stiffness.is_finite()) {
                return None;
            }
            // The first component other than zero is positive.
            if spring.offset > [0; 3] && spring.stiffness > 0.0 {
                if half.len() == MOST {
                    return None;
                }
                half.push(spring);
            }
        }
        (!half.is_empty()).then_some(Self { dimension, half })
    }

    /// 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// One spring of each pair ±offset.
    pub fn half(&self) -> &[LatticeSpring] {
        &self.half
    }
}
