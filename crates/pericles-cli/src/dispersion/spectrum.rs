//! Measured spectra as files: the map of power over k and ω, and the peaks on the curves.

use std::path::Path;

use pericles::analysis::spectrum::MeasuredSpectrum;
use pericles_io::{Cell, CellSize, Column, CsvTable, Curve, FieldPicture};

use super::curves::Curves;
use crate::error::CliError;
use crate::units::significant;

/// Rows of a map: lines are put together to no more than these.
const ROWS: usize = 240;
/// Width of a map over its height, in the units of its own axes.
const SHAPE: f64 = 1.4;
/// Power below this share of the largest is shown as this.
const FLOOR: f64 = 1e-8;

/// Writes `spectrum_<branch>.csv`, `spectrum_<branch>.png` for each branch and `peaks.csv`, `peaks.png`; the curves of the analysis are drawn into all pictures.
pub(crate) fn write_spectrum(
    folder: &dyn Fn(&str) -> std::path::PathBuf,
    spectrum: &MeasuredSpectrum,
    curves: &Curves<'_>,
    title: &str,
) -> Result<(), CliError> {
    for (branch, name) in curves.contour.branches.iter().enumerate() {
        let map = Map::of(spectrum, branch);
        map.write(&folder(&format!("spectrum_{name}.csv")), spectrum, branch)?;
        map.draw(
            &folder(&format!("spectrum_{name}.png")),
            &format!(
                "{title}, branch {name}: x is k over {}, y is ω over {}",
                significant(curves.contour.length() / SHAPE, 4) + " rad/m",
                significant(map.top * spectrum.line, 4) + " rad/s",
            ),
        )?;
    }
    write_peaks(&folder("peaks.csv"), spectrum, curves)?;
    let mut chart = curves.chart(&format!("{title}: measured peaks on the curves"));
    for (branch, name) in curves.contour.branches.iter().enumerate() {
        let (x, y): (Vec<f64>, Vec<f64>) = spectrum
            .waves
            .iter()
            .map(|wave| (wave.abscissa, wave.branches[branch].peak))
            .unzip();
        chart = chart.curve(Curve::points(format!("{name}, measured"), &x, &y));
    }
    Ok(chart.write(folder("peaks.png"))?)
}

fn write_peaks(
    path: &Path,
    spectrum: &MeasuredSpectrum,
    curves: &Curves<'_>,
) -> Result<(), CliError> {
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
    Ok(table.flush()?)
}

/// Power on a grid of waves and bands of lines.
struct Map {
    /// Lines in a band.
    lines: usize,
    bands: usize,
    /// Lines in all.
    top: f64,
    /// Largest power in each band, wave by wave.
    power: Vec<f64>,
    /// Band of the analysis, wave by wave.
    expected: Vec<usize>,
}

impl Map {
    /// Up to a little above the highest expected frequency.
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
        let expected = branches()
            .map(|b| (b.expected / spectrum.line / lines as f64) as usize)
            .collect();
        Self {
            lines,
            bands,
            top: (bands * lines) as f64,
            power,
            expected,
        }
    }

    fn write(
        &self,
        path: &Path,
        spectrum: &MeasuredSpectrum,
        branch: usize,
    ) -> Result<(), CliError> {
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
        Ok(table.flush()?)
    }

    /// Decibels below the largest power of each wave, the curve of the analysis in the brightest colour. Axes count waves and
    /// bands, scaled to a handy shape.
    fn draw(&self, path: &Path, title: &str) -> Result<(), CliError> {
        let waves = self.expected.len();
        let (width, height) = (SHAPE / waves as f64, 1.0 / self.bands as f64);
        let mut positions = Vec::with_capacity(2 * self.power.len());
        for entry in 0..self.power.len() {
            positions.push((entry / self.bands) as f64 * width);
        }
        for entry in 0..self.power.len() {
            positions.push((entry % self.bands) as f64 * height);
        }
        let mut values = Vec::with_capacity(self.power.len());
        for (wave, powers) in self.power.chunks(self.bands).enumerate() {
            let largest = powers.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            for (band, power) in powers.iter().enumerate() {
                let on_curve = band == self.expected[wave];
                let level = (power / largest).max(FLOOR).log10() * 10.0;
                values.push(if on_curve { 10.0 } else { level });
            }
        }
        FieldPicture::new(
            2,
            &positions,
            &values,
            CellSize::Block([width, height, height]),
        )
        .label("power, dB; 10: curve of the analysis", "")
        .range(10.0 * FLOOR.log10(), 10.0)
        .title(title)
        .write(path)?;
        Ok(())
    }
}
