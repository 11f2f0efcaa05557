//! Arguments of `plot`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use pericles_deck::PictureFormat;
use pericles_io::{ColourMap, PictureStyle, Print};

use super::values::{Direction, Range, direction, range, tolerance};
use crate::error::CliError;
use crate::frames::Frames;

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// The output folder of a run
    pub(crate) dir: PathBuf,
    /// Comma-separated fields, such as Damage or Velocity_y
    #[arg(long = "field", value_name = "NAMES", value_delimiter = ',')]
    pub(crate) fields: Vec<String>,
    /// Comma-separated table columns, such as kinetic_energy
    #[arg(long = "history", value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) columns: Vec<String>,
    /// Horizontal axis of a chart: a column of the tables; of a parameter sweep one of its keys [default: the first key]
    #[arg(long, value_name = "COLUMN", requires = "y", conflicts_with_all = ["fields", "columns", "terminal"])]
    pub(crate) x: Option<String>,
    /// Comma-separated vertical axes: columns of any table, drawn at the times that its table and that of --x have in
    /// common; of a parameter sweep scalars of its runs
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',', conflicts_with_all = ["fields", "columns", "terminal"])]
    pub(crate) y: Vec<String>,
    /// Output times: all, first, last, or the nearest to times such as "20 us" or 1e-5,2e-5 [default: last; all for an
    /// animation]
    #[arg(long, value_name = "TIMES")]
    pub(crate) time: Option<Frames>,
    /// Range of the colour bar in SI units, such as 0:1 or --range=-2e-3:2e-3
    #[arg(long, value_name = "LOW:HIGH", value_parser = range)]
    pub(crate) range: Option<Range>,
    /// View direction for 3D bodies, from the body to the viewer, such as 1,-2,1
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub(crate) view: Option<Direction>,
    /// Scale factor for displacements
    #[arg(long, value_name = "FACTOR", value_parser = tolerance)]
    pub(crate) scale: Option<f64>,
    #[command(flatten)]
    pub(crate) style: StyleArgs,
    /// The file format
    #[arg(long, value_enum, default_value_t = Format::Png)]
    pub(crate) format: Format,
    /// Write one animated PNG per field
    #[arg(long, conflicts_with = "terminal")]
    pub(crate) animation: bool,
    /// Show terminal plots of the time histories and write no files
    #[arg(long, conflicts_with = "fields")]
    pub(crate) terminal: bool,
    /// Folder for the pictures; existing pictures of the same name are replaced [default: plots in the output folder]
    #[arg(long, value_name = "FOLDER")]
    pub(crate) out: Option<PathBuf>,
}

/// Size and style of pictures. Without an option, pictures of a field have the style of the deck's pictures of this field.
#[derive(Debug, Args)]
pub(crate) struct StyleArgs {
    /// Width: pixels from 200 to 16000, or a length on paper such as 88mm [default: 1200]
    #[arg(long, value_name = "WIDTH", value_parser = width)]
    width: Option<Width>,
    /// Size of all text, from 4pt to 24pt, for a width on paper; line widths are in proportion to it [default: 8pt]
    #[arg(long, value_name = "SIZE", value_parser = font_size)]
    font_size: Option<f64>,
    /// Pixels per inch, from 72 to 2400, for a width on paper [default: 300]
    #[arg(long, value_name = "PIXELS", value_parser = dpi)]
    dpi: Option<f64>,
    /// The colour map [default: viridis, cool-to-warm for values of both signs]
    #[arg(long, value_enum)]
    colour_map: Option<Colours>,
    /// Region of the body shown: a range of coordinates for each axis, such as 10mm:30mm,0:20mm
    #[arg(long, value_name = "RANGES", value_parser = crop, allow_hyphen_values = true)]
    crop: Option<Crop>,
    /// Draw the edges of the cells
    #[arg(long)]
    edges: bool,
    /// Leave out title and time
    #[arg(long)]
    no_title: bool,
    /// The background
    #[arg(long, value_enum)]
    background: Option<Background>,
}

/// The width of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Width {
    Pixels(u32),
    /// On paper, m.
    Length(f64),
}

/// Ranges of coordinates, m.
#[derive(Debug, Clone, PartialEq)]
struct Crop(Vec<[f64; 2]>);

/// Colour maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Colours {
    /// From dark blue over green to yellow
    Viridis,
    /// From blue over light grey to red
    CoolToWarm,
    /// From dark to light grey
    Grey,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Background {
    White,
    Transparent,
}

