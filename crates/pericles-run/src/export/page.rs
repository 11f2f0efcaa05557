//! Export of a run as a stand-alone page.

use std::io;
use std::path::Path;

use pericles::observe::Field;
use pericles_deck::Model;
use pericles_io::observers::{CarriedLine, ImpactorSurfaces};
use pericles_io::viewer::{Block, PageWriter, Quantised};
use pericles_io::{ColourMap, CsvData, IoError, ResultBody, read_csv, write_atomically};

use super::contents::{
    CellData, ColumnData, FieldData, FieldGroup, FrameData, Header, ImpactorData, LineData,
    MapData, SetData, StepData, TableData, TimeAxisData, groups,
};
use super::run_fields::SelectedFields;
use super::{Exported, Selection};
use crate::build::Discretisation;
use crate::error::RunError;
use crate::observers::body_shape;
use crate::results::{Results, file_name};
use crate::time_axis::TimeAxis;
use crate::units::{bytes, count};

/// Default of the largest size of the fields of a page whose output times are chosen automatically, bytes.
const LIMIT: u64 = 200_000_000;

/// A run with its body.
pub(super) struct RunToShow<'a> {
    pub(super) results: &'a Results,
    pub(super) model: &'a Model,
    pub(super) points: &'a Discretisation,
    pub(super) body: &'a ResultBody,
}

/// Writes the page of a run.
///
/// # Errors
/// Files cannot be read or written.
pub(super) fn write(
    run: &RunToShow<'_>,
    mut fields: SelectedFields,
    selection: &Selection,
    path: &Path,
) -> Result<Exported, RunError> {
    // The displaced cells of every field follow from these two.
    fields.add(Field::Displacement.name());
    fields.add(Field::Damage.name());
    let groups = groups(&fields.specs(), run.body.dimension);
    let mut notes = Vec::new();
    if selection.every.is_none() {
        let limit = selection.size.unwrap_or(LIMIT).max(1);
        let size = expected_size(&mut fields, &groups)?;
        if size > limit {
            fields.keep_every(size.div_ceil(limit) as usize);
            notes.push(format!(
                "The page does not contain all output times, because their fields would have about {}, more than {}. Select fewer fields to keep more output times.",
                bytes(size),
                bytes(limit)
            ));
        }
    }
    if fields.outputs() < fields.all_outputs() {
        notes.push(format!(
            "{} of {} output times are shown.",
            count(fields.outputs() as u64),
            count(fields.all_outputs() as u64)
        ));
    }
    let outputs = fields.outputs();
    let mut failed = None;
    let written = write_atomically(path, |file| {
        let begun = PageWriter::begin(file, &run.title());
        let made = begun.map_err(|error| RunError::from(IoError::writing(path, error)));
        let made = made.and_then(|writer| {
            let page = Page { run, writer, path };
            page.write(&mut fields, &groups, &notes)
        });
        made.map_err(|error| {
            failed = Some(error);
            io::Error::other("the page is incomplete")
        })
    });
    match failed {
        Some(error) => return Err(error),
        None => written?,
    }
    Ok(Exported { outputs, notes })
}

/// Returns the expected size of the fields of a page from some outputs.
fn expected_size(fields: &mut SelectedFields, groups: &[FieldGroup]) -> Result<u64, RunError> {
    let outputs = fields.outputs();
    let mut sampled = vec![outputs / 2, outputs - 1];
    sampled.dedup();
    let mut size = 0;
    for &output in &sampled {
        let (_, values) = fields.read(output)?;
        let encoded = groups.iter().map(|group| Encoded::new(group, &values));
        size += encoded
            .map(|one| one.block.text().len() as u64)
            .sum::<u64>();
    }
    Ok(size * outputs as u64 / sampled.len() as u64)
}

/// A field at an output time.
struct Encoded {
    block: Block,
    /// Its number is not known yet.
    frame: FrameData,
}

