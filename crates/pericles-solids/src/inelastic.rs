//! Linear peridynamic solids with viscous or plastic shear.
//!
//! | module | contents |
//! |---|---|
//! | `law` | constants of viscosity and plasticity |
//! | `update` | viscous relaxation over a step, return to the yield surface |
//! | `point` | sums over the bonds of a point |
//! | `force_state` | the material as a [`Solid`](crate::solid::Solid) |
//! | `body` | bodies of elastic, viscous and plastic materials |

mod body;
mod force_state;
mod law;
mod point;
mod update;

pub use body::InelasticSolidBody;
pub use force_state::InelasticSolid;
pub use law::{Inelasticity, MOST_TERMS, ViscousTerm, Yield};
pub use point::InelasticShape;
