//! Members of sets in data lines.

use super::keyword::{Name, whole, words};
use super::scope::Member;
use crate::fault::Fault;

/// Adds a number, extending a range of consecutive numbers.
pub(super) fn push_number(members: &mut Vec<(Option<Name>, Member)>, number: i64) {
    match members.last_mut() {
        Some((None, Member::Range(_, last, 1))) if last.checked_add(1) == Some(number) => {
            *last = number;
        }
        _ => members.push((None, Member::Range(number, number, 1))),
    }
}

/// Returns the member that a word names.
pub(super) fn member(word: &str) -> Member {
    match word.parse() {
        Ok(number) => Member::Number(number),
        Err(_) => Member::Set(Name::of(word).0),
    }
}

/// Parses the members of a set in a line.
pub(super) fn members(text: &str, line: usize, generate: bool) -> Result<Vec<Member>, Fault> {
    if !generate {
        let words = words(text).filter(|word| !word.is_empty());
        return Ok(words.map(member).collect());
    }
    let numbers = words(text)
        .map(|word| whole(word, line))
        .collect::<Result<Vec<i64>, Fault>>()?;
    match *numbers {
        [first] => Ok(vec![Member::Range(first, first, 1)]),
        [first, last] => Ok(vec![Member::Range(first, last, 1)]),
        [first, last, step] if step > 0 => Ok(vec![Member::Range(first, last, step)]),
        _ => Err(Fault::at_line(
            line,
            format!(
                "invalid range {text:?} for GENERATE; allowed: first, last and a positive step"
            ),
        )),
    }
}
