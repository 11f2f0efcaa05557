//! Arrays of a page: rounding to 16 bits and compression.

use std::io::Write;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use flate2::Compression;
use flate2::write::ZlibEncoder;

/// A compressed array in base64.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block(String);

impl Block {
    /// Encodes integers of 16 bits.
    pub fn of_u16(values: &[u16]) -> Self {
        let differences = values.iter().scan(0_u16, |last, &value| {
            let difference = value.wrapping_sub(*last);
            *last = value;
            Some(difference)
        });
        Self::of_words(differences.map(u16::to_le_bytes))
    }

    /// Encodes integers of 32 bits.
    pub fn of_u32(values: &[u32]) -> Self {
        let differences = values.iter().scan(0_u32, |last, &value| {
            let difference = value.wrapping_sub(*last);
            *last = value;
            Some(difference)
        });
        Self::of_words(differences.map(u32::to_le_bytes))
    }

    /// Encodes numbers in single precision.
    pub fn of_f32(values: impl IntoIterator<Item = f64>) -> Self {
        Self::of_words(values.into_iter().map(|value| (value as f32).to_le_bytes()))
    }

    /// Encodes numbers in double precision.
    pub fn of_f64(values: &[f64]) -> Self {
        Self::of_words(values.iter().map(|value| value.to_le_bytes()))
    }

    /// Compresses words whose bytes are grouped by significance: first the lowest byte of all words, then the next. Smooth
    /// fields then compress better.
    fn of_words<const BYTES: usize>(words: impl Iterator<Item = [u8; BYTES]>) -> Self {
        let words: Vec<[u8; BYTES]> = words.collect();
        let grouped = (0..BYTES).flat_map(|byte| words.iter().map(move |word| word[byte]));
        let grouped: Vec<u8> = grouped.collect();
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        // Writing to memory does not fail.
        let _ = encoder.write_all(&grouped);
        Self(BASE64_STANDARD.encode(encoder.finish().unwrap_or_default()))
    }

    /// Returns the encoded text.
    pub fn text(&self) -> &str {
        &self.0
    }
}

/// Values rounded to 16 bits: `low + step · code`. The rounding error is at most half a step. Integers whose range is less than
/// [`Quantised::LEVELS`] are exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// The code of each value, at most [`Quantised::LEVELS`]; [`Quantised::MISSING`] for NaN and infinity.
    pub codes: Vec<u16>,
    /// The least value.
    pub low: f64,
    /// The difference of neighbouring codes.
    pub step: f64,
    /// The largest value.
    pub high: f64,
}

impl Quantised {
    /// The largest code.
    pub const LEVELS: u16 = 65534;
    /// Code of NaN and infinity.
    pub const MISSING: u16 = 65535;

    /// Rounds values.
    pub fn new(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let range = high - low;
        let levels = f64::from(Self::LEVELS);
        let is_whole = range <= levels && finite().all(|value| value.fract() == 0.0);
        let step = match is_whole {
            true => 1.0,
            false => range / levels,
        };
        let code = |&value: &f64| match value.is_finite() {
            true if step > 0.0 => (value / step - low / step).round().min(levels) as u16,
            true => 0,
            false => Self::MISSING,
        };
        Self {
            codes: values.iter().map(code).collect(),
            low,
            step,
            high,
        }
    }

    /// Returns the value of a code; NaN for [`Quantised::MISSING`].
    pub fn value(&self, code: u16) -> f64 {
        match code {
            Self::MISSING => f64::NAN,
            code => self.low + self.step * f64::from(code),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn rounding_errors_are_at_most_half_a_step_and_integers_are_exact() {
        let values: Vec<f64> = (0..1000)
            .map(|k| (0.37 * f64::from(k)).sin() * 1e-7 + 3e-8)
            .collect();
        let rounded = Quantised::new(&values);
        for (value, &code) in values.iter().zip(&rounded.codes) {
            let error = (rounded.value(code) - value).abs();
            assert!(error <= 0.500001 * rounded.step, "{error}");
        }
        assert!(rounded.step <= 2e-7 / 65534.0);
        let numbers = [7.0, f64::NAN, 1e4, -3.0, f64::INFINITY];
        let rounded = Quantised::new(&numbers);
        let values: Vec<f64> = rounded
            .codes
            .iter()
            .map(|&code| rounded.value(code))
            .collect();
        assert_eq!((values[0], values[2], values[3]), (7.0, 1e4, -3.0));
        assert!(values[1].is_nan() && values[4].is_nan());
        assert_eq!(Quantised::new(&[0.25; 3]).value(0), 0.25);
        assert!(
            Quantised::new(&[f64::NAN])
                .value(Quantised::MISSING)
                .is_nan()
        );
    }

    #[test]
    fn blocks_contain_differences_grouped_by_byte() {
        let block = Block::of_u16(&[0x0102, 0x0103, 0x0001]);
        let bytes = BASE64_STANDARD.decode(block.text()).unwrap();
        let mut grouped = Vec::new();
        let mut decoder = flate2::read::ZlibDecoder::new(&bytes[..]);
        decoder.read_to_end(&mut grouped).unwrap();
        // 0x0102, +1, -0x0102.
        assert_eq!(grouped, [0x02, 0x01, 0xfe, 0x01, 0x00, 0xfe]);
    }
}
