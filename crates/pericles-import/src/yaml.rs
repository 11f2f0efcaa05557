//! Reader of YAML.

use saphyr_parser::{Event, Parser, Span};

use crate::entry::{DEEPEST, Entry, path_of};
use crate::error::Fault;

/// Reads the first document of a text as a group of entries. Entries of a sequence have their numbers as keys.
pub(crate) fn read(text: &str) -> Result<Entry, Fault> {
    let mut events = Events {
        parser: Parser::new_from_str(text),
    };
    loop {
        match events.next()? {
            (Event::StreamEnd, span) => return Err(at(&span, "the file is empty")),
            (Event::StreamStart | Event::DocumentStart(_), _) => {}
            (event, span) => return events.entry("", "", event, &span, 0),
        }
    }
}

struct Events<'t> {
    parser: Parser<'t, saphyr_parser::StrInput<'t>>,
}

impl<'t> Events<'t> {
    fn next(&mut self) -> Result<(Event<'t>, Span), Fault> {
        match self.parser.next() {
            Some(Ok(next)) => Ok(next),
            Some(Err(error)) => Err(Fault {
                line: error.marker().line(),
                reason: format!("not valid YAML: {}", error.info()),
            }),
            None => Err(Fault {
                line: 1,
                reason: "not valid YAML: the file ends unexpectedly".into(),
            }),
        }
    }

    fn entry(
        &mut self,
        key: &str,
        parent: &str,
        event: Event<'t>,
        span: &Span,
        depth: usize,
    ) -> Result<Entry, Fault> {
        if depth > DEEPEST {
            return Err(at(span, "the groups are nested too deeply"));
        }
        let line = span.start.line();
        let path = path_of(parent, key);
        let mut entries = Vec::new();
        match event {
            Event::Scalar(text, ..) => return Ok(Entry::value(key, parent, line, &text)),
            Event::MappingStart(..) => loop {
                let (name, place) = match self.next()? {
                    (Event::MappingEnd, _) => break,
                    (Event::Scalar(name, ..), place) => (name, place),
                    (_, place) => return Err(at(&place, "expected: a key, a text")),
                };
                let (event, inner) = self.next()?;
                // A group is at the line of its key.
                let inner = if matches!(event, Event::MappingStart(..)) {
                    place
                } else {
                    inner
                };
                entries.push(self.entry(&name, &path, event, &inner, depth + 1)?);
            },
            Event::SequenceStart(..) => loop {
                match self.next()? {
                    (Event::SequenceEnd, _) => break,
                    (event, inner) => {
                        let number = (entries.len() + 1).to_string();
                        entries.push(self.entry(&number, &path, event, &inner, depth + 1)?);
                    }
                }
            },
            _ => {
                return Err(at(
                    span,
                    "aliases of YAML are not supported; repeat the values",
                ));
            }
        }
        Ok(Entry::group(key, parent, line, entries))
    }
}

fn at(span: &Span, reason: &str) -> Fault {
    Fault {
        line: span.start.line(),
        reason: reason.to_owned(),
    }
}
