//! Templates with names in braces.

use toml::{Table, Value};

/// Returns an argument, with names in its text replaced by the arguments that they refer to.
pub(super) fn argument(arguments: &Table, name: &str) -> Option<Value> {
    let value = arguments.get(name)?;
    let Value::String(text) = value else {
        return Some(value.clone());
    };
    let inner = expand(text, &|other| argument(arguments, other));
    inner.ok().map(Value::String)
}

/// Replaces the names in braces; other braces are left unchanged.
///
/// # Errors
/// The first name for which `known` returns nothing.
pub(super) fn expand(text: &str, known: &dyn Fn(&str) -> Option<Value>) -> Result<String, String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        out += before;
        let inside = after.split_once('}');
        let Some((name, format, behind)) = inside.and_then(|(inside, behind)| {
            let (name, format) = inside.split_once(':').unwrap_or((inside, ""));
            let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            (!name.is_empty() && name.chars().all(is_name)).then_some((name, format, behind))
        }) else {
            out.push('{');
            rest = after;
            continue;
        };
        out += &shown(&known(name).ok_or(name)?, format);
        rest = behind;
    }
    Ok(out + rest)
}

/// Formats a value; `.2` and the like give the number of digits.
pub(super) fn shown(value: &Value, format: &str) -> String {
    let number = match value {
        Value::String(text) => return text.clone(),
        Value::Integer(number) if format.is_empty() => return number.to_string(),
        Value::Integer(number) => *number as f64,
        Value::Float(number) => *number,
        other => return other.to_string(),
    };
    let digits = |text: &str| {
        text.strip_prefix('.')
            .and_then(|digits| digits.parse().ok())
    };
    if let Some(count) = format.strip_suffix('e').and_then(digits) {
        let count: usize = count;
        format!("{number:.count$e}")
    } else if let Some(count) = digits(format.trim_start_matches('+')) {
        let count: usize = count;
        match format.starts_with('+') {
            true => format!("{number:+.count$}"),
            false => format!("{number:.count$}"),
        }
    } else {
        number.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_replaced_and_other_braces_left_unchanged() {
        let known = |name: &str| match name {
            "alpha" => Some(Value::Float(1e-4)),
            "n" => Some(Value::Integer(3)),
            "name" => Some(Value::String("edge".into())),
            _ => None,
        };
        let text = |text| expand(text, &known).unwrap();
        assert_eq!(
            text("α = {alpha}, N = {n}: {name}"),
            "α = 0.0001, N = 3: edge"
        );
        assert_eq!(text("{alpha:.2} {alpha:.1e} {n:+.1}"), "0.00 1.0e-4 +3.0");
        assert_eq!(
            text("a={function=\"tuned\"} b={} {"),
            "a={function=\"tuned\"} b={} {"
        );
        assert_eq!(expand("{alfa}", &known), Err("alfa".into()));
    }
}
