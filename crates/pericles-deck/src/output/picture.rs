//! `[[output.picture]]`: pictures of a field.

use pericles::observe::{Field, Schedule};
use pericles::space::Point;
use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use super::{check_component, field_component, unit_of, whole_field};
use crate::component::Variables;
use crate::quantity::Quantity;
use crate::range::{Range, from_to};
use crate::reader::{Item, Table};

/// Pictures of a field. Any number of tables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Variables)]
pub struct Picture {
    /// Field to draw: a component, the magnitude of a vector or the norm of a tensor.
    #[serde(with = "crate::form")]
    #[deck(with = whole_field)]
    pub field: Field,
    /// Component of a vector or tensor; none for its magnitude.
    #[serde(default)]
    #[deck(
        flatten,
        keys(),
        with = field_component,
        scope = (field, scope),
        check = check_component
    )]
    pub component: Option<usize>,
    /// Magnification of displacements.
    #[deck(range = at_least(0.0).described("a number of at least 0"), default = 1.0)]
    pub scale: f64,
    /// Lowest and highest value of the colour bar. Default: the range of the field.
    #[serde(default)]
    #[deck(with = range, scope = unit_of(field))]
    pub range: Option<[f64; 2]>,
    /// 3D: direction from which the body is seen. Default: from the front, right and above.
    #[serde(default)]
    #[deck(with = view, forbid_if(is_plane(scope), "it requires a 3D body"))]
    pub view: Option<Point>,
    /// Format, size and style.
    #[serde(default)]
    #[deck(flatten)]
    pub look: PictureLook,
    /// Also write one animated PNG of all pictures at the end, ten frames per second. All frames then show the bounding
    /// box of the undeformed body plus a margin of 10 %.
    #[deck(
        default = false,
        forbid_if(is_vector(look), "an animation consists of PNG files")
    )]
    pub animation: bool,
    /// Schedule.
    #[serde(with = "crate::form")]
    #[deck(flatten, scope = Schedule::Count(4))]
    pub schedule: Schedule,
}

/// File formats of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "picture format")]
pub enum PictureFormat {
    /// Pixels.
    #[default]
    Png,
    /// Vector graphics for the web.
    Svg,
    /// Vector graphics for print.
    Pdf,
}

impl PictureFormat {
    /// Returns the ending of file names.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }
}

/// Colour maps of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "colour map")]
pub enum PictureColours {
    /// From dark blue over green to yellow.
    Viridis,
    /// From blue over light grey to red.
    CoolToWarm,
    /// From dark to light grey.
    Grey,
}

/// Format, size and style of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Variables, verify = require_pixels)]
pub struct PictureLook {
    /// File format: pixels (`png`) or vector graphics (`svg`, `pdf`), in which the cells of the body are an image. HTML
    /// reports and animations need `png`.
    #[deck(default)]
    pub format: PictureFormat,
    /// Width on paper, such as "88 mm" for a column of a journal. Default: 1200 pixels with text in proportion.
    ///
    /// In m.
    #[serde(default)]
    #[deck(quantity = Length, range = POSITIVE)]
    pub width: Option<f64>,
    /// With `width`: size of all text, 4 to 24 points, such as "8 pt". Lines are in proportion to it, 0.5 points at
    /// 8 points.
    ///
    /// In points of 1/72 inch.
    #[deck(
        flatten,
        key = "font_size",
        with = font_size,
        default = 8.0,
        forbid_if(width == Some(&None), NEEDS_WIDTH)
    )]
    pub font_size: f64,
    /// With `width`: pixels per inch of paper.
    #[deck(
        range = RESOLUTIONS,
        default = 300.0,
        forbid_if(width == Some(&None), NEEDS_WIDTH)
    )]
    pub dpi: f64,
    /// Colours from low to high values. `viridis`: dark blue over green to yellow; `cool-to-warm`: blue over light grey to
    /// red; `grey`: dark to light grey. Default: `cool-to-warm` for values of both signs, otherwise `viridis`.
    #[serde(default)]
    pub colour_map: Option<PictureColours>,
    /// Region of the body shown. Default: the whole body.
    ///
    /// Lowest and highest coordinates, m.
    #[serde(default)]
    #[deck(with = crop)]
    pub crop: Option<[Point; 2]>,
    /// Draw the edges of the cells of 2D and 3D bodies.
    #[deck(default = false, forbid_if(scope.dimension == Some(1), "it requires a 2D or 3D body"))]
    pub edges: bool,
    /// Whether title and time are drawn above the picture.
    #[deck(default = true)]
    pub title: bool,
    /// Background of the picture.
    ///
    /// Whether it is transparent instead of white.
    #[deck(flatten, key = "background", with = background, default = false)]
    pub transparent: bool,
}

