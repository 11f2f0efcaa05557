//! Surfaces and geodesic distances: closed forms, independent implementations, convergence.

mod geodesics;
mod oracle;
mod shapes;
