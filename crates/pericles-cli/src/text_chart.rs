//! Terminal plots.

use std::fmt;

use pericles_io::quantity;

use crate::charts::Chart;

/// Width and height in characters, without axes.
const WIDTH: usize = 68;
const HEIGHT: usize = 16;

/// Markers of the curves, repeated for more curves.
const MARKS: [char; 8] = ['*', '+', 'o', 'x', '#', '%', '@', '='];

/// A terminal plot of curves over time.
pub(crate) struct TextChart<'a> {
    chart: &'a Chart,
}

impl<'a> TextChart<'a> {
    pub(crate) fn of(chart: &'a Chart) -> Self {
        Self { chart }
    }

    /// Returns the rows from top to bottom; later curves cover earlier ones.
    fn rows(&self, time: (f64, f64), range: (f64, f64)) -> Vec<[char; WIDTH]> {
        let mut rows = vec![[' '; WIDTH]; HEIGHT];
        let place = |value: f64, (low, high): (f64, f64), cells: usize| {
            let share = if high > low {
                (value - low) / (high - low)
            } else {
                0.5
            };
            ((share * cells as f64) as usize).min(cells - 1)
        };
        for ((_, values), mark) in self.chart.curves.iter().zip(MARKS.iter().cycle()) {
            let points = self.chart.time.iter().zip(values);
            for (&t, &value) in points.filter(|(_, value)| value.is_finite()) {
                let row = HEIGHT - 1 - place(value, range, HEIGHT);
                rows[row][place(t, time, WIDTH)] = *mark;
            }
        }
        rows
    }
}

impl fmt::Display for TextChart<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let chart = self.chart;
        let time = extent(chart.time.iter().copied());
        let range = extent(
            chart
                .curves
                .iter()
                .flat_map(|(_, values)| values.iter().copied()),
        );
        write!(f, "{}", chart.name)?;
        if chart.curves.len() > 1 {
            let keys = chart.curves.iter().zip(MARKS.iter().cycle());
            let keys: Vec<String> = keys
                .map(|((name, _), mark)| format!("{mark} {name}"))
                .collect();
            write!(f, ": {}", keys.join("  "))?;
        }
        writeln!(f)?;
        let ends = [range.1, range.0].map(|value| quantity(value, &chart.unit));
        let width = ends
            .iter()
            .map(|label| label.chars().count())
            .max()
            .unwrap_or(0);
        for (number, row) in self.rows(time, range).iter().enumerate() {
            let label = match number {
                0 => &ends[0][..],
                _ if number == HEIGHT - 1 => &ends[1],
                _ => "",
            };
            let row: String = row.iter().collect();
            writeln!(f, "{label:>width$} |{}", row.trim_end())?;
        }
        writeln!(f, "{:width$} +{}", "", "-".repeat(WIDTH))?;
        let [from, to] = [time.0, time.1].map(|t| chart.along.label(t));
        let room = WIDTH.saturating_sub(from.chars().count());
        writeln!(f, "{:width$}  {from}{to:>room$}", "")
    }
}

/// Returns the smallest and the largest finite value.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles_run::TimeAxis;

    #[test]
    fn straight_lines_connect_the_corners_and_curves_have_markers() {
        let time: Vec<f64> = (0..=100).map(|k| f64::from(k) * 1e-6).collect();
        let up: Vec<f64> = time.iter().map(|t| 2e6 * t).collect();
        let down: Vec<f64> = up.iter().map(|x| 200.0 - x).collect();
        let chart = Chart {
            name: "energy".into(),
            unit: "J".into(),
            along: TimeAxis::TIME,
            time,
            curves: vec![("up".into(), up), ("down".into(), down)],
        };
        let text = TextChart::of(&chart).to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "energy: * up  + down");
        assert_eq!(lines.len(), HEIGHT + 3);
        assert!(
            lines[1].starts_with("200 J |+") && lines[1].ends_with('*'),
            "{text}"
        );
        assert!(lines[HEIGHT].trim_start().starts_with("0 J |*"), "{text}");
        assert!(lines[HEIGHT].ends_with('+'));
        assert!(lines[HEIGHT + 2].ends_with("100 µs"));
        // At the crossing in the middle the later curve is visible.
        assert!(lines[HEIGHT / 2].contains('+'));
    }
}
