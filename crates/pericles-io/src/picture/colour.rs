//! Colour maps: tables of equidistant colours with linear interpolation.

use super::bitmap::{Rgb, rounded};

/// A map from numbers to colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum ColourMap {
    /// Sequential, from dark blue over green to yellow, perceptually uniform also in grey. For damage,
    /// energies, sizes.
    #[default]
    Viridis,
    /// Diverging, from blue over light grey to red, with zero in the middle. For displacements, velocities
    /// and other signed quantities.
    Diverging,
    /// Sequential, from dark to light grey, for print without colours.
    Grey,
}

/// Every sixteenth colour of `viridis` by N. Smith and S. van der Walt (2015),
/// <https://bids.github.io/colormap/>, public domain (CC0).
const VIRIDIS: [Rgb; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 129, 142],
    [33, 144, 140],
    [31, 159, 136],
    [40, 174, 128],
    [62, 188, 116],
    [93, 201, 99],
    [130, 211, 76],
    [171, 220, 50],
    [213, 226, 26],
    [253, 231, 37],
];

/// Every sixteenth colour of the cool to warm map of K. Moreland, Diverging color maps for scientific
/// visualization, ISVC 2009,
/// <https://www.kennethmoreland.com/color-maps/>.
const COOL_TO_WARM: [Rgb; 17] = [
    [59, 76, 192],
    [77, 104, 215],
    [98, 130, 234],
    [119, 154, 247],
    [141, 176, 254],
    [163, 194, 254],
    [184, 208, 249],
    [204, 217, 238],
    [221, 221, 221],
    [236, 211, 197],
    [245, 196, 173],
    [247, 177, 148],
    [244, 154, 123],
    [236, 127, 99],
    [222, 96, 77],
    [203, 62, 56],
    [180, 4, 38],
];

/// Dark to light grey.
const GREY: [Rgb; 17] = {
    let mut table = [[0; 3]; 17];
    let mut k = 0;
    while k < 17 {
        table[k] = [30 + 13 * k as u8; 3];
        k += 1;
    }
    table
};

/// Colour of missing values.
pub(super) const NO_VALUE: Rgb = [170, 170, 170];

/// Curve colours that colour-blind readers can distinguish: M. Okabe and K. Ito, Color universal design
/// (2008); black and yellow, which is faint on white, come last.
pub(super) const CURVES: [Rgb; 8] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [0, 0, 0],
    [240, 228, 66],
];

impl ColourMap {
    /// Returns the colour of a number between 0 and 1; numbers outside take the colour of the nearer end, NaN
    /// is grey.
    pub fn colour(self, fraction: f64) -> [u8; 3] {
        if fraction.is_nan() {
            return NO_VALUE;
        }
        let table = match self {
            Self::Viridis => &VIRIDIS,
            Self::Diverging => &COOL_TO_WARM,
            Self::Grey => &GREY,
        };
        let last = table.len() - 1;
        let place = fraction.clamp(0.0, 1.0) * last as f64;
        let below = (place as usize).min(last - 1);
        let weight = place - below as f64;
        let part = |c: usize| {
            let (a, b) = (f64::from(table[below][c]), f64::from(table[below + 1][c]));
            rounded(a + weight * (b - a))
        };
        [part(0), part(1), part(2)]
    }
}

/// Darkens a colour, for faces in shade.
#[inline]
pub(super) fn shaded([r, g, b]: Rgb, light: f64) -> Rgb {
    let shade = |part: u8| rounded(f64::from(part) * light);
    [shade(r), shade(g), shade(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance([r, g, b]: Rgb) -> f64 {
        let linear = |v: u8| (f64::from(v) / 255.0).powf(2.2);
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    }

    #[test]
    fn the_luminance_of_viridis_increases_monotonically() {
        let light: Vec<_> = (0..=255)
            .map(|k| luminance(ColourMap::Viridis.colour(f64::from(k) / 255.0)))
            .collect();
        assert!(light.windows(2).all(|pair| pair[1] >= pair[0] - 2e-3));
        assert!(light[255] - light[0] > 0.6);
    }

    #[test]
    fn the_diverging_map_is_lightest_in_the_middle() {
        let middle = luminance(ColourMap::Diverging.colour(0.5));
        for fraction in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
            assert!(luminance(ColourMap::Diverging.colour(fraction)) < middle);
        }
        let [r, g, b] = ColourMap::Diverging.colour(0.5);
        assert!(r == g && g == b);
    }

    #[test]
    fn colours_at_the_ends_and_in_the_middle_match_the_tables() {
        assert_eq!(ColourMap::Viridis.colour(-1.0), [68, 1, 84]);
        assert_eq!(ColourMap::Viridis.colour(f64::INFINITY), [253, 231, 37]);
        assert_eq!(ColourMap::Viridis.colour(0.5), [33, 144, 140]);
        assert_eq!(ColourMap::Viridis.colour(1.0 / 32.0), [70, 13, 95]);
        assert_eq!(ColourMap::Viridis.colour(f64::NAN), NO_VALUE);
    }
}
