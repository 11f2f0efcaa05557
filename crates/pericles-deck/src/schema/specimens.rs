//! Valid decks that together contain every key in every form and omit every optional key.

/// A deck with overrides.
pub(super) struct Specimen {
    pub(super) deck: &'static str,
    pub(super) changes: &'static [&'static str],
}

const fn specimen(deck: &'static str, changes: &'static [&'static str]) -> Specimen {
    Specimen { deck, changes }
}

/// The minimal deck of a bar.
const BAR: &str = r#"
[body]
shape = "bar"
length = 10
spacing = 1
[material]
density = 1
youngs_modulus = 1
horizon = 3
[sets.left]
layer = { side = "-x", depth = 1 }
[sets.right]
layer = { side = "+x", depth = 1 }
[time]
end = 1
"#;

const PLATE: &str = r#"
title = "a plate"
[body]
shape = "plate"
size = [10, 4]
origin = [0, 0]
spacing = 1
plane = "strain"
thickness = 1
hole = [{ all = true }]
refine = [
    { ratio = 2, all = true },
    { ratio = 2, box = { min = ["-inf", 0], max = [1, "open"] } },
    { ratio = 2, ball = { centre = [0, 0], radius = 1 } },
    { ratio = 2, half_space = { point = [0, 0], normal = [0, 1] } },
    { ratio = 2, layer = { side = "-x", cells = 1 } },
    { ratio = 2, polygon = { corners = [[0, 0], [1, 0], [0, 1]] } },
    { ratio = 2, union = [{ all = true }] },
    { ratio = 2, intersection = [{ all = true }] },
    { ratio = 2, complement = { all = true } },
]
[material]
name = "glass"
model = "bond-stretch"
density = 1
youngs_modulus = 1
modulus = "lattice"
poisson_ratio = 0.25
horizon_ratio = 3
volume_correction = "linear"
surface_correction = "volume"
influence = { function = "constant", acts_on = "displacement" }
fracture_energy = 1
fracture_calibration = "lattice"
no_fail = "top"
bonds = "list"
damage = { measure = "count", count_precut = true }
[sets.top]
layer = { side = "+y", depth = 1 }
[[crack]]
segment = [[0, 0], [1, 1]]
ends = "open"
[[initial]]
set = "top"
displacement = [0, { expression = "x" }]
velocity = [0, { expression = "x" }]
random_velocity = { generator = "splitmix64", radius = 1, seed = 1 }
[[initial]]
random_velocity = { radius = 1 }
[[initial]]
file = "state.txt"
[[constraint]]
set = "top"
velocity = [0, "free"]
function = { kind = "ramp", start = 0, duration = 1 }
until = 1
[[constraint]]
set = "top"
displacement = [{ expression = "x*t" }, 1]
[[constraint]]
set = "top"
velocity = [{ expression = "x*t" }, "free"]
[[constraint]]
set = "top"
displacement = [1, "free"]
[[load]]
set = "top"
traction = [0, { expression = "x*t" }]
area = 1
function = { kind = "table", rows = [[0, 0], [1, 1]] }
from = 0
until = 1
[[load]]
set = "top"
body_force = [{ expression = "x" }, 1]
function = { kind = "expression", expression = "t" }
[[activation]]
set = "top"
active_from = { expression = "x" }
temperature = 300
[[activation]]
path = "path.txt"
radius = 1
[[probe]]
name = "a"
at = [0, 0]
[[probe]]
name = "b"
set = "top"
[time]
end = 1
dt = "auto"
safety = 0.9
scheme = "velocity-verlet"
allow_unstable = true
[output]
fields = { interval = 1, names = ["Damage"] }
history = { every = 1, extremes = ["Damage"] }
cracks = { count = 1, threshold = 0.5 }
fragments = { count = 1, smallest = 0.5 }
precision = "single"
[[output.picture]]
field = "Displacement"
scale = 1
range = [0, 1]
animation = true
edges = true
interval = 1
[[output.picture]]
field = "Damage"
range = [0, 1]
every = 1
[[output.picture]]
field = "Velocity"
range = [0, 1]
count = 1
[[output.picture]]
field = "Force_Density"
range = [0, 1]
[[output.picture]]
field = "Stress"
range = [0, 1]
[[output.picture]]
field = "Strain_Energy_Density"
range = [0, 1]
[[output.profile]]
name = "middle"
field = "Stress_xx"
from = [0, 0]
to = [1, 0]
reference = 1
[[output.profile]]
name = "side"
field = "Velocity"
from = [0, 0]
to = [0, 1]
reference = { expression = "x + t" }
[checkpoint]
wall = 1
[run]
device = "gpu"
adapter = 0
precision = "mixed"
"#;

const BLOCK: &str = r#"
[body]
shape = "block"
size = [4, 4, 4]
spacing = 1
periodic = true
[material]
density = 1
bulk_modulus = 1
horizon = 3
critical_stretch = 1
no_fail = ["all"]
[sets]
a = { all = true }
b = { box = { min = [0, 0, 0] } }
c = { ball = { centre = [0, 0, 0], radius = 1 } }
d = { cylinder = { centre = [0, 0, 0], axis = "z", radius = 1 } }
e = { half_space = { point = [0, 0, 0], normal = [0, 0, 1] } }
f = { layer = { side = "-z", depth = 1 } }
g = { polygon = { corners = [[0, 0], [1, 0], [0, 1]] } }
h = { union = [{ cylinder = { centre = [0, 0, 0], radius = 1 } }] }
i = { intersection = [{ all = true }] }
j = { complement = { all = true } }
k = { where = "x > 0" }
l = { block = 1 }
m = { block = [1, 2] }
n = { points = 3 }
o = { points = [0, '2-5'] }
[[crack]]
polygon = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
[[crack]]
disc = { centre = [0, 0, 0], normal = [0, 0, 1], radius = 1 }
[[load]]
set = "a"
body_force = [0, 0, 1]
[[boundary]]
kind = "damping-layer"
side = "+z"
thickness = 1
reflection = 0.1
power = 1
[[boundary]]
kind = "damping-layer"
side = "-z"
thickness = 1
[time]
end = 1
[output]
fields = "never"
history = "never"
cracks = "never"
fragments = "never"
[[output.picture]]
field = "Stress_xx"
view = [1, 1, 1]
[checkpoint]
every = 1
"#;

const SURFACE: &str = r#"
[body]
shape = "icosphere"
level = 1
radius = 1
[material]
density = 1
alpha = 0.5
p = 2
horizon = 1
[[load]]
set = "all"
traction = [0, 0, 1]
[time]
end = 1
dt = 1
"#;

/// A material with every key of state-based materials.
const STATE_BASED: &str = "material={ model = 'state-based', strains = 'small', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, volume_correction = 'none', \
     surface_correction = 'energy', influence = { function = 'inverse' }, fracture_energy = 1, failure = 'stretch', stretch_definition = 'bond', fracture_calibration = 'lattice', no_fail = 'top' }";

/// A material with every key of correspondence materials.
const CORRESPONDENCE: &str = "material={ model = 'correspondence', law = 'hencky', stabilisation = 'silling', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, yield_stress = 0.1, hardening = 0.2, horizon_ratio = 3, \
     volume_correction = 'none', influence = { function = 'constant' }, fracture_energy = 1, fracture_calibration = 'lattice', no_fail = 'top', bonds = 'list' }";

/// Materials with every key that is not shared.
const MATERIALS: &str = "materials={ \
     a = { density = 1, youngs_modulus = 1, modulus = 'lattice', poisson_ratio = 0.25, fracture_energy = 1, fracture_calibration = 'lattice', horizon_ratio = 3 }, \
     b = { density = 1, bulk_modulus = 1, critical_stretch = 1 }, \
     c = { density = 1, shear_modulus = 1 } }";

const ASSIGN: &str = "assign=[{ set = 'top', material = 'a' }, { set = ['top'], material = 'b', stiffness = 2 }, { set = 'all', stiffness = 1 }, { set = 'top', material = 'c' }]";

const INTERFACES: &str = "interface=[{ rule = 'harmonic' }, { between = ['a', 'b'], rule = 'weaker', critical_stretch = 1 }, \
     { between = ['a', 'c'], youngs_modulus = 1, modulus = 'lattice', fracture_energy = 1, fracture_calibration = 'lattice' }, \
     { between = ['b', 'c'], bulk_modulus = 1 }, { between = ['glass', 'a'], shear_modulus = 1 }]";

const STATE_BASED_MATERIALS: &str = "materials={ a = { density = 1, youngs_modulus = 1, poisson_ratio = 0.1, fracture_energy = 1, failure = 'bond-energy' }, \
     b = { density = 1, bulk_modulus = 2, shear_modulus = 1, critical_stretch = 1 } }";

const STATE_BASED_INTERFACES: &str = "interface=[{ critical_stretch = 1 }, { between = ['a', 'b'], fracture_energy = 1, failure = 'stretch', stretch_definition = 'bond' }]";

/// All specimens.
#[rustfmt::skip]
pub(super) const SPECIMENS: &[Specimen] = &[
    specimen(BAR, &[]),
    specimen(PLATE, &[]),
    specimen(BLOCK, &[]),
    specimen(SURFACE, &[]),
    // Pieces.
    specimen(
        PLATE,
        &[
            "body={ shape = 'plate', size = [10, 4], spacing = 1, plane = 'strain', name = 'target', piece = [{ name = 'a', shape = 'plate', size = [2, 2], origin = [11, 0], material = 'glass', velocity = [-1, 0] }, { name = 'b', shape = 'disc', radius = 2, centre = [-9, 0], rotation = { angle = '30 deg', centre = [0, 0] } }, { name = 'c', shape = 'points', file = 'c.txt', dimension = 2, origin = [0, 9] }, { name = 'd', shape = 'mesh', file = 'd.msh', unit = 'mm', dimension = 2, rotation = { angle = 1 } }, { name = 'e', shape = 'outline', polygons = [[[0, 0], [1, 0], [0, 1]]] }] }",
            "material.modulus=continuum",
            "material.fracture_calibration=continuum",
        ],
    ),
    specimen(BLOCK, &["body.periodic=false", "body.piece=[{ name = 'far', shape = 'ball', radius = 2, centre = [0, 0, 30], rotation = { angle = 1, axis = [1, 0, 0] } }]"]),
    // Contact.
    specimen(PLATE, &["contact={ pairs = 'pieces', law = 'power', exponent = 1.5, stiffness = 2, distance = 1, closing = 1, damping = 0.3, friction = { coefficient = 0.2, speed = 1 } }"]),
    specimen(PLATE, &["contact={}"]),
    specimen(BAR, &["damping={ mass = 1 }"]),
    specimen(BAR, &["output={ fragments = { smallest = 0.5 } }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = 1 }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = 1 }"]),
    specimen(PLATE, &["material.influence={ function = 'tuned', method = 'least-squares', combination = 'separated' }"]),
    specimen(BAR, &["contact={ law = 'emu' }", "impactor=[{ name = 'a', shape = 'half-space', normal = 1, centre = 0 }]"]),
    specimen(
        BAR,
        &[
            "contact={ pairs = 'all', stiffness = '3 MN/m' }",
            "impactor=[{ name = 'a', shape = 'ball', radius = 1, centre = 0, density = 1 }]",
        ],
    ),
    specimen(
        PLATE,
        &["impactor=[{ name = 'a', shape = 'box', size = [1, 1], centre = [0, 0], mass = 1, inertia = 1, spin = 1, velocity = [0, 1], rotation = { angle = 1 } }, { name = 'b', shape = 'ball', radius = 1, centre = [0, 9], motion = 'prescribed', displacement = [0, 1], function = { kind = 'ramp', duration = 1 } }, { name = 'c', shape = 'ball', radius = 1, centre = [9, 9], mass = 1 }]"],
    ),
    specimen(
        BLOCK,
        &["body.periodic=false", "impactor=[{ name = 'a', shape = 'cylinder', radius = 1, height = 1, centre = [0, 0, 0], mass = 1, inertia = [1, 1, 1], spin = [0, 0, 1], motion = 'free' }, { name = 'b', shape = 'surface', file = 'a.stl', unit = 'mm', centre = [0, 0, 9], motion = 'prescribed', velocity = [0, 0, -1] }, { name = 'c', shape = 'cylinder', radius = 1, height = 1, axis = [1, 0, 0], centre = [0, 0, 0], density = 1 }]"],
    ),
    // Shapes.
    specimen(BAR, &["body={ shape = 'bar', size = 10, origin = 0, spacing = 1, area = 1, quadrature = 'gauss' }"]),
    specimen(BAR, &["body={ shape = 'plate', size = [9, 9], spacing = [1, 1.5], plane = 'stress' }"]),
    specimen(BAR, &["body={ shape = 'disc', centre = [0, 0], radius = 9, inner_radius = 5, spacing = 1, plane = 'stress' }"]),
    specimen(BAR, &["body={ shape = 'disc', radius = 9, spacing = 1, plane = 'stress' }"]),
    specimen(BAR, &["body={ shape = 'ball', radius = 9, spacing = 1 }"]),
    specimen(BAR, &["body={ shape = 'cylinder', base = [0, 0, 0], axis = 'x', radius = 9, inner_radius = 5, height = 9, spacing = 1 }"]),
    specimen(BAR, &["body={ shape = 'cylinder', radius = 9, height = 9, spacing = 1 }"]),
    specimen(
        BAR,
        &["body={ shape = 'block', size = [9, 9, 9], spacing = 1, refine = [{ ratio = 2, cylinder = { centre = [0, 0, 0], radius = 1 } }], hole = [{ box = {} }, { ball = { centre = [0, 0, 0], radius = 1 } }, { cylinder = { centre = [0, 0, 0], radius = 1 } }, { half_space = { point = [0, 0, 0], normal = [0, 0, 1] } }, { layer = { side = '-z', depth = 1 } }, { polygon = { corners = [[0, 0], [1, 0], [0, 1]] } }, { union = [{ all = true }] }, { intersection = [{ all = true }] }, { complement = { all = true } }] }"],
    ),
    specimen(BAR, &["body={ shape = 'points', file = 'cloud.txt', spacing = 1 }"]),
    specimen(BAR, &["body={ shape = 'mesh', file = 'a.msh', unit = 'mm' }", "sets.grip={ near_faces = { faces = 'left', depth = 1 } }", "load=[{ set = 'right', pressure = 1 }]"]),
    specimen(BAR, &["body={ shape = 'mesh', file = 'a.msh', unit = 'mm', spacing = 'auto', blocks = ['steel'] }", "output.fields={ cells = true, format = 'exodus', blocks = 'materials' }"]),
    specimen(
        BAR,
        &["body={ shape = 'mesh', file = 'a.msh', unit = 'mm', spacing = 1, dimension = 2, plane = 'stress', thickness = 1, blocks = 'steel' }", "sets.grip={ near_faces = { faces = 'left', cells = 1 } }", "load=[{ set = 'right', pressure = { expression = 'x' } }]", "output.fields={ format = ['vtu', 'vtkhdf'] }"],
    ),
    specimen(BAR, &["body={ shape = 'solid', file = 'a.stl', unit = 'mm', spacing = 1 }", "crack=[{ file = 'crack.stl', unit = 'mm' }]"]),
    specimen(BAR, &["body={ shape = 'solid', file = 'a.stl', unit = 'mm', spacing = 1, open = true, hole = [{ all = true }], refine = [{ all = true, ratio = 2 }] }"]),
    specimen(BAR, &["body={ shape = 'solid', file = 'a.stl', unit = 'mm', spacing = 1, cells = 'partial' }"]),
    specimen(BAR, &["body={ shape = 'outline', polygons = [[[0, 0], [9, 0], [0, 9]]], spacing = 1, plane = 'stress', positions = 'jittered', jitter = 0.2, seed = 2 }"]),
    specimen(BAR, &["body={ shape = 'outline', file = 'a.txt', unit = 'mm', spacing = 1, plane = 'stress', cells = 'partial' }"]),
    specimen(BAR, &["body={ shape = 'outline', file = 'a.txt', unit = 'mm', spacing = 1, plane = 'strain', thickness = 1, positions = 'blue-noise' }"]),
    specimen(BAR, &["body.positions='jittered'"]),
    specimen(BAR, &["body={ shape = 'points', file = 'cloud.txt', spacing = 1, dimension = 2, plane = 'stress', thickness = 1 }"]),
    specimen(SURFACE, &["body={ shape = 'uv-sphere', segments = 8, rings = 5, radius = 1 }", "body.areas=1"]),
    specimen(SURFACE, &["body={ shape = 'ellipsoid', level = 1, half_axes = [1, 1, 1] }", "body.areas=mixed-voronoi"]),
    specimen(SURFACE, &["body={ shape = 'torus', major_radius = 1, minor_radius = 0.3, major_segments = 24, minor_segments = 8 }"]),
    specimen(SURFACE, &["body={ shape = 'capsule', radius = 1, length = 1, segments = 12 }"]),
    specimen(SURFACE, &["body={ shape = 'surface', file = 'part.stl', open = true, several = true, flip = true }"]),
    specimen(SURFACE, &["body={ shape = 'surface', file = 'part.stl' }"]),
    specimen(
        SURFACE,
        &[
            "geodesics={ method = 'edge', ball = 'euclid' }",
            "material={ model = 'power', name = 'a', density = 1, kappa = 1, alpha = 0.5, p = 2, horizon = 1, bond = 'displacement', self_interaction = true, critical_stretch = 1, no_fail = 'all' }",
            "assign=[{ set = 'all', stiffness = 2 }]",
        ],
    ),
    // Influence functions.
    specimen(BAR, &["material.influence={ function = 'power', exponent = 0 }"]),
    specimen(BAR, &["material.influence={ function = 'gaussian', length = 1, acts_on = 'displacement' }", "material.horizon=infinite"]),
    specimen(BAR, &["material.influence={ function = 'gaussian', length = 1, cutoff = 2 }"]),
    specimen(BAR, &["material.influence={ function = 'tabulated', table = [[0, 1], [3, 0.5]] }"]),
    specimen(BAR, &["material.influence={ function = 'tabulated', r = 'spacing', table = [[0, 1], [3, 0.5]] }"]),
    specimen(BAR, &["material.influence={ function = 'cosines', r = 'spacing', wavenumber = 1, coefficients = [1, 0.1] }"]),
    specimen(BAR, &["material.influence={ function = 'cosines', wavenumber = 1, coefficients = [1] }"]),
    specimen(BAR, &["material.influence={ function = 'lattice-classes', table = [[[1], 1], [[2], 1], [[3], 1]] }"]),
    specimen(PLATE, &["material.horizon_ratio=1", "material.influence={ function = 'lattice-classes', table = [[[1, 0], 1]] }"]),
    specimen(BAR, &["material.influence={ function = 'tuned' }"]),
    specimen(BAR, &["material.influence={ function = 'tuned', decay = 'none', lower_bound = 'none' }"]),
    specimen(BAR, &["material.influence={ function = 'tuned', lower_bound = 'auto' }"]),
    specimen(
        PLATE,
        &["material.influence={ function = 'tuned', method = 'least-squares', combination = 'separated', pressure_weight = 1, shear_weight = 1, decay = 1, lower_bound = 0.001 }"],
    ),
    // State-based materials.
    specimen(PLATE, &[STATE_BASED]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, bulk_modulus = 2, shear_modulus = 1, horizon_ratio = 3, influence = { function = 'isotropic' } }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'bond-energy', fracture_energy = 1 }"]),
    specimen(BAR, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, horizon = 3, critical_stretch = 1, failure = 'stretch' }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, viscosity = [{ share = 0.5, time = 1 }] }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = 1, hardening = 1 }"]),
    // Correspondence materials.
    specimen(PLATE, &[CORRESPONDENCE]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, bulk_modulus = 2, shear_modulus = 1, horizon_ratio = 3, law = 'neo-hooke', critical_stretch = 1 }"]),
    specimen(BAR, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, horizon = 3 }"]),
    // Several materials.
    specimen(PLATE, &[MATERIALS, ASSIGN, INTERFACES]),
    specimen(PLATE, &[STATE_BASED, STATE_BASED_MATERIALS, "assign=[{ set = 'top', material = 'a' }]", STATE_BASED_INTERFACES]),
    specimen(PLATE, &["material={ horizon_ratio = 3 }", "materials={ default = { density = 1, youngs_modulus = 1 } }"]),
    // Other laws.
    specimen(BAR, &["material.model=green-strain", "material.approximation=taylor-2"]),
    specimen(PLATE, &["material.shear_modulus=1"]),
    specimen(BAR, &["material.model=green-strain"]),
    // Bars: cracks, absorbing boundaries, exact solutions.
    specimen(BAR, &["crack=[{ layer = 'all' }]"]),
    specimen(BAR, &["crack=[{ section = 5 }, { section = 5, ends = 'open' }]", "probe=[{ name = 'a', at = 5 }]"]),
    specimen(BAR, &["constraint=[{ set = 'left', velocity = 1, function = { kind = 'pulse', duration = 1 } }]"]),
    specimen(BAR, &["initial=[{ velocity = { expression = 'x' } }]", "load=[{ set = 'left', traction = 1, function = { kind = 'constant' } }]"]),
    specimen(PLATE, &["boundary=[{ kind = 'open', side = 'all' }]"]),
    specimen(PLATE, &["boundary=[{ kind = 'open', side = '+x', cells = 16 }, { kind = 'open', side = ['-x', '-y'], thickness = 12 }]"]),
    specimen(BAR, &["boundary=[{ kind = 'absorbing', side = '-x' }, { kind = 'absorbing', side = '+x', history = 'auto', tolerance = 1e-9, verify = true, method = 'discrete', exterior_extent = 1 }]"]),
    specimen(BAR, &["exact={ solution = 'local-pulse', width = 1, amplitude = 1, centre = 0, window = 1, start = true }"]),
    specimen(BAR, &["exact={ solution = 'local-pulse', width = 1, amplitude = 1 }"]),
    specimen(BAR, &["exact={ solution = 'stretched-bar', length = 10, strain = 0.1 }"]),
    specimen(BAR, &["exact={ solution = 'bar-mode', length = 10, amplitude = 0.1 }"]),
    // Schemes.
    specimen(BAR, &["time.dt=1"]),
    specimen(BAR, &["time.scheme=rk3", "time.alpha=1"]),
    specimen(BAR, &["time.scheme=rk3"]),
    specimen(BAR, &["time.scheme=dormand-prince", "time.dt=1", "time.tolerance=1e-6"]),
    specimen(BAR, &["time.scheme=dormand-prince", "time.dt=1"]),
    specimen(BAR, &["time.scheme=multirate-rk4", "time.ratio=4", "time.fine=left", "time.predictor=structured", "time.interpolant=hermite"]),
    specimen(BAR, &["time.scheme=multirate-rk4", "time.ratio=4", "time.fine=['left', 'right']"]),
    specimen(BAR, &["output.cells=auto"]),
    specimen(BAR, &["output.cells=true"]),
    specimen(BAR, &["time.scheme=respa", "time.ratio=4", "time.adaptive={ every = 4, threshold = 0.8, layers = 2, keep_checks = 1 }"]),
    specimen(BAR, &["output.cells=auto"]),
    specimen(BAR, &["output.cells=true"]),
    specimen(BAR, &["time.scheme=respa", "time.ratio=4", "time.adaptive={}"]),
    specimen(BAR, &["time.scheme=implicit-midpoint", "time.dt=1", "time.linear_solver=direct"]),
    specimen(BAR, &["time.scheme=implicit-midpoint", "time.dt=1"]),
    specimen(BAR, &["time.scheme=trigonometric", "time.dt=1", "time.functions=lanczos", "time.loads=gauss", "time.regularisation=0"]),
    specimen(BAR, &["time.scheme=trigonometric", "time.dt=1"]),
    specimen(
        BAR,
        &["time={ end = 1, dt = 1, scheme = 'newmark', beta = 0.25, gamma = 0.5, tolerance = 1, norm = 'l2', iterations = 9, solver = 'anderson', depth = 4 }"],
    ),
    specimen(BAR, &["time={ end = 1, dt = 1, scheme = 'newmark', solver = 'anderson' }"]),
    specimen(BAR, &["time={ end = 1, dt = 1, scheme = 'newmark' }"]),
    specimen(BAR, &["time={ end = 1, dt = 1, scheme = 'discrete-gradient', tolerance = 1e-10 }"]),
    specimen(BAR, &["time={ end = 1, dt = 1, scheme = 'discrete-gradient' }"]),
    specimen(BAR, &["thermal={ expansion = 1e-5, temperature = 300, reference = 293, material = [{ name = 'default', expansion = 2e-5 }] }"]),
    specimen(BAR, &["thermal={ expansion = 1e-5, file = 'temperatures.txt', reference = 293, function = { kind = 'ramp', duration = 1 } }"]),
    specimen(BAR, &["material.scatter={ distribution = 'weibull', of = 'fracture_energy', shape = 5, seed = 2 }"]),
    specimen(BAR, &["material.scatter={ shape = 5 }"]),
    // Properties as functions.
    specimen(BAR, &["material.density={ expression = '1 + x' }", "material.youngs_modulus={ expression = '1 + x' }", "material.fracture_energy={ expression = '1 + x' }"]),
    specimen(BAR, &["material.critical_stretch={ expression = '1 + x' }"]),
    specimen(BAR, &["thermal={ conductivity = { expression = '45 + x' }, specific_heat = { expression = '460 + x' }, temperature = 300, expansion = { expression = '1e-5 * (1 + x)' }, reference = 293, material = [{ name = 'default', conductivity = { expression = '40 + x' }, specific_heat = { expression = '400 + x' }, expansion = { expression = '2e-5 * (1 + x)' } }] }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = { expression = '2 + x' }, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = { expression = '1 + x' } }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = { table = [[300, 1], [400, 0.5]] } }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'principal-stress', strength = { expression = '1 + x' } }"]),
    specimen(BAR, &["material.softening={ law = 'trilinear', onset_stretch = 1e-4, knee_force = 0.3, knee_position = 0.2 }"]),
    specimen(BAR, &["material.softening={ law = 'trilinear', onset_stretch = 1e-4 }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'principal-stress', strength = 1 }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'expression', criterion = 'stress_1' }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, anisotropy = { youngs_modulus = [2, 1, 1], poisson_ratio = [0.1, 0.1, 0.1], shear_modulus = [1, 1, 1], angle = 1 }, horizon_ratio = 3 }"]),
    specimen(PLATE, &["material={ model = 'correspondence', density = 1, anisotropy = { stiffness = [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]], axis = [0, 0, 2] }, horizon_ratio = 3 }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'principal-stress', strength = 1 }"]),
    specimen(PLATE, &["material={ model = 'state-based', density = 1, youngs_modulus = 2, poisson_ratio = 0.3, horizon_ratio = 3, failure = 'expression', criterion = 'stress_1' }"]),
    specimen(BAR, &["material.softening={ law = 'exponential', onset_stretch = 1e-4 }"]),
    specimen(BAR, &["material.fracture_energy=1", "material.tensile_strength=1", "material.softening={ law = 'exponential' }"]),
    specimen(BAR, &["material.fracture_energy=1", "material.tensile_strength=1", "material.failure=strength", "material.strength_surface=rankine"]),
    specimen(BAR, &["material.fracture_energy=1", "material.tensile_strength=1", "material.failure=strength"]),
    specimen(BAR, &["material.fracture_energy=1", "material.tensile_strength=1", "material.failure=strength", "material.strength_surface='stress_1 / 2'", "material.softening={ law = 'exponential' }"]),
    specimen(BAR, &["damping={ mass = 1, stiffness = 1e-3 }"]),
    specimen(BAR, &["damping={ stiffness = 1e-3 }"]),
    specimen(BAR, &["thermal={ expansion = 1e-5, temperature = { expression = '300 + t' }, reference = 293 }"]),
    specimen(BAR, &["thermal={ conductivity = 45, specific_heat = 460, temperature = 300, expansion = 1e-5, reference = 293, scheme = 'trapezoidal', step = 1, interface = 'arithmetic', surface_correction = false, broken_conductance = 0.5, dissipation = 0.9, material = [{ name = 'default', conductivity = 40, specific_heat = 400, expansion = 2e-5 }] }"]),
    specimen(BAR, &["thermal={ conductivity = 45, specific_heat = 460, temperature = { expression = '300 + x' }, condition = [{ set = 'left', temperature = 1 }, { set = 'left', flux = { expression = 't' }, area = 1, function = { kind = 'ramp', duration = 1 } }, { set = 'left', source = 1 }, { set = 'left', convection = { coefficient = 1, ambient = 300 } }, { set = 'left', radiation = { emissivity = 1, ambient = { expression = '300 + t' } } }] }", "time={ end = 1, dt = 1, scheme = 'thermal' }"]),
    specimen(BAR, &["thermal={ conductivity = 45, specific_heat = 460, file = 'temperatures.txt' }"]),
    specimen(BAR, &["time={ scheme = 'adaptive-dynamic-relaxation' }"]),
    specimen(BAR, &["time={ end = 1, scheme = 'adaptive-dynamic-relaxation', damping = 'adaptive', tolerance = 1e-6, iterations = 9, load_steps = 2 }"]),
    specimen(BAR, &["time={ end = 1, scheme = 'adaptive-dynamic-relaxation', damping = 0.1 }"]),
    specimen(BAR, &["time={ end = 1, scheme = 'fire', tolerance = 1e-6, iterations = 9, load_steps = 2 }"]),
    specimen(BAR, &["time={ scheme = 'static' }"]),
    specimen(BAR, &["time={ end = 1, scheme = 'static', tolerance = 1e-6, newton_steps = 9, load_steps = 2, rigid_modes = 'fix', breaking = 'all' }"]),
    specimen(BAR, &["time={ scheme = 'static', control = { quantity = 'end.u_x', rate = 1 } }"]),
    specimen(BAR, &["constraint=[{ set = 'left', velocity = 0 }]", "time.stop_when=[{ set = 'left', reaction_below = 0.02 }, { set = 'left', damage_above = 0.9 }, { condition = 'time > 1' }]"]),
    specimen(BAR, &["output.quantity=[{ name = 'a', expression = 'kinetic_energy', unit = 'J' }]"]),
    // Output.
    specimen(BAR, &["output={ fields = { every = 1 }, history = { interval = 1 }, cracks = { every = 1 }, fragments = { every = 1 }, energy_bound = 1 }"]),
    specimen(BAR, &["output={ fields = { count = 1 }, history = { count = 1 }, cracks = { interval = 1 }, fragments = { interval = 1 } }"]),
    specimen(BAR, &["output.picture=[{ field = 'Damage' }, { field = 'Damage', width = '88 mm' }]", "checkpoint.interval=1"]),
    specimen(BAR, &["run={}"]),
    specimen(BAR, &["run={ device = 'gpu' }"]),
    specimen(BAR, &["output.picture=[{ field = 'Damage', format = 'pdf', width = '88 mm', font_size = '8 pt', dpi = 600, colour_map = 'grey', crop = { min = 0, max = 1 }, title = false, background = 'transparent' }]"]),
];
