//! Graphics processors through `pericles-gpu`.

use std::path::Path;
use std::sync::Arc;

use pericles::PericlesError;
use pericles::time::Device;
use pericles_deck::{DevicePrecision, Processor};
use pericles_gpu::{Adapter, Gpu, GpuError, Precision, adapter, adapters};
use pericles_run::units::{bytes, count, significant};
use pericles_run::{Devices, RunError};
use serde_json::{Map, json};

use crate::args::{BenchArgs, DevicesArgs};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Edge of the block of the list, in points.
const EDGE: usize = 40;
/// Edges of the blocks of the bench, in points.
const EDGES: [usize; 3] = [46, 100, 200];
/// Products with sums that a bond takes: a product or a sum alone counts as one.
const PRODUCTS: f64 = 25.0;

/// Returns the graphics processors.
pub(crate) fn devices() -> Option<Arc<dyn Devices>> {
    Some(Arc::new(GraphicsProcessors))
}

struct GraphicsProcessors;

impl Devices for GraphicsProcessors {
    fn open(&self, wanted: Processor) -> Result<Arc<dyn Device>, PericlesError> {
        Ok(Arc::new(opened(&found(wanted)?, wanted)?))
    }
}

fn found(wanted: Processor) -> Result<Adapter, GpuError> {
    adapter(wanted.adapter.map(|number| number as usize))
}

fn opened(adapter: &Adapter, wanted: Processor) -> Result<Gpu, GpuError> {
    let precision = match wanted.precision {
        DevicePrecision::Auto => None,
        DevicePrecision::Double => Some(Precision::Double),
        DevicePrecision::Mixed => Some(Precision::Mixed),
    };
    Gpu::open(adapter, precision)
}

fn failed(error: impl Into<PericlesError>) -> CliError {
    RunError::from(error.into()).into()
}

/// Lists the graphics processors.
///
/// # Errors
/// There is none; a driver that fails.
pub(crate) fn list(args: &DevicesArgs) -> Result<Exit, CliError> {
    let adapters = adapters();
    if adapters.is_empty() {
        return Err(failed(GpuError::NoAdapter));
    }
    let table = args.json.as_deref() != Some(Path::new("-"));
    let mut listed = Vec::new();
    for (number, adapter) in adapters.iter().enumerate() {
        let mut speeds = Vec::new();
        for precision in Precision::ALL {
            if precision == Precision::Double && !adapter.has_doubles {
                continue;
            }
            let gpu = Gpu::open(adapter, Some(precision)).map_err(failed)?;
            let speed = gpu.speed(EDGE).map_err(failed)?;
            speeds.push((precision.name(), speed.bonds_per_second()));
        }
        if table {
            let Adapter {
                name,
                kind,
                interface,
                driver,
                largest_array,
                ..
            } = adapter;
            console::print(format_args!(
                "gpu:{number}  {name} ({kind}, {interface}, driver {driver}), arrays of up to {}",
                bytes(*largest_array)
            ))?;
            for (precision, speed) in &speeds {
                let speed = significant(1e-6 * speed, 3);
                console::print(format_args!(
                    "       {precision} precision: {speed} million bonds/s"
                ))?;
            }
        }
        let speeds = speeds
            .into_iter()
            .map(|(precision, speed)| (precision.to_owned(), json!(speed)));
        listed.push(json!({
            "number": number,
            "name": adapter.name,
            "kind": adapter.kind,
            "interface": adapter.interface,
            "driver": adapter.driver,
            "double_precision": adapter.has_doubles,
            "largest_array": adapter.largest_array,
            "bonds_per_second": speeds.collect::<Map<_, _>>(),
        }));
    }
    if let Some(path) = &args.json {
        console::write_json(path, &listed)?;
    }
    Ok(Exit::Done)
}

/// Measures complete steps of blocks on a graphics processor, beside its ceilings.
///
/// # Errors
/// An unknown case; a device that is missing, has too little memory or fails.
pub(crate) fn bench(args: &BenchArgs, wanted: Processor) -> Result<Exit, CliError> {
    let edges = match &args.case {
        None => EDGES.to_vec(),
        Some(case) => vec![edge(case)?],
    };
    let adapter = found(wanted).map_err(failed)?;
    let ceilings = adapter.ceilings().map_err(failed)?;
    let precisions = match wanted.precision {
        DevicePrecision::Auto => Precision::ALL.to_vec(),
        DevicePrecision::Double => vec![Precision::Double],
        DevicePrecision::Mixed => vec![Precision::Mixed],
    };
    let table = args.json.as_deref() != Some(Path::new("-"));
    if table {
        let doubles = match ceilings.doubles {
            Some(rate) => format!("{} GFLOP/s in double", significant(2e-9 * rate, 3)),
            None => "no double".into(),
        };
        console::print(format_args!(
            "{}: {doubles} and {} GFLOP/s in single precision, copies of {} GB/s\n{:<12} {:<8} {:>12} {:>15} {:>12} {:>12}",
            adapter.name,
            significant(2e-9 * ceilings.floats, 3),
            significant(1e-9 * ceilings.copied, 3),
            "case",
            "numbers",
            "points",
            "million bonds/s",
            "ns per bond",
            "of arithmetic"
        ))?;
    }
    let mut cases = Vec::new();
    for edge in edges {
        for &precision in &precisions {
            let ceiling = match precision {
                Precision::Double => ceilings.doubles,
                Precision::Mixed => Some(ceilings.floats),
            };
            let Some(ceiling) = ceiling else { continue };
            let gpu = Gpu::open(&adapter, Some(precision)).map_err(failed)?;
            let speed = gpu.speed(edge).map_err(failed)?;
            let rate = speed.bonds_per_second();
            let fraction = rate * PRODUCTS / ceiling;
            if table {
                console::print(format_args!(
                    "{:<12} {:<8} {:>12} {:>15} {:>12} {:>10} %",
                    format!("block-{edge}"),
                    precision.name(),
                    count(speed.points as u64),
                    significant(1e-6 * rate, 3),
                    significant(1e9 / rate, 3),
                    significant(100.0 * fraction, 3)
                ))?;
            }
            cases.push(json!({
                "case": format!("block-{edge}"),
                "precision": precision.name(),
                "points": speed.points,
                "directed_bonds": speed.bonds,
                "step_seconds": speed.step,
                "ns_per_bond": 1e9 / rate,
                "fraction_of_arithmetic": fraction,
            }));
        }
    }
    if let Some(path) = &args.json {
        let results = json!({
            "device": adapter.name,
            "double_flops": ceilings.doubles.map(|rate| 2.0 * rate),
            "single_flops": 2.0 * ceilings.floats,
            "copied_bytes_per_second": ceilings.copied,
            "cases": cases,
        });
        console::write_json(path, &results)?;
    }
    Ok(Exit::Done)
}

/// Returns the edge of the block of a case.
fn edge(case: &str) -> Result<usize, CliError> {
    let edge = case
        .strip_prefix("block-")
        .and_then(|edge| edge.parse().ok());
    edge.filter(|edge| (8..=2000).contains(edge))
        .ok_or_else(|| {
            let unknown = RunError::Unknown {
                kind: "bench case of a graphics processor",
                name: case.to_owned(),
                hint: "allowed: block-N with N³ points, N from 8 to 2000".into(),
            };
            unknown.into()
        })
}
