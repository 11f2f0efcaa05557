//! What the exterior remembers: histories of the outer sites, convolved with the ghosts' kernels.

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

/// A convolution in time that gives the ghosts of the next step from all steps before, and what of them hangs on the present one.
pub trait History: SavedUnder + Send + Sync {
    /// Name as in decks.
    fn name(&self) -> &'static str;

    /// Steps that it is made for; none if any number.
    fn steps(&self) -> Option<u64>;

    /// Memory, bytes.
    fn bytes(&self) -> usize;

    /// u_0, u_{−1} … u_{−(K−1)} at the step after those pushed, m.
    fn ghosts_into(&self, ghosts: &mut [f64]);

    /// Adds to these ghosts what they owe to displacements `own` of the body's outer points in the same step; nothing where kernels start with the first lag.
    fn settle(&self, own: &[f64], ghosts: &mut [f64]);

    /// Takes the displacements of a step: of the body's outer points 1 … K and of the ghosts. Allocates nothing.
    fn push(&mut self, own: &[f64], ghosts: &[f64]);

    /// Forgets all.
    fn reset(&mut self);
}
