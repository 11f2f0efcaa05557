//! Result files read back by the Exodus II reader of this crate and a small HDF5 reader; killed and resumed runs.

use std::path::Path;

use super::*;
use crate::netcdf::NetCdf;
use crate::{Format, PointOptions, SetKind};

mod hdf5;
mod vtkhdf;

const POINTS: usize = 5;

fn positions(dimension: usize) -> Vec<f64> {
    (0..dimension * POINTS)
        .map(|k| 0.25 * k as f64 - 1.0)
        .collect()
}

fn volumes() -> Vec<f64> {
    (0..POINTS).map(|i| 1.0 + i as f64).collect()
}

/// Damage and displacement of an output.
fn values(dimension: usize, output: usize) -> (Vec<f64>, Vec<f64>) {
    let damage = (0..POINTS).map(|i| (i + 10 * output) as f64 / 64.0);
    let displacement = (0..dimension * POINTS).map(|k| (k * k + 7 * output) as f64 / 32.0);
    (damage.collect(), displacement.collect())
}

fn fields(dimension: usize) -> Vec<FieldSpec> {
    vec![
        FieldSpec::new("Damage", 1),
        FieldSpec::new("Displacement", dimension),
    ]
}

fn exodus_layout<'a>(
    positions: &'a [f64],
    volumes: &'a [f64],
    dimension: usize,
    is_single: bool,
) -> ExodusLayout<'a> {
    let list = |name: &str, points: Vec<u32>| PointList {
        name: name.into(),
        points,
    };
    ExodusLayout {
        title: "a test".into(),
        dimension,
        positions,
        volumes,
        blocks: vec![
            list("steel", vec![0, 2, 4]),
            list("empty", vec![]),
            list("glue", vec![1, 3]),
        ],
        sets: vec![list("left end", vec![0, 1])],
        globals: vec!["KineticEnergy".into(), "Work".into()],
        fields: fields(dimension),
        is_single,
    }
}

fn append_exodus(writer: &mut ExodusWriter, dimension: usize, output: usize) {
    let (damage, displacement) = values(dimension, output);
    let globals = [output as f64, 2.0 * output as f64];
    writer
        .append(0.5 * output as f64, &globals, &[&damage, &displacement])
        .unwrap();
}

#[test]
fn exodus_files_are_read_back_as_written() {
    let place = tempfile::tempdir().unwrap();
    for (dimension, is_single) in [(1, false), (2, false), (3, false), (3, true)] {
        let path = place.path().join(format!("{dimension}-{is_single}.exo"));
        let (x, v) = (positions(dimension), volumes());
        let layout = exodus_layout(&x, &v, dimension, is_single);
        let mut writer = ExodusWriter::create(&path, &layout).unwrap();
        for output in 0..3 {
            append_exodus(&mut writer, dimension, output);
        }
        assert_eq!(writer.outputs(), 3);
        let content = std::fs::read(&path).unwrap();
        // As a mesh: points with volumes, blocks and sets.
        let mesh = Format::Exodus
            .parse(&content, u64::MAX, &|_| Err(String::new()))
            .unwrap();
        let points = mesh.points(&PointOptions::default()).unwrap();
        // The elements of a file are ordered by blocks.
        let order = [0, 2, 4, 1, 3];
        for (k, &i) in order.iter().enumerate() {
            assert_eq!(points.volumes[k], v[i]);
            for c in 0..3 {
                let expected = if c < dimension {
                    x[c * POINTS + i]
                } else {
                    0.0
                };
                assert_eq!(points.positions[k][c], expected);
            }
        }
        assert_eq!(points.set("steel").unwrap().points, [0, 1, 2]);
        assert_eq!(points.set("glue").unwrap().points, [3, 4]);
        let left = points.set("left end").unwrap();
        assert_eq!((left.kind, &left.points[..]), (SetKind::Nodes, &[0, 3][..]));
        // The records.
        let file = NetCdf::new(&content, 0).unwrap();
        assert_eq!(file.records(), 3);
        let real = |name: &str, k: u64| file.real(file.variable(name).unwrap(), k).unwrap();
        let names = file.texts(file.variable("name_nod_var").unwrap()).unwrap();
        let expected: &[&str] = match dimension {
            1 => &["Damage", "Displacement"],
            _ => &["Damage", "DisplacementX", "DisplacementY", "DisplacementZ"],
        };
        assert_eq!(names, expected);
        for output in 0..3 {
            let (damage, displacement) = values(dimension, output);
            let k = output as u64;
            assert_eq!(real("time_whole", k), [0.5 * output as f64]);
            assert_eq!(
                real("vals_glo_var", k),
                [output as f64, 2.0 * output as f64]
            );
            assert_eq!(real("vals_nod_var1", k), damage);
            for c in 0..names.len() - 1 {
                let found = real(&format!("vals_nod_var{}", c + 2), k);
                match displacement.get(c * POINTS..(c + 1) * POINTS) {
                    Some(expected) => assert_eq!(found, expected),
                    None => assert_eq!(found, [0.0; POINTS]),
                }
            }
        }
    }
}

/// Truncates a file as a killed run would, with `bytes` bytes of the last output written.
fn cut(path: &Path, bytes: usize) {
    let file = std::fs::OpenOptions::new().write(true).open(path).unwrap();
    file.set_len(bytes as u64).unwrap();
}

