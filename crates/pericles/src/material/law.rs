//! placeholder
/// Which pair force a material uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairLaw {
    /// Linear in the relative displacement: stretch s = ξ·η/|ξ|², direction ξ/|ξ|.
    Linear,
    /// Stretch s = (|ξ+η| − |ξ|)/|ξ| along the deformed bond.
    BondStretch,
}
