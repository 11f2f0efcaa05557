//! Size and style of a picture.

use super::bitmap::SIZES;
use super::colour::ColourMap;

/// Points per inch.
pub(super) const POINTS: f64 = 72.0;

/// Millimetres per inch.
const MILLIMETRES: f64 = 25.4;

/// Size and style of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureStyle {
    /// Width in pixels, 200 to 16 000.
    pub width: u32,
    /// Size of text and resolution in print; `None` for text in proportion to the width.
    pub print: Option<Print>,
    /// Whether title and time are drawn above the picture.
    pub titled: bool,
    /// Whether the background is transparent instead of white.
    pub transparent: bool,
    /// Whether the edges of cells are drawn.
    pub edges: bool,
    /// Colour map of fields; `None` for the one that suits the values.
    pub colours: Option<ColourMap>,
}

/// Sizes of a printed picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Print {
    /// Size of all text (em), in points of 1/72 inch; lines are in proportion to it, 0.5 points at 8 points.
    pub font_size: f64,
    /// Pixels per inch.
    pub dpi: f64,
}

impl Default for Print {
    /// Text of 8 points at 300 pixels per inch.
    fn default() -> Self {
        Self {
            font_size: 8.0,
            dpi: 300.0,
        }
    }
}

impl Print {
    /// Allowed sizes of text, in points.
    pub const FONT_SIZES: std::ops::RangeInclusive<f64> = 4.0..=24.0;
    /// Allowed resolutions, in pixels per inch.
    pub const RESOLUTIONS: std::ops::RangeInclusive<f64> = 72.0..=2400.0;

    /// Returns the number of pixels of a length in points.
    pub(super) fn pixels(&self, points: f64) -> f64 {
        points / POINTS * self.dpi
    }
}

impl Default for PictureStyle {
    /// A picture of 1200 pixels with a white background.
    fn default() -> Self {
        Self {
            width: 1200,
            print: None,
            titled: true,
            transparent: false,
            edges: false,
            colours: None,
        }
    }
}

impl PictureStyle {
    /// Returns the style of a picture with a width in pixels.
    pub fn of_width(width: u32) -> Self {
        Self {
            width,
            ..Self::default()
        }
    }

    /// Returns the style of a picture with a width in metres on paper.
    pub fn printed(width: f64, print: Print) -> Self {
        let pixels = (1e3 * width / MILLIMETRES * print.dpi).round();
        Self {
            // Widths beyond the limit are rejected when the picture is drawn.
            width: pixels.clamp(0.0, f64::from(u32::MAX)) as u32,
            print: Some(print),
            ..Self::default()
        }
    }

    /// Returns why the style cannot be used; `None` if it can.
    pub fn problem(&self) -> Option<String> {
        let (least, most) = (SIZES.start(), SIZES.end());
        if SIZES.contains(&self.width) {
            return None;
        }
        let width = self.width;
        Some(match self.print {
            None => format!("the width is {width} pixels; allowed: {least} to {most}"),
            Some(Print { dpi, .. }) => {
                let length = |pixels: u32| f64::from(pixels) / dpi * MILLIMETRES;
                format!(
                    "the width is {:.1} mm; allowed at {dpi} pixels per inch: {:.1} mm to {:.0} mm",
                    length(width),
                    length(*least),
                    length(*most)
                )
            }
        })
    }

    /// Returns the length of a pixel in points on paper, 1/300 inch unless the resolution is given.
    pub(super) fn pixel(&self) -> f64 {
        POINTS / self.print.unwrap_or_default().dpi
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_of_a_journal_has_its_width_and_text_in_pixels() {
        let print = Print {
            font_size: 8.0,
            dpi: 600.0,
        };
        let style = PictureStyle::printed(88e-3, print);
        assert_eq!(style.width, 2079);
        assert_eq!(style.problem(), None);
        assert!((print.pixels(8.0) - 66.67).abs() < 0.01);
        assert!((f64::from(style.width) * style.pixel() - 88.0 / 25.4 * 72.0).abs() < 0.1);
        let narrow = PictureStyle::printed(5e-3, print).problem().unwrap();
        assert!(
            narrow.contains("5.0 mm; allowed at 600 pixels per inch: 8.5 mm"),
            "{narrow}"
        );
    }
}
