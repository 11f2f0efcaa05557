//! Values of options.

use std::num::NonZeroUsize;
use std::time::Duration;

use clap::ValueEnum;
use pericles::operator::InstructionSet;
use pericles::sum::max_norm;

use crate::error::CliError;

/// A vector other than zero; missing components are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Direction {
    vector: [f64; 3],
    /// Components given.
    given: usize,
}

impl Direction {
    /// The vector, missing components zero.
    pub(crate) fn vector(self) -> [f64; 3] {
        self.vector
    }

    /// The vector, for a body of so many dimensions.
    ///
    /// # Errors
    /// More components than the body has; `option` is what they were given to.
    pub(crate) fn of(self, dimension: usize, option: &'static str) -> Result<[f64; 3], CliError> {
        if self.given <= dimension {
            return Ok(self.vector);
        }
        Err(CliError::Components {
            option,
            given: self.given,
            dimension,
        })
    }
}

/// One to three numbers, such as `2,1` or `1,1,0`.
pub(super) fn direction(text: &str) -> Result<Direction, String> {
    let mut vector = [0.0_f64; 3];
    let numbers: Vec<&str> = text.split(',').collect();
    let allowed = "one to three numbers with commas between them, not all zero";
    let given = numbers.len();
    if given > 3 {
        return Err(allowed.into());
    }
    for (component, number) in vector.iter_mut().zip(numbers) {
        *component = number.trim().parse().map_err(|_| allowed.to_owned())?;
    }
    let largest = max_norm(&vector);
    let length: f64 = vector.iter().map(|x| x * x).sum();
    if vector.iter().all(|x| x.is_finite()) && largest > 0.0 {
        if length == 0.0 || !length.is_finite() {
            // The direction is right, its square is not.
            vector = vector.map(|x| x / largest);
        }
        Ok(Direction { vector, given })
    } else {
        Err(allowed.into())
    }
}

/// An instruction set by its name.
pub(super) fn instruction_set(name: &str) -> Result<InstructionSet, String> {
    InstructionSet::named(name).ok_or_else(|| "allowed: baseline, avx2, avx512".to_owned())
}

/// Two numbers of vertices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair(pub(crate) [usize; 2]);

/// Reads two numbers of vertices.
pub(super) fn pair(text: &str) -> Result<Pair, String> {
    let numbers = text
        .split_once(',')
        .and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    numbers
        .map(Pair)
        .ok_or_else(|| "two numbers of vertices with a comma between them, such as 0,41".to_owned())
}

/// Reads a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    /// More than one for each core make a run slower, and thousands take minutes to start.
    const PER_CORE: usize = 4;
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let most = (PER_CORE * cores).max(64);
    let number = text
        .parse()
        .ok()
        .filter(|number: &NonZeroUsize| number.get() <= most);
    number.ok_or_else(|| format!("a whole number from 1 to {most}; this machine has {cores} cores"))
}

/// Kinds of picture files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Pixels
    Png,
    /// Shapes and text
    Svg,
}

impl Format {
    /// What its files end in.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
        }
    }
}

/// Two numbers, the first smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range(pub(crate) [f64; 2]);

/// Two numbers, such as `0:1`.
pub(super) fn range(text: &str) -> Result<Range, String> {
    let ends = text.split_once(':').and_then(|(low, high)| {
        let number = |text: &str| text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        Some([number(low)?, number(high)?])
    });
    let range = ends.filter(|[low, high]| low < high).map(Range);
    range.ok_or_else(|| "two numbers LOW:HIGH, the first smaller".to_owned())
}

/// A number of zero or more.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number >= 0.0);
    number.ok_or_else(|| "a number of zero or more".to_owned())
}

/// A length above zero, as it was written and in metres.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Length {
    pub(crate) text: String,
    pub(crate) metres: f64,
}

/// A length, such as `0.5 mm`.
pub(super) fn length(text: &str) -> Result<Length, String> {
    let metres = pericles_deck::metres(text).filter(|metres| *metres > 0.0);
    let metres =
        metres.ok_or_else(|| "a length above zero such as \"0.5 mm\" or 5e-4".to_owned())?;
    let text = text.trim().to_owned();
    Ok(Length { text, metres })
}

/// The unit of length of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LengthUnit {
    pub(crate) metres: f64,
}

/// A unit of length, such as `mm`.
pub(super) fn length_unit(text: &str) -> Result<LengthUnit, String> {
    let metres = pericles_deck::length_unit(text);
    let metres = metres.map_err(|_| "a unit of length such as mm, cm, m, um or \"25.4 mm\"")?;
    Ok(LengthUnit { metres })
}

/// A number of at least one.
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number: &f64| *number >= 1.0 && number.is_finite());
    number.ok_or_else(|| "a number of at least 1".to_owned())
}

/// A time on the clock, such as `2h`.
pub(super) fn wall_time(text: &str) -> Result<Duration, String> {
    let allowed = "a time above zero such as 2h, \"90 min\" or 5400 (seconds)";
    pericles_deck::seconds(text)
        .filter(|&seconds| seconds > 0.0)
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| allowed.to_owned())
}
