//! Motion of impactors and the forces on them over time.

use std::path::{Path, PathBuf};

use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles::units::BodyUnits;
use pericles::{Archive, Checkpointed, Result, Values};

use super::rigid::{RigidMesh, impactors};
use super::signals::Signals;
use super::table::{AXES, misfit, whole};
use crate::csv::{Cell, Column};
use crate::error::IoError;
use crate::file_stem::file_stem;
use crate::vtk::{PvdSeries, read_polydata, write_polydata};

/// Energies of contact, as columns of a history: energy stored by contact, energy dissipated by dampers and friction,
/// kinetic energy of free impactors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactColumns {
    /// Units of the energies.
    pub units: BodyUnits,
}

impl Signals for ContactColumns {
    fn columns(&self) -> Vec<Column> {
        let names = ["contact_energy", "contact_dissipated", "impactor_kinetic"];
        names
            .map(|name| Column::real(name, self.units.unit("J")))
            .into()
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let energies = snapshot.energies();
        let all = [
            energies.contact,
            energies.contact_dissipated,
            energies.bodies,
        ];
        Ok(all.map(Cell::Real).into())
    }
}

/// Place, motion and contact of impactors.
///
/// For each impactor the position of its centre of mass `<name>_<axis>` (m), its velocity
/// `<name>_v_<axis>` (m/s), its angular velocity `<name>_spin_<axis>` (rad/s; about z only in two dimensions), force
/// `<name>_force_<axis>` (N) and torque `<name>_torque_<axis>` (N m) on it, the impulse that it has given to the body
/// `<name>_impulse_<axis>` (N s), the number of points in contact and the largest overlap (m).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImpactorSignals {
    /// Names of the impactors.
    pub names: Vec<String>,
    /// Dimension of the body.
    pub dimension: usize,
    /// Units of forces and impulses.
    pub units: BodyUnits,
}

/// Returns the axes about which impactors rotate.
fn about(dimension: usize) -> &'static [&'static str] {
    match dimension {
        1 => &[],
        2 => &AXES[2..],
        _ => &AXES,
    }
}

impl Signals for ImpactorSignals {
    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for name in &self.names {
            let mut add = |quantity: &str, axes: &[&str], unit: &str| {
                for axis in axes {
                    columns.push(Column::real(format!("{name}{quantity}_{axis}"), unit));
                }
            };
            let (along, about) = (&AXES[..self.dimension], about(self.dimension));
            add("", along, "m");
            add("_v", along, "m/s");
            add("_spin", about, "rad/s");
            add("_force", along, &self.units.unit("N"));
            add("_torque", about, &self.units.unit("N m"));
            add("_impulse", along, &self.units.unit("N s"));
            columns.push(Column::integer(format!("{name}_points")));
            columns.push(Column::real(format!("{name}_overlap"), "m"));
        }
        columns
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let mut cells = Vec::new();
        let turns = 3 - about(self.dimension).len();
        for impactor in impactors(snapshot.system()) {
            let reading = impactor.reading();
            let mut add = |values: &[f64]| cells.extend(values.iter().map(|&x| Cell::Real(x)));
            add(&reading.centre[..self.dimension]);
            add(&reading.velocity[..self.dimension]);
            add(&reading.spin[turns..]);
            add(&reading.force[..self.dimension]);
            add(&reading.torque[turns..]);
            add(&reading.impulse[..self.dimension]);
            cells.push(whole(reading.points));
            cells.push(reading.overlap.into());
        }
        Ok(cells)
    }
}

/// The impactors as surfaces over time: for each one a series `<name>.pvd` with files `impactors/<name>_000000.vtp`.
/// Bodies in the plane are polygons and lines.
pub struct ImpactorSurfaces {
    folder: PathBuf,
    names: Vec<String>,
    series: Vec<PvdSeries>,
    outputs: usize,
}

impl ImpactorSurfaces {
    /// Name of the subfolder of the files, which must exist.
    pub const FOLDER: &'static str = "impactors";

