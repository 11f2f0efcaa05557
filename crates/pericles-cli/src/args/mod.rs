//! Command-line arguments.

mod converge;
mod fit;
mod geometry;
mod import;
mod modes;
mod plot;
mod shared;
mod values;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use pericles::operator::InstructionSet;
use pericles_manifold::geodesic::GeodesicMethod;
use pericles_run::sweep::Axis;

use crate::exit::Exit;

pub(crate) use converge::ConvergeArgs;
pub(crate) use fit::FitArgs;
pub(crate) use geometry::{ExportArgs, ExportFormat, MeshArgs, ViewArgs};
pub(crate) use import::ImportArgs;
pub(crate) use modes::ModesArgs;
pub(crate) use plot::{Format, PlotArgs};
pub(crate) use shared::{
    Caching, DeviceChoice, Execution, FromRun, Memory, Overrides, RunOptions, Threads,
};
pub(crate) use values::{Direction, Length, Pair};

use values::{direction, instruction_set, length, pair, tolerance};

const ABOUT: &str = "Peridynamics: elastic waves, cracks and nonlocal surfaces from a TOML deck";

const EXAMPLES: &str = "\
Examples:
  pericles new                                        list the example decks
  pericles import model.yaml                          input file of PeriLab or Peridigm as a deck
  pericles check examples/fracture/branching.toml     size, memory, time step and run time, without running
  pericles run examples/fracture/branching.toml       results in ./branching, then ./branching-2, ...
  pericles run deck.toml --out results --force        results in ./results, replacing earlier ones
  pericles run deck.toml --set time.end=20us --set material.fracture_energy=100
  pericles run deck.toml --sweep body.spacing=1e-3,2e-3     one run per value, summarised in a table
  pericles resume branching                           continue after Ctrl-C, with identical results
  pericles dispersion deck.toml --measure             dispersion curves, computed and measured
  pericles modes plate.toml --count 12                natural frequencies and mode shapes
  pericles geodesics 'icosphere(4)' --horizon 0.5     errors of geodesic distance methods
  pericles mesh bracket.msh --unit mm                 contents of a mesh: sets, volume, cell size
  pericles bench block-46 --threads 1                 performance of the force evaluation
  pericles reproduce --list                           list the studies of published results
  pericles reproduce fracture/branching";

