//! `dispersion`: analyse numerical dispersion and stability of the grid and kernel of a deck; with `--measure` also
//! in a time-domain run.

mod wavevectors;

use pericles::material::BondMaterial;
use pericles_deck::{Model, Solid};
use pericles_dispersion::spectrum::{SpectrumRun, measure};
use pericles_dispersion::tuning::{TunedTable, bond_classes, continuum_speeds};
use pericles_dispersion::{BondLattice, Contour, Stability, polar_speeds, stability, trace};
use pericles_io::{IoError, OutputFolder, write_atomically};
use pericles_run::dispersion::{
    Curves, STEPS, write_bonds, write_classes, write_polar, write_spectrum,
};
use pericles_run::units::{frequency, percent, quantity, significant};
use pericles_run::{Interior, KernelQuality, PlaneWaves, RunError, build, readers};
use serde_json::{Value as Json, json};

use crate::args::DispersionArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use wavevectors::AtWaveVector;

/// Analyses the lattice of a deck and writes curves, polar plot, bond classes and a summary.
///
/// # Errors
/// The deck is invalid, a vector has more components than the body has dimensions, output cannot be written, or the
/// spectrum of an unstable lattice is to be measured.
pub(crate) fn dispersion(args: &DispersionArgs) -> Result<Exit, CliError> {
    args.execution.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let assembly = build(&deck, &readers())?;
    let model = &deck.model;
    let interior = assembly.interior(model);
    let interior = interior.map_err(|error| deck.rejection(error))?;
    let (solid, title) = (interior.solid, model.title.as_deref());
    let material = interior.material;
    let study = Analysis::of(interior, assembly.dt, args)?;
    if args.measure && !study.stability.is_stable() {
        return Err(CliError::UnstableSpectrum);
    }
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-dispersion")?;
    let left_out = left_out(model, solid);
    for part in &left_out {
        console::note(format_args!(
            "warning: the analysis uses [material] in the interior of the body: {part}"
        ));
    }
    let curves = study.curves();
    curves.write(&folder.file("curves.csv"))?;
    curves.draw(&folder.file("curves.png"), title.unwrap_or_default())?;
    if study.lattice.dimension() > 1 {
        let polar = polar_speeds(&study.lattice, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 360);
        write_polar(
            &folder.file("polar.csv"),
            &folder.file("polar.png"),
            &polar,
            &["p", "s1", "s2"][..study.lattice.dimension()],
        )?;
    }
    study.write_classes(material, &folder)?;
    if !study.wavevectors.is_empty() {
        wavevectors::write(&folder.file("wavevectors.csv"), &study.wavevectors)?;
    }
    let measured = match args.measure {
        false => Json::Null,
        true => study.measure(&folder, title.unwrap_or_default())?,
    };
    let mut summary = study.summary(title, solid, &measured);
    summary["left_out"] = json!(left_out);
    summary["tuning"] = solid.material.tuned.as_ref().map_or(Json::Null, tuning);
    summary["plane_waves"] = assembly.plane_waves(model).map_or(Json::Null, plane_waves);
    let text = serde_json::to_string_pretty(&summary)?;
    write_atomically(&folder.file("dispersion.json"), |file| {
        use std::io::Write;
        writeln!(file, "{text}")
    })?;
    if !args.execution.quiet {
        study.print(&measured)?;
        solid.material.tuned.as_ref().map_or(Ok(()), print_tuning)?;
        console::print(format_args!("Results in {}", folder.path().display()))?;
    }
    Ok(Exit::Done)
}

/// The analysis of a lattice.
struct Analysis {
    lattice: BondLattice,
    contour: Contour,
    points: Vec<pericles_dispersion::ContourPoint>,
    stability: Stability,
    /// Long-wave speeds of the branches, m/s; `None` if the branches cannot be followed from segment to segment.
    targets: Vec<Option<f64>>,
    /// Speeds of pressure and shear waves in the continuum, m/s.
    speeds: Vec<f64>,
    /// Speed of the bar wave √(E/ρ), m/s.
    bar: f64,
    dt: f64,
    wavevectors: Vec<AtWaveVector>,
}

impl Analysis {
    fn of(interior: Interior<'_>, dt: f64, args: &DispersionArgs) -> Result<Self, CliError> {
        let Interior {
            lattice,
            solid,
            material,
            constants,
        } = interior;
        let dimension = lattice.dimension();
        let contour = match args.direction {
            Some(direction) => Contour::ray(&lattice, direction.of(dimension, "--direction")?),
            None => Contour::irreducible(&lattice),
        };
        let wavevectors = args.wavevector.iter().map(|k| {
            let k = k.of(dimension, "--wavevector")?;
            Ok(AtWaveVector::of(&lattice, k, dt))
        });
        let wavevectors = wavevectors.collect::<Result<_, CliError>>()?;
        let bar = (constants.young / material.density).sqrt();
        let speeds = continuum_speeds(solid.state);
        let speeds: Vec<f64> = (0..lattice.dimension())
            .map(|branch| {
                let speed = if branch == 0 {
                    speeds.pressure
                } else {
                    speeds.shear
                };
                speed * bar
            })
            .collect();
        let followed = lattice.is_cubic() || args.direction.is_some();
        let targets = speeds.iter().map(|speed| followed.then_some(*speed));
        Ok(Self {
            points: trace(&lattice, &contour, STEPS),
            stability: stability(&lattice),
            contour,
            targets: targets.collect(),
            speeds,
            bar,
            dt,
            wavevectors,
            lattice,
        })
    }

