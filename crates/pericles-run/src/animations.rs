//! Animations with pictures that were removed during the run.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::Path;

/// Returns warnings about animations in a folder with missing pictures.
pub fn gaps(folder: &Path) -> Vec<String> {
    let names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    let mut numbers: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for name in &names {
        // Stem and number of `Damage-000012.png`.
        let still = name
            .strip_suffix(".png")
            .and_then(|name| name.rsplit_once('-'));
        if let Some((stem, Ok(number))) = still.map(|(stem, number)| (stem, number.parse())) {
            numbers.entry(stem).or_default().push(number);
        }
    }
    let animated = names.iter().filter_map(|name| {
        let path = Path::new(name);
        (path.extension() == Some(OsStr::new("apng"))).then(|| path.file_stem()?.to_str())?
    });
    let mut found: Vec<String> = animated
        .filter_map(|stem| {
            let numbers = numbers.get(stem)?;
            let drawn = numbers.iter().max()? + 1;
            let missing = drawn - numbers.len();
            (missing > 0).then(|| {
                format!("{stem}.apng does not contain {missing} of {drawn} pictures, which were removed from the folder")
            })
        })
        .collect();
    found.sort();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_pictures_are_counted_for_animations_only() {
        let place = tempfile::tempdir().unwrap();
        let names = [
            "Damage-000000.png",
            "Damage-000003.png",
            "Damage.apng",
            "Velocity_x-000001.png",
        ];
        for name in names {
            std::fs::write(place.path().join(name), "").unwrap();
        }
        let said = gaps(place.path());
        assert_eq!(said.len(), 1);
        assert!(
            said[0].starts_with("Damage.apng does not contain 2 of 4"),
            "{said:?}"
        );
        assert!(gaps(&place.path().join("nowhere")).is_empty());
    }
}
