//! XML structure of a VTK file: elements and arrays.

use std::borrow::Cow;
use std::cell::Cell;
use std::ops::Range;

use super::array::{Encoding, Numbers, Source, read};
use crate::fault::Fault;
use crate::scan::Scalar;

/// A parsed file: elements and appended data.
pub(crate) struct File<'a> {
    content: &'a [u8],
    elements: Vec<Element<'a>>,
    encoding: Encoding,
    appended: Option<(Appended, &'a [u8])>,
    /// Remaining memory for arrays, bytes.
    room: Cell<u64>,
    memory: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Appended {
    Raw,
    Base64,
}

/// A start or end tag of the XML, with the position of the text after it.
struct Element<'a> {
    tag: &'a str,
    text: usize,
}

impl<'a> Element<'a> {
    fn name(&self) -> &'a str {
        self.tag
            .split([' ', '\t', '\r', '\n', '/'])
            .find(|word| !word.is_empty())
            .unwrap_or_default()
    }

    fn ends(&self, name: &str) -> bool {
        self.tag.starts_with('/') && self.name() == name
    }

    fn starts(&self, name: &str) -> bool {
        !self.tag.starts_with('/') && self.name() == name
    }

    fn attribute(&self, name: &str) -> Option<&'a str> {
        self.tag.match_indices(name).find_map(|(place, _)| {
            let before = self.tag[..place].chars().next_back();
            let value = self.tag[place + name.len()..]
                .trim_start()
                .strip_prefix('=')?
                .trim_start();
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let value = &value[1..];
            before.filter(|c| c.is_ascii_whitespace())?;
            Some(&value[..value.find(quote)?])
        })
    }
}

/// Replaces the entities of XML by their characters.
fn unescaped(text: &str) -> Cow<'_, str> {
    if !text.contains('&') {
        return Cow::Borrowed(text);
    }
    let entity = |name: &str| match name {
        "lt" => Some('<'),
        "gt" => Some('>'),
        "quot" => Some('"'),
        "apos" => Some('\''),
        "amp" => Some('&'),
        name => {
            let number = name.strip_prefix('#')?;
            let code = match number.strip_prefix('x') {
                Some(digits) => u32::from_str_radix(digits, 16),
                None => number.parse(),
            };
            char::from_u32(code.ok()?)
        }
    };
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        out.push_str(before);
        let found = after.split_once(';');
        match found.and_then(|(name, rest)| Some((entity(name)?, rest))) {
            Some((character, after)) => {
                out.push(character);
                rest = after;
            }
            None => {
                out.push('&');
                rest = after;
            }
        }
    }
    Cow::Owned(out + rest)
}

impl<'a> File<'a> {
    /// Parses a file whose content and arrays may take up to `memory` bytes together.
    pub(crate) fn new(content: &'a [u8], memory: u64) -> Result<Self, Fault> {
        let last = b"</VTKFile>";
        if !content
            .windows(last.len())
            .rev()
            .any(|window| window == last)
        {
            return Err(Fault::of_file(
                "unexpected end of file; expected </VTKFile>",
            ));
        }
        let mark = b"<AppendedData";
        let appended = content
            .windows(mark.len())
            .position(|window| window == mark);
        let xml = &content[..appended.unwrap_or(content.len())];
        let mut elements = tags(xml)?;
        let appended = match appended {
            None => None,
            Some(place) => {
                let rest = &content[place..];
                let Some(end) = rest.iter().position(|&byte| byte == b'>') else {
                    return Err(Fault::of_file("the file ends within the tag AppendedData"));
                };
                elements.extend(tags(&rest[..=end])?);
                let form = match elements
                    .last()
                    .and_then(|element| element.attribute("encoding"))
                {
                    Some("raw") => Appended::Raw,
                    _ => Appended::Base64,
                };
                let data = &rest[end + 1..];
                let Some(start) = data.iter().position(|&byte| byte == b'_') else {
                    return Err(Fault::of_file("the mark _ before appended data is missing"));
                };
                Some((form, &data[start + 1..]))
            }
        };
        let Some(file) = elements.iter().find(|element| element.starts("VTKFile")) else {
            return Err(Fault::of_file("the element VTKFile is missing"));
        };
        let encoding = Encoding {
            little: file.attribute("byte_order") != Some("BigEndian"),
            header: match file.attribute("header_type") {
                Some("UInt64") => Scalar::U64,
                _ => Scalar::U32,
            },
            packed: match file.attribute("compressor") {
                None => false,
                Some("vtkZLibDataCompressor") => true,
                Some(other) => {
                    return Err(Fault::of_file(format!(
                        "unsupported compressor {other}; allowed: vtkZLibDataCompressor, or none"
                    )));
                }
            },
        };
        Ok(Self {
            content,
            elements,
            encoding,
            appended,
            room: Cell::new(memory.saturating_sub(content.len() as u64)),
            memory,
        })
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.elements.iter().any(|element| element.starts(name))
    }

    /// Returns the elements of each piece; all elements if there are no pieces.
    pub(crate) fn pieces(&self) -> Vec<Range<usize>> {
        let mut pieces = Vec::new();
        let mut begin = None;
        for (place, element) in self.elements.iter().enumerate() {
            if element.starts("Piece") {
                begin = Some(place);
            } else if element.ends("Piece") {
                pieces.extend(begin.take().map(|begin| begin..place));
            }
        }
        if pieces.is_empty() {
            pieces.push(0..self.elements.len());
        }
        pieces
    }

