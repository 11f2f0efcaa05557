//! Escaping of text in XML and HTML.

/// Escapes text for attributes and content in XML and HTML. Control characters, which XML does not allow, are
/// replaced.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(character),
            _ if character.is_control() => out.push(char::REPLACEMENT_CHARACTER),
            _ => out.push(character),
        }
    }
    out
}

/// Reverses [`escaped`].
pub(crate) fn unescaped(text: &str) -> String {
    // The ampersand last: otherwise "&amp;lt;" would become "<".
    text.replace("&quot;", "\"")
        .replace("&gt;", ">")
        .replace("&lt;", "<")
        .replace("&amp;", "&")
}