    /// Creates the series of impactors with these names in an output folder.
    pub fn new(folder: impl Into<PathBuf>, names: &[String]) -> Self {
        Self {
            folder: folder.into(),
            names: Self::file_names(names),
            series: Vec::new(),
            outputs: 0,
        }
    }

    /// Returns the names of the files of impactors: `impactor-` and the name of the impactor, with other characters than
    /// letters, digits, `-` and `_` replaced; long ones are shortened, equal ones numbered.
    pub fn file_names(names: &[String]) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for name in names {
            let stem = format!("impactor-{}", file_stem(name, "-_"));
            let mut file = stem.clone();
            let mut number = 2;
            while found.contains(&file) {
                file = format!("{stem}-{number}");
                number += 1;
            }
            found.push(file);
        }
        found
    }

    /// Reads the impactors with these names at a time, s, from the files of a run; those without a file at this time are
    /// left out.
    ///
    /// # Errors
    /// A file is damaged.
    pub fn read(
        folder: &Path,
        names: &[String],
        time: f64,
    ) -> std::result::Result<Vec<RigidMesh>, IoError> {
        let mut meshes = Vec::new();
        for name in Self::file_names(names) {
            let series = folder.join(format!("{name}.pvd"));
            if !series.exists() {
                continue;
            }
            let outputs = PvdSeries::read(&series)?;
            let Some((_, file)) = outputs.into_iter().find(|(t, _)| *t == time) else {
                continue;
            };
            let (vertices, polygons, lines) = read_polydata(&folder.join(file))?;
            let triangles = polygons.iter();
            let triangles = triangles.filter_map(|one| <[u32; 3]>::try_from(&one[..]).ok());
            meshes.push(RigidMesh {
                vertices,
                triangles: triangles.collect(),
                closed: lines.is_empty(),
            });
        }
        Ok(meshes)
    }

    fn pvd(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.pvd"))
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        if self.series.is_empty() {
            let names = self.names.iter();
            let series = names.map(|name| PvdSeries::create(self.pvd(name)));
            self.series = series.collect::<std::result::Result<_, _>>()?;
        }
        let (system, t) = (snapshot.system(), snapshot.state().t);
        let cloud = snapshot.whole_cloud();
        let all = impactors(system).zip(&self.names).zip(&mut self.series);
        for ((impactor, name), series) in all {
            let file = format!("{}/{name}_{:06}.vtp", Self::FOLDER, self.outputs);
            let mesh = RigidMesh::of(impactor, cloud);
            let polygon: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
            let (polygons, lines): (Vec<&[u32]>, Vec<&[u32]>) = match mesh.triangles.is_empty() {
                false => (mesh.triangles.iter().map(|one| &one[..]).collect(), vec![]),
                true if mesh.closed => (vec![&polygon], vec![]),
                true => (vec![], vec![&polygon]),
            };
            let path = self.folder.join(&file);
            let velocity = impactor.reading().velocity;
            write_polydata(
                &path,
                t,
                &mesh.vertices,
                (&polygons, &lines),
                ("Velocity", velocity),
            )?;
            series.push(t, &file)?;
        }
        self.outputs += 1;
        Ok(())
    }
}

impl Observer for ImpactorSurfaces {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        match snapshot.is_written() {
            true => Ok(self.write(snapshot)?),
            false => Ok(()),
        }
    }

    fn observe_failed(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.observe(snapshot)
    }
}

impl Checkpointed for ImpactorSurfaces {
    fn save(&self, archive: &mut Archive) {
        let Self {
            outputs,
            // The series are reopened.
            series: _,
            folder: _,
            names: _,
        } = self;
        let outputs = Values::U64(vec![*outputs as u64]);
        archive.put("observer/impactor-surfaces", outputs);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut outputs = 0;
        archive.u64_into(
            "observer/impactor-surfaces",
            std::slice::from_mut(&mut outputs),
        )?;
        self.outputs = outputs as usize;
        let names = self.names.iter().filter(|_| outputs > 0);
        let series = names.map(|name| PvdSeries::reopen(self.pvd(name), outputs as usize));
        self.series = series
            .collect::<std::result::Result<_, _>>()
            .map_err(misfit)?;
        Ok(())
    }
}