/// The command line.
#[derive(Debug, Parser)]
#[command(
    name = "pericles",
    version = env!("PERICLES_VERSION"),
    about = ABOUT,
    after_help = EXAMPLES,
    after_long_help = format!("{EXAMPLES}\n\n{}", Exit::table()),
    subcommand_required = true,
    arg_required_else_help = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Limit vector instructions to a set, for tests and comparisons: baseline, avx2 or avx512 [default: the best of
    /// this machine]
    #[arg(long, value_name = "SET", global = true, hide_short_help = true, value_parser = instruction_set)]
    pub(crate) instruction_set: Option<InstructionSet>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List the example decks, or copy one to start from
    New(NewArgs),
    /// Import an input file of PeriLab (YAML) or Peridigm (text, YAML, XML) as a deck
    #[command(after_help = import::NOTES)]
    Import(ImportArgs),
    /// Run a deck
    #[command(after_help = "\
Results are written to ./<deck's name>, then ./<name>-2, -3, ..., or to the folder given by --out:
  run.json          the deck as read, balance of energy and momentum, performance, memory
  fields.pvd        time series for ParaView; its files are in fields/
  history.csv       energies, momentum, broken bonds; also reactions.csv, cracks.csv, probes.csv
  pictures/         pictures of the fields requested in [output]
  checkpoints/      the last two checkpoints, used by `pericles resume`")]
    Run(RunArgs),
    /// Check a deck and report size, memory, time step and estimated run time without running it
    Check(CheckArgs),
    /// Resume a stopped run
    #[command(after_help = "\
The run continues from its last checkpoint. The results are bitwise identical to those of an uninterrupted run, for
any number of threads. The deck is read from the checkpoint; the original file may have been changed or deleted.")]
    Resume(ResumeArgs),
    /// Show the contents of an output folder and the status of the run or the parameter sweep
    Info(InfoArgs),
    /// Write a report of a run or a parameter sweep as one HTML page
    #[command(after_help = "The page is self-contained: it needs no other files and no network.")]
    Report(ReportArgs),
    /// Render pictures and time histories of a run with other fields, ranges, views or times
    #[command(after_help = "\
Without --field and --history: the pictures of the deck (by default damage or displacement) at the last output time, and
charts of all tables.
  pericles plot branching --field Velocity_y --time '20 us,40 us' --range=-5:5
  pericles plot branching --field Damage --animation --width 800
  pericles plot branching --history kinetic_energy,elastic_energy --format svg
  pericles plot branching --terminal
  pericles plot bar --x top_displacement_y --y top_reaction_y
  pericles plot plate-sweep --y max:kinetic_energy     a scalar of each run over the first key of a sweep")]
    Plot(PlotArgs),
    /// Compare the results of two runs field by field
    #[command(after_help = "\
Fields are compared at each output time and tables column by column; differences are relative to the largest value of
the field or column. The exit status is 0 if nothing is missing and no difference exceeds the tolerance, otherwise 5.
With the default tolerance 0, all numbers must be identical.")]
    Diff(DiffArgs),
    /// Analyse numerical dispersion and stability of the grid and kernel of a deck
    #[command(after_help = "\
Results are written to ./<deck's name>-dispersion, then -2, -3, ..., or to the folder given by --out:
  dispersion.json   stability, highest frequency, critical time step, anisotropy, conventions
  curves.csv, .png  ω(k), phase and group velocity: semi-discrete, fully discrete, nonlocal continuum
  polar.csv, .png   wave speed in the long-wave limit by direction
  classes.csv       coefficient α of each class of bonds
  wavevectors.csv   frequencies at the wave vectors given by --wavevector
  spectrum_*, peaks spectra and peaks measured with --measure")]
    Dispersion(DispersionArgs),
    /// List the graphics processors with their precision and speed, for `--device` of `run`, `check` and `resume`
    #[command(after_help = "\
The speed is that of steps of a block of 64 000 points with bond-stretch bonds (horizon of three spacings), including the
state that the host reads. Needs a program with graphics processors:
  cargo build --release -p pericles-cli --features gpu")]
    Devices(DevicesArgs),
    /// Compute the lowest natural frequencies and mode shapes of a deck's body
    #[command(after_help = "\
The modes belong to the undeformed body with its constraints or, with --prestress, of the body under its static
loads. Results are written to ./<deck's name>-modes, then -2, -3, ..., or to the folder given by --out:
  modes.csv         frequency and residual of each mode
  modes.pvd         mode shapes for ParaView: the time value is the mode number
  modes/            the files of modes.pvd, and a picture of each mode
  pericles modes plate.toml --count 20
  pericles modes bar.toml --json - --quiet")]
    Modes(ModesArgs),
    /// Compare methods for geodesic distances on a surface
    #[command(after_help = "\
A surface is a file (.obj, .ply, .stl, .off, .msh, .vtu, .vtp) or a shape:
  icosphere(LEVEL)  icosphere(LEVEL,RADIUS)  uv-sphere(SEGMENTS,RINGS,RADIUS)  ellipsoid(LEVEL,A,B,C)
  torus(MAJOR,MINOR,MAJOR_SEGMENTS,MINOR_SEGMENTS)  capsule(RADIUS,LENGTH,SEGMENTS)
Errors are relative to exact distances on the triangulation, over all vertex pairs whose exact distance is within the
horizon; \"lost\" counts pairs that a method places beyond it. Times are wall-clock times.")]
    Geodesics(GeodesicsArgs),
    /// Report what a mesh or surface file contains: elements, volume, cell size, sets with areas, problems
    #[command(after_help = "\
  pericles mesh dogbone.msh --unit mm
  pericles mesh bracket.stl --unit mm --json -
