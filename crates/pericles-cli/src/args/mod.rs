//! The command line.

mod geometry;
mod modes;
mod shared;
mod values;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use pericles::operator::InstructionSet;
use pericles_manifold::geodesic::GeodesicMethod;
use pericles_run::sweep::Axis;

use crate::exit::Exit;
use crate::frames::Frames;

pub(crate) use geometry::{ExportArgs, ExportFormat, MeshArgs};
pub(crate) use modes::ModesArgs;
pub(crate) use shared::{Caching, Execution, Memory, Overrides, RunOptions, Threads};
pub(crate) use values::{Direction, Format, Length, Pair, Range};

use values::{direction, instruction_set, length, pair, range, ratio, tolerance};

const ABOUT: &str = "Peridynamics from a deck: bonds, waves, cracks";

const EXAMPLES: &str = "\
Examples:
  pericles new                                        example decks, one of which is near your own
  pericles check examples/fracture/branching.toml     what a run would need; runs nothing
  pericles run examples/fracture/branching.toml       results in ./branching, then ./branching-2 …
  pericles run deck.toml --out results --force        results in ./results, replacing earlier ones
  pericles run deck.toml --set time.end='\"20 us\"' --set material.Gc=100
  pericles run deck.toml --sweep body.spacing=1e-3,2e-3     one run per value, and a table of them
  pericles resume branching                           goes on after Ctrl-C, to the same bytes
  pericles dispersion deck.toml --measure             what the grid does to waves
  pericles modes plate.toml --count 12                natural frequencies and mode shapes
  pericles geodesics 'icosphere(4)' --horizon 0.5     how far distances along edges are off
  pericles mesh bracket.msh --unit mm                 what a mesh contains: sets, volume, cell size
  pericles bench block-46 --threads 1                 how fast the operators are here
  pericles reproduce --list                           studies of papers
  pericles reproduce fracture/branching";

/// The whole command line.
#[derive(Debug, Parser)]
#[command(
    name = "pericles",
    version,
    about = ABOUT,
    after_help = EXAMPLES,
    after_long_help = format!("{EXAMPLES}\n\n{}", Exit::table()),
    subcommand_required = true,
    arg_required_else_help = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Use no vector instructions beyond a set, for tests and comparisons: baseline, avx2 or avx512 [default: the best of this machine]
    #[arg(long, value_name = "SET", global = true, hide_short_help = true, value_parser = instruction_set)]
    pub(crate) instruction_set: Option<InstructionSet>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// List example decks, or write one as a start
    New(NewArgs),
    /// Run a deck
    #[command(after_help = "\
Results go to ./<deck's name>, then to ./<name>-2, -3 …, or to --out. In the folder:
  run.json          the deck as read, the audit of energy and momentum, speed, memory
  fields.pvd        open this one in ParaView; fields/ holds its files
  history.csv       energies, momentum, broken bonds; reactions.csv, cracks.csv, probes.csv
  pictures/         pictures of the fields the deck asks for
  checkpoints/      the last two states, from which `pericles resume` goes on")]
    Run(RunArgs),
    /// Tell what a run of a deck would need: points, bonds, memory, stable step, time; runs nothing
    Check(CheckArgs),
    /// Go on with a run that was stopped
    #[command(after_help = "\
The run goes on from its last checkpoint, bit for bit as if it had never stopped. The deck is the one the
checkpoint holds, so the file may have changed or gone. Another number of threads gives the same results.")]
    Resume(ResumeArgs),
    /// Tell what an output folder holds and how the run stands
    Info(InfoArgs),
    /// Put a run on one page of HTML: deck, pictures, histories, audit, warnings, machine
    #[command(
        after_help = "The page needs no other file and no network, so that it can be mailed."
    )]
    Report(ReportArgs),
    /// Draw pictures and histories of a run again: other fields, ranges, views, times
    #[command(after_help = "\
Without --field and --history the pictures of the last state and charts of all tables.
  pericles plot branching --field Velocity_y --time '20 us,40 us' --range=-5:5
  pericles plot branching --field Damage --animation --width 800
  pericles plot branching --history kinetic_energy,elastic_energy --format svg
  pericles plot branching --terminal")]
    Plot(PlotArgs),
    /// Compare two results field by field
    #[command(after_help = "\
