//! Text in the embedded font.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, GlyphId, PxScale, ScaleFont};

use super::bitmap::{Bitmap, Rgb};

/// The font file.
pub(super) const FONT_FILE: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    // The bytes are part of the program: this can fail only in a broken build, which the tests detect.
    FontRef::try_from_slice(FONT_FILE).expect("the embedded font is valid")
});

/// Half the height of capitals in DejaVu Sans relative to its size (1493 of 2048 units).
pub(super) const HALF_CAPITAL: f64 = 0.3645;

/// Which end of the text is at the given position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    Start,
    Middle,
    End,
}

impl Align {
    /// Returns the part of the text before the given position.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

/// Direction of the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Right,
    Up,
}

/// Style of a text.
#[derive(Debug, Clone, Copy)]
pub(super) struct Style {
    /// Font size (em) in pixels.
    pub(super) size: f64,
    pub(super) align: Align,
    pub(super) direction: Direction,
    pub(super) colour: Rgb,
}

impl Style {
    pub(super) fn new(size: f64, align: Align) -> Self {
        Self {
            size,
            align,
            direction: Direction::Right,
            colour: super::bitmap::INK,
        }
    }

    pub(super) fn up(mut self) -> Self {
        self.direction = Direction::Up;
        self
    }

    pub(super) fn colour(mut self, colour: Rgb) -> Self {
        self.colour = colour;
        self
    }

    /// Reduces the size if the text would be longer than `room`.
    pub(super) fn fitted(mut self, text: &str, room: f64) -> Self {
        let length = width(text, self.size);
        if length > room && room > 0.0 {
            self.size *= room / length;
        }
        self
    }
}

fn scale(size: f64) -> PxScale {
    let em = FONT.units_per_em().unwrap_or(2048.0);
    PxScale::from(size as f32 * FONT.height_unscaled() / em)
}

/// Returns the positions of the glyphs along the line and the total length, in pixels.
fn place(text: &str, size: f64) -> (Vec<(GlyphId, f32)>, f32) {
    let font = FONT.as_scaled(scale(size));
    let mut at = 0.0;
    let mut before = None;
    let mut glyphs = Vec::new();
    for character in text.chars() {
        let glyph = font.glyph_id(character);
        if let Some(before) = before {
            at += font.kern(before, glyph);
        }
        glyphs.push((glyph, at));
        at += font.h_advance(glyph);
        before = Some(glyph);
    }
    (glyphs, at)
}

/// Returns the length of a text in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    f64::from(place(text, size).1)
}

/// Returns the numbers of the glyphs of a text with their positions along the line, and the length, in pixels.
pub(super) fn glyphs(text: &str, size: f64) -> (Vec<(u16, f64)>, f64) {
    let (glyphs, length) = place(text, size);
    let placed = glyphs.into_iter();
    let placed = placed.map(|(glyph, at)| (glyph.0, f64::from(at)));
    (placed.collect(), f64::from(length))
}

/// Returns the width of a glyph relative to the size of the text.
pub(super) fn advance(glyph: u16) -> f64 {
    let em = FONT.units_per_em().unwrap_or(2048.0);
    f64::from(FONT.h_advance_unscaled(GlyphId(glyph)) / em)
}

/// Returns ascent and descent relative to the size of the text.
pub(super) fn metrics() -> [f32; 2] {
    let em = FONT.units_per_em().unwrap_or(2048.0);
    [FONT.ascent_unscaled() / em, FONT.descent_unscaled() / em]
}

/// Returns a text of at most `room` pixels: its beginning with an ellipsis if it is longer.
pub(super) fn shortened(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut kept: Vec<char> = text.chars().collect();
    while kept.pop().is_some() {
        let short: String = kept.iter().collect();
        let short = format!("{}...", short.trim_end());
        if width(&short, size) <= room {
            return short;
        }
    }
    String::new()
}

