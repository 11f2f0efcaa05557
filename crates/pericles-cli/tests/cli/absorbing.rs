//! Absorbing boundaries: cached kernels, studies, output of `check`.

use std::fs;
use std::path::Path;

use crate::common::{succeed, text};
use serde_json::Value;

const BAR: &str = r#"
[body]
shape = "bar"
length = "100 mm"
spacing = "1 mm"
[material]
model = "linear"
density = "7850 kg/m3"
youngs_modulus = "210 GPa"
horizon_ratio = 3
volume_correction = "none"
[[initial]]
displacement = { expression = "1e-6*exp(-((x-0.05)/0.004)^2)" }
[[boundary]]
kind = "absorbing"
side = "-x"
history = "blocked"
[[boundary]]
kind = "absorbing"
side = "+x"
history = "exponentials"
tolerance = 1e-8
verify = true
[time]
end = "60 us"
[output]
history = { count = 20 }
"#;

fn history(place: &Path, out: &str) -> (Vec<u8>, String) {
    let line = format!("run bar.toml --out {out} --cache cache");
    let output = succeed(place, &line);
    let bytes = fs::read(place.join(out).join("history.csv")).unwrap();
    (bytes, text(&output.stderr))
}

#[test]
fn a_truncated_cache_file_is_recomputed() {
    let place = tempfile::tempdir().unwrap();
    let place = place.path();
    fs::write(place.join("bar.toml"), BAR).unwrap();
    let (first, _) = history(place, "first");
    let stored: Vec<_> = fs::read_dir(place.join("cache"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().contains("absorbing-kernels"))
        .collect();
    assert_eq!(
        stored.len(),
        1,
        "both boundaries share their kernels: {stored:?}"
    );
    let bytes = fs::read(&stored[0]).unwrap();
    fs::write(&stored[0], &bytes[..bytes.len() / 2]).unwrap();
    let (second, notes) = history(place, "second");
    assert_eq!(first, second);
    assert!(notes.contains("cache"), "{notes}");
    assert_eq!(
        fs::read(&stored[0]).unwrap(),
        bytes,
        "the cache file is not rewritten"
    );
    let (third, _) = history(place, "third");
    assert_eq!(first, third);
}

#[test]
fn check_reports_the_type_of_absorbing_boundaries() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("bar.toml"), BAR).unwrap();
    let says = text(&succeed(place.path(), "check bar.toml --no-cache").stdout);
    let lines: Vec<&str> = says
        .lines()
        .filter(|line| line.contains("absorbing boundary"))
        .collect();
    assert_eq!(lines.len(), 2, "{says}");
    assert!(lines[0].contains("-x: blocked"), "{says}");
    assert!(lines[1].contains("terms, error"), "{says}");
    assert!(lines[1].contains("from the exact kernels"), "{says}");
}

#[test]
fn the_kernels_of_the_beam_reproduce_the_published_table() {
    let place = tempfile::tempdir().unwrap();
    let line = "reproduce absorbing-boundaries/table-1 --json -";
    let results: Value = serde_json::from_str(&text(&succeed(place.path(), line).stdout)).unwrap();
    assert_eq!(results["pass"], true, "{results:#}");
    let rows = results["rows"].as_array().unwrap();
    assert!(rows.iter().filter(|row| row["pass"] == true).count() >= 12);
}
