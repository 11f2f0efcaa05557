//! Draws synthetic fields and curves: `cargo run -p pericles-io --example pictures -- FOLDER`.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use pericles_io::{Axis, CellSize, ColourMap, Curve, FieldPicture, LineChart};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let folder = Path::new(&folder);
    plate(folder)?;
    solid(folder)?;
    bar(folder)?;
    curves(folder)?;
    Ok(())
}

/// A plate of 100 mm × 40 mm with an opening crack at its left edge.
fn plate(folder: &Path) -> Result<(), Box<dyn Error>> {
    let (columns, rows, dx) = (400, 160, 0.25e-3);
    let n = columns * rows;
    let mut x = vec![0.0; 2 * n];
    let mut u = vec![0.0; 2 * n];
    let mut damage = vec![0.0; n];
    for i in 0..n {
        let (a, b) = ((i % columns) as f64 + 0.5, (i / columns) as f64 + 0.5);
        (x[i], x[n + i]) = (a * dx, b * dx - 0.02);
        let (ahead, above) = (x[i] - 0.055, x[n + i]);
        let distance = ahead.hypot(above);
        let angle = above.atan2(ahead);
        u[n + i] = 4e-5 * (distance / 0.05).sqrt() * (angle / 2.0).sin() * 2.0;
        u[i] = 1e-5 * (distance / 0.05).sqrt() * (angle / 2.0).cos();
        let along_crack = if ahead < 0.0 { above.abs() } else { distance };
        damage[i] = 0.6 * (-(along_crack / 0.4e-3).powi(2)).exp();
    }
    FieldPicture::new(2, &x, &damage, CellSize::Uniform(dx))
        .label("Damage", "")
        .displacement(&u, 20.0)
        .title("Crack in a plate, displacement × 20")
        .time(46e-6)
        .write(folder.join("plate_damage.png"))?;
    FieldPicture::new(2, &x, &u[n..], CellSize::Uniform(dx))
        .label("Displacement y", "m")
        .colours(ColourMap::Diverging)
        .time(46e-6)
        .write(folder.join("plate_displacement.png"))?;
    Ok(())
}

/// A tube of 25 mm radius, seen from the side, coloured by the radial velocity.
fn solid(folder: &Path) -> Result<(), Box<dyn Error>> {
    let edge = 1e-3;
    let mut points = Vec::new();
    for k in -50..50 {
        for j in -25..25 {
            for i in -25..25 {
                let p = [i, j, k].map(|c| (f64::from(c) + 0.5) * edge);
                let radius = p[0].hypot(p[1]);
                if radius < 0.025 && radius > 0.02 && !(p[0] > 0.0 && p[1] < 0.0 && p[2] > 0.02) {
                    points.push(p);
                }
            }
        }
    }
    let x: Vec<f64> = (0..3)
        .flat_map(|c| points.iter().map(move |p| p[c]))
        .collect();
    let speed: Vec<f64> = points
        .iter()
        .map(|p| 200.0 - 50.0 * (p[2] / 0.05).powi(2) + 10.0 * (40.0 * p[0]).sin())
        .collect();
    FieldPicture::new(3, &x, &speed, CellSize::Uniform(edge))
        .label("Radial velocity", "m/s")
        .title("A tube with a window")
        .time(0.0)
        .write(folder.join("tube.png"))?;
    FieldPicture::new(3, &x, &speed, CellSize::Uniform(edge))
        .label("Radial velocity", "m/s")
        .view([1.0, 0.2, 0.1])
        .write(folder.join("tube_side.png"))?;
    Ok(())
}

/// A pulse in a bar.
fn bar(folder: &Path) -> Result<(), Box<dyn Error>> {
    let x: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.4e-3).collect();
    let pulse = |x: &f64| 1.5e-6 * (-((x - 0.08) / 0.01).powi(2)).exp() * (400.0 * x).cos();
    let u: Vec<f64> = x.iter().map(pulse).collect();
    FieldPicture::new(1, &x, &u, CellSize::Uniform(0.4e-3))
        .label("Displacement", "m")
        .title("Pulse in a bar")
        .time(12.5e-6)
        .write(folder.join("bar.png"))?;
    Ok(())
}

fn curves(folder: &Path) -> Result<(), Box<dyn Error>> {
    let t: Vec<f64> = (0..2000).map(|k| f64::from(k) * 23e-9).collect();
    let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { t.iter().map(|t| f(*t / 46e-6)).collect() };
    LineChart::new(Axis::new("time", "s"), Axis::new("energy", "J"))
        .title("Energies of the branching plate")
        .curve(Curve::line(
            "kinetic",
            &t,
            &of(&|s| 0.02 * s * s * (1.0 + 0.1 * (60.0 * s).sin())),
        ))
        .curve(Curve::line("elastic", &t, &of(&|s| 0.03 * s)))
        .curve(Curve::line(
            "dissipated",
            &t,
            &of(&|s| 0.012 * (s - 0.4).max(0.0)),
        ))
        .curve(Curve::line("external work", &t, &of(&|s| 0.06 * s * s)).dashed())
        .write(folder.join("energies.png"))?;

    let h = [0.1, 0.05, 0.025, 0.0125, 0.00625];
    let order =
        |c: f64, p: i32| h.map(|h: f64| c * h.powi(p) * (1.0 + 0.2 * (30.0 * PI * h).sin()));
    LineChart::new(
        Axis::new("dx / length", "").logarithmic(),
        Axis::new("error", "").logarithmic(),
    )
    .curve(Curve::line("Verlet", &h, &order(3.0, 2)).with_markers())
    .curve(Curve::line("Runge–Kutta 4", &h, &order(20.0, 4)).with_markers())
    .curve(Curve::points("measured", &h, &order(8.0, 3)))
    .curve(
        Curve::line("slope 2", &h, &h.map(|h| 0.8 * h * h))
            .dashed()
            .colour([120, 120, 120]),
    )
    .write(folder.join("orders.png"))?;
    Ok(())
}