    fn curves(&self) -> Curves<'_> {
        Curves {
            contour: &self.contour,
            points: &self.points,
            dt: Some(self.dt),
            targets: &self.targets,
        }
    }

    /// Writes α of each class of bonds and the volume factor κ of its bonds.
    fn write_classes(&self, material: &BondMaterial, folder: &OutputFolder) -> Result<(), IoError> {
        if !self.lattice.is_cubic() {
            return write_bonds(&folder.file("classes.csv"), &self.lattice);
        }
        let classes = bond_classes(&self.lattice);
        let spacing = self.lattice.spacing()[0];
        let alpha = classes
            .iter()
            .map(|class| {
                let xi = class.offset.map(|c| f64::from(c) * spacing);
                material.influence.alpha_of(xi, material.horizon)
            })
            .collect();
        let kappa = classes
            .iter()
            .map(|class| {
                let length = class.length * spacing;
                let correction = material.volume_correction;
                correction.factor(length, material.horizon, spacing)
            })
            .collect();
        let tables = [
            ("alpha".to_owned(), alpha),
            ("volume_factor".to_owned(), kappa),
        ];
        write_classes(&folder.file("classes.csv"), &classes, &tables)
    }

    fn measure(&self, folder: &OutputFolder, title: &str) -> Result<Json, CliError> {
        let (nodes, steps) = [(512, 8192), (48, 4096), (16, 1024)][self.lattice.dimension() - 1];
        let run = SpectrumRun {
            nodes,
            steps,
            dt: self.dt,
            seed: 1,
        };
        let spectrum = measure(&self.lattice, &self.contour, run)
            .map_err(|error| RunError::of_run(error, String::new))?;
        write_spectrum(&|name| folder.file(name), &spectrum, &self.curves(), title)?;
        let (worst, peaks) = spectrum.worst_deviation();
        Ok(json!({
            "nodes_per_axis": nodes, "steps": steps, "dt": self.dt, "line": spectrum.line,
            "worst_deviation_in_lines": worst, "peaks": peaks,
        }))
    }

    /// Returns the smallest and largest ratio over all directions of the long-wave speed to that of the continuum, for
    /// pressure and shear waves.
    fn anisotropy(&self) -> Vec<[f64; 2]> {
        let planes = match self.lattice.dimension() {
            1 => vec![[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]],
            2 => vec![[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]],
            _ => vec![
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                [[1.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            ],
        };
        let count = if self.lattice.dimension() == 1 {
            1
        } else {
            360
        };
        let all: Vec<_> = planes
            .into_iter()
            .flat_map(|plane| polar_speeds(&self.lattice, plane, count))
            .collect();
        (0..self.lattice.dimension())
            .map(|branch| {
                let ratios = all
                    .iter()
                    .map(|row| row.speeds[branch] / self.speeds[branch]);
                ratios.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                    [low.min(x), high.max(x)]
                })
            })
            .collect()
    }

    fn summary(&self, title: Option<&str>, solid: &Solid, measured: &Json) -> Json {
        let found = &self.stability;
        let state = solid.state;
        json!({
            "title": title,
            "state": state.name(),
            "poisson_ratio": state.poisson_ratio(),
            "spacing": self.lattice.spacing(),
            "horizon": solid.material.horizon(),
            "bar_wave_speed": self.bar,
            "continuum_speeds": self.speeds,
            "long_wave_speed_ratios": self.anisotropy(),
            "stable": found.is_stable(),
            "smallest_omega_squared_over_k_squared": found.smallest,
            "smallest_at": found.smallest_at,
            "omega_max": found.omega_max,
            "omega_max_at": found.omega_max_at,
            "dt_max": found.is_stable().then(|| found.dt_max()),
            "dt": self.dt,
            "shortest_wavelength_in_spacings": self.resolved(0.01),
            "measured_spectrum": measured,
            "wavevectors": wavevectors::summary(&self.wavevectors),
            "conventions": {
                "contour": "boundary of the irreducible Brillouin zone, or a ray, by arc length; segments share their corners",
                "branches": "followed by the polarisation that symmetry determines; otherwise by similarity of polarisations",
                "omega_verlet": "(2/dt) asin(omega dt/2)",
                "long_wave_speed_ratios": "[smallest, largest] over directions, relative to the continuum; pressure, then shear",
                "body": "the interior of the body; points near its surface have fewer bonds",
                "units": "SI",
            },
        })
    }

    /// Returns the shortest wavelength, in spacings, above which the phase velocities of all branches are within
    /// `share` of the long-wave limit, sampled at the points of the first segment; `None` if the first point exceeds
    /// it.
    fn resolved(&self, share: f64) -> Option<f64> {
        let first = self.points.iter().take_while(|point| point.segment == 0);
        let limits: Vec<f64> = self.points[0]
            .branches
            .iter()
            .map(|b| b.phase_velocity)
            .collect();
        let good = first.skip(1).take_while(|point| {
            let branches = point.branches.iter().zip(&limits);
            branches
                .clone()
                .all(|(b, limit)| (b.phase_velocity / limit - 1.0).abs() <= share)
        });
        let last = good.last()?;
        let k = last.k.iter().map(|k| k * k).sum::<f64>().sqrt();
        Some(std::f64::consts::TAU / k / self.lattice.spacing()[0])
    }

    fn print(&self, measured: &Json) -> Result<(), IoError> {
        let found = &self.stability;
        let names = ["pressure", "shear", "second shear"];
        for (branch, [low, high]) in self.anisotropy().into_iter().enumerate() {
            console::print(format_args!(
                "long {} waves      speed {} to {} times {:.0} m/s (continuum)",
                names[branch],
                significant(low, 5),
                significant(high, 5),
                self.speeds[branch]
            ))?;
        }
        if let Some(wavelength) = self.resolved(0.01) {
            console::print(format_args!(
                "phase velocity      within {} of the long-wave limit for wavelengths above {} spacings",
                percent(0.01),
                significant(wavelength, 3)
            ))?;
        }
        wavevectors::print(&self.wavevectors)?;
        if found.is_stable() {
            console::print(format_args!(
                "highest frequency   {} 1/s; critical time step {}, time step of the deck {}",
                frequency(found.omega_max),
                quantity(found.dt_max(), "s"),
                quantity(self.dt, "s")
            ))?;
        } else {
            console::print(format_args!(
                "UNSTABLE: some waves grow exponentially, smallest ω²/k² = {} m²/s²",
                significant(found.smallest, 5)
            ))?;
        }
        match measured["worst_deviation_in_lines"].as_f64() {
            Some(worst) => console::print(format_args!(
                "measured spectrum   largest deviation of a peak from the time-discrete curve: {} spectral lines",
                significant(worst, 2)
            )),
            None => Ok(()),
        }
    }
}