impl Default for PictureLook {
    fn default() -> Self {
        Self {
            format: PictureFormat::default(),
            width: None,
            font_size: Self::default_font_size(),
            dpi: Self::default_dpi(),
            colour_map: None,
            crop: None,
            edges: Self::default_edges(),
            title: Self::default_title(),
            transparent: Self::default_transparent(),
        }
    }
}

/// A point of 1/72 inch, m.
const POINT: f64 = 25.4e-3 / 72.0;

/// Why the size of text on paper has no meaning.
const NEEDS_WIDTH: &str = "it requires `width`, such as width = \"88 mm\"";

/// Range of resolutions.
const RESOLUTIONS: Range =
    from_to(72.0, 2400.0).described("a number of pixels per inch from 72 to 2400");

fn is_plane(scope: Variables) -> bool {
    matches!(scope.dimension, Some(1 | 2))
}

fn is_vector(look: Option<&PictureLook>) -> bool {
    look.is_some_and(|look| look.format != PictureFormat::Png)
}

/// Requires a picture of given width to have a useful number of pixels.
fn require_pixels(table: &Table<'_>, look: &PictureLook, _: Variables) -> Option<()> {
    let (Some(item), Some(width)) = (table.optional("width"), look.width) else {
        return Some(());
    };
    let dpi = look.dpi;
    let [least, most] = [200.0, 16_000.0].map(|pixels| pixels / dpi * 25.4e-3);
    if (least..=most).contains(&width) {
        return Some(());
    }
    item.out_of_range(&format!(
        "{:.1} mm to {:.0} mm at {dpi} pixels per inch",
        1e3 * least,
        1e3 * most
    ));
    None
}

/// Reads the direction from which a 3D body is seen.
fn view(item: &Item<'_>, scope: Variables) -> Option<Point> {
    let view = item
        .vector(Quantity::Number, Some(3))
        .filter(|_| scope.dimension.is_some())?;
    if view == [0.0; 3] {
        item.out_of_range("a nonzero vector");
        return None;
    }
    Some(view)
}

fn background(table: &Table<'_>, _: Variables) -> Option<bool> {
    let backgrounds = [("white", false), ("transparent", true)];
    table.choice_or_first("background", "background", &backgrounds)
}

/// Reads a size of text, returned in points.
fn font_size(table: &Table<'_>, _: Variables) -> Option<f64> {
    let Some(item) = table.optional("font_size") else {
        let usual = PictureLook::default_font_size();
        table.record("font_size", format!("{usual} pt"));
        return Some(usual);
    };
    let metres = item.within(
        Quantity::Length,
        "a size of text from \"4 pt\" to \"24 pt\"",
        |size| (3.999..=24.001).contains(&(size / POINT)),
    )?;
    // Sizes are given with a few digits.
    Some((1e6 * metres / POINT).round() / 1e6)
}

/// Reads the lowest and the highest coordinates of a region.
fn crop(item: &Item<'_>, scope: Variables) -> Option<[Point; 2]> {
    let table = item.table()?;
    table.describe("min", "Lower corner of the region.");
    table.describe("max", "Upper corner of the region.");
    let dimension = scope.dimension;
    let corner = |key| {
        let item = table.required(key)?;
        item.vector(Quantity::Length, dimension)
            .map(|corner| (item, corner))
    };
    let (low, high) = (corner("min"), corner("max"));
    table.finish();
    let ((_, low), (item, high)) = (low?, high?);
    let axes = dimension.unwrap_or(3);
    if (0..axes).any(|c| low[c] >= high[c]) {
        item.out_of_range("an upper corner `max` above the lower corner `min` along every axis");
        return None;
    }
    Some([low, high])
}

fn range(item: &Item<'_>, quantity: Quantity) -> Option<[f64; 2]> {
    let ends = item.exactly(2, "two numbers [lowest, highest]")?;
    let (low, high) = (ends[0].quantity(quantity), ends[1].quantity(quantity));
    let (low, high) = (low?, high?);
    if low < high {
        return Some([low, high]);
    }
    item.out_of_range("two numbers [lowest, highest], the first smaller");
    None
}
