//! Times of the expensive parts: `cargo run --release --example speed`.

use std::time::Instant;

use pericles_mesh::fill::{TriangleSurface, fill, fill_open, fill_partially};
use pericles_mesh::random::{blue_noise, nearest_volumes};
use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, PointList, VtkHdfLayout, VtkHdfWriter,
};

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let result = work();
    println!("{what}: {:.3} s", begin.elapsed().as_secs_f64());
    result
}

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

fn main() {
    let surface = torus(512, 320);
    println!("{} triangles", surface.len());
    let spacing = [2.8 / 200.0, 2.8 / 200.0, 0.8 / 200.0];
    let filled = timed("200 x 200 x 200 nodes", || fill(&surface, spacing)).expect("closed");
    println!(
        "{} nodes inside, volume error {:.1e}",
        filled.len(),
        filled.volume() / filled.enclosed_volume() - 1.0
    );
    timed("parts of 200 x 200 x 200 cells", || {
        fill_partially(&surface, spacing)
    })
    .expect("closed");
    let coarse = [0.04; 3];
    timed("winding number, 70 x 70 x 20 nodes", || {
        fill_open(&surface, coarse)
    })
    .expect("closed");
    let box_of = [[0.0; 3], [1.0; 3]];
    let spacing = 1.0 / 60.0;
    let points = timed("blue noise", || {
        blue_noise(box_of, 3, spacing, 1, &|_| true)
    })
    .expect("a box");
    println!("{} points", points.len());
    timed("their volumes", || {
        nearest_volumes(&points, box_of, 3, spacing, &|_| true)
    })
    .expect("a box");

    let n = 1_000_000;
    let positions: Vec<f64> = (0..3 * n).map(|k| k as f64).collect();
    let fields = vec![
        FieldSpec::new("Displacement", 3),
        FieldSpec::new("Velocity", 3),
        FieldSpec::new("Damage", 1),
    ];
    let folder = std::env::temp_dir();
    let layout = ExodusLayout {
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
    let values: [&[f64]; 3] = [&positions, &positions, &positions[..n]];
    let path = folder.join("pericles-mesh-speed.exo");
    let mut exodus = timed("Exodus, begin, 1 M points", || {
        ExodusWriter::create(&path, &layout)
    })
    .expect("a file");
    for _ in 0..3 {
        timed("Exodus, output of 7 numbers", || {
            exodus.append(0.0, &[], &values)
        })
        .expect("a file");
    }
    let _ = std::fs::remove_file(path);
    let layout = VtkHdfLayout {
        dimension: 3,
        positions: &positions,
        fields,
        constants: vec![],
        outputs: 3,
        is_single: true,
    };
    let path = folder.join("pericles-mesh-speed.vtkhdf");
    let mut vtkhdf = timed("VTKHDF, begin, 1 M points", || {
        VtkHdfWriter::create(&path, &layout)
    })
    .expect("a file");
    for _ in 0..3 {
        timed("VTKHDF, output of 7 numbers", || {
            vtkhdf.append(0.0, &values)
        })
        .expect("a file");
    }
    let plain: Vec<u8> = positions
        .iter()
        .chain(&positions)
        .chain(&positions[..n])
        .flat_map(|x| (*x as f32).to_le_bytes())
        .collect();
    timed("the same bytes in one write", || {
        std::fs::write(&path, &plain)
    })
    .expect("a file");
    let _ = std::fs::remove_file(path);
}
