//! Reader of Peridigm's own format: one entry per line, a key followed by a value in quotes or by a number. The lines below a
//! key with deeper indentation are its group.

use crate::entry::{DEEPEST, Entry, path_of};
use crate::error::Fault;

/// A line without comment.
struct Line<'t> {
    number: usize,
    indentation: usize,
    text: &'t str,
}

/// Returns whether the first entry of a text is in this format, in which keys have no colon.
pub(crate) fn is_plain(text: &str) -> bool {
    lines(text)
        .next()
        .is_some_and(|line| !line.text.contains(':'))
}

pub(crate) fn read(text: &str) -> Result<Entry, Fault> {
    let lines: Vec<Line<'_>> = lines(text).collect();
    Ok(Entry::group("", "", 1, entries(&lines, "", 0)?))
}

fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    text.lines().zip(1..).filter_map(|(line, number)| {
        // A comment begins outside of quotes.
        let is_comment = |k: &usize| line[..*k].matches('"').count() % 2 == 0;
        let end = line.match_indices('#').map(|(k, _)| k).find(is_comment);
        let line = &line[..end.unwrap_or(line.len())];
        let text = line.trim();
        (!text.is_empty()).then(|| Line {
            number,
            indentation: line.len() - line.trim_start().len(),
            text,
        })
    })
}

/// Reads lines of the same group, each with the lines that belong to it.
fn entries(lines: &[Line<'_>], parent: &str, depth: usize) -> Result<Vec<Entry>, Fault> {
    let mut entries = Vec::new();
    let mut rest = lines;
    while let Some((line, below)) = rest.split_first() {
        let fault = |reason: &str| Fault {
            line: line.number,
            reason: reason.to_owned(),
        };
        if depth > DEEPEST {
            return Err(fault("the groups are nested too deeply"));
        }
        if line.indentation < lines[0].indentation {
            return Err(fault(
                "the indentation differs from that of the entries above",
            ));
        }
        let own = below
            .iter()
            .take_while(|other| other.indentation > line.indentation);
        let (own, left) = below.split_at(own.count());
        rest = left;
        let value = value(line.text).filter(|_| own.is_empty());
        entries.push(match value {
            Some((key, value)) => Entry::value(key, parent, line.number, value),
            None => {
                let path = path_of(parent, line.text);
                let own = self::entries(own, &path, depth + 1)?;
                Entry::group(line.text, parent, line.number, own)
            }
        });
    }
    Ok(entries)
}

/// Returns key and value of a line; `None` for the key of a group.
fn value(line: &str) -> Option<(&str, &str)> {
    if let Some((key, quoted)) = line.split_once('"') {
        return Some((key.trim(), quoted.strip_suffix('"').unwrap_or(quoted)));
    }
    let (key, word) = line.rsplit_once(char::is_whitespace)?;
    let is_value =
        word.parse::<f64>().is_ok() || matches!(word, "true" | "false") || word.starts_with('{');
    is_value.then_some((key.trim(), word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_with_deeper_lines_below_are_groups() {
        let text = "\n# Units are SI\nBlock 1   # a group\n  Material \"My #1 Material\"\n  Horizon 0.3\n  Empty Group\nFinal Time 1e-3\n";
        assert!(is_plain(text) && !is_plain("Peridigm:\n") && !is_plain(""));
        let root = read(text).unwrap();
        let block = root.find("Block 1").unwrap();
        assert_eq!(block.line(), 3);
        assert_eq!(
            block.find("Material").unwrap().text().unwrap(),
            "My #1 Material"
        );
        assert_eq!(block.find("Horizon").unwrap().number().unwrap(), 0.3);
        assert!(
            block
                .find("Empty Group")
                .unwrap()
                .entries()
                .unwrap()
                .is_empty()
        );
        assert_eq!(root.find("Final Time").unwrap().number().unwrap(), 1e-3);
        let error = read("    Blocks\n  Horizon 3\n").unwrap_err();
        assert_eq!(error.line, 2);
    }
}
