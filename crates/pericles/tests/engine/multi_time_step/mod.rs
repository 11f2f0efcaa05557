//! Runge–Kutta with one and with two time steps, r-RESPA, and what they ask of operators. Errors against the numbers of another code on more bodies are the studies
//! `multi-time-step/…` of the program.

mod bodies;
mod conservation;
mod cracks;
mod equality;
mod orders;
mod refusals;
mod schemes;
mod stability;
mod two_grids;
mod zones;
