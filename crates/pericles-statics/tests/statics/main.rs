//! Static equilibrium: iteration counts, closed forms, reference values, energy balance.

mod bodies;
mod breaking;
mod control;
mod divided;
mod equilibrium;
mod events;
mod modes;
mod progress;
mod relaxation;
mod solver;
