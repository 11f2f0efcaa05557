//! Prints the content of mesh files: `cargo run --example mesh_info -- FILE …`.

use std::path::Path;
use std::time::Instant;

use pericles_mesh::{Format, PointOptions, Summary};

fn report(path: &Path) -> Result<(), String> {
    let format = Format::of(path).ok_or("unknown file extension")?;
    let include = |name: &str| {
        std::fs::read(path.with_file_name(name)).map_err(|error| format!("{name}: {error}"))
    };
    let begin = Instant::now();
    let content = std::fs::read(path).map_err(|error| error.to_string())?;
    let mesh = format
        .parse(&content, u64::MAX, &include)
        .map_err(|fault| fault.to_string())?;
    let read = begin.elapsed().as_secs_f64();
    let options = PointOptions::default();
    let points = mesh
        .points(&options)
        .map_err(|problem| problem.to_string())?;
    let all = begin.elapsed().as_secs_f64();
    let summary = Summary::new(&mesh, &points, options.unit);
    println!(
        "{summary:#?}\nread in {read:.3} s, points and sets {:.3} s",
        all - read
    );
    Ok(())
}

fn main() {
    for path in std::env::args().skip(1) {
        println!("{path}");
        if let Err(reason) = report(Path::new(&path)) {
            println!("  error: {reason}");
        }
    }
}
