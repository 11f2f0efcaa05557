//! Exodus II, output by output.
//!
//! The file is CDF-2: a header, values that do not change, then one record for each output. A record is appended first, then the number of records is
//! written: a run that is killed leaves a whole file. To resume, the file is cut after a number of records.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::cdf::{Attribute, Header, Places, Type};
use super::{FieldSpec, Numbers, WriteError, check_fields, check_values, unsuitable};

/// The longest name; one byte more ends it.
const NAME: usize = 32;

/// A named list of points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PointList {
    /// The name.
    pub name: String,
    /// The points, from 0.
    pub points: Vec<u32>,
}

/// What a file holds.
#[derive(Debug, Clone)]
pub struct ExodusLayout<'a> {
    /// A title of at most 80 characters.
    pub title: String,
    /// Number of coordinates of a point.
    pub dimension: usize,
    /// Positions, component-major, m.
    pub positions: &'a [f64],
    /// Volumes of the points, m³.
    pub volumes: &'a [f64],
    /// Blocks, such as materials: every point is in exactly one.
    pub blocks: Vec<PointList>,
    /// Node sets.
    pub sets: Vec<PointList>,
    /// Names of numbers of the whole body.
    pub globals: Vec<String>,
    /// Fields on the points.
    pub fields: Vec<FieldSpec>,
    /// Whether fields are written with four bytes a number in place of eight.
    pub is_single: bool,
}

impl ExodusLayout<'_> {
    fn points(&self) -> usize {
        self.volumes.len()
    }

    fn check(&self) -> Result<(), WriteError> {
        check_fields(&self.fields)?;
        let points = self.points();
        if points == 0 {
            return unsuitable("there are no points");
        }
        if !(1..=3).contains(&self.dimension) || self.positions.len() != self.dimension * points {
            return unsuitable(format!(
                "{} coordinates are given for {points} points of {} dimensions",
                self.positions.len(),
                self.dimension
            ));
        }
        let mut seen = vec![false; points];
        for &point in self.blocks.iter().flat_map(|block| &block.points) {
            match seen.get_mut(point as usize) {
                Some(seen) if !*seen => *seen = true,
                Some(_) => return unsuitable(format!("point {point} is in two blocks")),
                None => return unsuitable(format!("a block has the point {point} of {points}")),
            }
        }
        if let Some(point) = seen.iter().position(|seen| !seen) {
            return unsuitable(format!("point {point} is in no block"));
        }
        for set in &self.sets {
            if let Some(point) = set.points.iter().find(|&&p| p as usize >= points) {
                return unsuitable(format!(
                    "the set {:?} has the point {point} of {points}",
                    set.name
                ));
            }
        }
        Ok(())
    }
}

/// Values of a variable that do not change.
enum Fixed<'a> {
    Int(Vec<i32>),
    Texts(Vec<String>),
    Component(usize),
    /// Radius and volume of the points of a block.
    Spheres(&'a [u32]),
}

/// A file that grows by one record for each output.
#[derive(Debug)]
pub struct ExodusWriter {
    file: File,
    places: Places,
    points: usize,
    globals: usize,
    fields: Vec<FieldSpec>,
    numbers: Numbers,
    records: u32,
}

/// Names of at most 32 bytes that differ from each other.
fn names<'a>(given: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let cut = |name: &str, most: usize| {
        let mut end = name.len().min(most);
        while !name.is_char_boundary(end) {
            end -= 1;
        }
        name[..end].to_owned()
    };
    for name in given {
        let mut short = cut(name, NAME);
        let mut number = 2;
        while names.contains(&short) {
            let ending = format!("_{number}");
            short = cut(name, NAME - ending.len()) + &ending;
            number += 1;
        }
        names.push(short);
    }
    names
}

