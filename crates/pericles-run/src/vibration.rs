//! Natural modes of an assembled body, with output as table, fields and pictures.

use std::path::Path;
use std::sync::Arc;

use pericles::space::PointCloud;
use pericles::{Interrupt, System};
use pericles_deck::Model;
use pericles_io::observers::BodyShape;
use pericles_io::{
    CellSize, ColourMap, Column, CsvTable, FieldPicture, IoError, OutputFolder, PvdSeries,
    VtkField, VtuFile, in_user_order, write_animation,
};
use pericles_manifold::surface::Surface;
use pericles_statics::{Mode, ModeOptions, NaturalModes};
use rayon::prelude::*;

use crate::build::Assembly;
use crate::error::RunError;
use crate::observers::{body_shape, cracks};

/// Natural modes of a body.
pub struct Vibration {
    /// The modes.
    pub modes: NaturalModes,
    cloud: Arc<PointCloud>,
    surface: Option<Arc<Surface>>,
    shape: Option<BodyShape>,
}

/// Number of pictures of an animation over one period.
const STILLS: usize = 16;
/// Largest displacement in pictures, relative to the longest side of the body.
const ENLARGED: f64 = 0.08;

impl Vibration {
    /// Computes the lowest modes of the body of a model with its initial constraints: about the undeformed body or, if
    /// `prestressed`, about the last state of its simulation, which must be static.
    ///
    /// # Errors
    /// The simulation fails, and the errors of [`NaturalModes::find`].
    pub fn of(
        model: &Model,
        assembly: Assembly,
        options: ModeOptions,
        prestressed: bool,
    ) -> Result<Self, RunError> {
        let (cloud, surface) = (assembly.cloud.clone(), assembly.surface.clone());
        let (sets, meshes) = (&assembly.sets, &assembly.meshes);
        let shape = body_shape(model, &cloud, sets, meshes, &cracks(&assembly));
        let find = |system: &System, t: f64, u: &[f64]| {
            NaturalModes::find(options, system, (t, u), Interrupt::never())
        };
        let modes = if prestressed {
            let mut simulation = assembly.simulation()?;
            let ended = simulation.run_to_end();
            ended.map_err(|error| RunError::of_run(error, String::new))?;
            let state = simulation.state();
            find(simulation.system(), state.t, &state.u)
        } else {
            let rest = vec![0.0; assembly.state.u.len()];
            find(&assembly.system, 0.0, &rest)
        };
        Ok(Self {
            modes: modes?,
            cloud,
            surface,
            shape,
        })
    }

    /// Returns the number of points of the body.
    pub fn points(&self) -> usize {
        self.cloud.len()
    }

    /// Writes `modes.csv`, `modes.pvd` with a field `Mode_Shape` per mode (largest displacement 1; the time value is
    /// the mode number) and a picture of each mode; with `animated` also an animation of one period.
    ///
    /// # Errors
    /// Files cannot be written.
    pub fn write(
        &self,
        folder: &OutputFolder,
        title: &str,
        animated: bool,
    ) -> Result<(), RunError> {
        self.write_table(&folder.file("modes.csv"))?;
        folder.subfolder("modes")?;
        let mut series = PvdSeries::create(folder.file("modes.pvd"))?;
        let numbered: Vec<(u32, &Mode)> = (1..).zip(&self.modes.modes).collect();
        for (number, mode) in &numbered {
            let file = format!("modes/mode_{number:03}.vtu");
            self.write_fields(&folder.file(&file), *number, &self.normalised(mode))?;
            series.push(f64::from(*number), &file)?;
        }
        // Pictures take longer than the modes of a small body.
        numbered
            .into_par_iter()
            .try_for_each(|(number, mode)| self.draw(folder, title, (number, mode), animated))
    }

    /// Draws the picture of a mode and, if wanted, its animation.
    fn draw(
        &self,
        folder: &OutputFolder,
        title: &str,
        (number, mode): (u32, &Mode),
        animated: bool,
    ) -> Result<(), RunError> {
        let stem = format!("modes/mode_{number:03}");
        let shape = self.normalised(mode);
        let drawn = Drawn {
            body: self,
            title: format!(
                "{title}{}mode {number}, {}",
                if title.is_empty() { "" } else { ": " },
                pericles::units::quantity(mode.frequency_hz, "Hz")
            ),
            values: self.values(&shape),
            shape,
        };
        drawn.write(&folder.file(format!("{stem}.png")), None)?;
        if animated {
            drawn.animate(folder, &stem)?;
        }
        Ok(())
    }

    fn write_table(&self, path: &Path) -> Result<(), IoError> {
        let columns = [
            Column::integer("mode"),
            Column::real("frequency", "Hz"),
            Column::real("residual", ""),
        ];
        let mut table = CsvTable::create(path, &columns)?;
        for (number, mode) in (1i64..).zip(&self.modes.modes) {
            table.append(&[
                number.into(),
                mode.frequency_hz.into(),
                mode.residual.into(),
            ])?;
        }
        table.flush()
    }

