//! A custom observer: gauges on a bar that record the arrival of a pulse and its peak velocity.
//!
//! Observers read a run without changing it. `Arc<Mutex<…>>` shares a gauge with the program, which reads it after the
//! run.

use std::error::Error;
use std::sync::{Arc, Mutex};

use pericles::prelude::*;

/// The peak velocity (m/s) at a point and its time (s).
struct Gauge {
    point: usize,
    peak: f64,
    time: f64,
}

impl Observer for Gauge {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        // Component c of point i is entry c · n + i for n points; a bar has component 0 only.
        let velocity = snapshot.field(Field::Velocity)[self.point];
        if velocity > self.peak {
            (self.peak, self.time) = (velocity, snapshot.state().t);
        }
        Ok(())
    }
}

// The fields stored in checkpoints, so that a resumed run has the same readings. A missing field is a compile error.
saved! {
    impl Checkpointed for Gauge {
        peak: array("gauge/peak"),
        time: array("gauge/time"),
        point: fixed,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    const PUSH: f64 = 0.5;
    let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3e-3);
    let wave_speed = (210e9_f64 / 7850.0).sqrt();
    let bar = Grid::bar(0.8, 1e-3, 1e-4).points()?;
    let gauge = |x: f64| {
        Arc::new(Mutex::new(Gauge {
            point: bar.nearest([x, 0.0, 0.0]),
            peak: 0.0,
            time: 0.0,
        }))
    };
    let (first, second, end) = (gauge(0.2), gauge(0.6), gauge(0.8));

    // The left end moves with the prescribed velocity 0.5 m/s · sin²(π t/40 µs) and then stays fixed.
    let driven = bar.select(&Region::layer("-x", 3e-3)?);
    let pulse = TimeFunction::Pulse {
        start: 0.0,
        duration: 40e-6,
    };
    let push = PrescribedMotion::velocity(driven, [Some(PUSH), None, None], pulse).named("push");
    let system = Body::new(bar, steel).motion(push).build()?;
    let mut run = Simulation::builder(system)
        .observe(Schedule::Every(1), first.clone())
        .observe(Schedule::Every(1), second.clone())
        .observe(Schedule::Every(1), end.clone())
        .end(0.9 / wave_speed + 20e-6)
        .build()?;
    run.run_to_end()?;

    let read = |gauge: &Mutex<Gauge>| match gauge.lock() {
        Ok(gauge) => Ok((gauge.time, gauge.peak)),
        Err(_) => Err("an observer panicked"),
    };
    let ((t1, v1), (t2, _), (_, v_end)) = (read(&first)?, read(&second)?, read(&end)?);
    let speed = 0.4 / (t2 - t1);
    println!("wave speed between the gauges: {speed:.0} m/s (continuum: {wave_speed:.0} m/s)");
    println!("peak velocity inside the bar: {v1:.4} m/s (prescribed: {PUSH} m/s)");
    println!(
        "peak velocity of the free end: {:.3} times that inside (continuum: 2)",
        v_end / v1
    );

    // A compression pulse is reflected as tension at a free end, which moves with twice the velocity.
    if (speed / wave_speed - 1.0).abs() > 0.01 || (v_end / v1 - 2.0).abs() > 0.02 {
        return Err("the wave speed or the reflection is wrong".into());
    }
    Ok(())
}
