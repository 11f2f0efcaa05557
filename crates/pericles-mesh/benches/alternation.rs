//! Timings as ratios to a simple reference, measured alternately so that they hold on a busy machine:
//! `cargo bench -p pericles-mesh`.
//!
//! | measured | reference |
//! |---|---|
//! | filling 200 × 200 × 200 nodes from 327,680 triangles, one thread | the same columns by a plain loop in floating-point arithmetic |
//! | an output of 10⁶ points and 7 numbers, Exodus and VTKHDF, single precision | writing the same bytes |
//!
//! Readers are compared with meshio by `validation/formats/compare_readers.py`.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use pericles_mesh::fill::{TriangleSurface, fill};
use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, PointList, VtkHdfLayout, VtkHdfWriter, WriteError,
};

/// A torus of n × m quadrilaterals, each split into two triangles.
fn torus(n: u32, m: u32) -> TriangleSurface {
    let angle = |k: u32, n: u32| 2.0 * std::f64::consts::PI * f64::from(k) / f64::from(n);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..m {
            let (a, b) = (angle(i, n), angle(j, m));
            let r = 1.0 + 0.4 * b.cos();
            positions.push([r * a.cos(), r * a.sin(), 0.4 * b.sin()]);
            let at = |i: u32, j: u32| i % n * m + j % m;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleSurface::new(positions, triangles).expect("a torus is a surface")
}

/// Counts the nodes inside by a plain loop: for each triangle the columns in its bounding box, for each
/// crossed column the nodes below. Nodes on edges may be counted wrongly.
fn fill_plainly(surface: &TriangleSurface, low: [f64; 3], spacing: [f64; 3], n: usize) -> usize {
    let mut changes = vec![0i32; n * n * (n + 1)];
    let coordinate = |c: usize, k: usize| low[c] + (k as f64 + 0.5) * spacing[c];
    for triangle in 0..surface.len() {
        let [a, b, c] = surface.corners(triangle);
        let range = |axis: usize| {
            let (x, y, z) = (a[axis], b[axis], c[axis]);
            let place = |x: f64| (x - low[axis]) / spacing[axis] - 0.5;
            let begin = place(x.min(y).min(z)).ceil().max(0.0) as usize;
            let end = (place(x.max(y).max(z)).floor() + 1.0).max(0.0) as usize;
            begin..end.min(n)
        };
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 {
            continue;
        }
        for j in range(1) {
            let y = coordinate(1, j);
            for i in range(0) {
                let x = coordinate(0, i);
                let u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
                let v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
                if u < 0.0 || v < 0.0 || u + v > 1.0 {
                    continue;
                }
                let z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
                let above = ((z - low[2]) / spacing[2] - 0.5).ceil().max(0.0) as usize;
                let change = if area > 0.0 { 1 } else { -1 };
                changes[(j * n + i) * (n + 1) + above.min(n)] += change;
            }
        }
    }
    let mut inside = 0;
    for column in changes.chunks(n + 1) {
        let mut winding = 0;
        for change in column[1..].iter().rev() {
            winding += change;
            inside += usize::from(winding >= 1);
        }
    }
    inside
}

fn seconds(work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64()
}

/// Alternates two tasks and prints the median times and the median of their ratios.
fn compare(name: &str, rounds: usize, mut ours: impl FnMut(), mut plain: impl FnMut()) {
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let times: Vec<[f64; 2]> = (0..rounds)
        .map(|_| [seconds(&mut ours), seconds(&mut plain)])
        .collect();
    let least = |k: usize| times.iter().map(|t| t[k]).fold(f64::INFINITY, f64::min);
    println!(
        "{name}: {:.0} ms, reference {:.0} ms (minimum {:.0} and {:.0}), ratio {:.2} (medians of {rounds} rounds)",
        1e3 * median(times.iter().map(|t| t[0]).collect()),
        1e3 * median(times.iter().map(|t| t[1]).collect()),
        1e3 * least(0),
        1e3 * least(1),
        median(times.iter().map(|t| t[0] / t[1]).collect()),
    );
}

fn filling() {
    let surface = torus(512, 320);
    let n = 200;
    let [low, high] = surface.bounds();
    let spacing: [f64; 3] = std::array::from_fn(|c| (high[c] - low[c]) / n as f64);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.expect("a thread");
    let (mut exact, mut plain) = (0, 0);
    compare(
        &format!("filling 200^3 nodes from {} triangles", surface.len()),
        7,
        || exact = one.install(|| fill(&surface, spacing).expect("closed").len()),
        || plain = fill_plainly(&surface, low, spacing, n),
    );
    println!("  nodes inside: {exact} (exact), {plain} (plain loop)");
}

fn writing(folder: &Path) -> Result<(), WriteError> {
    let n = 1_000_000;
    let positions: Vec<f64> = (0..3 * n).map(|k| k as f64).collect();
    let fields = vec![
        FieldSpec::new("Displacement", 3),
        FieldSpec::new("Velocity", 3),
        FieldSpec::new("Damage", 1),
    ];
    let values: [&[f64]; 3] = [&positions, &positions, &positions[..n]];
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|values| values.iter())
        .flat_map(|x| (*x as f32).to_le_bytes())
        .collect();
    let rounds = 9;
    let mut raw = File::create(folder.join("raw"))?;
    let exodus = ExodusLayout {
        title: String::new(),
        dimension: 3,
        positions: &positions,
        volumes: &positions[..n],
        blocks: vec![PointList {
            name: "all".into(),
            points: (0..n as u32).collect(),
        }],
        sets: vec![],
        globals: vec![],
        fields: fields.clone(),
        is_single: true,
    };
    let mut exodus = ExodusWriter::create(folder.join("fields.exo"), &exodus)?;
    compare(
        "Exodus, an output of 1e6 points and 7 numbers",
        rounds,
        || exodus.append(0.0, &[], &values).expect("disk space"),
        || raw.write_all(&bytes).expect("disk space"),
    );
    let vtkhdf = VtkHdfLayout {
        dimension: 3,
        positions: &positions,
        fields,
        constants: vec![],
        outputs: rounds,
        is_single: true,
    };
    let mut vtkhdf = VtkHdfWriter::create(folder.join("fields.vtkhdf"), &vtkhdf)?;
    compare(
        "VTKHDF, an output of 1e6 points and 7 numbers",
        rounds,
        || vtkhdf.append(0.0, &values).expect("disk space"),
        || raw.write_all(&bytes).expect("disk space"),
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    filling();
    let folder = tempfile::tempdir()?;
    Ok(writing(folder.path())?)
}