impl Encoded {
    /// Rounds and compresses a field; `values` are those of all arrays, component-major.
    fn new(group: &FieldGroup, values: &[Vec<f64>]) -> Self {
        let component = |&(array, component): &(usize, usize)| {
            let n = values[array].len() / group.width;
            &values[array][component * n..(component + 1) * n]
        };
        let components: Vec<&[f64]> = group.arrays.iter().map(component).collect();
        let mut codes = Vec::new();
        let mut frame = FrameData::default();
        for values in &components {
            let rounded = Quantised::new(values);
            frame.low.push(rounded.low);
            frame.step.push(rounded.step);
            frame.ranges.push([rounded.low, rounded.high]);
            codes.extend(rounded.codes);
        }
        if group.is_vector {
            let n = components.first().map_or(0, |first| first.len());
            let norm = |i: usize| {
                let squares = components.iter().map(|values| values[i] * values[i]);
                squares.sum::<f64>().sqrt()
            };
            let norms = (0..n).map(norm).filter(|norm| norm.is_finite());
            let [low, high] = norms.fold(EMPTY, |[low, high], x| [low.min(x), high.max(x)]);
            frame
                .ranges
                .push(if low <= high { [low, high] } else { [0.0; 2] });
        }
        Self {
            block: Block::of_u16(&codes),
            frame,
        }
    }
}

/// The range of no numbers.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl RunToShow<'_> {
    fn title(&self) -> String {
        match self.body.title.as_str() {
            "" => self.results.folder().display().to_string(),
            title => title.to_owned(),
        }
    }
}

/// A page that is being written.
struct Page<'a, 'w> {
    run: &'a RunToShow<'a>,
    writer: PageWriter<'w>,
    path: &'a Path,
}

impl Page<'_, '_> {
    fn write(
        mut self,
        fields: &mut SelectedFields,
        groups: &[FieldGroup],
        notes: &[String],
    ) -> Result<(), RunError> {
        let run = self.run;
        let (results, cloud) = (run.results, &run.points.cloud);
        let along = TimeAxis::of(results);
        let [low, high] = cloud.bounds();
        let origin = std::array::from_fn(|c| 0.5 * (low[c] + high[c]));
        let mut header = Header {
            version: env!("CARGO_PKG_VERSION"),
            title: run.title(),
            deck: results.text("/deck/file").to_owned(),
            dimension: cloud.dimension(),
            points: cloud.len(),
            spacing: cloud.spacing(),
            scale: run
                .model
                .output
                .pictures
                .first()
                .map_or(1.0, |one| one.scale),
            notes: notes.to_vec(),
            axis: TimeAxisData {
                name: along.name(),
                unit: along.unit(),
                scale: along.scale(),
            },
            steps: steps(results),
            maps: colour_maps(),
            origin,
            ..Header::default()
        };
        self.body(&mut header)?;
        self.fields(&mut header, fields, groups)?;
        header.impactors = self.impactors(&header.times, origin)?;
        header.tables = self.tables()?;
        let written = self.writer.finish(&serde_json::to_string(&header)?);
        written.map_err(|error| IoError::writing(self.path, error))?;
        Ok(())
    }

    fn block(&mut self, block: &Block) -> Result<u32, IoError> {
        let written = self.writer.block(block);
        written.map_err(|error| IoError::writing(self.path, error))
    }

    fn integers(&mut self, values: &[u32]) -> Result<u32, IoError> {
        self.block(&Block::of_u32(values))
    }

