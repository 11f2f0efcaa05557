//! Pictures as PNG or SVG files: a field on the points of a body, and charts of curves.
//!
//! * [`FieldPicture`]: every point as a filled cell at its displaced place, coloured by a scalar, with colour bar, time stamp and
//!   lengths in a fitting unit. A body in the plane has axes; a body in space is seen in parallel projection along a chosen
//!   direction, nearer cells in front; a bar is drawn as a curve over its length.
//! * [`LineChart`]: named curves, with markers, dashes and logarithmic axes where wanted; a [`Backdrop`] puts a map of numbers beneath them.
//! * [`write_animation`]: pictures one after another in one file.
//!
//! Quantities come in SI units and are shown with the SI prefix that suits their size. The bytes of a picture depend on its data
//! alone. Text is set in the font inside the crate (DejaVu Sans), lines and glyphs are antialiased; nothing of the system is used.
//!
//! ```
//! use pericles_io::{Axis, CellSize, ColourMap, Curve, FieldPicture, LineChart};
//! let folder = tempfile::tempdir().unwrap();
//! let x = [0.0, 1e-3, 0.0, 1e-3, 0.0, 0.0, 1e-3, 1e-3]; // four points: x of all, then y of all
//! let damage = [0.0, 0.2, 0.4, 1.0];
//! FieldPicture::new(2, &x, &damage, CellSize::Uniform(1e-3))
//!     .label("Damage", "")
//!     .range(0.0, 1.0)
//!     .time(46e-6)
//!     .write(folder.path().join("damage.png"))
//!     .unwrap();
//!
//! let (t, energy) = ([0.0, 1e-6, 2e-6], [0.0, 0.3, 0.4]);
//! LineChart::new(Axis::new("time", "s"), Axis::new("energy", "J"))
//!     .curve(Curve::line("kinetic", &t, &energy))
//!     .write(folder.path().join("energy.png"))
//!     .unwrap();
//! ```

mod animation;
mod backdrop;
mod bitmap;
mod clip;
mod colour;
mod curve;
mod drawing;
mod field;
mod frame;
mod line_chart;
mod plane;
mod raster;
mod scene;
mod solid;
mod svg;
mod text;
mod ticks;
mod write;

pub use animation::write_animation;
pub use backdrop::Backdrop;
pub use colour::ColourMap;
pub use curve::{Axis, Curve};
pub use field::{CellSize, FieldPicture};
pub use line_chart::LineChart;
pub use pericles::units::quantity;