Compares fields state by state and tables column by column, relative to the largest value of each. The exit status
is 0 if nothing is missing and nothing differs by more than the tolerance, else 5. With the tolerance 0, the
default, all numbers must be the same.")]
    Diff(DiffArgs),
    /// Analyse what the grid and the kernel of a deck do to waves
    #[command(after_help = "\
Results go to ./<deck's name>-dispersion, then -2, -3 …, or to --out. In the folder:
  dispersion.json   stability, highest frequency, largest step, anisotropy, conventions
  curves.csv, .png  ω(k) with phase and group velocity, the time-discrete curve, the continuum
  polar.csv, .png   speed of long waves by direction
  classes.csv       α of every class of bonds
  wavevectors.csv   frequencies at the wave vectors of --wavevector
  spectrum_*, peaks what --measure found")]
    Dispersion(DispersionArgs),
    /// Compute the lowest natural frequencies and mode shapes of a deck's body
    #[command(after_help = "\
The modes are those of the undeformed body with its supports, or with --prestress of the body under its static loads.
Results go to ./<deck's name>-modes, then -2, -3 …, or to --out. In the folder:
  modes.csv         frequency and residual of each mode
  modes.pvd         mode shapes for ParaView: the time is the number of the mode
  modes/            the files of modes.pvd, and a picture of each mode
  pericles modes plate.toml --count 20
  pericles modes bar.toml --json - --quiet")]
    Modes(ModesArgs),
    /// Compare ways to find distances along a surface
    #[command(after_help = "\
A surface is a file (.obj, .ply, .stl, .off, .msh, .vtu, .vtp) or a shape:
  icosphere(LEVEL)  icosphere(LEVEL,RADIUS)  uv-sphere(SEGMENTS,RINGS,RADIUS)  ellipsoid(LEVEL,A,B,C)
  torus(MAJOR,MINOR,AROUND,ACROSS)  capsule(RADIUS,LENGTH,SEGMENTS)
Errors are relative to exact distances on the triangles, over all pairs of vertices that are truly within the
horizon; \"lost\" are those that a method places beyond it. Times are on the wall clock.")]
    Geodesics(GeodesicsArgs),
    /// Report what a mesh or surface file contains: elements, volume, cell size, sets with areas, problems
    #[command(after_help = "\
  pericles mesh dogbone.msh --unit mm
  pericles mesh bracket.stl --unit mm --json -
Elements of the highest dimension are the points of a body (shape = \"mesh\"); a closed surface of triangles is filled
with a lattice (shape = \"solid\"). Names of sets can be used in a deck as they are printed.")]
    Mesh(MeshArgs),
    /// Convert the fields of a run to another format
    #[command(after_help = "\
  pericles export branching --to exodus
  pericles export branching --to npz --out branching.npz")]
    Export(ExportArgs),
    /// Time whole steps on fixed bodies and set them against what the machine can do
    #[command(after_help = "\
Times are medians over rounds, on the wall clock: quote ratios, not seconds, of a machine that others use too.
The roofline counts 28 operations per eight bonds and pass at the measured rate of multiply-adds, idle lanes included;
on processors that add and multiply in separate units the fraction can exceed one.")]
    Bench(BenchArgs),
    /// Run a deck on finer and finer grids, and see a number converge
    #[command(after_help = "\
Of each run one number counts: the last value of a column of its tables, or its greatest or least value (max:COLUMN,
min:COLUMN), or a number of run.json such as audit.elastic_energy.
  pericles converge bar.toml --m 3 --dx '20 mm,10 mm,5 mm' --scalar tip_u_x --reference 1e-3
  pericles converge bar.toml --m 2,3,4 --dx '20 mm,10 mm,5 mm' --scalar tip_u_x
  pericles converge bar.toml --m 2,4,8 --horizon '40 mm' --scalar tip_u_x
