//! Writes result files with known values, to be read by other programs:
//! `cargo run --example result_files -- FOLDER`.
//!
//! Point i of 24 is at (i mod 2, i / 2 mod 3, i / 6) and has volume 1 + i / 100; output k of 3 is at time 0.5
//! k, with damage i + 100 k and displacement (i, 2 i, 3 i + k). `validation/formats/read_results.py` checks
//! the values read by VTK, h5py and netCDF.

use std::path::Path;

use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, PointList, VtkHdfLayout, VtkHdfWriter, WriteError,
};

const POINTS: usize = 24;

fn main() -> Result<(), WriteError> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let folder = Path::new(&folder);
    let place = |i: usize| [i % 2, i / 2 % 3, i / 6].map(|x| x as f64);
    let positions: Vec<f64> = (0..3)
        .flat_map(|c| (0..POINTS).map(move |i| place(i)[c]))
        .collect();
    let volumes: Vec<f64> = (0..POINTS).map(|i| 1.0 + i as f64 / 100.0).collect();
    let list = |name: &str, range: std::ops::Range<u32>| PointList {
        name: name.into(),
        points: range.collect(),
    };
    let fields = vec![
        FieldSpec::new("Damage", 1),
        FieldSpec::new("Displacement", 3),
    ];
    for is_single in [false, true] {
        let ending = if is_single { "32" } else { "64" };
        let exodus = ExodusLayout {
            title: "numbers".into(),
            dimension: 3,
            positions: &positions,
            volumes: &volumes,
            blocks: vec![list("steel", 0..10), list("glue", 10..24)],
            sets: vec![list("left", 0..6)],
            globals: vec!["KineticEnergy".into()],
            fields: fields.clone(),
            is_single,
        };
        let vtkhdf = VtkHdfLayout {
            dimension: 3,
            positions: &positions,
            fields: fields.clone(),
            constants: vec![(FieldSpec::new("Volume", 1), &volumes)],
            // One more than is written, as in a run that was stopped.
            outputs: 4,
            is_single,
        };
        let mut exodus = ExodusWriter::create(folder.join(format!("run{ending}.exo")), &exodus)?;
        let mut vtkhdf = VtkHdfWriter::create(folder.join(format!("run{ending}.vtkhdf")), &vtkhdf)?;
        for k in 0..3 {
            let time = 0.5 * k as f64;
            let damage: Vec<f64> = (0..POINTS).map(|i| (i + 100 * k) as f64).collect();
            let displacement: Vec<f64> = (0..3 * POINTS)
                .map(|m| {
                    let (c, i) = (m / POINTS, m % POINTS);
                    ((c + 1) * i + if c == 2 { k } else { 0 }) as f64
                })
                .collect();
            exodus.append(time, &[10.0 * time], &[&damage, &displacement])?;
            vtkhdf.append(time, &[&damage, &displacement])?;
        }
    }
    Ok(())
}