    /// Adds points, cells, lines and sets.
    fn body(&mut self, header: &mut Header) -> Result<(), RunError> {
        let run = self.run;
        let (points, body) = (run.points, run.body);
        let cloud = &points.cloud;
        let origin = header.origin;
        let n = cloud.len();
        let along = |c: usize, i: usize| match c < body.dimension {
            true => body.positions[c * n + i] - origin[c],
            false => 0.0,
        };
        let positions = (0..3 * n).map(|k| along(k / n, k % n));
        header.positions = self.block(&Block::of_f32(positions))?;
        let mut radii = vec![0.0; n];
        for i in 0..n {
            radii[cloud.user_number(i)] = 0.5 * cloud.cell_size(i);
        }
        header.radii = self.block(&Block::of_f32(radii))?;
        let number = |point: u32| cloud.user_number(point as usize) as u32;
        if let Some(surface) = &points.surface {
            let corners = surface.triangles().iter().flatten();
            let corners: Vec<u32> = corners.map(|&corner| number(corner)).collect();
            header.triangles = Some(self.integers(&corners)?);
        }
        let cracks: Vec<_> = (points.cracks.iter().map(|(crack, _)| crack.clone())).collect();
        let shape = body_shape(run.model, cloud, &points.sets, &points.meshes, &cracks);
        if let Some(cells) = shape.as_ref().and_then(|shape| shape.cells()) {
            let nodes = (0..3).flat_map(|c| cells.nodes.iter().map(move |x| x[c] - origin[c]));
            let of_cells: Vec<u32> = cells.points.iter().map(|&point| number(point)).collect();
            let cut: Vec<u32> = cells.cut.iter().map(|&cut| u32::from(cut)).collect();
            header.cells = Some(CellData {
                nodes: self.block(&Block::of_f32(nodes))?,
                types: self.integers(&cells.types)?,
                corners: self.integers(&cells.corners)?,
                points: self.integers(&of_cells)?,
                across: self.integers(&cells.across)?,
                cut: self.integers(&cut)?,
            });
        }
        let lines: Vec<CarriedLine> = shape.map_or(Vec::new(), |shape| shape.lines_at_rest());
        let places = || lines.iter().flatten();
        let coordinates = places().flat_map(|(place, _)| (0..3).map(move |c| place[c] - origin[c]));
        let carriers: Vec<u32> = places()
            .flat_map(|(_, points)| *points)
            .map(number)
            .collect();
        let lengths: Vec<u32> = lines.iter().map(|line| line.len() as u32).collect();
        header.lines = LineData {
            places: self.block(&Block::of_f32(coordinates))?,
            points: self.integers(&carriers)?,
            lengths: self.integers(&lengths)?,
        };
        for set in &body.sets {
            header.sets.push(SetData {
                name: set.name.clone(),
                points: self.integers(&set.points)?,
            });
        }
        Ok(())
    }

    /// Adds the fields at all output times.
    fn fields(
        &mut self,
        header: &mut Header,
        fields: &mut SelectedFields,
        groups: &[FieldGroup],
    ) -> Result<(), RunError> {
        let start = |group: &FieldGroup| FieldData {
            name: group.name.clone(),
            unit: group.unit,
            components: group.components.clone(),
            is_vector: group.is_vector,
            ..FieldData::default()
        };
        header.fields = groups.iter().map(start).collect();
        let mut last: Vec<Option<Block>> = vec![None; groups.len()];
        for output in 0..fields.outputs() {
            let (time, values) = fields.read(output)?;
            header.times.push(time);
            for ((group, field), last) in groups.iter().zip(&mut header.fields).zip(&mut last) {
                let Encoded { block, mut frame } = Encoded::new(group, &values);
                // Codes that do not change are written once.
                frame.block = match (&last, field.frames.last()) {
                    (Some(last), Some(before)) if *last == block => before.block,
                    _ => self.block(&block)?,
                };
                *last = Some(block);
                field.ranges.resize(frame.ranges.len(), EMPTY);
                for (all, own) in field.ranges.iter_mut().zip(&frame.ranges) {
                    *all = [all[0].min(own[0]), all[1].max(own[1])];
                }
                field.frames.push(frame);
            }
        }
        Ok(())
    }

    /// Adds the impactors at the output times.
    fn impactors(
        &mut self,
        times: &[f64],
        origin: [f64; 3],
    ) -> Result<Vec<ImpactorData>, RunError> {
        let mut all = Vec::new();
        for impactor in &self.run.model.impactors {
            let mut data = ImpactorData {
                name: impactor.name.clone(),
                ..ImpactorData::default()
            };
            for &time in times {
                let names = std::slice::from_ref(&impactor.name);
                let found = ImpactorSurfaces::read(self.run.results.folder(), names, time)?.pop();
                let Some(mesh) = found else {
                    data.frames.push(None);
                    continue;
                };
                if data.triangles.is_none() && !mesh.triangles.is_empty() {
                    data.triangles = Some(self.integers(mesh.triangles.as_flattened())?);
                }
                data.closed = mesh.closed;
                let vertices = mesh.vertices.iter();
                let vertices = vertices.flat_map(|x| (0..3).map(move |c| x[c] - origin[c]));
                data.frames
                    .push(Some(self.block(&Block::of_f32(vertices))?));
            }
            all.push(data);
        }
        Ok(all)
    }

