//! The forms in which bonds are stored.

use std::sync::Arc;

use super::tally::{BlockDamage, BondPlace, BreakEvent, DamageMeasure};
use crate::archive::Archive;
use crate::domain::Letter;
use crate::error::Result;
use crate::parallel::{Cost, PointSubset};
use crate::space::PointCloud;

/// A directed bond that counts in the damage of its first end.
#[derive(Debug, Clone, Copy)]
pub struct CountedBond {
    /// The first end.
    pub point: usize,
    /// Number of the directed bond: eight times the number of its byte in all blocks, plus its bit.
    pub entry: usize,
    /// Weight in the damage.
    pub weight: f64,
    /// Whether it is intact.
    pub intact: bool,
}

/// A way to store the bonds of a body: members and their order.
pub trait Form: Send + Sync {
    /// Begins the names of arrays in checkpoints.
    const NAME: &'static str;

    /// Returns the points.
    fn cloud(&self) -> &Arc<PointCloud>;

    /// Returns the number of own points.
    fn points(&self) -> usize {
        self.cloud().len()
    }

    /// Returns the bits of the bonds that exist after pre-cracks, for each block.
    fn initial_bits(&self) -> Vec<Vec<u8>>;

    /// Returns the first point of a block; after the last block, the number of points.
    fn first_point(&self, block: usize) -> usize;

    /// Returns the number of directed bonds after pre-cracks: each bond counts twice.
    fn directed_bonds(&self) -> u64;

    /// Returns the cost of a loop over the bonds of a subset of the points.
    fn cost(&self, on: &PointSubset<'_>) -> Cost;

    /// Calls `visit` with each bond of the points of a block that counts in the damage. The bonds of a point come in
    /// ascending order of their entries.
    fn for_each_counted(
        &self,
        block: usize,
        intact: &[u8],
        measure: DamageMeasure,
        visit: impl FnMut(CountedBond),
    );

    /// Calls `visit` with the other end of each intact bond of own point i; ghosts are counted after the own points.
    fn for_each_intact_of(&self, blocks: &[BlockDamage], i: usize, visit: &mut dyn FnMut(usize));

    /// Calls `visit` once for each point other than i that is initially bonded to own point i; ghosts are counted after
    /// the own points.
    fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// Returns the message to the other end of a bond that broke; its first number is the recorded energy, J.
    fn letter(&self, event: &BreakEvent) -> Letter;

    /// Returns the place of the directed bond from the receiver of a message.
    fn place_of(&self, letter: &Letter) -> Option<BondPlace>;

    /// Returns the memory use, bytes.
    fn bytes(&self) -> usize;

    /// Saves the intact bonds.
    fn save(&self, blocks: &[BlockDamage], archive: &mut Archive);

    /// Restores the intact bonds.
    ///
    /// # Errors
    /// Arrays of another body.
    fn restore(&self, blocks: &mut [BlockDamage], archive: &Archive) -> Result<()>;
}