#[test]
fn a_killed_run_leaves_a_valid_exodus_file_and_resumes_byte_for_byte() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(3), volumes());
    let layout = exodus_layout(&x, &v, 3, false);
    let (whole, other) = (
        place.path().join("whole.exo"),
        place.path().join("other.exo"),
    );
    let mut writer = ExodusWriter::create(&whole, &layout).unwrap();
    let mut lengths = vec![std::fs::metadata(&whole).unwrap().len() as usize];
    let mut states = vec![std::fs::read(&whole).unwrap()];
    for output in 0..4 {
        append_exodus(&mut writer, 3, output);
        lengths.push(std::fs::metadata(&whole).unwrap().len() as usize);
        states.push(std::fs::read(&whole).unwrap());
    }
    let expected = std::fs::read(&whole).unwrap();
    for killed_in in 0..4 {
        // While a record is written, the number of records is still the previous one.
        for part in 1..lengths[1] - lengths[0] {
            let mut bytes = states[killed_in].clone();
            bytes.extend_from_slice(
                &states[killed_in + 1][lengths[killed_in]..lengths[killed_in] + part],
            );
            let file = NetCdf::new(&bytes, 0).unwrap();
            assert_eq!(file.records(), killed_in as u64);
            if part % 37 != 1 {
                continue;
            }
            for resumed in 0..=killed_in {
                std::fs::write(&other, &bytes).unwrap();
                let mut writer = ExodusWriter::resume(&other, &layout, resumed).unwrap();
                for output in resumed..4 {
                    append_exodus(&mut writer, 3, output);
                }
                assert!(
                    std::fs::read(&other).unwrap() == expected,
                    "{killed_in} {part} {resumed}"
                );
            }
        }
    }
    // More outputs than the file contains, a file of another run, a truncated file.
    let rejected = |path: &Path, layout: &ExodusLayout<'_>, outputs: usize| {
        ExodusWriter::resume(path, layout, outputs)
            .unwrap_err()
            .to_string()
    };
    assert!(rejected(&whole, &layout, 5).contains("it contains 4 outputs; expected at least 5"));
    let renamed = ExodusLayout {
        title: "another".into(),
        ..layout.clone()
    };
    assert!(rejected(&whole, &renamed, 1).contains("another run"));
    cut(&whole, lengths[3]);
    assert!(rejected(&whole, &layout, 4).contains("expected at least 4"));
    cut(&whole, 20);
    assert!(rejected(&whole, &layout, 1).contains("another run"));
}

#[test]
fn names_in_exodus_files_are_short_and_unique() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(1), volumes());
    let long = "a name that is longer than what Exodus holds";
    let mut layout = exodus_layout(&x, &v, 1, false);
    layout.fields = vec![
        FieldSpec::new(long, 3),
        FieldSpec::new(format!("{long}, again"), 3),
        FieldSpec::new("Stress", 6),
        FieldSpec::new("Other", 4),
    ];
    layout.blocks[0].name = "größer als zweiunddreißig Zeichen".into();
    let path = place.path().join("names.exo");
    drop(ExodusWriter::create(&path, &layout).unwrap());
    let content = std::fs::read(&path).unwrap();
    let file = NetCdf::new(&content, 0).unwrap();
    let names = file.texts(file.variable("name_nod_var").unwrap()).unwrap();
    let mut unique = names.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), 16);
    assert!(names.iter().all(|name| name.len() <= 32));
    // 31 bytes and the suffix of a component; the second field is numbered, so that its components stay together.
    assert_eq!(names[0], "a name that is longer than whatX");
    assert_eq!(
        names[3..6].join(" "),
        "a name that is longer than wh_2X a name that is longer than wh_2Y a name that is longer than wh_2Z"
    );
    assert_eq!(
        names[6..12].join(" "),
        "StressXX StressYY StressZZ StressXY StressYZ StressXZ"
    );
    assert_eq!(names[15], "Other_4");
    let blocks = file.texts(file.variable("eb_names").unwrap()).unwrap();
    assert!("größer als zweiunddreißig Zeichen".starts_with(&blocks[0]) && blocks[0].len() > 28);
}

#[test]
fn inconsistent_layouts_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(3), volumes());
    let good = exodus_layout(&x, &v, 3, false);
    let rejected = |change: &dyn Fn(&mut ExodusLayout<'_>)| {
        let mut layout = good.clone();
        change(&mut layout);
        let path = place.path().join("rejected.exo");
        ExodusWriter::create(path, &layout).unwrap_err().to_string()
    };
    assert!(rejected(&|l| l.blocks[0].points.push(1)).contains("point 1 is in two blocks"));
    assert!(rejected(&|l| l.blocks[2].points.clear()).contains("point 1 is in no block"));
    assert!(
        rejected(&|l| l.blocks[0].points.push(9)).contains("point 9, but there are only 5 points")
    );
    assert!(
        rejected(&|l| l.sets[0].points.push(9)).contains("point 9, but there are only 5 points")
    );
    assert!(rejected(&|l| l.dimension = 2).contains("15 coordinates"));
    assert!(rejected(&|l| l.volumes = &[]).contains("no points"));
    assert!(rejected(&|l| l.fields[0].components = 0).contains("no components"));
    let mut writer = ExodusWriter::create(place.path().join("a.exo"), &good).unwrap();
    let (damage, displacement) = values(3, 0);
    for (globals, values) in [
        (&[1.0][..], vec![&damage[..], &displacement[..]]),
        (&[1.0, 2.0], vec![&damage[..]]),
        (&[1.0, 2.0], vec![&damage[..4], &displacement[..]]),
    ] {
        assert!(matches!(
            writer.append(0.0, globals, &values),
            Err(WriteError::Unsuitable(_))
        ));
    }
    assert!(matches!(
        ExodusWriter::create(place.path().join("no/such/folder.exo"), &good),
        Err(WriteError::Io(_))
    ));
}