With --dx the horizon goes to zero with the spacing, at each m (δ-convergence); with --horizon the spacing is the
horizon over m (m-convergence). The observed order is that of the distance from the reference, or of three results
without one. Results go to ./<deck's name>-converge, then -2, -3 …, or to --out: convergence.csv and .png, and a
folder for each run; `pericles resume` goes on with the runs.")]
    Converge(ConvergeArgs),
    /// Compute published results again and compare
    #[command(after_help = "\
Studies and their decks are inside the program. The exit status is 0 only if every judged row holds, else 5.")]
    Reproduce(ReproduceArgs),
    /// Write what a deck may hold, as a JSON Schema
    #[command(after_help = "\
Editors complete and check decks by it. Even Better TOML (VS Code) and Taplo take it by a first line of the deck:
  pericles schema > pericles.schema.json
  #:schema ./pericles.schema.json")]
    Schema(SchemaArgs),
    /// Write what completes the command line for a shell
    #[command(after_help = "\
Put it where the shell looks, such as
  pericles completions bash > ~/.local/share/bash-completion/completions/pericles
  pericles completions zsh > \"${fpath[1]}/_pericles\"
  pericles completions fish > ~/.config/fish/completions/pericles.fish")]
    Completions(CompletionsArgs),
    /// Write the manual page; read it with: pericles man | man -l -
    Man,
}

#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// The example, such as fracture/branching; lists all without one
    pub(crate) example: Option<String>,
    /// The file to write; must not exist; `-` is the standard output [default: the example's name]
    pub(crate) file: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SchemaArgs {
    /// Write it for people instead, as Markdown
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
    /// Folder for the results; must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Let --out replace the results of an earlier run: the files that it put on record; other files in the folder stay
    #[arg(long, requires = "out")]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    /// Run the deck once per value of a key: a,b,c or start:stop:step; several times for all combinations.
    /// Results go to a folder each, with a table of them, in ./<deck's name>-sweep or --out; `resume` goes on
    #[arg(long, value_name = "KEY=VALUES", conflicts_with = "force")]
    pub(crate) sweep: Vec<Axis>,
    /// Draw the histories in letters once the run has ended
    #[arg(long, conflicts_with_all = ["sweep", "quiet"])]
    pub(crate) chart: bool,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Write all numbers as JSON, in SI units, to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) caching: Caching,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct DispersionArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Follow waves along this direction instead of the border of the irreducible zone, such as 2,1 or 1,1,0
    #[arg(long, value_name = "X,Y,Z", value_parser = direction)]
    pub(crate) direction: Option<Direction>,
    /// Report the frequencies at this wave vector, rad/m, such as 1000,0; may be given several times
    #[arg(long, value_name = "KX,KY,KZ", value_parser = direction, allow_hyphen_values = true)]
    pub(crate) wavevector: Vec<Direction>,
    /// Also measure the spectrum in a time-domain run of a periodic box
    #[arg(long, conflicts_with = "direction")]
    pub(crate) measure: bool,
    /// Folder for the results; must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) execution: Execution,
}

