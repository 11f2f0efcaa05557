//! Result files read back by the Exodus II reader of this crate and a small HDF5 reader; killed and resumed runs.

use std::path::Path;

use super::*;
use crate::netcdf::NetCdf;
use crate::{Format, PointOptions, SetKind};

mod hdf5;

use self::hdf5::Hdf5;

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
    let refused = |path: &Path, layout: &ExodusLayout<'_>, outputs: usize| {
        ExodusWriter::resume(path, layout, outputs)
            .unwrap_err()
            .to_string()
    };
    assert!(refused(&whole, &layout, 5).contains("it contains 4 outputs; expected at least 5"));
    let renamed = ExodusLayout {
        title: "another".into(),
        ..layout.clone()
    };
    assert!(refused(&whole, &renamed, 1).contains("another run"));
    cut(&whole, lengths[3]);
    assert!(refused(&whole, &layout, 4).contains("expected at least 4"));
    cut(&whole, 20);
    assert!(refused(&whole, &layout, 1).contains("another run"));
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
    let refused = |change: &dyn Fn(&mut ExodusLayout<'_>)| {
        let mut layout = good.clone();
        change(&mut layout);
        let path = place.path().join("refused.exo");
        ExodusWriter::create(path, &layout).unwrap_err().to_string()
    };
    assert!(refused(&|l| l.blocks[0].points.push(1)).contains("point 1 is in two blocks"));
    assert!(refused(&|l| l.blocks[2].points.clear()).contains("point 1 is in no block"));
    assert!(
        refused(&|l| l.blocks[0].points.push(9)).contains("point 9, but there are only 5 points")
    );
    assert!(
        refused(&|l| l.sets[0].points.push(9)).contains("point 9, but there are only 5 points")
    );
    assert!(refused(&|l| l.dimension = 2).contains("15 coordinates"));
    assert!(refused(&|l| l.volumes = &[]).contains("no points"));
    assert!(refused(&|l| l.fields[0].components = 0).contains("no components"));
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

fn vtkhdf_layout<'a>(
    positions: &'a [f64],
    volumes: &'a [f64],
    dimension: usize,
    is_single: bool,
) -> VtkHdfLayout<'a> {
    VtkHdfLayout {
        dimension,
        positions,
        fields: fields(dimension),
        constants: vec![(FieldSpec::new("Volume", 1), volumes)],
        outputs: 4,
        is_single,
    }
}

fn append_vtkhdf(writer: &mut VtkHdfWriter, dimension: usize, output: usize) {
    let (damage, displacement) = values(dimension, output);
    writer
        .append(0.5 * output as f64, &[&damage, &displacement])
        .unwrap();
}

fn check_vtkhdf(content: Vec<u8>, dimension: usize, outputs: usize) {
    let file = Hdf5::new(content);
    let in_steps = |name: &str| format!("/VTKHDF/Steps/{name}");
    assert_eq!(file.attribute("/VTKHDF/Steps@NSteps"), outputs as i64);
    let times: Vec<f64> = (0..outputs).map(|k| 0.5 * k as f64).collect();
    assert_eq!(file.real(&in_steps("Values")), times);
    assert_eq!(file.whole(&in_steps("NumberOfParts")), [1; 4]);
    for name in [
        "PartOffsets",
        "PointOffsets",
        "CellOffsets",
        "ConnectivityIdOffsets",
        "PointDataOffsets/Volume",
    ] {
        assert_eq!(file.whole(&in_steps(name)), [0; 4]);
    }
    assert_eq!(
        file.whole(&in_steps("PointDataOffsets/Damage")),
        [0, 5, 10, 15]
    );
    assert_eq!(file.whole("/VTKHDF/NumberOfPoints"), [5]);
    assert_eq!(file.whole("/VTKHDF/NumberOfConnectivityIds"), [5]);
    assert_eq!(file.whole("/VTKHDF/NumberOfCells"), [1]);
    assert_eq!(file.whole("/VTKHDF/Connectivity"), [0, 1, 2, 3, 4]);
    assert_eq!(file.whole("/VTKHDF/Offsets"), [0, 5]);
    assert_eq!(file.whole("/VTKHDF/Types"), [2]);
    assert_eq!(file.attributes["/VTKHDF@Version"], 0i64.to_le_bytes());
    assert!(
        file.attributes["/VTKHDF@Type"].ends_with(b"redGrid\0")
            || file.attributes["/VTKHDF@Type"].ends_with(b"Grid")
    );
    let x = positions(dimension);
    let expected: Vec<f64> = (0..3 * POINTS)
        .map(|k| {
            if k % 3 < dimension {
                x[k % 3 * POINTS + k / 3]
            } else {
                0.0
            }
        })
        .collect();
    assert_eq!(file.real("/VTKHDF/Points"), expected);
    assert_eq!(file.real("/VTKHDF/PointData/Volume"), volumes());
    let (found, rows) = (
        file.real("/VTKHDF/PointData/Damage"),
        file.real("/VTKHDF/PointData/Displacement"),
    );
    let columns = if dimension == 1 { 1 } else { 3 };
    for output in 0..outputs {
        let (damage, displacement) = values(dimension, output);
        assert_eq!(found[output * POINTS..(output + 1) * POINTS], damage);
        for i in 0..POINTS {
            for c in 0..columns {
                let expected = if c < dimension {
                    displacement[c * POINTS + i]
                } else {
                    0.0
                };
                assert_eq!(rows[(output * POINTS + i) * columns + c], expected);
            }
        }
    }
}