Elements of the highest dimension become the points of a body (shape = \"mesh\"); a closed triangulated surface is
filled with a lattice (shape = \"solid\"). Set names can be used in a deck as printed.")]
    Mesh(MeshArgs),
    /// Convert the fields of a run to another format
    #[command(after_help = "\
  pericles export branching --to exodus
  pericles export branching --to npz --out branching.npz
  pericles export branching --to html --fields Damage,Velocity --every 2")]
    Export(ExportArgs),
    /// Show the fields of a run in the browser: time slider, fields, deformation, clipping, time histories
    #[command(after_help = "\
The page fields.html in the output folder is written and opened. It needs no other files and no network; values are rounded
to 16 bits, so that errors are at most 8e-6 of the range of a field at an output time.
  pericles view branching
  pericles view branching --fields Damage,Velocity --every 2 --out branching.html --no-open")]
    View(ViewArgs),
    /// Measure the performance of time steps on fixed bodies, relative to the limits of the machine
    #[command(after_help = "\
Times are wall-clock medians over several rounds; on a shared machine, compare ratios rather than seconds.
The roofline model counts 28 operations per eight bonds and pass at the measured multiply-add rate, idle SIMD lanes
included; on processors with separate add and multiply units the fraction can exceed one.")]
    Bench(BenchArgs),
    /// Run a convergence study: one deck on successively finer grids or with smaller time steps
    #[command(after_help = "\
The scalar of each run is the last value of a table column, its maximum or minimum (max:COLUMN, min:COLUMN), or a
number of run.json such as audit.elastic_energy.
  pericles converge bar.toml --m 3 --dx '20 mm,10 mm,5 mm' --scalar tip_u_x --reference 1e-3
  pericles converge bar.toml --m 2,3,4 --dx '20 mm,10 mm,5 mm' --scalar tip_u_x
  pericles converge bar.toml --m 2,4,8 --horizon '40 mm' --scalar tip_u_x
  pericles converge bar.toml --dt '1 us,0.5 us,0.25 us' --scalar tip_u_x
With --dx, the horizon is m times the spacing and both are refined (δ-convergence); with --horizon, the horizon is
fixed and the spacing is horizon/m (m-convergence); with --dt, the grid is given by the deck. The observed order follows from the errors against --reference or,
without it, from three successive results. Results are written to ./<deck's name>-converge, then -2, -3, ..., or to the
folder given by --out: convergence.csv and .png, and a folder per run. `pericles resume` continues the runs.")]
    Converge(ConvergeArgs),
    /// Fit keys of a deck to a measured curve
    #[command(after_help = "\
  pericles fit beam.toml measured.csv --x CMOD --y load --keys material.youngs_modulus,material.fracture_energy
  pericles fit beam.toml measured.csv --x CMOD --y load --keys 'material.tensile_strength=2 MPa:6 MPa'
Least squares within bounds: the curve of each run is compared at the measured x. Derivatives are differences of runs, which
are independent and use all cores. Results are written to ./<deck's name>-fit, then -2, -3, ..., or to the folder given by --out:
fit.csv (values, standard errors and 95 % confidence intervals), curve.csv, fit.png, and a folder per run. `pericles resume`
continues the fit. The exit status is 5 if the values still change after --runs runs.")]
    Fit(FitArgs),
    /// Reproduce published results and compare
    #[command(after_help = "\
The studies and their decks are built in. The exit status is 0 if every row with a tolerance passes, otherwise 5.")]
    Reproduce(ReproduceArgs),
    /// Print the JSON Schema of decks
    #[command(after_help = "\