    /// Returns the arrays in the first section of this name in a range of elements.
    fn arrays(&self, within: Range<usize>, section: &str) -> impl Iterator<Item = &Element<'a>> {
        let inside = self.elements[within]
            .iter()
            .skip_while(move |element| !element.starts(section));
        inside
            .take_while(move |element| !element.ends(section))
            .filter(|element| element.starts("DataArray"))
    }

    /// Returns names and numbers of components of the arrays in the first section of this name.
    pub(crate) fn columns(&self, section: &str) -> impl Iterator<Item = (Cow<'a, str>, usize)> {
        self.columns_in(0..self.elements.len(), section)
    }

    /// Like [`File::columns`], in a range of elements.
    pub(crate) fn columns_in(
        &self,
        within: Range<usize>,
        section: &str,
    ) -> impl Iterator<Item = (Cow<'a, str>, usize)> {
        self.arrays(within, section).map(|array| {
            let components = array.attribute("NumberOfComponents");
            let components = components.and_then(|count| count.trim().parse().ok());
            (
                unescaped(array.attribute("Name").unwrap_or_default()),
                components.unwrap_or(1),
            )
        })
    }

    /// Returns the first array with the given name, or any array, in the first section of this name.
    pub(crate) fn array(&self, section: &str, name: Option<&str>) -> Result<Numbers, Fault> {
        self.array_in(0..self.elements.len(), section, name)
    }

    /// Like [`File::array`], in a range of elements.
    pub(crate) fn array_in(
        &self,
        within: Range<usize>,
        section: &str,
        name: Option<&str>,
    ) -> Result<Numbers, Fault> {
        let what = name.unwrap_or(section);
        let array = self.arrays(within, section).find(|element| match name {
            None => true,
            Some(name) => element
                .attribute("Name")
                .is_some_and(|own| unescaped(own) == name),
        });
        let Some(array) = array else {
            return Err(Fault::of_file(format!(
                "the array {what} is missing in {section}"
            )));
        };
        let scalar = match array.attribute("type") {
            Some("Float32") => Scalar::F32,
            Some("Float64") => Scalar::F64,
            Some("Int8") => Scalar::I8,
            Some("UInt8") => Scalar::U8,
            Some("Int16") => Scalar::I16,
            Some("UInt16") => Scalar::U16,
            Some("Int32") => Scalar::I32,
            Some("UInt32") => Scalar::U32,
            Some("Int64") => Scalar::I64,
            Some("UInt64") => Scalar::U64,
            other => {
                return Err(Fault::of_file(format!(
                    "{what}: unsupported type {}",
                    other.unwrap_or("(none)")
                )));
            }
        };
        let text = || {
            let rest = &self.content[array.text..];
            &rest[..rest
                .iter()
                .position(|&byte| byte == b'<')
                .unwrap_or(rest.len())]
        };
        let source = match array.attribute("format") {
            Some("ascii") => Source::Text(text()),
            Some("binary") => Source::Base64(text().trim_ascii()),
            Some("appended") => {
                let offset = array
                    .attribute("offset")
                    .and_then(|offset| offset.trim().parse::<usize>().ok());
                let data = self
                    .appended
                    .zip(offset)
                    .and_then(|((form, data), offset)| Some((form, data.get(offset..)?)));
                match data {
                    Some((Appended::Raw, data)) => Source::Raw(data),
                    Some((Appended::Base64, data)) => Source::Base64(data),
                    None => {
                        return Err(Fault::of_file(format!(
                            "{what}: the offset exceeds the appended data"
                        )));
                    }
                }
            }
            other => {
                return Err(Fault::of_file(format!(
                    "{what}: unknown format {:?}; allowed: ascii, binary, appended",
                    other.unwrap_or_default()
                )));
            }
        };
        let (numbers, taken) =
            read(source, scalar, self.encoding, what, self.room.get()).map_err(|fault| Fault {
                // Relative to the whole file: memory taken by previous arrays is needed as well.
                needed: fault
                    .needed
                    .map(|needed| needed + (self.memory - self.room.get())),
                ..fault
            })?;
        self.room.set(self.room.get() - taken);
        Ok(numbers)
    }
}

/// Returns all tags of an XML text, without comments and declarations.
fn tags(xml: &[u8]) -> Result<Vec<Element<'_>>, Fault> {
    let mut tags = Vec::new();
    let mut at = 0;
    while let Some(open) = xml[at..].iter().position(|&byte| byte == b'<') {
        let start = at + open + 1;
        let Some(length) = xml[start..].iter().position(|&byte| byte == b'>') else {
            return Err(Fault::of_file("the file ends within a tag"));
        };
        at = start + length + 1;
        let Ok(tag) = std::str::from_utf8(&xml[start..start + length]) else {
            return Err(Fault::at_byte(start, "the tag is not UTF-8 text"));
        };
        if !tag.starts_with(['?', '!']) {
            tags.push(Element { tag, text: at });
        }
    }
    Ok(tags)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entities_of_names_are_replaced() {
        assert_eq!(
            unescaped("a &lt;b&gt; &amp;lt; &quot;c&apos;"),
            "a <b> &lt; \"c'"
        );
        assert_eq!(unescaped("&#223;&#xe4;"), "ßä");
        assert_eq!(unescaped("a & b &x; &"), "a & b &x; &");
    }
}