    /// Adds the tables over time.
    fn tables(&mut self) -> Result<Vec<TableData>, RunError> {
        let mut all = Vec::new();
        for path in self.run.results.tables() {
            let name = file_name(&path).trim_end_matches(".csv").to_owned();
            for (part, rows) in parts(&read_csv(&path)?) {
                let Some(time) = rows.column("time").filter(|time| time.len() > 1) else {
                    continue;
                };
                let stride = time.len().div_ceil(MOST_ROWS);
                let thinned = |values: &[f64]| -> Vec<f64> {
                    let kept =
                        (0..values.len()).filter(|k| k % stride == 0 || k + 1 == values.len());
                    kept.map(|k| values[k]).collect()
                };
                let time = self.block(&Block::of_f64(&thinned(time)))?;
                let mut columns = Vec::new();
                for (column, values) in rows.columns.iter().zip(&rows.values) {
                    if ["step", "time", "crack"].contains(&column.name()) {
                        continue;
                    }
                    columns.push(ColumnData {
                        name: format!("{part}{}", column.name()),
                        unit: column.unit().to_owned(),
                        constant: !values.iter().any(|x| *x != values[0] && !x.is_nan()),
                        block: self.block(&Block::of_f64(&thinned(values)))?,
                    });
                }
                if !columns.is_empty() {
                    all.push(TableData {
                        name: name.clone(),
                        time,
                        columns,
                    });
                }
            }
        }
        Ok(all)
    }
}

/// Most rows of a table: more than a chart has pixels are not visible.
const MOST_ROWS: usize = 4000;

/// Returns a table, or, of a table with several rows for each time, the rows of each crack with a prefix for their columns.
fn parts(table: &CsvData) -> Vec<(String, CsvData)> {
    let Some(place) = table
        .columns
        .iter()
        .position(|column| column.name() == "crack")
    else {
        return vec![(String::new(), table.clone())];
    };
    let mut cracks = table.values[place].clone();
    cracks.sort_unstable_by(f64::total_cmp);
    cracks.dedup();
    let part = |crack: f64| {
        let rows = |values: &Vec<f64>| {
            let rows = values.iter().zip(&table.values[place]);
            rows.filter(|(_, number)| **number == crack)
                .map(|(value, _)| *value)
                .collect()
        };
        let data = CsvData {
            columns: table.columns.clone(),
            values: table.values.iter().map(rows).collect(),
        };
        (format!("crack_{crack}_"), data)
    };
    cracks.into_iter().map(part).collect()
}

/// Returns the steps of a run of several steps.
fn steps(results: &Results) -> Vec<StepData> {
    let list = results
        .value("/steps")
        .and_then(serde_json::Value::as_array);
    let step = |value: &serde_json::Value| {
        Some(StepData {
            name: value["name"].as_str()?.to_owned(),
            start: value["start"].as_f64()?,
        })
    };
    list.into_iter().flatten().filter_map(step).collect()
}

fn colour_maps() -> Vec<MapData> {
    /// Colours between which the maps interpolate linearly.
    const COLOURS: usize = 17;
    let maps = [
        ("viridis", ColourMap::Viridis),
        ("diverging", ColourMap::Diverging),
        ("grey", ColourMap::Grey),
    ];
    maps.map(|(name, map)| {
        let colour = |k: usize| map.colour(k as f64 / (COLOURS - 1) as f64);
        MapData {
            name,
            colours: (0..COLOURS).map(colour).collect(),
        }
    })
    .into()
}
