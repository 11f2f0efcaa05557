//! Reader of XML parameter lists: `<ParameterList name="…">` is a group, `<Parameter name="…" value="…"/>` a value.

use roxmltree::{Document, Node};

use crate::entry::{DEEPEST, Entry, path_of};
use crate::error::Fault;

pub(crate) fn read(text: &str) -> Result<Entry, Fault> {
    let document = Document::parse(text).map_err(|error| Fault {
        line: error.pos().row as usize,
        reason: format!("not valid XML: {error}"),
    })?;
    entry(&document, document.root_element(), "", "", 0)
}

fn entry(
    document: &Document<'_>,
    node: Node<'_, '_>,
    key: &str,
    parent: &str,
    depth: usize,
) -> Result<Entry, Fault> {
    let line = document.text_pos_at(node.range().start).row as usize;
    let fault = |reason: &str| Fault {
        line,
        reason: reason.to_owned(),
    };
    if depth > DEEPEST {
        return Err(fault("the lists are nested too deeply"));
    }
    match node.tag_name().name() {
        "Parameter" => {
            let value = node.attribute("value");
            let value = value.ok_or_else(|| fault("the attribute `value` is missing"))?;
            Ok(Entry::value(key, parent, line, value))
        }
        "ParameterList" => {
            let path = path_of(parent, key);
            let mut entries = Vec::new();
            for child in node.children().filter(Node::is_element) {
                let name = child.attribute("name").unwrap_or_default();
                entries.push(entry(document, child, name, &path, depth + 1)?);
            }
            Ok(Entry::group(key, parent, line, entries))
        }
        other => Err(fault(&format!(
            "unknown element <{other}>; allowed: <ParameterList> and <Parameter>"
        ))),
    }
}
