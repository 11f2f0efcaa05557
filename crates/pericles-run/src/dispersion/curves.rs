//! Files of dispersion curves, polar plots and bond classes.

use std::path::Path;

use pericles_dispersion::tuning::BondClass;
use pericles_dispersion::{BondLattice, Contour, ContourPoint, PolarSpeeds, verlet_frequency};
use pericles_io::{Axis, Cell, Column, CsvTable, Curve, IoError, LineChart};

/// Number of points per segment.
pub const STEPS: usize = 200;

/// Branches along a contour.
pub struct Curves<'a> {
    /// The path through the wave vectors.
    pub contour: &'a Contour,
    /// The branches at each point of the path.
    pub points: &'a [ContourPoint],
    /// Time step for the time-discrete curve, s.
    pub dt: Option<f64>,
    /// Wave speed in the continuum for each branch, m/s; `None` if the branch cannot be followed.
    pub targets: &'a [Option<f64>],
}

impl Curves<'_> {
    /// Returns the frequency of the continuum, 1/s.
    pub fn target(&self, branch: usize, point: &ContourPoint) -> f64 {
        let wave_number = point.k.iter().map(|k| k * k).sum::<f64>().sqrt();
        let speed = self.targets.get(branch).copied().flatten();
        speed.map_or(f64::NAN, |speed| speed * wave_number)
    }

    fn discrete(&self, omega: f64) -> f64 {
        let discrete = self.dt.and_then(|dt| verlet_frequency(omega, dt));
        discrete.unwrap_or(f64::NAN)
    }

    /// Writes a table. Cells are empty where a wave is unstable or a branch has no counterpart in the continuum.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        let mut columns = vec![
            Column::integer("segment"),
            Column::real("abscissa", "rad/m"),
        ];
        columns.extend(["k_x", "k_y", "k_z"].map(|name| Column::real(name, "rad/m")));
        for name in &self.contour.branches {
            columns.extend(
                ["omega", "omega_verlet", "omega_continuum"]
                    .map(|what| Column::real(format!("{what}_{name}"), "rad/s")),
            );
            columns.extend(
                ["phase_velocity", "group_velocity"]
                    .map(|what| Column::real(format!("{what}_{name}"), "m/s")),
            );
        }
        let mut table = CsvTable::create(path, &columns)?;
        for point in self.points {
            let mut cells: Vec<Cell> = vec![(point.segment as i64).into(), point.abscissa.into()];
            cells.extend(point.k.map(Cell::from));
            let along = self.contour.segments[point.segment].direction();
            for (number, branch) in point.branches.iter().enumerate() {
                let group: f64 = (0..3).map(|c| branch.group_velocity[c] * along[c]).sum();
                cells.extend(
                    [
                        branch.omega(),
                        self.discrete(branch.omega()),
                        self.target(number, point),
                        branch.phase_velocity,
                        group,
                    ]
                    .map(Cell::from),
                );
            }
            table.append(&cells)?;
        }
        table.flush()
    }

    /// Writes the chart: lattice as solid lines, continuum dashed.
    pub fn draw(&self, path: &Path, title: &str) -> Result<(), IoError> {
        self.chart(title).write(path)
    }

    /// Returns the label of the abscissa.
    pub fn along(&self) -> String {
        let mut names = vec![self.contour.segments[0].ends[0]];
        names.extend(self.contour.segments.iter().map(|segment| segment.ends[1]));
        format!("arc length along {}", names.join("–"))
    }

    /// Returns the abscissas of the symmetry points with their names; none for a single segment, whose axis shows numbers.
    fn symmetry_points(&self) -> Vec<(f64, String)> {
        if self.contour.segments.len() < 2 {
            return Vec::new();
        }
        let mut place = 0.0;
        let mut points = vec![(0.0, self.contour.segments[0].ends[0].to_owned())];
        for segment in &self.contour.segments {
            place += segment.length();
            points.push((place, segment.ends[1].to_owned()));
        }
        points
    }

    /// Returns abscissas and time-discrete frequencies of a branch.
    pub fn discrete_branch(&self, branch: usize) -> (Vec<f64>, Vec<f64>) {
        let place = |point: &ContourPoint| {
            let omega = self.discrete(point.branches[branch].omega());
            (point.abscissa, omega)
        };
        self.points.iter().map(place).unzip()
    }

    /// Returns the chart, to which curves can be added.
    pub fn chart(&self, title: &str) -> LineChart {
        let along = self.along();
        let x: Vec<f64> = self.points.iter().map(|point| point.abscissa).collect();
        let across = Axis::new(along, "rad/m").marks(self.symmetry_points());
        let mut chart = LineChart::new(across, Axis::new("ω", "rad/s")).title(title);
        for (number, name) in self.contour.branches.iter().enumerate() {
            let curve = |value: &dyn Fn(&ContourPoint) -> f64| -> Vec<f64> {
                self.points.iter().map(value).collect()
            };
            let discrete = self.dt.is_some();
            let omega = curve(&|point| {
                let omega = point.branches[number].omega();
                if discrete {
                    self.discrete(omega)
                } else {
                    omega
                }
            });
            let target = curve(&|point| self.target(number, point));
            chart = chart.curve(Curve::line(*name, &x, &omega));
            if target.iter().any(|y| y.is_finite()) {
                chart =
                    chart.curve(Curve::line(format!("{name}, continuum"), &x, &target).dashed());
            }
        }
        chart
    }
}

