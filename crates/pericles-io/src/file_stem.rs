//! Names of files and folders from names that users choose.

/// Maximum length of the part of a file name that comes from a user, bytes; file systems allow 255 for the whole name.
const LONGEST: usize = 120;

/// Returns a name as part of a file name: characters other than letters, digits and the `allowed` ones become `_`, and
/// long names are shortened. It contains no separator of folders.
pub fn file_stem(name: &str, allowed: &str) -> String {
    let plain = |c: char| match c.is_alphanumeric() || allowed.contains(c) {
        true => c,
        false => '_',
    };
    let mut stem = String::new();
    for c in name.chars().map(plain) {
        if stem.len() + c.len_utf8() > LONGEST {
            break;
        }
        stem.push(c);
    }
    stem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_single_components_of_limited_length() {
        assert_eq!(file_stem("../../etc/passwd", "-_"), "______etc_passwd");
        assert_eq!(file_stem("a\\b:c\0d\u{202e}e", "-_"), "a_b_c_d_e");
        assert_eq!(file_stem("Größe-1", "-_"), "Größe-1");
        assert_eq!(file_stem(&"ß".repeat(200), "").len(), 120);
    }
}
