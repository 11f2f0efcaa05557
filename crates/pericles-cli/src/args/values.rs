//! Parsers of option values.

use std::num::NonZeroUsize;
use std::time::Duration;

use pericles::operator::InstructionSet;
use pericles::sum::max_norm;
use pericles_deck::{DeviceKind, DevicePrecision, Processor};

use crate::error::CliError;

/// A nonzero vector of one to three components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Direction {
    vector: [f64; 3],
    /// Number of components given.
    given: usize,
}

impl Direction {
    /// Returns the vector; components not given are zero.
    pub(crate) fn vector(self) -> [f64; 3] {
        self.vector
    }

    /// Returns the vector for a body of `dimension` dimensions.
    ///
    /// # Errors
    /// The vector has more components than the body has dimensions; `option` names the option in the message.
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

/// Parses a processor: cpu, gpu or gpu:N.
pub(super) fn device(text: &str) -> Result<Processor, String> {
    let of = |device, adapter| Processor {
        device,
        adapter,
        ..Processor::default()
    };
    match text.split_once(':') {
        None if text == "cpu" => Ok(of(DeviceKind::Cpu, None)),
        None if text == "gpu" => Ok(of(DeviceKind::Gpu, None)),
        Some(("gpu", number)) if number.parse::<u32>().is_ok() => {
            Ok(of(DeviceKind::Gpu, number.parse().ok()))
        }
        _ => Err("expected cpu, gpu or gpu:N with the number of a graphics processor".into()),
    }
}

/// Parses the precision of a graphics processor.
pub(super) fn device_precision(text: &str) -> Result<DevicePrecision, String> {
    match text {
        "double" => Ok(DevicePrecision::Double),
        "mixed" => Ok(DevicePrecision::Mixed),
        _ => Err("expected double or mixed".into()),
    }
}

/// Parses one to three numbers, such as `2,1` or `1,1,0`.
pub(super) fn direction(text: &str) -> Result<Direction, String> {
    let mut vector = [0.0_f64; 3];
    let numbers: Vec<&str> = text.split(',').collect();
    let allowed = "expected one to three comma-separated numbers, not all zero";
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
            // The square underflows or overflows: normalise by the largest component.
            vector = vector.map(|x| x / largest);
        }
        Ok(Direction { vector, given })
    } else {
        Err(allowed.into())
    }
}

/// Parses the name of an instruction set.
pub(super) fn instruction_set(name: &str) -> Result<InstructionSet, String> {
    InstructionSet::named(name).ok_or_else(|| "allowed: baseline, avx2, avx512".to_owned())
}

/// Two vertex numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair(pub(crate) [usize; 2]);

/// Parses two vertex numbers, such as `0,41`.
pub(super) fn pair(text: &str) -> Result<Pair, String> {
    let numbers = text
        .split_once(',')
        .and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    numbers
        .map(Pair)
        .ok_or_else(|| "expected two comma-separated vertex numbers, such as 0,41".to_owned())
}

/// Parses a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    /// More threads than cores slow a run down, and thousands take minutes to start.
    const PER_CORE: usize = 4;
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let most = (PER_CORE * cores).max(64);
    let number = text
        .parse()
        .ok()
        .filter(|number: &NonZeroUsize| number.get() <= most);
    number.ok_or_else(|| {
        format!("expected an integer from 1 to {most}; this machine has {cores} cores")
    })
}

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range(pub(crate) [f64; 2]);

/// Parses an interval, such as `0:1`.
pub(super) fn range(text: &str) -> Result<Range, String> {
    let ends = text.split_once(':').and_then(|(low, high)| {
        let number = |text: &str| text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        Some([number(low)?, number(high)?])
    });
    let range = ends.filter(|[low, high]| low < high).map(Range);
    range.ok_or_else(|| "expected LOW:HIGH with LOW < HIGH".to_owned())
}

/// Parses a number of at least zero.
pub(super) fn tolerance(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number >= 0.0);
    number.ok_or_else(|| "expected a number of at least 0".to_owned())
}

/// Parses a positive number.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

/// A positive length, as written and in metres.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Length {
    pub(crate) text: String,
    pub(crate) metres: f64,
}

/// Parses a positive length, such as `0.5 mm`.
pub(super) fn length(text: &str) -> Result<Length, String> {
    let metres = pericles_deck::metres(text).filter(|metres| *metres > 0.0);
    let metres = metres.ok_or_else(|| {
        "expected a positive length such as \"0.5 mm\" or 5e-4 (metres)".to_owned()
    })?;
    let text = text.trim().to_owned();
    Ok(Length { text, metres })
}

/// Parses a positive time step, such as `0.5 us`, as written.
pub(super) fn time_step(text: &str) -> Result<String, String> {
    let seconds = pericles_deck::seconds(text).filter(|seconds| *seconds > 0.0);
    seconds.ok_or("expected a positive time such as \"0.5 us\" or 5e-7 (seconds)")?;
    Ok(text.trim().to_owned())
}

/// The length unit of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LengthUnit {
    pub(crate) metres: f64,
}

/// Parses a length unit, such as `mm`.
pub(super) fn length_unit(text: &str) -> Result<LengthUnit, String> {
    let metres = pericles_deck::length_unit(text);
    let metres =
        metres.map_err(|_| "expected a length unit such as mm, cm, m, um or \"25.4 mm\"")?;
    Ok(LengthUnit { metres })
}

/// Parses a number of at least one.
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let number = number.filter(|number: &f64| *number >= 1.0 && number.is_finite());
    number.ok_or_else(|| "expected a number of at least 1".to_owned())
}

/// Parses a wall-clock time, such as `2h`.
pub(super) fn wall_time(text: &str) -> Result<Duration, String> {
    let allowed = "expected a positive time such as 2h, \"90 min\" or 5400 (seconds)";
    pericles_deck::seconds(text)
        .filter(|&seconds| seconds > 0.0)
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| allowed.to_owned())
}
