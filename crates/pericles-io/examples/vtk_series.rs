//! Writes a small series of synthetic fields: `cargo run -p pericles-io --example vtk_series -- FOLDER [POINTS]`.
//!
//! It demonstrates the writer and produces files for `validation/vtk/check.py`.

use std::error::Error;
use std::path::PathBuf;

use pericles_io::{OutputFolder, PvdSeries, VtkField, VtuFile};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "vtk-series".into());
    let n: usize = arguments.next().map_or(Ok(20_000), |text| text.parse())?;

    let folder = OutputFolder::create_numbered(PathBuf::from(folder))?;
    folder.subfolder("fields")?;
    let columns = n.div_ceil(2).max(1);
    let x: Vec<f64> = (0..2 * n)
        .map(|k| {
            let i = k % n;
            let cell = if k < n { i % columns } else { i / columns };
            cell as f64 * 1e-3
        })
        .collect();
    let kind: Vec<i32> = (0..n).map(|i| (i / columns) as i32).collect();
    let held: Vec<u8> = (0..n).map(|i| (i % columns == 0).into()).collect();

    let mut series = PvdSeries::create(folder.file("fields.pvd"))?;
    for output in 0..3 {
        let time = output as f64 * 0.1e-6;
        let phase = |k: usize| x[k] * 40.0 - time * 2e6;
        let u: Vec<f64> = (0..2 * n).map(|k| 1e-5 * phase(k % n).sin()).collect();
        let damage: Vec<f64> = (0..n).map(|i| phase(i).cos().powi(2)).collect();
        let file = PvdSeries::field_file(output);
        VtuFile::new(2, &x)
            .time(time)
            .field(VtkField::vector("Displacement", &u))
            .field(VtkField::scalar("Damage", &damage))
            .field(VtkField::scalar("Damage (single)", &damage).in_single_precision())
            .field(VtkField::integers("Block", &kind))
            .field(VtkField::bytes("Held", &held))
            .write(folder.file(&file))?;
        series.push(time, &file)?;
    }
    println!("{}", series.path().display());
    Ok(())
}