/// The endings of the names of components, which viewers join to vectors and tensors.
fn endings(columns: usize) -> Vec<String> {
    let words: &[&str] = match columns {
        1 => &[""],
        3 => &["X", "Y", "Z"],
        6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
        _ => return (1..=columns).map(|k| format!("_{k}")).collect(),
    };
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Names of all columns of all fields.
fn column_names(fields: &[FieldSpec]) -> Vec<String> {
    let longest = |field: &FieldSpec| endings(field.columns()).iter().map(String::len).max();
    // Fields are shortened so that their endings stay.
    let short = fields.iter().map(|field| {
        let room = NAME - longest(field).unwrap_or(0);
        let mut end = field.name.len().min(room);
        while !field.name.is_char_boundary(end) {
            end -= 1;
        }
        (&field.name[..end], field.columns())
    });
    let all: Vec<String> = short
        .flat_map(|(name, columns)| {
            let endings = endings(columns).into_iter();
            endings.map(move |ending| format!("{name}{ending}"))
        })
        .collect();
    names(all.iter().map(String::as_str))
}

/// The variables of a file with the values that do not change.
struct Description<'a> {
    header: Header,
    fixed: Vec<(usize, Fixed<'a>)>,
    /// Dimensions: the length of names, the points, the records.
    name: usize,
    nodes: usize,
    time: usize,
}

impl<'a> Description<'a> {
    fn new(layout: &'a ExodusLayout<'_>) -> Result<Self, WriteError> {
        let mut header = Header::default();
        header.attribute("api_version", Attribute::Float(8.11));
        header.attribute("version", Attribute::Float(8.11));
        let size = if layout.is_single { 4 } else { 8 };
        header.attribute("floating_point_word_size", Attribute::Int(size));
        header.attribute("file_size", Attribute::Int(1));
        header.attribute("maximum_name_length", Attribute::Int(NAME as i32));
        header.attribute("int64_status", Attribute::Int(0));
        let title = layout.title.chars().filter(char::is_ascii).take(80);
        header.attribute("title", Attribute::Text(title.collect()));
        header.dimension("len_string", NAME + 1)?;
        header.dimension("len_line", 81)?;
        header.dimension("four", 4)?;
        let name = header.dimension("len_name", NAME + 1)?;
        let time = header.dimension("time_step", 0)?;
        let axes = header.dimension("num_dim", 3)?;
        let nodes = header.dimension("num_nodes", layout.points())?;
        header.dimension("num_elem", layout.points())?;
        let mut own = Self {
            header,
            fixed: Vec::new(),
            name,
            nodes,
            time,
        };
        for (c, axis) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
            own.add(axis, Type::Double, &[nodes], Fixed::Component(c));
        }
        own.add_texts(
            "coor_names",
            axes,
            ["x", "y", "z"].map(str::to_owned).to_vec(),
        );
        own.blocks(layout)?;
        own.sets(layout)?;
        own.records(layout)?;
        Ok(own)
    }

    fn add(
        &mut self,
        name: impl Into<String>,
        kind: Type,
        dimensions: &[usize],
        values: Fixed<'a>,
    ) {
        let number = self.header.variable(name, kind, dimensions);
        self.fixed.push((number, values));
    }

    fn add_texts(&mut self, name: impl Into<String>, count: usize, texts: Vec<String>) {
        let dimensions = [count, self.name];
        self.add(name, Type::Character, &dimensions, Fixed::Texts(texts));
    }

    /// Status, identities and names of blocks or sets.
    fn add_lists(&mut self, word: &str, dimension: usize, lists: &[&PointList]) {
        let count = lists.len();
        let status = Fixed::Int(vec![1; count]);
        self.add(format!("{word}_status"), Type::Int, &[dimension], status);
        let identities = Fixed::Int((1..=count as i32).collect());
        self.add(format!("{word}_prop1"), Type::Int, &[dimension], identities);
        self.header.of_last("name", "ID");
        let words = names(lists.iter().map(|list| list.name.as_str()));
        self.add_texts(format!("{word}_names"), dimension, words);
    }

    fn blocks(&mut self, layout: &'a ExodusLayout<'_>) -> Result<(), WriteError> {
        let blocks = layout
            .blocks
            .iter()
            .filter(|block| !block.points.is_empty());
        let blocks: Vec<&PointList> = blocks.collect();
        let all = self.header.dimension("num_el_blk", blocks.len())?;
        self.add_lists("eb", all, &blocks);
        for (k, block) in (1..).zip(&blocks) {
            let count = block.points.len();
            let elements = self.header.dimension(format!("num_el_in_blk{k}"), count)?;
            let one = self.header.dimension(format!("num_nod_per_el{k}"), 1)?;
            let two = self.header.dimension(format!("num_att_in_blk{k}"), 2)?;
            let corners = Fixed::Int(block.points.iter().map(|&p| p as i32 + 1).collect());
            self.add(format!("connect{k}"), Type::Int, &[elements, one], corners);
            self.header.of_last("elem_type", "SPHERE");
            let spheres = Fixed::Spheres(&block.points);
            self.add(
                format!("attrib{k}"),
                Type::Double,
                &[elements, two],
                spheres,
            );
            let words = ["radius", "volume"].map(str::to_owned).to_vec();
            self.add_texts(format!("attrib_name{k}"), two, words);
        }
        Ok(())
    }

    fn sets(&mut self, layout: &'a ExodusLayout<'_>) -> Result<(), WriteError> {
        let sets = layout.sets.iter().filter(|set| !set.points.is_empty());
        let sets: Vec<&PointList> = sets.collect();
        if sets.is_empty() {
            return Ok(());
        }
        let all = self.header.dimension("num_node_sets", sets.len())?;
        self.add_lists("ns", all, &sets);
        for (k, set) in (1..).zip(&sets) {
            let members = self
                .header
                .dimension(format!("num_nod_ns{k}"), set.points.len())?;
            let numbers = Fixed::Int(set.points.iter().map(|&p| p as i32 + 1).collect());
            self.add(format!("node_ns{k}"), Type::Int, &[members], numbers);
        }
        Ok(())
    }

    /// The time, numbers of the whole body, then a variable for each column, in this order.
    fn records(&mut self, layout: &ExodusLayout<'_>) -> Result<(), WriteError> {
        let columns = column_names(&layout.fields);
        let count = columns.len();
        let mut globals = None;
        if !layout.globals.is_empty() {
            let all = self.header.dimension("num_glo_var", layout.globals.len())?;
            let words = names(layout.globals.iter().map(String::as_str));
            self.add_texts("name_glo_var", all, words);
            globals = Some(all);
        }
        if !columns.is_empty() {
            let all = self.header.dimension("num_nod_var", count)?;
            self.add_texts("name_nod_var", all, columns);
        }
        self.header
            .variable("time_whole", Type::Double, &[self.time]);
        if let Some(all) = globals {
            let dimensions = [self.time, all];
            self.header
                .variable("vals_glo_var", Type::Double, &dimensions);
        }
        let kind = match layout.is_single {
            true => Type::Float,
            false => Type::Double,
        };
        for k in 1..=count {
            let dimensions = [self.time, self.nodes];
            self.header
                .variable(format!("vals_nod_var{k}"), kind, &dimensions);
        }
        Ok(())
    }
}

