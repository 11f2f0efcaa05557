//! Influence functions α(r) and their moments.
//!
//! The pair force density of a bond of length r and stretch s is c α(r) s along the bond. α contains no modulus:
//! the constant c follows from the moments m_q = ∫₀^δ α(r) r^q dr (or from lattice sums), so that every function
//! gives the same modulus. Lengths are in metres; α may have any unit, which c absorbs.

mod caps;
mod classes;
mod influence;
mod moments;
mod quadrature;

pub use caps::CapIntegrals;
pub use classes::{ClassOffset, ClassTable, class_of, multiplicity};
pub use influence::{ActsOn, Influence, InfluenceFunction};
