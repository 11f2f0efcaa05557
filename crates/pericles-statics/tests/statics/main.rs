//! Static equilibrium: iteration counts, closed forms, reference values, balances.

mod bodies;
mod breaking;
mod equilibrium;
mod modes;
mod solver;
