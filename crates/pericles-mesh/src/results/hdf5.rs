//! Minimal HDF5 writer: groups, attributes and contiguous datasets with offsets known in advance.
//!
//! Superblock 0, object headers of version 1, groups by symbol tables, no checksums (HDF5 File Format
//! Specification 3.0). Numbers are little-endian; all bits of an undefined address are set.

/// Number types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    U8,
    I64,
    F32,
    F64,
}

impl Type {
    pub(super) fn bytes(self) -> u64 {
        match self {
            Self::U8 => 1,
            Self::F32 => 4,
            Self::I64 | Self::F64 => 8,
        }
    }

    /// The datatype message.
    fn message(self) -> Vec<u8> {
        let real = |size: u32, sign: u8, exponent: [u8; 2], mantissa: u8, bias: u32| {
            let mut message = vec![0x11, 0x20, sign, 0];
            message.extend(size.to_le_bytes());
            message.extend(0u16.to_le_bytes());
            message.extend((8 * size as u16).to_le_bytes());
            message.extend([exponent[0], exponent[1], 0, mantissa]);
            message.extend(bias.to_le_bytes());
            message
        };
        let whole = |size: u32, is_signed: bool| {
            let mut message = vec![0x10, if is_signed { 8 } else { 0 }, 0, 0];
            message.extend(size.to_le_bytes());
            message.extend(0u16.to_le_bytes());
            message.extend((8 * size as u16).to_le_bytes());
            message
        };
        match self {
            Self::U8 => whole(1, false),
            Self::I64 => whole(8, true),
            Self::F32 => real(4, 31, [23, 8], 23, 127),
            Self::F64 => real(8, 63, [52, 11], 52, 1023),
        }
    }
}

/// Value of an attribute.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Text(&'static str),
    Numbers(Vec<i64>),
    Number(i64),
}

/// A group or a dataset.
#[derive(Debug, Clone)]
pub(super) struct Object {
    pub(super) name: String,
    pub(super) attributes: Vec<(&'static str, Value)>,
    pub(super) kind: Kind,
    /// Address of its header, if it is prescribed.
    pub(super) header: Option<u64>,
}

#[derive(Debug, Clone)]
pub(super) enum Kind {
    Group(Vec<Object>),
    /// Type, shape, address and size of the data in bytes.
    Dataset(Type, Vec<u64>, u64, u64),
}

impl Object {
    pub(super) fn group(name: &str, members: Vec<Self>) -> Self {
        Self {
            name: name.to_owned(),
            attributes: Vec::new(),
            kind: Kind::Group(members),
            header: None,
        }
    }

    pub(super) fn with(mut self, name: &'static str, value: Value) -> Self {
        self.attributes.push((name, value));
        self
    }