impl ExodusWriter {
    /// Makes a file without outputs.
    ///
    /// # Errors
    /// A file that cannot be written, arrays that do not fit together, a point that is not in exactly one block, more points than the format can hold.
    pub fn create(path: impl AsRef<Path>, layout: &ExodusLayout<'_>) -> Result<Self, WriteError> {
        layout.check()?;
        let Description { header, fixed, .. } = Description::new(layout)?;
        let places = header.places()?;
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(true)
            .open(path)?;
        file.write_all(&places.header)?;
        for (variable, values) in &fixed {
            write_fixed(&mut file, places.begins[*variable], values, layout)?;
        }
        file.set_len(places.first_record)?;
        Ok(Self::of(file, places, layout, 0))
    }

    fn of(file: File, places: Places, layout: &ExodusLayout<'_>, records: u32) -> Self {
        Self {
            file,
            places,
            points: layout.points(),
            globals: layout.globals.len(),
            fields: layout.fields.clone(),
            numbers: Numbers {
                is_single: layout.is_single,
                is_little: false,
            },
            records,
        }
    }

    /// Continues a file after a number of outputs; what it holds beyond these is cut off.
    ///
    /// # Errors
    /// A file that cannot be written, is of another layout, or holds fewer outputs.
    pub fn resume(
        path: impl AsRef<Path>,
        layout: &ExodusLayout<'_>,
        outputs: usize,
    ) -> Result<Self, WriteError> {
        layout.check()?;
        let places = Description::new(layout)?.header.places()?;
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let mut begin = vec![0; places.header.len()];
        let other = || WriteError::NotContinued("its header is that of another run".into());
        file.read_exact(&mut begin).map_err(|_| other())?;
        if begin[..4] != places.header[..4] || begin[8..] != places.header[8..] {
            return Err(other());
        }
        let found = u32::from_be_bytes([begin[4], begin[5], begin[6], begin[7]]);
        let needed = u32::try_from(outputs).unwrap_or(u32::MAX);
        let end = places.first_record + u64::from(needed) * places.record_bytes;
        if found < needed || file.metadata()?.len() < end {
            return Err(WriteError::NotContinued(format!(
                "it holds {found} outputs; {needed} are needed"
            )));
        }
        let mut writer = Self::of(file, places, layout, needed);
        writer.publish()?;
        writer.file.set_len(end)?;
        Ok(writer)
    }

