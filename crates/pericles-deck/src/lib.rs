//! Pericles decks: TOML in, a checked model out.
//!
//! A deck is one TOML file. [`Deck::read`] turns it into plain data in SI units, [`Deck::build`] turns that into points, bonds, an operator, loads and a
//! time step, and [`Model::simulation`] into a run. Reading is strict: unknown keys, wrong units, vectors of the wrong
//! length or names of sets that do not exist are errors which point at the file, line and column and say what is allowed; one reading finds all of
//! them. What the library refuses while the model is built points into the deck as well.
//!
//! ```
//! use pericles_deck::Deck;
//!
//! let text = r#"
//!     [body]
//!     shape = "bar"
//!     length = "1 m"
//!     spacing = "1 cm"
//!     area = "4 cm2"
//!     [material]
//!     density = "7850 kg/m3"
//!     youngs_modulus = "210 GPa"
//!     horizon_ratio = 3
//!     [time]
//!     end = "1 ms"
//! "#;
//! let deck = Deck::parse(text, "bar.toml", &[]).unwrap();
//! assert_eq!(deck.body.grid.section, 4e-4);
//! let model = deck.build().unwrap();
//! assert_eq!(model.cloud.len(), 100);
//!
//! // The same deck with another horizon and a slip of the pen.
//! let changes = ["material.m=4".to_owned(), "time.ende=1".to_owned()];
//! let error = Deck::parse(text, "bar.toml", &changes).unwrap_err();
//! let message = error.to_string();
//! assert!(message.starts_with("--set time.ende:1:6: unknown key `ende` in [time]; did you mean `end`?"));
//! ```
//!
//! # Format
//! Names in brackets are synonyms; values shown after `default` are taken if the key is left out.
//! ```toml
//! title = "Branching crack"              # for people; optional
//!
//! [body]
//! shape = "plate"                        # bar (1D) | plate, disc (2D) | block, cylinder, ball (3D) | points
//! size = ["100 mm", "40 mm"]             # bar (or length = "…"), plate, block; whole numbers of cells
//! origin = ["0 mm", "0 mm"]              # their lower corner; default 0
//! # disc, ball: centre [center], default 0; radius          disc: inner_radius, optional
//! # cylinder: base (centre of the lower base), default 0; axis, default "z"; radius; inner_radius, optional; height
//! spacing = "0.25 mm"                    # [dx] size of the cells; plates and blocks also ["0.25 mm", "0.2 mm"], one for each axis: bonds are then a list, modulus is the continuum's,
//!                                         # and horizon_ratio counts the largest
//! plane = "strain"                       # 2D only, and needed there: stress | strain
//! thickness = "1 mm"                     # 2D only; default 1 m
//! # area = "1 mm2"                       # 1D only; default 1 m²
//! # periodic = true                       # bar, plate, block without holes: opposite faces are one; default false
//! # quadrature = "midpoint"               # default; or gauss: a bar with two Gauss nodes in every cell of `spacing`
//! # points: those of file = "cloud.txt", beside the deck: text `x y z block volume` (m, m³), see below; dimension, default 3; spacing: about their distance
//! [[body.hole]]                          # a region without material; any number
//! ball = { centre = ["20 mm", "20 mm"], radius = "5 mm" }
//! # [[body.refine]]                      # a region with smaller cells and a smaller horizon; any number, later ones before earlier ones. Bonds are then
//! #                                        kept as a list, and what breaks needs a critical stretch instead of a fracture energy
//! # ball = { centre = ["50 mm", "20 mm"], radius = "8 mm" }
//! # ratio = 2                            # 2 … 16: cells whose centres lie in it are divided into so many along each axis; the horizon is as many of the
//! #                                        smaller spacings. A bond exists within the larger horizon of its ends; its force is the mean of both ends' laws
//!
//! [material]
//! name = "soda-lime glass"               # for people; optional
//! model = "bond-stretch"                 # default; or linear, green-strain (force by the Green strain of bonds), literal57 (bars: a softening law as printed by Coclite et al. 2020)
//! # treatment = "exact"                 # green-strain and literal57: default; on bars also taylor-1, taylor-2, taylor-3 (the polynomial of that order in the relative
//! #                                        displacement; three is exact) or trapezoidal (the mean of the tangents at rest and in place)
//! density = "2440 kg/m3"                 # [rho]
//! youngs_modulus = "72 GPa"              # [E], or bulk_modulus [K], or shear_modulus [G]: exactly one
//! poisson_ratio = 0.25                   # [nu] optional; checked against the only one that bonds can have
//! horizon = "0.75 mm"                    # or horizon_ratio [m] = 3, in spacings: exactly one; "infinite" for a Gaussian: seven of its lengths
//! volume_correction = "extended"         # default; or linear, none
//! modulus = "continuum"                  # default; or lattice: bond constant from the grid's own sums; or unmodified: that of the constant function
//! influence = { function = "constant", acts_on = "stretch" }   # the defaults; acts_on = stretch | displacement
//! # function = "constant" | "conical" | "inverse" | "power" (exponent) | "gaussian" (length; cutoff, default the horizon)
//! #   | "tabulated" (table = [[r, value], …]; r = "length" (default) | "spacing" | "horizon", the unit of the first column)
//! #   | "cosines" (coefficients = [a0, a1, …], wavenumber; r = "spacing" (default) | "horizon"): a0 + Σ a_j cos(j · wavenumber · r)
//! #   | "classes" (table = [[[1, 0], value], [[1, 1], value], …]): one value for every class of bonds of the grid
//! #   | "tuned": classes made against dispersion for this grid and horizon; all optional: method = "least-squares" (default) |
//! #     "point-collocation" | "subdomain-collocation" | "galerkin" | "galerkin-literal" (1D) | "absolute"; combination = "separated" (default) |
//! #     "absolute" | "signed-sum"; pressure_weight, shear_weight, default 1; decay (rad per spacing), default none; lower_bound, default none –
//! #     needed, and positive, where bonds can break. With classes and tuned the modulus is always that of the lattice
//! fracture_energy = "135 J/m2"           # [Gc, G0], or critical_stretch [s0]; neither: bonds never break
//! no_fail = ["top", "left"]              # sets whose bonds never break; default none
//! damage = { measure = "volume", count_precut = false }        # the defaults; measure = volume | count
//! bonds = "fastest"                      # default; or grid, list: how bonds are kept, a matter of speed only; linear unbreakable bodies also
//!                                         # convolution (grids of any shape and gauss bars; periodic ones, too) and spectral (periodic: the continuum's own forces)
//! surface_correction = "none"            # default; or volume, energy: bonds near surfaces are stiffened so that families lack nothing; kept as a list
//! [[material.inclusion]]                 # a part of other stiffness; any number, later ones before earlier ones
//! set = "left"
//! stiffness = 64                         # over the material's; a bond has the mean of its ends, density and critical stretch are the material's
//!
//! # [[material.part]]                    # another material; any number, later ones before earlier ones. Model, horizon and the like are those of [material]
//! # name = "aluminium"
//! # set = "left"                         # or block = 2, block = [2, 3]
//! # density = "2700 kg/m3"
//! # youngs_modulus = "70 GPa"            # and fracture_energy or critical_stretch, as above
//! # [material.interface]                 # bonds between two materials
//! # rule = "harmonic"                    # default: 2c₁c₂/(c₁+c₂); or arithmetic: (c₁+c₂)/2; or weaker: the smaller. Critical stretch: the smaller, unless
//! # pair = [{ between = ["soda-lime glass", "aluminium"], critical_stretch = 1e-3 }]
//!
//! [sets.top]                             # named sets of points: exactly one region each; "all" is always there
//! layer = { side = "+y", depth = "0.25 mm" }
//! [sets.left]
//! layer = { side = "-x", cells = 2 }
//!
//! [sets.grain]
//! where = "x > 0.01 && (x - 0.02)^2 + y^2 <= 1e-6 || block == 2"   # a condition on x, y, z (m) and block; or block = 2, block = [2, 3]
//!
//! [[crack]]                              # cuts bonds before the run
//! segment = [["0 mm", "20 mm"], ["50 mm", "20 mm"]]   # 2D
//! # 1D: section = "5 mm"    3D: polygon = [[x, y, z], …], or disc = { centre, normal, radius }
//! ends = "closed"                        # default; or open: bonds through the very border are kept
//!
//! [[initial]]                            # later entries replace earlier ones
//! set = "all"                            # default
//! velocity = ["0 m/s", { expression = "exp(-x^2)" }]   # displacement, velocity, or both
//!
//! [[prescribe]]
//! set = "left"
//! velocity = [0, "free"]                 # or displacement; "free" where nothing is prescribed
//! function = { kind = "constant" }       # default; or ramp (start, default 0; duration), pulse (the same),
//! #                                        table (rows = [["0 s", 0], ["1 us", 1], …]), expression (expression = "sin(2*pi*1e6*t)")
//! until = "10 us"                        # optional: the points are free from then on
//!
//! [[load]]
//! set = "top"
//! traction = [0, "12 MPa"]               # force per area, spread over the set's volume; or body_force, per volume
//! area = "100 mm2"                       # optional: else the set as seen along the normal of its layer, or along the load
//! function = { kind = "ramp", duration = "1 us" }
//! from = "0 s"                           # optional, as `until`: when the load acts
//!
//! [[boundary]]                           # a boundary with memory; 1D, scheme = "velocity-verlet", "implicit-midpoint" or "trapezoidal"
//! kind = "absorbing"                     # the bar goes on for ever beyond this end, as its outermost points are; exact
//! side = "-x"                            # or +x
//! history = "auto"                       # default: the cheaper of the exact forms direct and blocked, and of exponentials if a tolerance is given; or one of the three
//! # tolerance = 1e-9                     # allowed error of displacements beyond the end, relative to those before it: exponentials, in little memory
//! # verify = true                        # default false: compares the exponentials with the exact kernels; `check` and run.json say how far they are apart
//! # method = "discrete"                  # default: exact for the scheme; or semi-discrete (exact in continuous time, by the trapezoidal rule); or historical (the same from a
//! #                                        chain that is closed by an identity; errors grow)
//! # exterior_data = "40 mm"              # optional: the [[initial]] fields of set "all" go on that far beyond the end, and move there from the start
//!
//! [[boundary]]                           # a layer in which motion dies away; any body, scheme = "velocity-verlet"; reflects a little
//! kind = "damping-layer"
//! side = "+y"
//! thickness = "20 mm"                    # of the body's own material; a few wavelengths are best
//! reflection = 1e-3                      # default: share of the amplitude of a long wave, head on, that is to come back from the side
//! power = 2                              # default: the damping grows as this power of the depth
//!
//! [[probe]]                              # displacement and velocity in the history
//! name = "middle"
//! at = ["50 mm", "20 mm"]                # the nearest point; or set = "top", the mean over a set
//!
//! # [exact]                                # a bar whose solution is known: the history gets columns with the distance from it; optional
//! # solution = "nonlocal-pulse"            # u = amplitude exp(−((x − centre)/width)²) at rest, on the line with a Gaussian micromodulus; or
//! # width = "1 m"                          #   local-pulse (the same on the local string), stretched-bar (strain, length: held at 0, free at length),
//! # amplitude = "1 m"                      #   bar-mode (amplitude, length)
//! # centre = 0                             # default
//! # window = "3 m"                         # default all: only points so near to the centre count
//! # start = true                           # default false: the body starts as the solution, whatever [[initial]] says of the displacement
//!
//! [time]
//! end = "46 us"
//! dt = "auto"                            # default: the largest stable step times `safety`; or a time
//! safety = 0.95                          # default; only with "auto"
//! scheme = "velocity-verlet"             # default; or rk3, rk4, dormand-prince, rk3-mts, rk4-mts, respa, newmark, discrete-gradient, implicit-midpoint, trapezoidal, trigonometric, relaxation
//! # implicit-midpoint, trapezoidal, trigonometric: stable for any dt, which must be given
//! # implicit-midpoint, trapezoidal: linear_solver = "fastest" (default) | "direct" | "conjugate-gradients", of linear bodies
//! # trigonometric: functions = "fastest" (default) | "chebyshev" | "fourier" | "lanczos" | "eigenvectors"; loads = "gauss" (default, order 4) | "midpoint";
//! #   regularisation = 0 (default; 1/s², never needed)
//! # rk3, rk3-mts: alpha = 0.75
//! # dormand-prince: tolerance = 1e-6, of its own sub-steps within dt, which must be given
//! # newmark: beta = 0.25, gamma = 0.5; tolerance = 1e-7 (change of the velocity, m/s), norm = "l2" (default) | "area-weighted" | "max", iterations = 50;
//! #   solver = "fixed-point" (default: P-(EC)^k) | "anderson" (depth = 4) | "newton-krylov" (any step)
//! # discrete-gradient: conserves energy for any elastic forces and step; tolerance = 1e-10, of the energy; dt must be given
//! # rk3-mts, rk4-mts, respa: two time steps, `dt` and `dt`/`ratio`, the smaller one for
//! # ratio = 4
//! # fine = ["notch", "inclusion"]        # these sets, which may not overlap; or
//! # adaptive = { every = 4, threshold = 0.85, layers = 2, hold = 1 }   # the defaults: what is near to breaking, looked for every so many steps
//! # rk3-mts, rk4-mts: predictor = "structured" (default) | "backward-difference"; interpolant = "hermite" (default) | "stages"
//! # relaxation: static states. load_steps = 1 (default) of them up to `end` (default 1 s), dt is not given; tolerance = 1e-6, the forces out of balance over
//! #   those that act; iterations = 100000; damping = "adaptive" (default) or a number below 2, per iteration
//! allow_unstable = false                 # default; true: a step known to be unstable is only warned of
//!
//! [output]                               # schedules: interval = time | every = steps | count = number over the run
//! fields = { count = 20 }                # default; or "never". names = ["Displacement", …]: which fields, by default the first five below; Stress and Strain are
//! #                                        made of listed bonds, so that bonds = "fastest" becomes "list"
//! # energy_bound = "46 us"                # adds to the history what kinetic plus elastic energy cannot exceed under the loads, e(0) exp(t/τ) + τ/2 ∫ exp((t−s)/τ) ‖b‖² ds, for
//! #                                        this τ (best: the time that is looked at), and the margin to it; not with supports that move
//! history = { count = 200 }              # default; or "never". Reactions follow it too
//! cracks = { threshold = 0.35 }          # default threshold of damage; schedule by default that of the history; or "never"
//! # fragments = { count = 50, smallest = 1e-3 }   # default "never": fragments.csv, the pieces that bonds hold together; those below that share of the body's mass do not count
//! precision = "double"                   # default; or single: numbers in field files
//! [[output.picture]]                     # any number
//! field = "Damage"                       # Displacement, Velocity, Force_Density (magnitude, or _x, _y, _z), Damage, Strain_Energy_Density,
//! #                                        External_Force_Density, Reaction_Density (_x, …), Stress, Strain (Frobenius norm of the components kept, or _xx, _yy, _xy …)
//! scale = 1                              # default: factor of the displacement
//! range = [0, 1]                         # of the colour bar; default: that of the field
//! animation = false                      # default; true: at the end all of them in one animated PNG, ten a second; all then show the box of the body at rest and a
//!                                        #   tenth around it. Give it a `range` too, or the colours change their meaning from picture to picture
//! count = 4                              # default
//!
//! [checkpoint]
//! wall = "10 min"                        # default: time on the clock; or every = steps, or interval = simulated time
//! ```
//!
//! Regions, in sets and holes: `all = true`, `box = { min, max }` (either may be left out, entries may be `"open"`), `ball = { centre, radius }`,
//! `cylinder = { centre, axis, radius }` (3D), `half_space = { point, normal }` (the side the normal points away from),
//! `layer = { side, depth }` (side −x, +x, …, +z of the body's bounding box; `cells` counts spacings instead), `polygon = { corners = [[x, y], …] }`,
//! `union = [ … ]`, `intersection = [ … ]`, `complement = { … }`.
//!
//! # Surfaces
//! A body may be a closed surface of triangles. Its points are the vertices, with areas in place of volumes: densities are per area, forces are tractions.
//! ```toml
//! [body]
//! shape = "icosphere"                    # level, radius; or
//! # "uv-sphere" (segments, rings, radius) | "ellipsoid" (level, half_axes) | "torus" (major_radius, minor_radius, around, across) |
//! # "capsule" (radius, length, segments) | "surface" (file = "part.stl", beside the deck: OBJ, PLY, STL, OFF, Gmsh, VTU, VTP; open, several, flip = true allow
//! # borders and several parts, and turn over triangles that run the wrong way)
//! level = 4                              # halvings of the icosahedron's edges
//! radius = "1 m"
//! areas = "barycentric"                  # default; or mixed-voronoi, or one area for every vertex
//!
//! [geodesics]
//! method = "exact"                       # default; or edge, edge-diagonals, steiner(1) to steiner(32)
//! ball = "geodesic"                      # default: bonds within the horizon along the surface; or euclid: on the straight line, with distances along the surface
//!
//! [material]
//! model = "power"                        # default, the only one: κ |η|^(p−2) η / d^(2+αp)
//! density = "1 kg/m2"
//! alpha = 0.5                            # between 0 and 1
//! p = 3                                  # at least 2
//! kappa = 1                              # default; SI units, which depend on p and α
//! horizon = "0.5 m"                      # along the surface
//! bond = "displacement"                  # default; or chord: indifferent to rigid motions
//! self_cell = false                      # default; true, for p = 2: adds the integral over the point's own cell
//! # critical_stretch, no_fail, [[material.inclusion]] as for other bodies; a bond breaks beyond |η|/d
//!
//! [[initial]]                            # random_velocity is for all bodies
//! random_velocity = { radius = "0.1 m/s", seed = 1 }   # uniform in the ball, added to `velocity`; generator = "splitmix64" is the default
//!
//! [[load]]
//! set = "north"
//! traction = [0, 0, "1 mPa"]             # on the area of each vertex
//! ```
//! Cracks, body forces and sets in spacings belong to grids. `[[output.picture]]` takes `view = [x, y, z]`, the direction a body in space is seen from.
//!
#![doc = include_str!("language.md")]