    pub(super) fn at(mut self, header: u64) -> Self {
        self.header = Some(header);
        self
    }
}

/// Maximum number of members of a group: twice the largest K of its only leaf node.
pub(super) const MOST_MEMBERS: usize = 2 * u16::MAX as usize;
/// Smallest K of leaf nodes.
const LEAF_K: usize = 64;
const NODE_K: usize = 16;
const NONE: u64 = u64::MAX;
const SUPERBLOCK: usize = 96;

fn padded(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// Returns the dataspace message; an empty shape gives a scalar.
fn dataspace(lengths: &[u64]) -> Vec<u8> {
    let mut message = vec![1, lengths.len() as u8, 0, 0, 0, 0, 0, 0];
    for length in lengths {
        message.extend(length.to_le_bytes());
    }
    message
}

fn attribute(name: &str, value: &Value) -> Vec<u8> {
    let (kind, space, data) = match value {
        Value::Text(text) => {
            let mut kind = vec![0x13, 1, 0, 0];
            kind.extend((text.len() as u32).to_le_bytes());
            (kind, dataspace(&[]), text.as_bytes().to_vec())
        }
        Value::Numbers(numbers) => {
            let data = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
            (
                Type::I64.message(),
                dataspace(&[numbers.len() as u64]),
                data,
            )
        }
        Value::Number(number) => {
            let data = number.to_le_bytes().to_vec();
            (Type::I64.message(), dataspace(&[]), data)
        }
    };
    let mut message = vec![1, 0];
    for size in [name.len() + 1, kind.len(), space.len()] {
        message.extend((size as u16).to_le_bytes());
    }
    let mut word = name.as_bytes().to_vec();
    word.push(0);
    for part in [word, kind, space] {
        message.extend(padded(part));
    }
    message.extend(data);
    message
}

/// Returns an object header with its messages, each a type and data.
fn object_header(messages: Vec<(u16, Vec<u8>)>) -> Vec<u8> {
    let mut body = Vec::new();
    let count = messages.len() as u16;
    for (kind, data) in messages {
        let data = padded(data);
        body.extend(kind.to_le_bytes());
        body.extend((data.len() as u16).to_le_bytes());
        body.extend([0; 4]);
        body.extend(data);
    }
    let mut header = vec![1, 0];
    header.extend(count.to_le_bytes());
    header.extend(1u32.to_le_bytes());
    header.extend((body.len() as u32).to_le_bytes());
    header.extend([0; 4]);
    header.extend(body);
    header
}

/// Returns the header of an object; for a group with the addresses of its B-tree and heap.
pub(super) fn header_of(object: &Object, group: Option<[u64; 2]>) -> Vec<u8> {
    let mut messages = Vec::new();
    match &object.kind {
        Kind::Group(_) => {
            let places = group.unwrap_or([NONE; 2]);
            messages.push((0x11, places.iter().flat_map(|p| p.to_le_bytes()).collect()));
        }
        Kind::Dataset(kind, lengths, place, bytes) => {
            messages.push((1, dataspace(lengths)));
            messages.push((3, kind.message()));
            // No fill value; space is allocated at creation.
            messages.push((5, vec![2, 1, 1, 0]));
            let mut layout = vec![3, 1];
            layout.extend(place.to_le_bytes());
            layout.extend(bytes.to_le_bytes());
            messages.push((8, layout));
        }
    }
    for (name, value) in &object.attributes {
        messages.push((12, attribute(name, value)));
    }
    object_header(messages)
}

/// Returns the largest number of members of a group.
fn most_members(object: &Object) -> usize {
    match &object.kind {
        Kind::Dataset(..) => 0,
        Kind::Group(members) => {
            let inner = members.iter().map(most_members).max();
            inner.unwrap_or(0).max(members.len())
        }
    }
}

/// The metadata of a file: everything except the data of datasets.
pub(super) struct Skeleton {
    bytes: Vec<u8>,
    /// Half of the number of members for which a leaf node has space.
    leaf_k: usize,
    /// Addresses of B-tree and heap of groups, by the address of the header.
    groups: Vec<(u64, [u64; 2])>,
}

impl Skeleton {
    /// Creates the metadata of a file of `file_bytes` bytes; `reserved` bytes after the page of the
    /// superblock are reserved for headers with prescribed addresses.
    pub(super) fn new(root: &Object, reserved: usize, file_bytes: u64) -> Self {
        let mut skeleton = Self {
            leaf_k: most_members(root).div_ceil(2).max(LEAF_K),
            bytes: vec![0; reserved.max(SUPERBLOCK)],
            groups: Vec::new(),
        };
        let header = skeleton.add(root);
        let places = skeleton.places_of(header);
        let mut block = b"\x89HDF\r\n\x1a\n".to_vec();
        block.extend([0, 0, 0, 0, 0, 8, 8, 0]);
        block.extend((skeleton.leaf_k as u16).to_le_bytes());
        block.extend((NODE_K as u16).to_le_bytes());
        block.extend([0; 4]);
        for address in [0, NONE, file_bytes, NONE, 0, header] {
            block.extend(address.to_le_bytes());
        }
        // The root entry contains the addresses of its B-tree and heap.
        block.extend(1u32.to_le_bytes());
        block.extend([0; 4]);
        for place in places {
            block.extend(place.to_le_bytes());
        }
        skeleton.bytes[..SUPERBLOCK].copy_from_slice(&block);
        skeleton
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns the addresses of B-tree and heap of the group with this header.
    pub(super) fn places_of(&self, header: u64) -> [u64; 2] {
        let found = self.groups.iter().find(|(place, _)| *place == header);
        found.map_or([NONE; 2], |&(_, places)| places)
    }

    fn put(&mut self, place: Option<u64>, bytes: &[u8]) -> u64 {
        let begin = match place {
            Some(place) => place as usize,
            None => self.bytes.len().next_multiple_of(8),
        };
        let end = begin + bytes.len();
        if end > self.bytes.len() {
            self.bytes.resize(end, 0);
        }
        self.bytes[begin..end].copy_from_slice(bytes);
        begin as u64
    }

    /// Adds an object with its members; returns the address of its header.
    fn add(&mut self, object: &Object) -> u64 {
        let places = match &object.kind {
            Kind::Group(members) => Some(self.add_members(members)),
            Kind::Dataset(..) => None,
        };
        let header = self.put(object.header, &header_of(object, places));
        self.groups.extend(places.map(|places| (header, places)));
        header
    }

    /// Adds B-tree, symbol table and heap of a group; returns the addresses of B-tree and heap.
    fn add_members(&mut self, members: &[Object]) -> [u64; 2] {
        let mut sorted: Vec<&Object> = members.iter().collect();
        sorted.sort_by(|a, b| a.name.cmp(&b.name));
        // Names; the first one is empty.
        let mut names = vec![0; 8];
        let mut table = b"SNOD\x01\0".to_vec();
        table.extend((sorted.len() as u16).to_le_bytes());
        let mut last = 0u64;
        for member in sorted {
            let header = self.add(member);
            last = names.len() as u64;
            let mut name = member.name.as_bytes().to_vec();
            name.push(0);
            names.extend(padded(name));
            table.extend(last.to_le_bytes());
            table.extend(header.to_le_bytes());
            table.extend([0; 24]);
        }
        table.resize(8 + 80 * self.leaf_k, 0);
        let table = self.put(None, &table);
        let names_place = self.put(None, &names);
        let mut heap = b"HEAP\0\0\0\0".to_vec();
        // The heap has no free block, which is marked by the value one.
        for number in [names.len() as u64, 1, names_place] {
            heap.extend(number.to_le_bytes());
        }
        let heap = self.put(None, &heap);
        let mut tree = b"TREE\0\0".to_vec();
        tree.extend(1u16.to_le_bytes());
        for number in [NONE, NONE, 0, table, last] {
            tree.extend(number.to_le_bytes());
        }
        tree.resize(24 + 8 * (4 * NODE_K + 1), 0);
        let tree = self.put(None, &tree);
        [tree, heap]
    }
}