#[test]
fn vtkhdf_files_are_valid_after_every_output() {
    let place = tempfile::tempdir().unwrap();
    for (dimension, is_single) in [(1, false), (2, true), (3, false), (3, true)] {
        let path = place.path().join(format!("{dimension}-{is_single}.vtkhdf"));
        let (x, v) = (positions(dimension), volumes());
        let layout = vtkhdf_layout(&x, &v, dimension, is_single);
        let mut writer = VtkHdfWriter::create(&path, &layout).unwrap();
        // A file without steps does not have the name that a reader expects.
        assert!(!path.exists());
        for output in 0..4 {
            append_vtkhdf(&mut writer, dimension, output);
            check_vtkhdf(std::fs::read(&path).unwrap(), dimension, output + 1);
        }
        let (damage, displacement) = values(dimension, 4);
        let error = writer.append(2.0, &[&damage, &displacement]).unwrap_err();
        assert!(error.to_string().contains("space for 4 outputs"), "{error}");
        assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 1);
        std::fs::remove_file(path).unwrap();
    }
}

#[test]
fn a_killed_run_leaves_a_valid_vtkhdf_file_and_resumes_byte_for_byte() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(3), volumes());
    let layout = vtkhdf_layout(&x, &v, 3, false);
    let path = place.path().join("run.vtkhdf");
    let mut writer = VtkHdfWriter::create(&path, &layout).unwrap();
    let mut states = Vec::new();
    for output in 0..4 {
        append_vtkhdf(&mut writer, 3, output);
        states.push(std::fs::read(&path).unwrap());
    }
    for killed_in in 1..4 {
        // The values of an output are written before the page that counts it: any number of them may be present.
        let mut bytes = states[killed_in].clone();
        let page = 4096..8192;
        bytes[page.clone()].copy_from_slice(&states[killed_in - 1][page]);
        check_vtkhdf(bytes.clone(), 3, killed_in);
        for resumed in 0..=killed_in {
            std::fs::write(&path, &bytes).unwrap();
            let mut writer = VtkHdfWriter::resume(&path, &layout, resumed).unwrap();
            assert_eq!(writer.outputs(), resumed);
            for output in resumed..4 {
                append_vtkhdf(&mut writer, 3, output);
            }
            assert!(
                std::fs::read(&path).unwrap() == states[3],
                "{killed_in} {resumed}"
            );
        }
    }
    let refused = |layout: &VtkHdfLayout<'_>, outputs: usize| {
        let error = VtkHdfWriter::resume(&path, layout, outputs).err().unwrap();
        error.to_string()
    };
    std::fs::write(&path, &states[1]).unwrap();
    assert!(refused(&layout, 3).contains("it contains 2 outputs; expected at least 3"));
    let mut other = layout.clone();
    other.fields[0].name = "Hamage".into();
    assert!(refused(&other, 1).contains("another run"));
    other.fields.pop();
    assert!(refused(&other, 1).contains("another run"));
}

#[test]
fn inconsistent_vtkhdf_layouts_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(3), volumes());
    let refused = |change: &dyn Fn(&mut VtkHdfLayout<'_>)| {
        let mut layout = vtkhdf_layout(&x, &v, 3, false);
        change(&mut layout);
        let path = place.path().join("refused.vtkhdf");
        VtkHdfWriter::create(path, &layout)
            .err()
            .unwrap()
            .to_string()
    };
    assert!(refused(&|l| l.outputs = 0).contains("allowed: 1 to 16777216"));
    assert!(refused(&|l| l.dimension = 4).contains("4 dimensions"));
    assert!(refused(&|l| l.fields[0].name = "Volume".into()).contains("two fields"));
    assert!(refused(&|l| l.fields[1].components = 0).contains("no components"));
    assert!(
        refused(&|l| l.constants[0].0.components = 2).contains("5 points of 2 components need 10")
    );
    assert!(refused(&|l| l.outputs = usize::MAX).contains("allowed: 1 to 16777216"));
}

#[test]
fn vtkhdf_files_take_any_names_and_numbers_of_fields_and_are_read_back() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("many.vtkhdf");
    let (x, v) = (positions(2), volumes());
    let mut layout = vtkhdf_layout(&x, &v, 2, true);
    layout.fields = (0..300)
        .map(|k| FieldSpec::new(format!("field {k}"), 1))
        .collect();
    for name in ["a/b", "a_b", ".", &"x".repeat(2000)] {
        layout.fields.push(FieldSpec::new(name, 2));
    }
    layout.constants.clear();
    let value = |k: usize, i: usize| k as f64 + 0.25 * i as f64;
    let arrays: Vec<Vec<f64>> = (0..layout.fields.len())
        .map(|k| {
            (0..layout.fields[k].components * POINTS)
                .map(|i| value(k, i))
                .collect()
        })
        .collect();
    let arrays: Vec<&[f64]> = arrays.iter().map(Vec::as_slice).collect();
    let mut writer = VtkHdfWriter::create(&path, &layout).unwrap();
    writer.append(0.5, &arrays).unwrap();
    let file = Hdf5::new(std::fs::read(&path).unwrap());
    let first = |name: &str| file.real(&format!("/VTKHDF/PointData/{name}"))[0];
    assert_eq!(first("field 299"), 299.0);
    for (k, name) in [
        (300, "a_b"),
        (301, "a_b_2"),
        (302, "_"),
        (303, &*"x".repeat(2000)),
    ] {
        assert_eq!(first(name), f64::from(k), "{name}");
    }
    let mut reader = VtkHdfReader::open(&path, &layout).unwrap();
    assert_eq!(reader.outputs(), 1);
    let (time, values) = reader.read(0).unwrap();
    assert_eq!(time, 0.5);
    assert_eq!(values, arrays);
    let other = vtkhdf_layout(&x, &v, 2, true);
    assert!(VtkHdfReader::open(&path, &other).is_err());
}
