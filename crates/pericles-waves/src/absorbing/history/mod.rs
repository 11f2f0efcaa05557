//! Histories of the outer sites, convolved with the kernels of the ghosts.

mod blocked;
mod compare;
mod cost;
mod direct;
mod exponential;
mod record;

pub use blocked::BlockedHistory;
pub use compare::history_distance;
pub use cost::{HistoryCost, HistoryForm};
pub use direct::DirectHistory;
pub use exponential::ExponentialHistory;

use pericles::archive::SavedUnder;

/// Convolution in time that gives the ghosts of the next step from all previous ones, and the part of them that
/// depends on the current step.
pub trait History: SavedUnder + Send + Sync {
    /// Name in decks.
    fn name(&self) -> &'static str;

    /// Number of steps for which it was created; `None` for any number.
    fn steps(&self) -> Option<u64>;

    /// Memory, bytes.
    fn bytes(&self) -> usize;

    /// Writes u_0, u_{−1} … u_{−(K−1)} (m) of the step after the last one pushed.
    fn ghosts_into(&self, ghosts: &mut [f64]);

    /// Adds to the ghosts their dependence on the displacements `own` of the body's outer points in the same step;
    /// zero for kernels that start at lag one.
    fn settle(&self, own: &[f64], ghosts: &mut [f64]);

    /// Appends the displacements of a step: of the body's outer points 1 … K and of the ghosts. Does not allocate.
    fn push(&mut self, own: &[f64], ghosts: &[f64]);

    /// Clears the history.
    fn reset(&mut self);
}
