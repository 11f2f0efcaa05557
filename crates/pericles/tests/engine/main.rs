//! Tests of the engine as one program, so that generic loops are compiled once for all of them.

mod arguments;
mod batches;
mod builder;
#[path = "../common/mod.rs"]
mod common;
mod divided;
mod divided_bonds;
mod divided_checkpoints;
mod divided_zones;
mod division;
mod dynamics;
mod ends;
mod fragments;
mod grid;
mod guard;
mod horizons;
mod implicit;
mod list;
mod multi_time_step;
mod periodic;
mod properties;
mod round_trip;
mod single_precision;
mod state_based;
mod statics;
mod strength;
mod strength_surface;
mod surface_correction;
mod two_pass;
mod values;
