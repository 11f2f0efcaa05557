//! Reading of outlines from text: a line `x y` for each corner, a blank line or `#` between polygons.

use std::path::Path;

use crate::TextError;
use crate::points::words;
use crate::whole::read_whole;

/// Reads the polygons of an outline, in the length unit of the file.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds `memory` bytes, for the first line that is not two
/// finite numbers, and for a file without corners.
pub fn read_outline(path: impl AsRef<Path>, memory: u64) -> Result<Vec<Vec<[f64; 2]>>, TextError> {
    /// A corner takes 16 bytes and at least four characters; a growing list has capacity for up to twice its
    /// length.
    const EXPANSION: u64 = 9;
    let path = path.as_ref();
    parse_outline(path, &read_whole(path, EXPANSION, memory)?)
}

/// Parses the content of an outline file; `name` is used in messages. A last corner equal to the first one is
/// omitted.
///
/// # Errors
/// As [`read_outline`], except for errors of reading the file.
pub fn parse_outline(
    name: impl AsRef<Path>,
    content: &[u8],
) -> Result<Vec<Vec<[f64; 2]>>, TextError> {
    let content = content.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(content);
    let mut polygons: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut is_open = false;
    for (k, line) in content.split(|&byte| byte == b'\n').enumerate() {
        let rejected = |reason: String| TextError::line(&name, k + 1, reason);
        let line =
            std::str::from_utf8(line).map_err(|_| rejected("the line is not UTF-8 text".into()))?;
        let words = words(line);
        if words.is_empty() {
            is_open = false;
            continue;
        }
        let numbers: Vec<f64> = words
            .iter()
            .filter_map(|word| word.parse().ok())
            .filter(|number: &f64| number.is_finite())
            .collect();
        let corner: [f64; 2] = match numbers[..] {
            [x, y] if words.len() == 2 => [x, y],
            _ => {
                let line = line.trim();
                return Err(rejected(format!(
                    "`{line}` is not a corner; expected two finite numbers `x y`"
                )));
            }
        };
        match polygons.last_mut() {
            Some(polygon) if is_open => polygon.push(corner),
            _ => polygons.push(vec![corner]),
        }
        is_open = true;
    }
    for polygon in &mut polygons {
        if polygon.len() > 1 && polygon.first() == polygon.last() {
            polygon.pop();
        }
    }
    match polygons.is_empty() {
        true => Err(TextError::whole(
            &name,
            "no corners; write one line `x y` for each corner and a blank line between polygons",
        )),
        false => Ok(polygons),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blank_lines_separate_polygons() {
        let text = b"# a frame\n0 0\n4, 0\n4 3\n0 3 # last\n0 0\n\n1 1\n2 1\n2 2\n";
        let polygons = parse_outline("frame.txt", text).unwrap();
        assert_eq!(polygons.len(), 2);
        assert_eq!(polygons[0].len(), 4);
        assert_eq!(polygons[1], [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]);
    }

    #[test]
    fn lines_that_are_not_corners_are_reported_with_their_location() {
        for (text, place) in [
            ("0 0\n1 2 3\n", "frame.txt:2: `1 2 3` is not a corner"),
            ("0 0\n\n1 x\n", "frame.txt:3:"),
            ("0 nan\n", "frame.txt:1:"),
            ("# nothing\n", "no corners"),
        ] {
            let error = parse_outline("frame.txt", text.as_bytes()).unwrap_err();
            assert!(error.to_string().contains(place), "{error}");
        }
    }
}