impl StyleArgs {
    /// Returns the style of a picture: `own`, changed by the options.
    ///
    /// # Errors
    /// A size of text or a resolution without a width on paper.
    pub(crate) fn style(&self, own: PictureStyle) -> Result<PictureStyle, CliError> {
        let mut style = own;
        let sizes_text = self.font_size.is_some() || self.dpi.is_some();
        let before = own.print.unwrap_or_default();
        let print = Print {
            font_size: self.font_size.unwrap_or(before.font_size),
            dpi: self.dpi.unwrap_or(before.dpi),
        };
        // The width on paper of the deck's picture, m.
        let paper = own
            .print
            .map(|print| f64::from(own.width) / print.dpi * 25.4e-3);
        match (self.width, paper) {
            (Some(Width::Length(width)), _) | (None, Some(width)) => {
                let PictureStyle { width, print, .. } = PictureStyle::printed(width, print);
                style = PictureStyle {
                    width,
                    print,
                    ..own
                };
            }
            _ if sizes_text => return Err(CliError::NoPaperWidth),
            (Some(Width::Pixels(width)), _) => {
                style.width = width;
                style.print = None;
            }
            (None, None) => {}
        }
        if let Some(problem) = style.problem() {
            return Err(CliError::PictureWidth { problem });
        }
        style.colours = match self.colour_map {
            None => own.colours,
            Some(Colours::Viridis) => Some(ColourMap::Viridis),
            Some(Colours::CoolToWarm) => Some(ColourMap::Diverging),
            Some(Colours::Grey) => Some(ColourMap::Grey),
        };
        style.edges |= self.edges;
        style.titled &= !self.no_title;
        if let Some(background) = self.background {
            style.transparent = background == Background::Transparent;
        }
        Ok(style)
    }

    /// Returns the lowest and highest coordinates of the region shown of a body of `dimension` dimensions.
    ///
    /// # Errors
    /// Another number of ranges than dimensions.
    pub(crate) fn crop(&self, dimension: usize) -> Result<Option<[[f64; 3]; 2]>, CliError> {
        let Some(Crop(ranges)) = &self.crop else {
            return Ok(None);
        };
        if ranges.len() != dimension {
            return Err(CliError::CropRanges {
                given: ranges.len(),
                dimension,
            });
        }
        let corner =
            |end: usize| std::array::from_fn(|c| ranges.get(c).map_or(0.0, |range| range[end]));
        Ok(Some([corner(0), corner(1)]))
    }
}

/// Formats of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Raster image
    Png,
    /// Vector graphics; the cells of a body are an image
    Svg,
    /// Vector graphics for print; the cells of a body are an image
    Pdf,
}

impl Format {
    /// Returns the file extension.
    pub(crate) fn ending(self) -> &'static str {
        let format = match self {
            Self::Png => PictureFormat::Png,
            Self::Svg => PictureFormat::Svg,
            Self::Pdf => PictureFormat::Pdf,
        };
        format.ending()
    }
}

/// Parses a number of pixels or a length with a unit.
fn width(text: &str) -> Result<Width, String> {
    let allowed = "expected a number of pixels from 200 to 16000, or a length such as 88mm";
    if let Ok(pixels) = text.trim().parse::<u32>() {
        let right = (200..=16_000).contains(&pixels);
        return right
            .then_some(Width::Pixels(pixels))
            .ok_or_else(|| allowed.into());
    }
    if text.trim().parse::<f64>().is_ok() {
        return Err(allowed.into());
    }
    let metres = pericles_deck::metres(text).filter(|metres| *metres > 0.0);
    metres.map(Width::Length).ok_or_else(|| allowed.into())
}

/// Parses a size of text in points.
fn font_size(text: &str) -> Result<f64, String> {
    let trimmed = text.trim();
    let number = trimmed.strip_suffix("pt").unwrap_or(trimmed).trim().parse();
    let size = number
        .ok()
        .filter(|size: &f64| Print::FONT_SIZES.contains(size));
    size.ok_or_else(|| "expected a size in points from 4pt to 24pt, such as 8pt".into())
}

/// Parses a resolution.
fn dpi(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|dpi: &f64| Print::RESOLUTIONS.contains(dpi));
    number.ok_or_else(|| "expected a number of pixels per inch from 72 to 2400".into())
}

/// Parses ranges of coordinates, such as `10mm:30mm,0:20mm`.
fn crop(text: &str) -> Result<Crop, String> {
    let range = |text: &str| {
        let (low, high) = text.split_once(':')?;
        let (low, high) = (pericles_deck::metres(low)?, pericles_deck::metres(high)?);
        (low < high).then_some([low, high])
    };
    let ranges: Option<Vec<[f64; 2]>> = text.split(',').map(range).collect();
    ranges.map(Crop).ok_or_else(|| {
        "expected a range LOW:HIGH with LOW < HIGH for each axis, such as 10mm:30mm,0:20mm".into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_parsed() {
        assert_eq!(width("400"), Ok(Width::Pixels(400)));
        assert_eq!(width("88mm"), Ok(Width::Length(88e-3)));
        for wrong in ["100", "0.5", "-88mm", "88", "wide", "0mm"] {
            assert!(width(wrong).is_err(), "{wrong}");
        }
        assert_eq!(font_size("8pt"), Ok(8.0));
        assert_eq!(font_size("9.5"), Ok(9.5));
        assert!(font_size("3pt").is_err() && font_size("8mm").is_err());
        assert_eq!(
            crop("-1mm:2mm,0:3"),
            Ok(Crop(vec![[-1e-3, 2e-3], [0.0, 3.0]]))
        );
        assert!(crop("2mm:1mm").is_err());
    }
}
