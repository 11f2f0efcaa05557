//! Single-rate and multirate Runge–Kutta, r-RESPA, and their requirements on forces. Errors compared
//! with another code on more bodies are in the studies `multi-time-step/…` of the program.

mod bodies;
mod conservation;
mod cracks;
mod equality;
mod orders;
mod rejections;
mod schemes;
mod stability;
mod two_grids;
mod zones;
