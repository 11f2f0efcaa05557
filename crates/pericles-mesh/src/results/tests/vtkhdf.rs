//! VTKHDF files: layout, resumed series, rejected layouts.

use super::hdf5::Hdf5;
use super::*;

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
    let rejected = |layout: &VtkHdfLayout<'_>, outputs: usize| {
        let error = VtkHdfWriter::resume(&path, layout, outputs).err().unwrap();
        error.to_string()
    };
    std::fs::write(&path, &states[1]).unwrap();
    assert!(rejected(&layout, 3).contains("it contains 2 outputs; expected at least 3"));
    let mut other = layout.clone();
    other.fields[0].name = "Hamage".into();
    assert!(rejected(&other, 1).contains("another run"));
    other.fields.pop();
    assert!(rejected(&other, 1).contains("another run"));
}

#[test]
fn inconsistent_vtkhdf_layouts_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    let (x, v) = (positions(3), volumes());
    let rejected = |change: &dyn Fn(&mut VtkHdfLayout<'_>)| {
        let mut layout = vtkhdf_layout(&x, &v, 3, false);
        change(&mut layout);
        let path = place.path().join("rejected.vtkhdf");
        VtkHdfWriter::create(path, &layout)
            .err()
            .unwrap()
            .to_string()
    };
    assert!(rejected(&|l| l.outputs = 0).contains("allowed: 1 to 16777216"));
    assert!(rejected(&|l| l.dimension = 4).contains("4 dimensions"));
    assert!(rejected(&|l| l.fields[0].name = "Volume".into()).contains("two fields"));
    assert!(rejected(&|l| l.fields[1].components = 0).contains("no components"));
    assert!(
        rejected(&|l| l.constants[0].0.components = 2).contains("5 points of 2 components need 10")
    );
    assert!(rejected(&|l| l.outputs = usize::MAX).contains("allowed: 1 to 16777216"));
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
