//! Charts of a parameter sweep.

use pericles_io::read_csv;
use pericles_run::sweep::SweepResults;

use crate::args::PlotArgs;
use crate::error::CliError;
use crate::exit::Exit;

/// Draws the scalars `--y` of the runs over the key `--x`; without `--y` the final values of the probes, or the energies of a sweep
/// without probes.
///
/// # Errors
/// The sweep does not have the key or the scalar, or a chart cannot be written.
pub(super) fn plot(args: &PlotArgs) -> Result<Exit, CliError> {
    let sweep = SweepResults::open(&args.dir)?;
    let place = super::place(args)?;
    let scalars = match args.y.is_empty() {
        true => usual(&sweep),
        false => args.y.clone(),
    };
    for scalar in &scalars {
        let chart = sweep.chart(args.x.as_deref(), scalar)?;
        super::write(chart, scalar, &place, args)?;
    }
    Ok(Exit::Done)
}

/// Returns the scalars of a sweep that are shown by default.
pub(crate) fn usual(sweep: &SweepResults) -> Vec<String> {
    let probes = sweep.runs().find_map(|(_, results)| {
        let table = read_csv(results?.folder().join("probes.csv")).ok()?;
        let columns = table.columns.iter().skip(2);
        Some(columns.map(|column| column.name().to_owned()).collect())
    });
    probes.unwrap_or_else(|| {
        ["kinetic_energy", "elastic_energy", "dissipated_energy"]
            .map(|name| format!("audit.{name}"))
            .into()
    })
}