Editors use it to complete and validate decks. Even Better TOML (VS Code) and Taplo read it from the first line of the
deck:
  pericles schema > pericles.schema.json
  #:schema ./pericles.schema.json")]
    Schema(SchemaArgs),
    /// Print the completion script for a shell
    #[command(after_help = "\
Save it where the shell looks for completions, for example:
  pericles completions bash > ~/.local/share/bash-completion/completions/pericles
  pericles completions zsh > \"${fpath[1]}/_pericles\"
  pericles completions fish > ~/.config/fish/completions/pericles.fish")]
    Completions(CompletionsArgs),
    /// Print the manual page; view it with: pericles man | man -l -
    #[command(after_help = "\
  pericles man | man -l -
  pericles man run | man -l -
  pericles man --out ~/.local/share/man/man1")]
    Man(ManArgs),
}

impl Command {
    /// Returns whether several processes can share the command.
    pub(crate) fn is_shared(&self) -> bool {
        matches!(self, Self::Run(_) | Self::Resume(_))
    }
}

#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The command whose page is printed; by default one page with all commands
    pub(crate) command: Option<String>,
    /// Write pericles.1 and one page per command, such as pericles-run.1, to a folder
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// The example, such as fracture/branching [default: list all]
    pub(crate) example: Option<String>,
    /// The file to write, which must not exist; `-` for standard output [default: the example's name]
    pub(crate) file: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// Print the reference of all keys as Markdown instead
    #[arg(long)]
    pub(crate) markdown: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Folder for the results, which must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Allow --out to replace the results of an earlier run. Only files written by that run are removed
    #[arg(long, requires = "out")]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) origin: FromRun,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Run a parameter sweep: one run per value of a key, given as a,b,c or start:stop:step; repeat the option for all
    /// combinations. Each run has its own folder in ./<deck's name>-sweep or --out, with a summary table; `resume`
    /// continues the sweep
    #[arg(long, value_name = "KEY=VALUES", conflicts_with = "force")]
    pub(crate) sweep: Vec<Axis>,
    /// Show terminal plots of the time histories when the run ends
    #[arg(long, conflicts_with_all = ["sweep", "quiet"])]
    pub(crate) chart: bool,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Write all numbers as JSON, in SI units, to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Draw the body at rest, coloured by its sets, with pre-cracks and interfaces, into a PNG or SVG file
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Predict runs on several processes (MPI ranks), such as 1,2,8,64: points, ghosts, messages, memory and time per step of
    /// each process, without MPI
    #[arg(long, value_name = "COUNTS", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) ranks: Vec<u32>,
    #[command(flatten)]
    pub(crate) origin: FromRun,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) caching: Caching,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) device: DeviceChoice,
}

#[derive(Debug, Args)]
pub(crate) struct DispersionArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Direction of the wave vectors, such as 2,1 or 1,1,0 [default: the boundary of the irreducible Brillouin zone]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction)]
    pub(crate) direction: Option<Direction>,
    /// Report the frequencies at this wave vector in rad/m, such as 1000,0; may be repeated
    #[arg(long, value_name = "KX,KY,KZ", value_parser = direction, allow_hyphen_values = true)]
    pub(crate) wavevector: Vec<Direction>,
    /// Also measure the spectrum in a time-domain run of a periodic box
    #[arg(long, conflicts_with = "direction")]
    pub(crate) measure: bool,
    /// Folder for the results, which must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) execution: Execution,
}

