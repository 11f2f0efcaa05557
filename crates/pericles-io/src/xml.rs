//! Text in XML and HTML.

/// Text escaped for attributes and for content between tags in XML and HTML. Control characters, which XML does not allow, are replaced.
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

/// The text of an attribute that [`escaped`] made.
pub(crate) fn unescaped(text: &str) -> String {
    // The ampersand last: what it stands before must not be taken for another mark.
    text.replace("&quot;", "\"")
        .replace("&gt;", ">")
        .replace("&lt;", "<")
        .replace("&amp;", "&")
}
