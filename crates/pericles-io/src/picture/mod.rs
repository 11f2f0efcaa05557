//! Pictures as PNG, SVG or PDF files: fields on the points of a body, and charts of curves.
//!
//! * [`FieldPicture`]: every point as a filled cell at its displaced position, coloured by a scalar, with
//!   colour bar, time stamp and suitable length unit. Cells are [`Polygons`] or, for points without a mesh,
//!   squares and cubes. A plane body has axes; a solid is shown in parallel projection along a chosen
//!   direction, with hidden faces removed; a bar is drawn as a curve over its length.
//! * [`LineChart`]: named curves, with optional markers, dashes and logarithmic axes; a [`Backdrop`] adds a
//!   colour map below them.
//! * [`write_animation`]: several pictures as an animation in one file.
//!
//! Quantities are given in SI units and shown with a suitable SI prefix. The bytes of a picture depend on its
//! data alone. Text uses the embedded font DejaVu Sans; lines and glyphs are antialiased; no system fonts or
//! libraries are used.
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
mod category;
mod clip;
mod colour;
mod curve;
mod drawing;
mod extent;
mod field;
mod frame;
mod legend;
mod line_chart;
mod palette;
mod pdf;
mod plane;
mod polygon;
mod projection;
mod raster;
mod scene;
mod solid;
mod style;
mod surface;
mod svg;
mod text;
mod ticks;
mod write;

pub use animation::write_animation;
pub use backdrop::Backdrop;
pub use colour::ColourMap;
pub use curve::{Axis, Curve};
pub use extent::Extent;
pub use field::{CellSize, FieldPicture};
pub use line_chart::LineChart;
pub use pericles::units::quantity;
pub use polygon::{Polygon, Polygons};
pub use style::{PictureStyle, Print};