#[derive(Debug, Args)]
pub(crate) struct GeodesicsArgs {
    /// A surface file, or a shape such as icosphere(3)
    pub(crate) surface: String,
    /// The horizon, such as 0.5 (metres) or "300 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) horizon: Length,
    /// Comma-separated methods: edge, edge-diagonals, steiner(1) to steiner(32), exact
    #[arg(
        long,
        value_name = "METHODS",
        value_delimiter = ',',
        default_value = "exact,edge,edge-diagonals,steiner(2),steiner(3)"
    )]
    pub(crate) methods: Vec<GeodesicMethod>,
    /// Also report the distance between two vertices, such as 0,41, numbered from 0 as in the file; may be repeated
    #[arg(long, value_name = "I,J", value_parser = pair)]
    pub(crate) between: Vec<Pair>,
    /// Allow open surfaces: edges with a single triangle
    #[arg(long)]
    pub(crate) open: bool,
    /// Allow several disconnected components
    #[arg(long)]
    pub(crate) several: bool,
    /// Fix inconsistent triangle orientation
    #[arg(long)]
    pub(crate) flip: bool,
    /// Write the results as JSON to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct ResumeArgs {
    /// The output folder of the run
    pub(crate) dir: PathBuf,
    /// Give the run a later end, time.end=TIME, also after it has finished; the time step stays
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Show terminal plots of the time histories when the run ends
    #[arg(long, conflicts_with = "quiet")]
    pub(crate) chart: bool,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct DevicesArgs {
    /// Write the list as JSON to a file; - for standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The output folder of a run
    pub(crate) dir: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// The output folder of a run
    pub(crate) dir: PathBuf,
    /// The file to write [default: report.html in the output folder]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// The output folder of a run
    pub(crate) a: PathBuf,
    /// The output folder of another run
    pub(crate) b: PathBuf,
    /// Largest allowed difference, relative to the largest value of the field or column
    #[arg(long, value_name = "RATIO", default_value_t = 0.0, value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// Write the results as JSON to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// The case, such as block-46, or small-bodies: complete steps of small bodies on one and two threads [default: all cases]
    pub(crate) case: Option<String>,
    /// Write the results as JSON to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) device: DeviceChoice,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// The study, such as fracture/branching
    #[arg(required_unless_present = "list", conflicts_with = "list")]
    pub(crate) id: Option<String>,
    /// List the studies
    #[arg(long)]
    pub(crate) list: bool,
    /// Write the rows as JSON to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    pub(crate) json: Option<PathBuf>,
    /// Include the rows that take long to compute
    #[arg(long, conflicts_with = "list")]
    pub(crate) full: bool,
    /// Folder for the figures [default: ./reproduce-STUDY, then -2, -3, ...]
    #[arg(long, value_name = "DIR", conflicts_with = "list")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) execution: Execution,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn argument_definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn option_conflicts_and_value_ranges_are_checked() {
        let parse = |line: &str| Cli::try_parse_from(line.split(' '));
        assert!(parse("pericles run a.toml --force").is_err());
        assert!(parse("pericles run a.toml --force --out b").is_ok());
        assert!(parse("pericles reproduce").is_err());
        assert!(parse("pericles reproduce --list").is_ok());
        assert!(parse("pericles reproduce --list fracture/branching").is_err());
        assert!(parse("pericles run a.toml --threads 0").is_err());
        assert!(parse("pericles run a.toml --wall-time 2h").is_ok());
        for wrong in ["0", "2m", "-1s", "soon", "1e99h"] {
            assert!(
                parse(&format!("pericles resume a --wall-time={wrong}")).is_err(),
                "{wrong}"
            );
        }
        assert!(parse("pericles check a.toml --max-memory 8GB").is_ok());
        assert!(parse("pericles resume a --max-memory much").is_err());
        assert!(parse("pericles run a.toml --chart").is_ok());
        assert!(parse("pericles run a.toml --chart --quiet").is_err());
        assert!(parse("pericles dispersion a.toml --direction 2,1").is_ok());
        for wrong in ["0,0", "1,x", "1,2,3,4"] {
            assert!(parse(&format!("pericles dispersion a.toml --direction {wrong}")).is_err());
        }
        let run = parse("pericles run a.toml --set a=1 --set b=2 -q").unwrap();
        let Command::Run(run) = run.command else {
            panic!("not a run");
        };
        assert_eq!(run.overrides.set, ["a=1", "b=2"]);
        assert!(run.options.execution.quiet);
    }
}
