//! Decks that several tests share.
#![allow(dead_code)] // each test uses its part

/// A right deck of a wave on a ring.
pub const WAVE: &str = r#"[body]
shape = "bar"
length = 20
origin = -10
spacing = 0.1
periodic = true

[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon = "infinite"
influence = { function = "gaussian", length = 1, acts_on = "displacement" }
bonds = "spectral"

[exact]
solution = "nonlocal-pulse"
width = 1
amplitude = 1
window = 3

[time]
end = 3
dt = 0.5
scheme = "trigonometric"
"#;