/// Returns the parts of a deck that the plane-wave analysis of its first material does not include.
fn left_out(model: &Model, solid: &Solid) -> Vec<String> {
    let counted = |count: usize, what: [&str; 2]| match count {
        0 => None,
        1 => Some(format!("1 {} is not included", what[0])),
        _ => Some(format!("{count} {} are not included", what[1])),
    };
    let stiffnesses = model.assignments.iter().filter_map(|one| one.stiffness);
    let refined = solid.shape.finer().len();
    let correction = solid.material.surface_correction != Default::default();
    [
        counted(model.materials.len(), ["other material", "other materials"]),
        counted(
            stiffnesses.count(),
            ["assigned stiffness", "assigned stiffnesses"],
        ),
        counted(
            refined,
            ["region with a finer grid", "regions with a finer grid"],
        ),
        correction.then(|| "the surface correction is not included".to_owned()),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Returns the method and residual functionals of tuned coefficients; lengths in spacings, speeds relative to √(E/ρ).
fn tuning(table: &TunedTable) -> Json {
    let (tuning, error) = (&table.tuning, &table.assessment.error);
    json!({
        "method": tuning.method.name(),
        "combination": tuning.combination.name(),
        "pressure_weight": tuning.weights.pressure,
        "shear_weight": tuning.weights.shear,
        "decay": tuning.weights.decay,
        "lower_bound": tuning.lower_bound,
        "coefficients_at_the_bound": table.active.len(),
        "condition": table.condition,
        "optimality": table.kkt,
        "functionals": table.functionals,
        "constraints": table.assessment.constraints,
        "error_absolute": error.absolute,
        "error_ratio": error.ratio,
        "error_square": error.square,
    })
}

fn print_tuning(table: &TunedTable) -> Result<(), IoError> {
    let error = &table.assessment.error;
    let functionals = table.functionals.iter().map(|branches| {
        let values = branches.iter().map(|value| significant(*value, 3));
        values.collect::<Vec<_>>().join(", ")
    });
    console::print(format_args!(
        "tuned coefficients  ∮|R| {} ({} of the constant kernel's), residual functionals {}",
        significant(error.absolute, 4),
        significant(error.ratio, 3),
        functionals.collect::<Vec<_>>().join("; ")
    ))
}

/// Returns the dispersion errors of kernel and grid over all directions, in SI units.
fn plane_waves(waves: PlaneWaves) -> Json {
    let quality = |kernel: KernelQuality| {
        json!({
            "spacings_per_wavelength": kernel.spacings,
            "largest_error": kernel.worst,
        })
    };
    json!({
        "tolerance": waves.grid.tolerance,
        "kernel_shortest_wavelength": waves.model,
        "grid_shortest_wavelength": std::f64::consts::TAU / waves.grid.wavenumber,
        "grid_shortest_period": std::f64::consts::TAU / waves.grid.frequency,
        "tuned": waves.tuning.map(|[tuned, _]| quality(tuned)),
        "constant": waves.tuning.map(|[_, constant]| quality(constant)),
    })
}