mod body;
mod boundary;
mod build;
mod caution;
mod component;
mod conditions;
mod course;
mod crack;
mod deck;
mod document;
mod error;
mod exact;
mod expression;
mod fault;
mod finding;
mod influence;
mod material;
mod nearest;
mod newmark;
mod output;
mod overrides;
mod part;
mod points;
mod quantity;
mod reader;
mod region;
mod relaxation;
mod schema;
mod scheme;
mod set;
mod source;
mod surface;
mod time;
mod units;
mod vocabulary;

pub use body::{Body, Quadrature};
pub use boundary::BoundaryCondition;
pub use build::{ExactReference, Model, PointsReader, Resources, Sets, SurfaceReader};
pub use caution::Caution;
pub use component::{Component, VectorField};
pub use conditions::{Initial, Load, LoadAmplitude, Prescribe, Probe, ProbePlace, RandomVelocity};
pub use crack::PreCrack;
pub use deck::Deck;
pub use error::DeckError;
pub use exact::{Exact, KnownSolution, Pulse};
pub use expression::{Condition, Expression};
pub use fault::Fault;
pub use finding::{Finding, Problem, Subject, Warning};
pub use material::{Inclusion, Material};
pub use output::{Checkpoint, CrackOutput, FragmentOutput, Output, Picture, Precision};
pub use part::{MaterialInterface, Part, PartPlace};
pub use points::PointsFile;
pub use quantity::{metres, seconds};
pub use schema::{json_schema, reference};
pub use scheme::{FineRegion, FineStep, Interface, Scheme};
pub use set::{ALL, Members, NamedSet};
pub use source::Location;
pub use surface::{SurfaceDeck, SurfaceFormula, SurfaceShape, VertexAreas};
pub use time::{Time, TimeStep};
