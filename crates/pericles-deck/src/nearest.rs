//! "Did you mean …": the nearest allowed word.

/// Returns the allowed word most similar to a given one, if it is similar enough; the first of equally similar ones.
pub(crate) fn nearest<'a>(
    written: &str,
    allowed: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let plain = |word: &str| word.to_lowercase().replace(['-', ' '], "_");
    let target = plain(written);
    let length = target.chars().count();
    // One wrong letter in three: enough for typos, too few for unrelated words.
    let limit = (length / 3).max(1);
    allowed
        .into_iter()
        .filter_map(|word| {
            let candidate = plain(word);
            let distance = strsim::damerau_levenshtein(&target, &candidate);
            // At least one letter must agree.
            let shared = distance < length.max(candidate.chars().count());
            let begins = length >= 3 && candidate.starts_with(&target);
            (shared && distance <= limit || begins).then_some((distance.min(limit), word))
        })
        // `min_by_key` returns the first minimum.
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn typos_are_recognised_and_unrelated_words_are_not() {
        let allowed = ["spacing", "shape", "size", "volume_correction", "E"];
        let near = |word| nearest(word, allowed);
        assert_eq!(near("spaceing"), Some("spacing"));
        assert_eq!(near("Size"), Some("size"));
        assert_eq!(near("volume-correction"), Some("volume_correction"));
        assert_eq!(near("volume"), Some("volume_correction"));
        assert_eq!(near("colour"), None);
        assert_eq!(near(""), None);
        assert_eq!(near("e"), Some("E"));
    }
}
