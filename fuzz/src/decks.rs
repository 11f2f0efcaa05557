//! Small decks for targets that need a body: one of every scheme, operator and boundary that keeps a state.

macro_rules! decks {
    ($($name:literal),* $(,)?) => { &[$(include_str!(concat!("../seeds/model/", $name, ".toml"))),*] };
}

/// Their texts.
pub const ALL: &[&str] = decks![
    "list-verlet",
    "grid-rk4",
    "list-rk4-mts",
    "grid-rk3-mts",
    "list-respa",
    "list-anderson",
    "dormand-prince",
    "midpoint",
    "trigonometric",
    "discrete-gradient",
    "ends-direct",
    "ends-blocked",
    "ends-exponentials",
    "surface-rk4",
    "surface-respa",
];
