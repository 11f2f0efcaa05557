//! Dimensions and variables of an Exodus file, and constant values.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write};

use super::{ExodusLayout, PointList};
use crate::results::cdf::{Attribute, Header, Type};
use crate::results::names::{NAME, column_names, names};
use crate::results::{Numbers, WriteError};

/// Constant values of a variable.
pub(super) enum Fixed<'a> {
    Int(Vec<i32>),
    Texts(Vec<String>),
    Component(usize),
    /// Radius and volume of the points of a block.
    Spheres(&'a [u32]),
}

/// The variables of a file with constant values.
pub(super) struct Description<'a> {
    pub(super) header: Header,
    pub(super) fixed: Vec<(usize, Fixed<'a>)>,
    /// Dimensions: name length, points, records.
    name: usize,
    nodes: usize,
    time: usize,
}

impl<'a> Description<'a> {
    pub(super) fn new(layout: &'a ExodusLayout<'_>) -> Result<Self, WriteError> {
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

    /// Adds status, IDs and names of blocks or sets.
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

    /// Adds the time, the global values, then a variable for each column, in this order.
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

/// Writes the values of a variable at its offset.
pub(super) fn write_fixed(
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
