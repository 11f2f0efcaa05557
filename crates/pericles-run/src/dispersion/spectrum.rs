//! Files of measured spectra: power over k and ω, and peaks on the dispersion curves.

use std::path::Path;

use pericles_dispersion::spectrum::MeasuredSpectrum;
use pericles_io::{Axis, Backdrop, Cell, Column, CsvTable, Curve, IoError, LineChart};

use super::curves::Curves;

/// Maximum number of rows of a map; spectral lines are grouped into bands.
const ROWS: usize = 240;
/// Lower limit of the displayed power, relative to the largest.
const FLOOR: f64 = 1e-8;

/// Writes `spectrum_<branch>.csv`, `spectrum_<branch>.png` for each branch and `peaks.csv`, `peaks.png`. All pictures
/// show the curves of the analysis.
pub fn write_spectrum(
    folder: &dyn Fn(&str) -> std::path::PathBuf,
    spectrum: &MeasuredSpectrum,
    curves: &Curves<'_>,
    title: &str,
) -> Result<(), IoError> {
    for (branch, name) in curves.contour.branches.iter().enumerate() {
        let map = Map::of(spectrum, branch);
        map.write(&folder(&format!("spectrum_{name}.csv")), spectrum, branch)?;
        let title = format!("{title}: measured power, branch {name}");
        let chart = map.chart(spectrum, branch, curves).title(title);
        chart.write(folder(&format!("spectrum_{name}.png")))?;
    }
    write_peaks(&folder("peaks.csv"), spectrum, curves)?;
    let mut chart = curves.chart(&format!("{title}: measured peaks"));
    for (branch, name) in curves.contour.branches.iter().enumerate() {
        let (x, y): (Vec<f64>, Vec<f64>) = spectrum
            .waves
            .iter()
            .map(|wave| (wave.abscissa, wave.branches[branch].peak))
            .unzip();
        chart = chart.curve(Curve::points(format!("{name}, measured"), &x, &y));
    }
    chart.write(folder("peaks.png"))
}

fn write_peaks(
    path: &Path,
    spectrum: &MeasuredSpectrum,
    curves: &Curves<'_>,
) -> Result<(), IoError> {
    let mut columns = vec![Column::real("abscissa", "rad/m")];
    columns.extend(["k_x", "k_y", "k_z"].map(|name| Column::real(name, "rad/m")));
    for name in &curves.contour.branches {
        columns.extend(
            ["peak", "expected"].map(|what| Column::real(format!("{what}_{name}"), "rad/s")),
        );
    }
    let mut table = CsvTable::create(path, &columns)?;
    for wave in &spectrum.waves {
        let mut cells = vec![wave.abscissa.into()];
        cells.extend(wave.k.map(Cell::from));
        for branch in &wave.branches {
            cells.extend([branch.peak, branch.expected].map(Cell::from));
        }
        table.append(&cells)?;
    }
    table.flush()
}

/// Power over wave vectors and frequency bands.
struct Map {
    /// Spectral lines per band.
    lines: usize,
    bands: usize,
    /// Largest power in each band, for each wave vector.
    power: Vec<f64>,
}

impl Map {
    /// Creates the map up to slightly above the highest expected frequency.
    fn of(spectrum: &MeasuredSpectrum, branch: usize) -> Self {
        let branches = || spectrum.waves.iter().map(|wave| &wave.branches[branch]);
        let highest = branches().map(|b| b.expected).fold(0.0, f64::max);
        let most = branches().map(|b| b.power.len()).max().unwrap_or(1);
        let shown = ((1.15 * highest / spectrum.line) as usize + 2).min(most);
        let lines = shown.div_ceil(ROWS).max(1);
        let bands = shown.div_ceil(lines);
        let power = branches()
            .flat_map(|b| {
                (0..bands).map(move |band| {
                    let end = ((band + 1) * lines).min(b.power.len());
                    let part = &b.power[(band * lines).min(end)..end];
                    part.iter().copied().fold(0.0, f64::max)
                })
            })
            .collect();
        Self {
            lines,
            bands,
            power,
        }
    }

    fn write(
        &self,
        path: &Path,
        spectrum: &MeasuredSpectrum,
        branch: usize,
    ) -> Result<(), IoError> {
        let columns = [
            Column::real("abscissa", "rad/m"),
            Column::real("omega", "rad/s"),
            Column::real("power", ""),
        ];
        let mut table = CsvTable::create(path, &columns)?;
        for wave in &spectrum.waves {
            let power = &wave.branches[branch].power;
            for (line, power) in power.iter().take(self.bands * self.lines).enumerate() {
                let omega = line as f64 * spectrum.line;
                table.append(&[wave.abscissa.into(), omega.into(), (*power).into()])?;
            }
        }
        table.flush()
    }

    /// Returns a chart of the power in decibels relative to the largest of each wave vector, with the time-discrete
    /// curve.
    fn chart(&self, spectrum: &MeasuredSpectrum, branch: usize, curves: &Curves<'_>) -> LineChart {
        let abscissa: Vec<f64> = spectrum.waves.iter().map(|wave| wave.abscissa).collect();
        let top = (self.bands * self.lines) as f64 * spectrum.line;
        let mut values = Vec::with_capacity(self.power.len());
        for powers in self.power.chunks(self.bands) {
            let largest = powers.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            let level = |power: &f64| (power / largest).max(FLOOR).log10() * 10.0;
            values.extend(powers.iter().map(level));
        }
        let ends = column_ends(&abscissa);
        let map = Backdrop::new(&ends, (0.0, top), self.bands, &values)
            .label("power relative to the largest of each wave vector, dB", "")
            .range(10.0 * FLOOR.log10(), 0.0);
        let range = (ends[0], ends[ends.len() - 1]);
        let (x, y) = curves.discrete_branch(branch);
        LineChart::new(
            Axis::new(curves.along(), "rad/m").range(range.0, range.1),
            Axis::new("ω", "rad/s").range(0.0, top),
        )
        .backdrop(map)
        .curve(
            Curve::line("analysis (time-discrete)", &x, &y)
                .dashed()
                .colour(ANALYSIS),
        )
    }
}

/// Colour of the curve, distinct from those of the map.
const ANALYSIS: [u8; 3] = [255, 70, 50];

/// Returns the boundaries between columns, midway between their centres.
fn column_ends(places: &[f64]) -> Vec<f64> {
    let (Some(first), Some(last)) = (places.first(), places.last()) else {
        return vec![0.0, 1.0];
    };
    let between = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let mut ends = vec![*first];
    ends.extend(between);
    ends.push(*last);
    ends
}
