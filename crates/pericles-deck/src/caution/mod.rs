//! Warnings about decks that are valid but may not do what the user means.

mod advice;
mod area;
mod contact;

use pericles::units::{BodyUnits, precise, quantity, significant};
use pericles_manifold::surface::SurfaceCaution;

pub use area::AreaCaution;
pub use contact::ContactCaution;

use area::area_caution;

use crate::wording::{further, percent, prefixed, reach, short, shortened, spot};

/// Kinds of warnings.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Caution {
    /// A material without points.
    #[error("the material `{material}` is not assigned to any set")]
    UnusedMaterial {
        /// Its name.
        material: String,
    },
    /// A pre-crack that cuts no bond.
    #[error("this crack cuts no bond")]
    CrackCutsNothing,
    /// A pre-crack outside the body.
    #[error("this crack lies outside the body, which extends {}", reach(low, high))]
    CrackOutside {
        /// Lowest coordinates of the body along each of its axes, m.
        low: Vec<f64>,
        /// Highest, m.
        high: Vec<f64>,
    },
    /// A horizon that does not suit the mesh of a 2-manifold.
    #[error("{0}")]
    Surface(SurfaceCaution),
    /// An implausibly large critical stretch.
    #[error("the critical stretch is {:.0} %: implausibly large for a brittle material", 100.0 * stretch)]
    LargeStretch {
        /// The critical stretch.
        stretch: f64,
    },
    /// A body whose bulk stiffness differs from the given modulus.
    #[error(
        "the bulk stiffness of the discretised body is {} of the given one",
        percent(1.0 + error)
    )]
    StiffnessError {
        /// Relative error of the bulk stiffness.
        error: f64,
    },
    /// A body whose shear stiffness along the grid axes is far below the material's.
    #[error(
        "the shear stiffness of the discretised body along the grid axes is {} of the material's",
        percent(1.0 + error)
    )]
    ShearStiffness {
        /// Relative error of the shear stiffness.
        error: f64,
    },
    /// A lattice on which the shear modulus of a state-based material is anisotropic.
    #[error(
        "the shear modulus of the discretised body is {} of the material's along the grid axes and {} along the diagonals",
        percent(*axes),
        percent(*diagonals)
    )]
    ShearAnisotropy {
        /// Ratio of the shear modulus along the axes to the material's.
        axes: f64,
        /// The same ratio along the diagonals.
        diagonals: f64,
    },
    /// A thin body whose stiffness differs from the material's.
    #[error(
        "the smallest side has {} horizons: in tension along its longest side the body is about {} too {} (surface effect)",
        significant(*sides, 2), percent(error.abs()), if *error > 0.0 { "stiff" } else { "compliant" }
    )]
    ThinBody {
        /// Smallest side in horizons.
        sides: f64,
        /// Relative error of the stiffness.
        error: f64,
    },
    /// A layer of a material that bonds bridge.
    #[error(
        "most points of the material {material:?} lie between points of other materials that are within a horizon of {} of each other: bonds bridge this layer, so that it hardly deforms",
        quantity(*horizon, "m")
    )]
    BridgedLayer {
        /// The material.
        material: String,
        /// Largest horizon, m.
        horizon: f64,
    },
    /// A force on a surface that depends on the mesh.
    #[error(
        "the interaction of a vertex with its own area, which the sum over bonds omits, is {} of the force, so that results depend on the mesh",
        percent(*share)
    )]
    MeshDependence {
        /// Omitted share of the force.
        share: f64,
    },
    /// An implausibly large wave speed.
    #[error("the speed of pressure waves is {} m/s, larger than in any solid", significant(*speed, 4))]
    FastWaves {
        /// Speed of the pressure wave, m/s.
        speed: f64,
    },
    /// An implausibly small Young's modulus.
    #[error(
        "Young's modulus is {} at a density of {}: lower than for any solid of this density",
        quantity(*modulus, "Pa"), quantity(*density, "kg/m³")
    )]
    SoftSolid {
        /// Young's modulus, Pa.
        modulus: f64,
        /// Density, kg/m³.
        density: f64,
    },
    /// An implausibly large density.
    #[error("the density is {} kg/m³, larger than for any solid", significant(*density, 4))]
    HeavySolid {
        /// Density, kg/m³.
        density: f64,
    },
    /// A spacing below interatomic distances.
    #[error("the spacing is {}, below the distance between atoms", quantity(*spacing, "m"))]
    TinySpacing {
        /// Spacing, m.
        spacing: f64,
    },
    /// Two listed points much closer to each other than the others.
    #[error(
        "points {} and {} of the list (counted from 1) are {} apart, the mean spacing is {}",
        points[0], points[1], quantity(*distance, "m"), quantity(*spacing, "m")
    )]
    ClosePoints {
        /// Their numbers in the list, from 1.
        points: [usize; 2],
        /// Their distance, m.
        distance: f64,
        /// Mean spacing of the points, m.
        spacing: f64,
    },
    /// A coordinate of listed points that the dimension of the body does not use.
    #[error("the coordinate {axis} is not used: all points have {axis} = {}", quantity(*value, "m"))]
    UnusedCoordinate {
        /// The axis.
        axis: char,
        /// Its value, m.
        value: f64,
    },
    /// An unlikely temperature or coefficient of thermal expansion.
    #[error("{problem}")]
    ImplausibleHeat {
        /// Description, with advice.
        problem: String,
    },
    /// Names that are too long for Exodus files.
    #[error(
        "the name `{}` is shortened to `{}` in the Exodus file{}",
        shortened(name), shortened(stored), further(*more)
    )]
    LongExodusNames {
        /// The name.
        name: String,
        /// Its form in the file.
        stored: String,
        /// Number of further names.
        more: usize,
    },
    /// An unusual property of a mesh.
    #[error("{problem}")]
    Mesh {
        /// Description.
        problem: String,
    },
    /// Cells whose volume differs from that enclosed by the surface or outline.
    #[error(
        "the volume of the cells is {} of the volume that the boundary encloses ({} of {} m³)",
        percent(volume / enclosed), significant(*volume, 4), significant(*enclosed, 4)
    )]
    FilledVolume {
        /// The volume of the cells, m³.
        volume: f64,
        /// The volume that the boundary encloses, m³.
        enclosed: f64,
    },
    /// A hole without effect.
    #[error("this hole has no effect: it contains no cell centre of the body")]
    IdleHole,
    /// A key that has no effect without fracture.
    #[error("`{key}` has no effect: the bonds of this body never break")]
    NothingBreaks {
        /// The key.
        key: &'static str,
    },
    /// Heat from dissipated energy in a body that dissipates none.
    #[error("`dissipation` has no effect: {}", if *moves { "no material of this body breaks, yields or relaxes" } else { "the body does not move" })]
    NothingDissipates {
        /// Whether the body moves.
        moves: bool,
    },
    /// A run without loads, prescribed motion and initial fields.
    #[error("nothing acts on the body: no loads, no prescribed motion, and it starts at rest")]
    NothingActs,
    /// Bond classes without stiffness at an absorbing boundary.
    #[error(
        "bonds longer than {reach} of {given} spacings have no stiffness, in the body and in the exterior of the absorbing boundary"
    )]
    IdleClasses {
        /// Spacings within the horizon.
        given: usize,
        /// The longest bonds with a stiffness, in spacings.
        reach: usize,
    },
    /// A traction on a set that is not a single layer on one face.
    #[error("{}", area_caution(.0))]
    LoadedArea(AreaCaution),
    /// A load on constrained points.
    #[error("{} constrained along it: there the supports take the load", share(*held, *points))]
    LoadOnHeld {
        /// Constrained points of the load.
        held: usize,
        /// Points of the load.
        points: usize,
    },
    /// A disconnected body.
    #[error(
        "the body is disconnected: it consists of {pieces} parts without bonds between them; the smallest has {}, such as the one at {} m",
        if *points == 1 { "one point".to_owned() } else { format!("{points} points") },
        spot(place)
    )]
    Pieces {
        /// Number of parts.
        pieces: usize,
        /// Points of the smallest part.
        points: usize,
        /// One of them, m.
        place: Vec<f64>,
    },
    /// Several pieces without contact.
    #[error(
        "the {pieces} pieces of the body do not interact: bonds do not join them and the deck has no [contact]"
    )]
    NoContact {
        /// Their number.
        pieces: usize,
    },
    /// Contact of points or impactors.
    #[error(transparent)]
    Contact(ContactCaution),
    /// A static body with parts that are not connected to a support.
    #[error(
        "{points} of {of} points, such as the one at {} m, are not connected to a support by bonds",
        spot(place)
    )]
    NoSupport {
        /// Points without support.
        points: usize,
        /// All points.
        of: usize,
        /// One of them, m.
        place: Vec<f64>,
    },
    /// A static body with parts on which the loads are not in equilibrium.
    #[error(
        "the loads on {points} of {of} points, such as the one at {} m, have {} that no support takes",
        spot(place),
        net(*force, *moment, *units)
    )]
    Unbalanced {
        /// Points of the part.
        points: usize,
        /// All points.
        of: usize,
        /// One of them, m.
        place: Vec<f64>,
        /// The net force, N.
        force: Option<f64>,
        /// The net moment about the centre of the part, N m.
        moment: Option<f64>,
        /// Units of the body's forces.
        units: BodyUnits,
    },
    /// A probe outside the body.
    #[error("the probe `{name}` is {} away from the nearest point", quantity(*distance, "m"))]
    ProbeOutside {
        /// The probe.
        name: String,
        /// The distance, m.
        distance: f64,
    },
    /// A time step above the stable limit, accepted by `allow_unstable`.
    #[error("the time step of {} is unstable: the largest stable step is {}", precise(*dt, "s"), precise(*limit, "s"))]
    UnstableStep {
        /// The step, s.
        dt: f64,
        /// The limit, s.
        limit: f64,
    },
    /// A time step that does not divide the end time.
    #[error(
        "time.end is not a multiple of the time step {}: all steps are shortened to {}, so that {count} steps end exactly at time.end",
        precise(*given, "s"), precise(*used, "s")
    )]
    ShortenedStep {
        /// The given step, s.
        given: f64,
        /// The shortened step, s.
        used: f64,
        /// Number of steps.
        count: u64,
    },
    /// A time step above the limit up to which the scheme is proven to be stable.
    #[error(
        "the time step of {} may be unstable: stability is guaranteed up to {}",
        precise(*dt, "s"), precise(*limit, "s")
    )]
    UncertainStep {
        /// The step, s.
        dt: f64,
        /// The largest step with guaranteed stability, s.
        limit: f64,
    },
    /// A period that waves cross during the run.
    #[error(
        "the period of {} is short for this run: at its end, waves from the periodic images have an amplitude of about {estimate:.1e} times that of the pulse within {} of its centre",
        quantity(*period, "m"), quantity(*window, "m")
    )]
    ShortPeriod {
        /// The period, m.
        period: f64,
        /// Ratio of their amplitude to that of the pulse.
        estimate: f64,
        /// Half-width of the region of comparison, m.
        window: f64,
    },
    /// Waves too short for the grid.
    #[error(
        "{:.0} % of the energy of this {what} is in waves shorter than {} or with periods below {}: on this grid, their speed differs by more than {:.0} % from {}",
        100.0 * share, prefixed(*length, "m"), prefixed(*period, "s"), 100.0 * tolerance,
        if *nonlocal { "that in the nonlocal continuum" } else { "that of long waves" }
    )]
    ShortWaves {
        /// Their source.
        what: &'static str,
        /// Their share of the energy.
        share: f64,
        /// Relative deviation of their speed.
        tolerance: f64,
        /// Whether the reference is the speed in the nonlocal continuum; otherwise the speed of long waves.
        nonlocal: bool,
        /// The shortest period that the grid resolves, s.
        period: f64,
        /// The shortest wavelength that the grid resolves, m.
        length: f64,
    },
    /// Coefficients of both signs that make the lattice unstable.
    #[error(
        "the coefficients of this influence function make the lattice unstable: some waves grow (smallest ω²/k² = {smallest:.3e} m²/s²)"
    )]
    GrowingWaves {
        /// The smallest ω²/k², m²/s².
        smallest: f64,
    },
    /// Tuned coefficients with more dispersion than a constant influence function.
    #[error(
        "the tuned influence function has more numerical dispersion than a constant one: the phase speed error is below 1 % from {} spacings per wavelength (constant: {}) and at most {:.1} % from {shortest} spacings (constant: {:.1} %)",
        short(spacings[0]), short(spacings[1]), 100.0 * worst[0], 100.0 * worst[1]
    )]
    PoorTuning {
        /// Spacings per wavelength above which the phase speed error is below 1 %: tuned, constant.
        spacings: [f64; 2],
        /// The largest relative error down to `shortest`: tuned, constant.
        worst: [f64; 2],
        /// Spacings per wavelength.
        shortest: f64,
    },
    /// A speed above the limiting speed of cracks.
    #[error(

        "this {what} reaches {} m/s, above the {wave} of {} m/s: bonds break everywhere instead of along cracks",
        short(*speed), short(*limit)

    )]
    FastMotion {
        /// What moves.
        what: &'static str,
        /// Its largest speed, m/s.
        speed: f64,
        /// The speed that cracks do not exceed, m/s.
        limit: f64,
        /// The name of that speed.
        wave: &'static str,
    },
    /// Bonds that break in the first time step.
    #[error(
        "the first time step ({}) stretches bonds of {points} of {of} points beyond the critical stretch",
        prefixed(*dt, "s")
    )]
    TornAtOnce {
        /// Points with such bonds.
        points: usize,
        /// All points.
        of: usize,
        /// The step, s.
        dt: f64,
    },
    /// Initial displacements without the internal variables of the material.
    #[error(
        "the file contains no internal variables: the body starts without plastic or viscous strain and without softened bonds"
    )]
    NoHistory,
    /// Bonds that break but have no stiffness.
    #[error(
        "{empty} of {of} bond classes have the coefficient 0: these bonds carry no force, but they break and count as damage"
    )]
    EmptyClasses {
        /// Classes without stiffness.
        empty: usize,
        /// All classes.
        of: usize,
    },
    /// Absorbing-boundary kernels whose errors grow.
    #[error(
        "the historical kernels have a relative error of {growth:.1e} at the end of the run, which grows with time"
    )]
    HistoricalKernels {
        /// The error of the Green functions.
        growth: f64,
    },
    /// Exponentials that do not meet their tolerance.
    #[error(
        "no sum of exponentials meets the tolerance {tolerance:.0e} (smallest error: {residual:.1e}): the exact blocked history is used"
    )]
    ExactHistory {
        /// The requested tolerance.
        tolerance: f64,
        /// The error of the best fit.
        residual: f64,
    },
    /// An initial field that is not zero at an absorbing boundary.
    #[error(
        "the initial field at the absorbing boundary {side} is {share:.1e} of its maximum, but zero is assumed beyond it, which is an error of that size"
    )]
    FieldAtEnd {
        /// The side.
        side: &'static str,
        /// Ratio of the maximum in the outer layer to that in the body.
        share: f64,
    },
    /// A multirate scheme with equal time steps.
    #[error("both time steps are equal: ratio = 1")]
    EqualSteps,
    /// A predictor that is weakly unstable.
    #[error(
        "the backward-difference predictor is weakly unstable at this time step: ω dt = {omega_dt:.2}, recommended at most {quiet}"
    )]
    GrowingPredictor {
        /// Product of the highest frequency and the time step.
        omega_dt: f64,
        /// Value below which the growth is negligible.
        quiet: f64,
    },
}

/// `all 40 points of this load are`, `3 of the 40 points of this load are`
fn share(part: usize, whole: usize) -> String {
    if part == whole {
        format!("all {whole} points of this load are")
    } else {
        format!("{part} of the {whole} points of this load are")
    }
}

/// `a net force of 3.00 N and a net moment of 1.00 N m`
fn net(force: Option<f64>, moment: Option<f64>, units: BodyUnits) -> String {
    let force = force.map(|force| format!("a net force of {}", units.quantity(force, "N")));
    let moment = moment.map(|moment| format!("a net moment of {}", units.quantity(moment, "N m")));
    let both: Vec<String> = force.into_iter().chain(moment).collect();
    both.join(" and ")
}
