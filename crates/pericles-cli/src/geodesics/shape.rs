//! Surfaces given on the command line: a shape such as `torus(1,0.4,40,20)`, or a file.

use pericles_io::read_surface;
use pericles_manifold::surface::{Surface, SurfaceError};
use pericles_run::machine;

use crate::error::CliError;

const ALLOWED: &str = "expected icosphere(LEVEL), icosphere(LEVEL,RADIUS), uv-sphere(SEGMENTS,RINGS,RADIUS), ellipsoid(LEVEL,A,B,C), \
                       torus(MAJOR,MINOR,MAJOR_SEGMENTS,MINOR_SEGMENTS), capsule(RADIUS,LENGTH,SEGMENTS), or a file";

/// Creates or reads a surface.
///
/// # Errors
/// The shape is unknown, a parameter is out of range, or the file has no valid surface.
pub(super) fn surface(word: &str) -> Result<Surface, CliError> {
    let Some((name, numbers)) = word.strip_suffix(')').and_then(|word| word.split_once('(')) else {
        return Ok(read_surface(word, machine::memory())?);
    };
    let unknown = || CliError::UnknownShape {
        given: word.into(),
        allowed: ALLOWED,
    };
    let numbers: Vec<f64> = numbers
        .split(',')
        .map(|number| number.trim().parse())
        .collect::<Result<_, _>>()
        .map_err(|_| unknown())?;
    made(name, &numbers)
        .ok_or_else(unknown)?
        .map_err(|source| CliError::Surface {
            name: word.into(),
            source,
        })
}

fn made(name: &str, numbers: &[f64]) -> Option<Result<Surface, SurfaceError>> {
    Some(match (name, numbers) {
        ("icosphere", &[level]) => Surface::icosphere(whole(level)?, 1.0),
        ("icosphere", &[level, radius]) => Surface::icosphere(whole(level)?, radius),
        ("uv-sphere", &[segments, rings, radius]) => {
            Surface::uv_sphere(whole(segments)?, whole(rings)?, radius)
        }
        ("ellipsoid", &[level, a, b, c]) => Surface::ellipsoid(whole(level)?, [a, b, c]),
        ("torus", &[major, minor, around, across]) => {
            Surface::torus(major, minor, whole(around)?, whole(across)?)
        }
        ("capsule", &[radius, length, segments]) => {
            Surface::capsule(radius, length, whole(segments)?)
        }
        _ => return None,
    })
}

fn whole(number: f64) -> Option<u32> {
    let fits = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number);
    fits.then_some(number as u32)
}