/// Draws a text at (x, y); along its direction, y is at half the height of its capitals.
pub(super) fn draw(bitmap: &mut Bitmap, text: &str, (x, y): (f64, f64), style: Style) {
    let (glyphs, length) = place(text, style.size);
    let back = style.align.share() * f64::from(length);
    // Across the line, positions are whole pixels: a baseline between two rows of pixels looks blurred.
    let (along, across) = match style.direction {
        Direction::Right => (x - back, y),
        Direction::Up => (-y - back, x),
    };
    let base = (across + HALF_CAPITAL * style.size).round();
    for (glyph, offset) in glyphs {
        let place = ab_glyph::point(along as f32 + offset, base as f32);
        let Some(outline) =
            FONT.outline_glyph(glyph.with_scale_and_position(scale(style.size), place))
        else {
            continue; // a space
        };
        let corner = outline.px_bounds().min;
        outline.draw(|i, j, cover| {
            let i = corner.x as i64 + i64::from(i);
            let j = corner.y as i64 + i64::from(j);
            let (i, j) = match style.direction {
                Direction::Right => (i, j),
                // rotated by 90°: the line runs upwards, from pixel k to pixel −1 − k
                Direction::Up => (j, -1 - i),
            };
            bitmap.blend(i, j, style.colour, f64::from(cover));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the box of the pixels that are not white: left, top, right, bottom (exclusive).
    fn ink(bitmap: &Bitmap) -> (usize, usize, usize, usize) {
        let mut found = (usize::MAX, usize::MAX, 0, 0);
        for j in 0..bitmap.height() {
            for i in 0..bitmap.width() {
                if bitmap.pixel(i, j) != [255; 3] {
                    found.0 = found.0.min(i);
                    found.1 = found.1.min(j);
                    found.2 = found.2.max(i + 1);
                    found.3 = found.3.max(j + 1);
                }
            }
        }
        found
    }

    #[test]
    fn the_font_has_all_characters_used_in_pictures() {
        let signs = "AZaz09 [](),.·×−-+=%°µΩαβγδεηθκλνξπρστφψω∂∇∞√≤≥≈Δ²³⁰¹⁴⁵⁶⁷⁸⁹⁻₀₁∥";
        for sign in signs.chars() {
            assert_ne!(FONT.glyph_id(sign), GlyphId(0), "{sign}");
        }
    }

    #[test]
    fn drawn_text_has_the_computed_width() {
        let text = "HEIGHTH";
        let length = width(text, 40.0);
        for (align, start) in [
            (Align::Start, 200.0),
            (Align::Middle, 200.0 - length / 2.0),
            (Align::End, 200.0 - length),
        ] {
            let mut bitmap = Bitmap::white(400, 100);
            draw(&mut bitmap, text, (200.0, 50.0), Style::new(40.0, align));
            let (left, top, right, bottom) = ink(&bitmap);
            // the stems of H are 0.1 em inside its advance width
            assert!((left as f64 - start - 4.0).abs() < 1.5, "{align:?} {left}");
            assert!(
                (right as f64 - start - length + 4.0).abs() < 1.5,
                "{align:?} {right}"
            );
            let height = bottom - top;
            assert!((29..=31).contains(&height), "{height}");
            assert!((top as f64 + bottom as f64 - 100.0).abs() <= 2.0);
        }
    }

    #[test]
    fn vertical_text_is_rotated_horizontal_text() {
        let (mut level, mut up) = (Bitmap::white(200, 200), Bitmap::white(200, 200));
        let style = Style::new(30.0, Align::Middle);
        draw(&mut level, "Energy", (100.0, 80.0), style);
        draw(&mut up, "Energy", (80.0, 100.0), style.up());
        for j in 0..200 {
            for i in 0..200 {
                assert_eq!(level.pixel(i, j), up.pixel(j, 199 - i), "{i} {j}");
            }
        }
    }

    #[test]
    fn long_text_is_reduced_to_fit() {
        let style = Style::new(30.0, Align::Start).fitted("a long title of a picture", 100.0);
        assert!((width("a long title of a picture", style.size) - 100.0).abs() < 1.0);
    }
}