#[derive(Debug, Args)]
pub(crate) struct GeodesicsArgs {
    /// A file or a shape such as icosphere(3)
    pub(crate) surface: String,
    /// The horizon, m
    #[arg(long, value_name = "LENGTH")]
    pub(crate) horizon: f64,
    /// The methods, with commas between them: edge, edge-diagonals, steiner(1) to steiner(32), exact
    #[arg(
        long,
        value_name = "METHODS",
        value_delimiter = ',',
        default_value = "exact,edge,edge-diagonals,steiner(2),steiner(3)"
    )]
    pub(crate) methods: Vec<GeodesicMethod>,
    /// Also report the distance between two vertices, numbered from 0 as in the file, such as 0,41; may be given several times
    #[arg(long, value_name = "I,J", value_parser = pair)]
    pub(crate) between: Vec<Pair>,
    /// Allow edges with one triangle
    #[arg(long)]
    pub(crate) open: bool,
    /// Allow parts that do not hang together
    #[arg(long)]
    pub(crate) several: bool,
    /// Turn over triangles that run the wrong way
    #[arg(long)]
    pub(crate) flip: bool,
    /// Write the results as JSON to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct ResumeArgs {
    /// The folder of the run
    pub(crate) dir: PathBuf,
    /// Draw the histories in letters once the run has ended
    #[arg(long, conflicts_with = "quiet")]
    pub(crate) chart: bool,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The folder of a run
    pub(crate) dir: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// The folder of a run
    pub(crate) dir: PathBuf,
    /// The page [default: report.html in the folder]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// The folder of a run
    pub(crate) dir: PathBuf,
    /// Fields, such as Damage or Velocity_y, with commas between them
    #[arg(long = "field", value_name = "NAMES", value_delimiter = ',')]
    pub(crate) fields: Vec<String>,
    /// Columns of the tables, such as kinetic_energy, with commas between them
    #[arg(long = "history", value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) columns: Vec<String>,
    /// The states: all, first, last, or those nearest to times such as "20 us" or 1e-5,2e-5 [default: last; all of an animation]
    #[arg(long, value_name = "TIMES")]
    pub(crate) time: Option<Frames>,
    /// Values at the ends of the colour bar, SI units, such as 0:1 or --range=-2e-3:2e-3
    #[arg(long, value_name = "LOW:HIGH", value_parser = range)]
    pub(crate) range: Option<Range>,
    /// The direction from which a body in space is seen, such as 1,-2,1
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub(crate) view: Option<Direction>,
    /// Factor of the displacement of the points
    #[arg(long, value_name = "FACTOR", value_parser = tolerance)]
    pub(crate) scale: Option<f64>,
    /// Pixels across, from 200 to 16000
    #[arg(long, value_name = "PIXELS", default_value_t = 1200, value_parser = clap::value_parser!(u32).range(200..=16_000))]
    pub(crate) width: u32,
    /// The kind of files
    #[arg(long, value_enum, default_value_t = Format::Png)]
    pub(crate) format: Format,
    /// Put the pictures of each field into one animated PNG
    #[arg(long, conflicts_with = "terminal")]
    pub(crate) animation: bool,
    /// Draw the histories here, in letters, and write nothing
    #[arg(long, conflicts_with = "fields")]
    pub(crate) terminal: bool,
    /// Folder for the pictures; those of the same name are replaced [default: plots in the folder of the run]
    #[arg(long, value_name = "FOLDER")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// The folder of a run
    pub(crate) a: PathBuf,
    /// The folder of another
    pub(crate) b: PathBuf,
    /// Largest difference allowed, relative to the largest value of a field or column
    #[arg(long, value_name = "RATIO", default_value_t = 0.0, value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// Write the results as JSON to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// The case, such as block-46; all of them without one
    pub(crate) case: Option<String>,
    /// Write the results as JSON to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) threads: Threads,
}

#[derive(Debug, Args)]
pub(crate) struct ConvergeArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Ratios of horizon to spacing, with commas between them
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', required = true, value_parser = ratio)]
    pub(crate) m: Vec<f64>,
    /// Spacings, such as "2 mm,1 mm,0.5 mm"
    #[arg(long, value_name = "LENGTHS", value_delimiter = ',', required_unless_present = "horizon", conflicts_with = "horizon", value_parser = length)]
    pub(crate) dx: Vec<Length>,
    /// One horizon for all m
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub(crate) horizon: Option<Length>,
    /// The number that should converge
    #[arg(long, value_name = "NAME")]
    pub(crate) scalar: String,
    /// What it should converge to
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    pub(crate) reference: Option<f64>,
    /// Folder for the results; must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    /// The study, such as fracture/branching
    #[arg(required_unless_present = "list", conflicts_with = "list")]
    pub(crate) id: Option<String>,
    /// List the studies
    #[arg(long)]
    pub(crate) list: bool,
    /// Write the rows as JSON to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    pub(crate) json: Option<PathBuf>,
    /// Add the rows that take long
    #[arg(long, conflicts_with = "list")]
    pub(crate) full: bool,
    /// Folder for the figures [default: ./reproduce-STUDY, then -2, -3 …]
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
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn force_needs_out_and_list_stands_alone() {
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
