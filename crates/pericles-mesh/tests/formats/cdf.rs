//! Classic netCDF files for the tests, written from the format description, independent of the library.

/// A variable: name, dimensions, a text attribute, and values.
pub struct Variable {
    pub name: String,
    pub dimensions: Vec<usize>,
    pub attribute: Option<(&'static str, String)>,
    pub values: Values,
}

pub enum Values {
    Text(Vec<u8>),
    Int(Vec<i32>),
    Double(Vec<f64>),
}

pub fn variable(name: &str, dimensions: &[usize], values: Values) -> Variable {
    Variable {
        name: name.into(),
        dimensions: dimensions.to_vec(),
        attribute: None,
        values,
    }
}

/// A file of version 1, 2 or 5.
pub fn file(version: u8, dimensions: &[(&str, u64)], variables: &[Variable]) -> Vec<u8> {
    let size = |x: u64| match version {
        5 => x.to_be_bytes().to_vec(),
        _ => (x as u32).to_be_bytes().to_vec(),
    };
    let padded = |mut bytes: Vec<u8>| {
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes
    };
    let name = |text: &str| [size(text.len() as u64), padded(text.as_bytes().to_vec())].concat();
    let data = |values: &Values| match values {
        Values::Text(text) => (2u32, text.clone()),
        Values::Int(x) => (4, x.iter().flat_map(|x| x.to_be_bytes()).collect()),
        Values::Double(x) => (6, x.iter().flat_map(|x| x.to_be_bytes()).collect()),
    };
    let header = |begins: &[u64]| {
        let mut out = vec![b'C', b'D', b'F', version];
        out.extend(size(0));
        out.extend(10u32.to_be_bytes());
        out.extend(size(dimensions.len() as u64));
        for (word, length) in dimensions {
            out.extend(name(word));
            out.extend(size(*length));
        }
        // No global attributes.
        out.extend(0u32.to_be_bytes());
        out.extend(size(0));
        out.extend(11u32.to_be_bytes());
        out.extend(size(variables.len() as u64));
        for (variable, begin) in variables.iter().zip(begins) {
            out.extend(name(&variable.name));
            out.extend(size(variable.dimensions.len() as u64));
            for &dimension in &variable.dimensions {
                out.extend(size(dimension as u64));
            }
            match &variable.attribute {
                Some((word, text)) => {
                    out.extend(12u32.to_be_bytes());
                    out.extend(size(1));
                    out.extend(name(word));
                    out.extend(2u32.to_be_bytes());
                    out.extend(name(text));
                }
                None => {
                    out.extend(0u32.to_be_bytes());
                    out.extend(size(0));
                }
            }
            let (kind, bytes) = data(&variable.values);
            out.extend(kind.to_be_bytes());
            out.extend(size(bytes.len() as u64));
            match version {
                1 => out.extend((*begin as u32).to_be_bytes()),
                _ => out.extend(begin.to_be_bytes()),
            }
        }
        out
    };
    let mut next = header(&vec![0; variables.len()]).len() as u64;
    let begins: Vec<u64> = variables
        .iter()
        .map(|variable| {
            let begin = next;
            next += padded(data(&variable.values).1).len() as u64;
            begin
        })
        .collect();
    let mut out = header(&begins);
    for variable in variables {
        out.extend(padded(data(&variable.values).1));
    }
    out
}