/// Writes the wave speed in the long-wave limit over the direction, as a table and a chart.
pub fn write_polar(
    table: &Path,
    picture: &Path,
    polar: &[PolarSpeeds],
    names: &[&str],
) -> Result<(), IoError> {
    let mut columns = vec![Column::real("angle", "rad")];
    columns.extend(
        names
            .iter()
            .map(|name| Column::real(format!("speed_{name}"), "m/s")),
    );
    let mut csv = CsvTable::create(table, &columns)?;
    for row in polar {
        let mut cells = vec![Cell::from(row.angle)];
        cells.extend(row.speeds.iter().map(|speed| Cell::from(*speed)));
        csv.append(&cells)?;
    }
    csv.flush()?;
    // The curve of the velocity vectors is a circle for an isotropic lattice.
    let axis = |name: &str| Axis::new(format!("speed along {name}"), "m/s");
    let mut chart = LineChart::new(axis("x"), axis("y"))
        .title("wave speed in the long-wave limit by direction")
        .size(900, 900);
    for (number, name) in names.iter().enumerate() {
        let closed = polar.iter().chain(polar.first());
        let (x, y): (Vec<f64>, Vec<f64>) = closed
            .map(|row| {
                let (s, c) = row.angle.sin_cos();
                (row.speeds[number] * c, row.speeds[number] * s)
            })
            .unzip();
        chart = chart.curve(Curve::line(*name, &x, &y));
    }
    chart.write(picture)
}

/// Writes the classes of bonds with one column of coefficients per table.
pub fn write_classes(
    path: &Path,
    classes: &[BondClass],
    tables: &[(String, Vec<f64>)],
) -> Result<(), IoError> {
    let mut columns = ["i", "j", "k"].map(Column::integer).to_vec();
    columns.push(Column::real("length_in_spacings", ""));
    columns.push(Column::integer("multiplicity"));
    columns.extend(tables.iter().map(|(name, _)| Column::real(name, "")));
    let mut csv = CsvTable::create(path, &columns)?;
    for (number, class) in classes.iter().enumerate() {
        let mut cells: Vec<Cell> = class.offset.map(|c| i64::from(c).into()).to_vec();
        cells.push(class.length.into());
        cells.push((class.multiplicity as i64).into());
        cells.extend(tables.iter().map(|(_, alpha)| Cell::from(alpha[number])));
        csv.append(&cells)?;
    }
    csv.flush()
}

/// Writes one bond of each pair ±ξ, for lattices with anisotropic spacing.
pub fn write_bonds(path: &Path, lattice: &BondLattice) -> Result<(), IoError> {
    let mut columns = ["i", "j", "k"].map(Column::integer).to_vec();
    columns.push(Column::real("length", "m"));
    columns.push(Column::real("stiffness_over_density", "m/s2"));
    let mut csv = CsvTable::create(path, &columns)?;
    for bond in lattice.bonds() {
        let mut cells: Vec<Cell> = bond.offset.map(|c| i64::from(c).into()).to_vec();
        cells.extend([bond.length, bond.stiffness].map(Cell::from));
        csv.append(&cells)?;
    }
    csv.flush()
}