    /// The number of outputs.
    pub fn outputs(&self) -> usize {
        self.records as usize
    }

    /// Writes an output: the time (s), numbers of the whole body, and a component-major array for each field.
    ///
    /// # Errors
    /// A file that cannot be written, arrays that do not fit together.
    pub fn append(
        &mut self,
        time: f64,
        globals: &[f64],
        values: &[&[f64]],
    ) -> Result<(), WriteError> {
        check_values(&self.fields, values, self.points)?;
        if globals.len() != self.globals {
            return unsuitable(format!(
                "{} global numbers are given; {} are needed",
                globals.len(),
                self.globals
            ));
        }
        let mut place =
            self.places.first_record + u64::from(self.records) * self.places.record_bytes;
        let doubles = Numbers {
            is_single: false,
            is_little: false,
        };
        doubles.write_at(&mut self.file, place, 1, |_| time)?;
        place += 8;
        doubles.write_at(&mut self.file, place, globals.len(), |k| globals[k])?;
        place += 8 * globals.len() as u64;
        let points = self.points;
        for (field, values) in self.fields.iter().zip(values) {
            for column in 0..field.columns() {
                let number = |i: usize| match column < field.components {
                    true => values[column * points + i],
                    false => 0.0,
                };
                self.numbers
                    .write_at(&mut self.file, place, points, number)?;
                place += self.numbers.bytes() * points as u64;
            }
        }
        self.records += 1;
        self.publish()
    }

    /// Writes the number of records into the header.
    fn publish(&mut self) -> Result<(), WriteError> {
        self.file.seek(SeekFrom::Start(4))?;
        self.file.write_all(&self.records.to_be_bytes())?;
        Ok(())
    }
}

fn write_fixed(
    file: &mut File,
    place: u64,
    values: &Fixed<'_>,
    layout: &ExodusLayout<'_>,
) -> Result<(), WriteError> {
    let points = layout.points();
    let doubles = Numbers {
        is_single: false,
        is_little: false,
    };
    match values {
        Fixed::Int(numbers) => {
            let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_be_bytes()).collect();
            file.seek(SeekFrom::Start(place))?;
            file.write_all(&bytes)?;
        }
        Fixed::Texts(texts) => {
            let mut bytes = Vec::new();
            for text in texts {
                let end = bytes.len() + NAME + 1;
                bytes.extend_from_slice(text.as_bytes());
                bytes.resize(end, 0);
            }
            file.seek(SeekFrom::Start(place))?;
            file.write_all(&bytes)?;
        }
        Fixed::Component(c) => {
            let number = |i: usize| match *c < layout.dimension {
                true => layout.positions[c * points + i],
                false => 0.0,
            };
            doubles.write_at(file, place, points, number)?;
        }
        Fixed::Spheres(members) => {
            let number = |k: usize| {
                let volume = layout.volumes[members[k / 2] as usize];
                match k % 2 {
                    0 => (0.75 * volume / std::f64::consts::PI).cbrt(),
                    _ => volume,
                }
            };
            doubles.write_at(file, place, 2 * members.len(), number)?;
        }
    }
    Ok(())
}