    fn write_fields(&self, path: &Path, number: u32, shape: &[f64]) -> Result<(), IoError> {
        let cloud = &*self.cloud;
        let positions = in_user_order(cloud, cloud.positions());
        let shape = in_user_order(cloud, shape);
        let triangles: Vec<[u32; 3]> = self.surface.as_ref().map_or_else(Vec::new, |surface| {
            let number = |vertex: u32| surface.user_number(vertex as usize) as u32;
            let triangles = surface.triangles().iter();
            triangles.map(|triangle| triangle.map(number)).collect()
        });
        let mut file = VtuFile::new(cloud.dimension(), &positions)
            .time(f64::from(number))
            .field(VtkField::vector("Mode_Shape", &shape));
        if !triangles.is_empty() {
            file = file.triangles(&triangles);
        }
        file.write(path)
    }

    /// Returns the mode shape with a largest displacement of 1.
    fn normalised(&self, mode: &Mode) -> Vec<f64> {
        let largest = self.sizes(&mode.shape).into_iter().fold(0.0, f64::max);
        let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        mode.shape.iter().map(|x| scale * x).collect()
    }

    fn sizes(&self, shape: &[f64]) -> Vec<f64> {
        let n = self.cloud.len();
        let square = |i: usize| shape.iter().skip(i).step_by(n).map(|x| x * x).sum::<f64>();
        (0..n).map(|i| square(i).sqrt()).collect()
    }

    /// Returns the values shown by colours: the displacement of a bar, its magnitude for other bodies.
    fn values(&self, shape: &[f64]) -> Vec<f64> {
        match self.cloud.dimension() {
            1 => shape.to_vec(),
            _ => self.sizes(shape),
        }
    }
}

/// A mode to be drawn.
struct Drawn<'a> {
    body: &'a Vibration,
    title: String,
    shape: Vec<f64>,
    values: Vec<f64>,
}

impl Drawn<'_> {
    /// Writes a picture at the largest displacement, or at a fraction of it with the axes of an animation.
    fn write(&self, path: &Path, part: Option<f64>) -> Result<(), IoError> {
        let cloud = &*self.body.cloud;
        let dimension = cloud.dimension();
        let sizes: Vec<f64>;
        let cell = if cloud.lattice().is_some() {
            CellSize::Uniform(cloud.spacing())
        } else {
            sizes = (0..cloud.len()).map(|i| cloud.cell_size(i)).collect();
            CellSize::PerPoint(&sizes)
        };
        let (low, high) = corners(cloud);
        let longest = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
        let factor = part.unwrap_or(1.0);
        // Magnitudes have no sign.
        let of_values = if dimension == 1 { factor } else { factor.abs() };
        let values: Vec<f64> = self.values.iter().map(|value| of_values * value).collect();
        let (colours, least) = match dimension {
            1 => (ColourMap::Diverging, -1.0),
            _ => (ColourMap::Viridis, 0.0),
        };
        let mut picture = FieldPicture::new(dimension, cloud.positions(), &values, cell)
            .label("Mode shape", "")
            .displacement(&self.shape, factor * ENLARGED * longest)
            .title(&self.title)
            .colours(colours)
            .range(least, 1.0);
        if let Some(surface) = &self.body.surface {
            picture = picture.triangles(surface.triangles());
        }
        if let Some(shape) = &self.body.shape {
            let drawn = shape.drawn(cloud, &self.shape, None, factor * ENLARGED * longest);
            picture = picture.polygons(drawn.polygons).lines(drawn.lines);
        }
        if part.is_some() {
            let around = 1.2 * ENLARGED * longest + 0.5 * cloud.spacing();
            picture = picture.window(low.map(|x| x - around), high.map(|x| x + around));
        }
        picture.write(path)
    }

    fn animate(&self, folder: &OutputFolder, stem: &str) -> Result<(), RunError> {
        let mut stills = Vec::new();
        for still in 0..STILLS {
            let phase = std::f64::consts::TAU * still as f64 / STILLS as f64;
            let path = folder.file(format!("{stem}-{still:02}.png"));
            self.write(&path, Some(phase.cos()))?;
            stills.push(path);
        }
        write_animation(&stills, folder.file(format!("{stem}.apng")))?;
        for still in &stills {
            std::fs::remove_file(still).map_err(|error| IoError::writing(still, error))?;
        }
        Ok(())
    }
}

/// Returns opposite corners of the bounding box of the points.
fn corners(cloud: &PointCloud) -> ([f64; 3], [f64; 3]) {
    let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
    for c in 0..cloud.dimension() {
        let axis = cloud.axis(c).iter().copied();
        low[c] = axis.clone().fold(f64::INFINITY, f64::min);
        high[c] = axis.fold(f64::NEG_INFINITY, f64::max);
    }
    (low, high)
}
