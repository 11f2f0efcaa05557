//! The figures of the studies.

use pericles::observe::Field;
use pericles_io::observers::PictureOf;
use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;

use super::record::Recorded;
use crate::study::Context;

/// The damage at the end.
pub(super) fn picture(
    context: &Context<'_>,
    recorded: &Recorded,
    title: &str,
) -> Result<(), RunError> {
    let Some(path) = context.figure("damage.png") else {
        return Ok(());
    };
    let picture = PictureOf {
        title: title.into(),
        ..PictureOf::new(Field::Damage)
    };
    Ok(picture.draw(&recorded.simulation.snapshot(), path)?)
}

/// A figure of one curve over time.
pub(super) fn curve(
    context: &Context<'_>,
    name: &str,
    axis: Axis,
    points: &[(f64, f64)],
) -> Result<(), RunError> {
    let Some(path) = context.figure(name) else {
        return Ok(());
    };
    let (t, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    LineChart::new(Axis::new("time", "s"), axis)
        .curve(Curve::line("", &t, &y))
        .write(path)?;
    Ok(())
}
