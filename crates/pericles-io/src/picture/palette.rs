//! Colours of a bar in steps, for many values.

use super::bitmap::Rgb;
use super::frame::ColourBar;

/// Colours of a bar in steps that eyes do not distinguish, for many values.
pub(super) struct Palette<'a> {
    bar: &'a ColourBar,
    colours: Vec<Rgb>,
    /// Steps per unit of the values.
    scale: f64,
}

impl<'a> Palette<'a> {
    pub(super) fn of(bar: &'a ColourBar) -> Self {
        const STEPS: usize = 2048;
        let scale = STEPS as f64 / (bar.high - bar.low);
        let colours = match bar.categories.is_empty() && scale.is_finite() {
            true => (0..=STEPS)
                .map(|step| bar.map.colour(step as f64 / STEPS as f64))
                .collect(),
            false => Vec::new(),
        };
        Self {
            bar,
            colours,
            scale,
        }
    }

    /// Returns the colour of a value; see [`ColourBar::colour`].
    #[inline]
    pub(super) fn colour(&self, value: f64) -> Rgb {
        // A negative number becomes zero.
        let step = ((value - self.bar.low) * self.scale + 0.5) as usize;
        match self
            .colours
            .get(step.min(self.colours.len().wrapping_sub(1)))
        {
            Some(colour) if !value.is_nan() => *colour,
            _ => self.bar.colour(value),
        }
    }
}
