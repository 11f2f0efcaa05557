//! Peridynamics on surfaces, with implicit schemes.

mod breaking;
mod modes;
mod observe;
mod operator;
mod refused;
mod schemes;
mod sphere;
mod zones;
