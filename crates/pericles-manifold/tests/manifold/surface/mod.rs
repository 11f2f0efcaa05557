//! Surfaces and distances along them: closed forms, independent routes, convergence.

mod geodesics;
mod oracle;
mod shapes;
