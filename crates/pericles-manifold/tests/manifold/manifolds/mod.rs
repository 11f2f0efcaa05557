//! Peridynamics on surfaces, with implicit schemes.

mod breaking;
mod modes;
mod observe;
mod operator;
mod rejected;
mod schemes;
mod sphere;
mod zones;
