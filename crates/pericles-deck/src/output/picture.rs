//! `[[output.picture]]`: pictures of a field.

use pericles::observe::{Field, Schedule};
use pericles::space::Point;
use serde::{Deserialize, Serialize};

use super::{field, quantity, schedule};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// A picture of a field on the points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// The field.
    #[serde(with = "crate::form")]
    pub field: Field,
    /// Component of a vector or tensor; none for its magnitude.
    #[serde(default)]
    pub component: Option<usize>,
    /// Magnification of displacements.
    pub scale: f64,
    /// Lowest and highest value of the colour bar; none for the range of the field.
    #[serde(default)]
    pub range: Option<[f64; 2]>,
    /// Direction from which a 3D body is seen; none for the front, right and above.
    #[serde(default)]
    pub view: Option<Point>,
    /// Whether an animation of all pictures is written at the end.
    pub animation: bool,
    /// Schedule.
    #[serde(with = "crate::form")]
    pub schedule: Schedule,
    /// Format, size and style.
    #[serde(default)]
    pub look: PictureLook,
}

/// File formats of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PictureColours {
    /// From dark blue over green to yellow.
    Viridis,
    /// From blue over light grey to red.
    CoolToWarm,
    /// From dark to light grey.
    Grey,
}

/// Format, size and style of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureLook {
    /// File format.
    pub format: PictureFormat,
    /// Width on paper, m; none for 1200 pixels.
    #[serde(default)]
    pub width: Option<f64>,
    /// Size of text on paper, points of 1/72 inch.
    pub font_size: f64,
    /// Pixels per inch of paper.
    pub dpi: f64,
    /// Colour map; none for the one that suits the values.
    #[serde(default)]
    pub colour_map: Option<PictureColours>,
    /// Lowest and highest coordinates of the region shown, m; none for the whole body.
    #[serde(default)]
    pub crop: Option<[Point; 2]>,
    /// Whether title and time are drawn above the picture.
    pub title: bool,
    /// Whether the background is transparent instead of white.
    pub transparent: bool,
}

impl Default for PictureLook {
    fn default() -> Self {
        Self {
            format: PictureFormat::default(),
            width: None,
            font_size: 8.0,
            dpi: 300.0,
            colour_map: None,
            crop: None,
            title: true,
            transparent: false,
        }
    }
}

/// A point of 1/72 inch, m.
const POINT: f64 = 25.4e-3 / 72.0;

/// Reads a picture.
pub(super) fn read(table: Table<'_>, dimension: Option<usize>) -> Option<Picture> {
    let field = table
        .required("field")
        .and_then(|item| field(&item, dimension));
    let scale = table.or("scale", 1.0, |item| {
        item.within(Quantity::Number, "a number of at least 0", |scale| {
            scale >= 0.0
        })
    });
    let quantity = field.map_or(Quantity::Number, |(field, _)| quantity(field));
    let range = table.maybe("range", |item| range(&item, quantity));
    let view = if dimension == Some(3) {
        table.maybe("view", |item| {
            let view = item.vector(Quantity::Number, Some(3))?;
            if view == [0.0; 3] {
                item.out_of_range("a nonzero vector");
                return None;
            }
            Some(view)
        })
    } else {
        if dimension.is_some() {
            table.forbid("view", "it requires a 3D body");
        }
        Some(None)
    };
    let look = look(&table, dimension);
    let animation = match look.as_ref().map(|look| look.format) {
        Some(PictureFormat::Svg | PictureFormat::Pdf) => {
            table.forbid("animation", "an animation consists of PNG files");
            Some(false)
        }
        _ => table.or("animation", false, |item| item.boolean()),
    };
    let schedule = schedule(&table, Schedule::Count(4));
    table.finish();
    let (field, component) = field?;
    Some(Picture {
        field,
        component,
        scale: scale?,
        range: range?,
        view: view?,
        animation: animation?,
        schedule: schedule?,
        look: look?,
    })
}

fn look(table: &Table<'_>, dimension: Option<usize>) -> Option<PictureLook> {
    let usual = PictureLook::default();
    let formats = [
        ("png", PictureFormat::Png),
        ("svg", PictureFormat::Svg),
        ("pdf", PictureFormat::Pdf),
    ];
    let format = table.choice_or_first("format", "picture format", &formats);
    let item = table.optional("width");
    let (width, font_size, dpi) = match &item {
        None => {
            let needs = "it requires `width`, such as width = \"88 mm\"";
            table.forbid("font_size", needs);
            table.forbid("dpi", needs);
            (Some(None), Some(usual.font_size), Some(usual.dpi))
        }
        Some(item) => (
            item.positive(Quantity::Length).map(Some),
            match table.optional("font_size") {
                Some(item) => font_size(&item),
                None => {
                    table.record("font_size", format!("{} pt", usual.font_size));
                    Some(usual.font_size)
                }
            },
            table.or("dpi", usual.dpi, |item| {
                item.within(
                    Quantity::Number,
                    "a number of pixels per inch from 72 to 2400",
                    |dpi| (72.0..=2400.0).contains(&dpi),
                )
            }),
        ),
    };
    if let (Some(item), Some(Some(width)), Some(dpi)) = (&item, width, dpi) {
        let [least, most] = [200.0, 16_000.0].map(|pixels| pixels / dpi * 25.4e-3);
        if !(least..=most).contains(&width) {
            item.out_of_range(&format!(
                "{:.1} mm to {:.0} mm at {dpi} pixels per inch",
                1e3 * least,
                1e3 * most
            ));
            return None;
        }
    }
    let maps = [
        ("viridis", PictureColours::Viridis),
        ("cool-to-warm", PictureColours::CoolToWarm),
        ("grey", PictureColours::Grey),
    ];
    let colour_map = table.maybe("colour_map", |item| item.choice("colour map", &maps));
    let crop = table.maybe("crop", |item| crop(&item, dimension));
    let title = table.or("title", true, |item| item.boolean());
    let backgrounds = [("white", false), ("transparent", true)];
    let transparent = table.choice_or_first("background", "background", &backgrounds);
    Some(PictureLook {
        format: format?,
        width: width?,
        font_size: font_size?,
        dpi: dpi?,
        colour_map: colour_map?,
        crop: crop?,
        title: title?,
        transparent: transparent?,
    })
}

/// Reads a size of text, returned in points.
fn font_size(item: &Item<'_>) -> Option<f64> {
    let metres = item.within(
        Quantity::Length,
        "a size of text from \"4 pt\" to \"24 pt\"",
        |size| (3.999..=24.001).contains(&(size / POINT)),
    )?;
    // Sizes are given with a few digits.
    Some((1e6 * metres / POINT).round() / 1e6)
}

/// Reads the lowest and the highest coordinates of a region.
fn crop(item: &Item<'_>, dimension: Option<usize>) -> Option<[Point; 2]> {
    let table = item.table()?;
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
