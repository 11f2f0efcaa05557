//! Reading of number tables from text: one line per row, comments after `#` or `!`, numbers separated by
//! commas or blanks.

use std::path::Path;

use crate::TextError;
use crate::points::words;
use crate::whole::read_whole;

/// Reads a table with one column per name and `rows` rows, or any number of rows; returns the numbers row by row.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds `memory` bytes, for the first line that does not
/// contain one finite number per column, and for too many or too few lines.
pub fn read_rows(
    path: impl AsRef<Path>,
    rows: Option<usize>,
    columns: &[&str],
    memory: u64,
) -> Result<Vec<f64>, TextError> {
    /// A number takes eight bytes and at least two characters with its separator; a growing list has capacity
    /// for up to twice its length.
    const EXPANSION: u64 = 9;
    let path = path.as_ref();
    let content = read_whole(path, EXPANSION, memory)?;
    parse_rows(path, &content, rows, columns)
}

/// Parses the content of a table; `name` is used in messages.
///
/// # Errors
/// As [`read_rows`], except for errors of reading the file.
pub fn parse_rows(
    name: impl AsRef<Path>,
    content: &[u8],
    rows: Option<usize>,
    columns: &[&str],
) -> Result<Vec<f64>, TextError> {
    let content = content.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(content);
    let mut numbers = Vec::new();
    for (k, line) in content.split(|&byte| byte == b'\n').enumerate() {
        let rejected = |reason: String| TextError::line(&name, k + 1, reason);
        let line =
            std::str::from_utf8(line).map_err(|_| rejected("the line is not UTF-8 text".into()))?;
        let words = words(line);
        if words.is_empty() {
            continue;
        }
        if let Some(rows) = rows
            && numbers.len() == rows * columns.len()
        {
            return Err(rejected(format!(
                "too many lines of numbers; expected {rows}"
            )));
        }
        if words.len() != columns.len() {
            return Err(rejected(format!(
                "{} numbers, expected {}: {}",
                words.len(),
                columns.len(),
                columns.join(" ")
            )));
        }
        for (word, column) in words.iter().zip(columns) {
            let number = word.parse().ok().filter(|number: &f64| number.is_finite());
            let number = number.ok_or_else(|| {
                rejected(format!(
                    "{column} is `{word}`; allowed: a finite number (column names only after `#`)"
                ))
            })?;
            numbers.push(number);
        }
    }
    let found = numbers.len() / columns.len().max(1);
    if let Some(rows) = rows
        && found < rows
    {
        let reason = format!("lines of numbers: {found}; expected: {rows}");
        return Err(TextError::whole(&name, reason));
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::IoError;

    const COLUMNS: [&str; 2] = ["u_x", "v_x"];

    #[test]
    fn rows_are_read_in_order() {
        let text = "\u{feff}# u_x v_x\n1e-3, -2\r\n\n 0.5\t4 ! the end\n";
        let numbers = parse_rows("u.txt", text.as_bytes(), Some(2), &COLUMNS).unwrap();
        assert_eq!(numbers, [1e-3, -2.0, 0.5, 4.0]);
    }

    #[test]
    fn errors_are_reported_with_file_and_line() {
        let cases: [(&[u8], &str); 7] = [
            (b"1 2\n3\n", "u.txt:2: 1 numbers, expected 2: u_x v_x"),
            (b"1 2 3\n", "u.txt:1: 3 numbers, expected 2: u_x v_x"),
            (
                b"u_x v_x\n1 2\n3 4",
                "u.txt:1: u_x is `u_x`; allowed: a finite number (column names only after `#`)",
            ),
            (
                b"1 2\n3 nan\n",
                "u.txt:2: v_x is `nan`; allowed: a finite number",
            ),
            (b"1 2\n", "u.txt: lines of numbers: 1; expected: 2"),
            (
                b"1 2\n3 4\n\n5 6",
                "u.txt:4: too many lines of numbers; expected 2",
            ),
            (b"\xff\xfe", "u.txt:1: the line is not UTF-8 text"),
        ];
        for (text, says) in cases {
            let error = parse_rows("u.txt", text, Some(2), &COLUMNS)
                .unwrap_err()
                .to_string();
            assert!(error.starts_with(says), "{error}");
        }
    }

    #[test]
    fn a_file_beyond_the_memory_limit_is_rejected() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("u.txt");
        std::fs::write(&path, "1 2\n3 4\n").unwrap();
        assert!(read_rows(&path, Some(2), &COLUMNS, 100).is_ok());
        let error = read_rows(&path, Some(2), &COLUMNS, 50).unwrap_err();
        assert!(
            matches!(error, TextError::Io(IoError::TooLarge { .. })),
            "{error}"
        );
    }
}
