//! Invalid decks: messages report line, column, text and what is allowed.

mod common;

use common::{SURFACE, Wrong, explained, wrong};
use miette::Diagnostic;
use pericles_deck::{Deck, DeckError, Fault};
use proptest::prelude::*;

const COMPLETE: &str = include_str!("complete.toml");

/// A valid deck; replacements of its text make invalid ones.
const RIGHT: &str = r#"title = "plate"

[body]
shape = "plate"
size = ["100 mm", "40 mm"]
spacing = "0.25 mm"
plane = "strain"

[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon = "0.75 mm"
fracture_energy = "135 J/m2"

[sets.top]
layer = { side = "+y", depth = "0.25 mm" }

[[crack]]
segment = [["0 mm", "20 mm"], ["50 mm", "20 mm"]]

[[constraint]]
set = "top"
velocity = [0, "free"]

[[load]]
set = "top"
traction = [0, "12 MPa"]

[[probe]]
name = "middle"
at = ["50 mm", "20 mm"]

[time]
end = "46 us"
dt = "auto"

[output]
fields = { interval = "0.5 us" }
"#;

/// Keys of the shape of the body.
const BODY: &str =
    "shape = \"plate\"\nsize = [\"100 mm\", \"40 mm\"]\nspacing = \"0.25 mm\"\nplane = \"strain\"";

#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    // Steps.
    wrong("[output]", "[run]\ndevice = \"tpu\"\n[output]", (38, 10), "\"tpu\"", &["unknown device", "`cpu`"]),
    wrong("[output]", "[run]\nadapter = 1\n[output]", (38, 1), "adapter", &["not allowed", "device = \"gpu\""]),
    wrong("[output]", "[run]\ndevice = \"gpu\"\nprecision = \"half\"\n[output]", (39, 13), "\"half\"", &["unknown precision of a device", "\"mixed\""]),
    wrong("[output]", "[[step]]\nmaterial = { density = 1 }\n[output]", (38, 1), "material", &["unknown key `material` in [[step]]", "`time`, `initial`, `constraint`"]),
    wrong("[output]", "[[step]]\nname = \"a/b\"\n[output]", (38, 8), "\"a/b\"", &["\"a/b\"", "letters, digits, - and _"]),
    wrong("[output]", "[step]\nname = \"a\"\n[output]", (37, 2), "step", &["expected a list of tables, found a table"]),
    wrong("[output]", "[[step]]\n[[step.load]]\nset = \"botom\"\ntraction = [0, 1]\n[output]", (39, 7), "\"botom\"", &["botom"]),
    // Keys.
    wrong("spacing =", "spaceing =", (6, 1), "spaceing", &["unknown key `spaceing` in [body]", "did you mean `spacing`?", "`piece`, `shape`, `size`, `origin`, `spacing`, `thickness`, `hole`, `refine`, `positions`, `periodic` and `plane`"]),
    wrong("[time]", "[tme]", (33, 2), "tme", &["unknown key `tme` in the deck", "did you mean `time`?"]),
    wrong("depth =", "deep =", (16, 24), "deep", &["unknown key `deep` in [sets.top.layer]", "`side`, `depth` and `cells`"]),
    wrong("spacing = \"0.25 mm\"\n", "", (3, 1), "[body]", &["[body] requires `spacing`", "alternative names: `dx`"]),
    wrong("[body]\n", "[corpus]\n", (1, 1), "", &["the deck requires `body`"]),
    wrong("density =", "rho = 1\ndensity =", (11, 1), "density", &["`rho` and `density` are given together in [material]", "only one"]),
    wrong("horizon =", "horizon_ratio = 3\nhorizon =", (13, 11), "\"0.75 mm\"", &["`horizon` and `horizon_ratio` are given together"]),
    wrong("horizon = \"0.75 mm\"\n", "", (9, 1), "[material]", &["[material] requires one of `horizon` and `horizon_ratio`"]),
    wrong("fracture_energy", "bulk_modulus = 1\nfracture_energy", (13, 16), "1", &["`youngs_modulus` and `bulk_modulus`", "`shear_modulus`"]),
    wrong("spacing =", "area = 1\nspacing =", (6, 1), "area", &["`area` is not allowed in [body]", "only a bar"]),
    wrong("dt = \"auto\"", "dt = 1e-9\nsafety = 0.5", (36, 1), "safety", &["`safety` is not allowed", "dt = \"auto\""]),
    wrong("segment =", "section =", (19, 1), "section", &["`section` is not allowed in [crack.0]", "`section` requires a bar"]),
    wrong("traction =", "body_force = [0, 1]\narea = 1\n# traction =", (28, 1), "area", &["`area` is not allowed in [load.0]", "`traction`"]),
    // Pieces, contact, impactors.
    wrong("[material]", "[[body.piece]]\nshape = \"plate\"\nsize = [1, 1]\n[material]", (9, 1), "[[body.piece]]", &["[body.piece.0] requires `name`"]),
    wrong("[material]", "[[body.piece]]\nname = \"main\"\nshape = \"plate\"\nsize = [1, 1]\n[material]", (10, 8), "\"main\"", &["another piece has this name"]),
    wrong("[material]", "[[body.piece]]\nname = \"a\"\nshape = \"ball\"\nradius = 1\n[material]", (11, 9), "\"ball\"", &["shapes of the dimension of the body"]),
    wrong("[material]", "[[body.piece]]\nname = \"a\"\nshape = \"plate\"\nsize = [1, 1]\nperiodic = true\n[material]", (11, 9), "\"plate\"", &["not periodic"]),
    wrong("[material]", "[[body.piece]]\nname = \"a\"\nshape = \"plate\"\nsize = [1, 1]\nmaterial = \"b\"\nrotation = { angle = 1, axis = [0, 0, 1] }\n[material]", (14, 25), "axis", &["rotates in its plane"]),
    wrong("plane = \"strain\"", "plane = \"strain\"\nname = \"a\"", (8, 1), "name", &["`name` is not allowed in [body]", "[[body.piece]]"]),
    wrong("[material]", "[contact]\nclosing = 1.2\n[material]", (10, 11), "1.2", &["out of range", "release energy when a bond breaks"]),
    wrong("[material]", "[contact]\npairs = \"all\"\nclosing = 1\n[material]", (11, 11), "1", &["at most 0.9"]),
    wrong("[material]", "[contact]\nexponent = 2\n[material]", (10, 1), "exponent", &["`exponent` is not allowed in [contact]", "law = \"power\""]),
    wrong("[material]", "[contact]\nstiffness = \"3 MPa\"\n[material]", (10, 13), "\"3 MPa\"", &["a stiffness"]),
    wrong("[material]", "[contact]\nfriction = { coefficient = 0.1 }\n[material]", (10, 12), "{ coefficient = 0.1 }", &["requires `speed`"]),
    wrong("[material]", "[[impactor]]\nname = \"a\"\nshape = \"half-space\"\nnormal = [0, 1]\ncentre = [0, 0]\nmotion = \"free\"\n[material]", (14, 10), "\"free\"", &["no finite mass"]),
    wrong("[material]", "[[impactor]]\nname = \"a\"\nshape = \"ball\"\nradius = 1\ncentre = [0, 0]\nmotion = \"prescribed\"\ndensity = 1\n[material]", (15, 1), "density", &["`density` is not allowed in [impactor.0]", "does not depend on mass"]),
    wrong("[material]", "[[impactor]]\nname = \"a\"\nshape = \"ball\"\nradius = 1\ncentre = [0, 0]\n[material]", (9, 1), "[[impactor]]", &["requires one of `density` and `mass`"]),
    wrong("[material]", "[[impactor]]\nname = \"a\"\nshape = \"cylinder\"\nradius = 1\nheight = 1\ncentre = [0, 0]\ndensity = 1\n[material]", (11, 9), "\"cylinder\"", &["require a 3D body"]),
    // Meshes, random positions, formats.
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "near_faces = { faces = \"a\", depth = 1 }", (16, 1), "near_faces", &["requires shape = \"mesh\"", "`layer`"]),
    wrong("fields = { interval = \"0.5 us\" }", "fields = { cells = true }", (38, 12), "cells", &["`cells` is not allowed in [output.fields]", "requires shape = \"mesh\""]),
    wrong("fields = { interval = \"0.5 us\" }", "fields = { format = \"vtk\" }", (38, 21), "\"vtk\"", &["unknown format `vtk`", "\"exodus\""]),
    wrong("spacing = \"0.25 mm\"", "spacing = \"0.25 mm\"\njitter = 0.1", (7, 1), "jitter", &["`jitter` is not allowed in [body]", "jittered"]),
    wrong("spacing = \"0.25 mm\"", "spacing = \"0.25 mm\"\npositions = \"random\"", (7, 13), "\"random\"", &["unknown kind of positions `random`", "\"blue-noise\""]),
    wrong("spacing = \"0.25 mm\"", "spacing = \"0.25 mm\"\npositions = \"jittered\"\njitter = 0.5", (8, 10), "0.5", &["out of range", "below 0.5"]),
    wrong(BODY, "shape = \"mesh\"\nfile = \"a.msh\"\ndimension = 2\nplane = \"strain\"", (3, 1), "[body]", &["[body] requires `unit`"]),
    wrong(BODY, "shape = \"mesh\"\nfile = \"a.msh\"\nunit = \"mmm\"\ndimension = 2\nplane = \"strain\"", (6, 8), "\"mmm\"", &["unknown unit `mmm`", "the unit of length of the file"]),
    wrong(BODY, "shape = \"mesh\"\nfile = \"a.msh\"\nunit = \"mm\"\ndimension = 1\nplane = \"strain\"", (7, 13), "1", &["out of range", "2 or 3"]),
    wrong(BODY, "shape = \"outline\"\nfile = \"a.txt\"\nunit = \"mm\"\nspacing = 1e-4\nplane = \"strain\"\npositions = \"jittered\"\ncells = \"partial\"", (10, 1), "cells", &["`cells` is not allowed in [body]", "partial cells require positions = \"lattice\""]),
    wrong("fields = { interval = \"0.5 us\" }", "fields = { blocks = \"sets\" }", (38, 21), "\"sets\"", &["unknown kind of blocks `sets`", "\"groups\"", "\"materials\""]),
    wrong(BODY, "shape = \"outline\"\npolygons = []\nspacing = 1e-4\nplane = \"strain\"", (5, 12), "[]", &["at least one polygon"]),
    // Expressions and tables.
    wrong("[0, \"free\"]", "[{ expression = \"sine(t)\" }, \"free\"]", (23, 28), "\"sine(t)\"", &["unknown name `sine`", "did you mean `sin`", "Variables: x, y, t"]),
    wrong("[0, \"12 MPa\"]", "[0, { expression = \"(x\" }]", (27, 31), "\"(x\"", &["a parenthesis is not closed", "SI units"]),
    wrong("[0, \"12 MPa\"]", "[0, 1]\nfunction = { kind = \"table\", rows = [[1, 0], [1, 2]] }", (28, 37), "[[1, 0]", &["row 1 of the time table", "times that increase"]),
    wrong("[0, \"12 MPa\"]", "[0, 1]\nfrom = \"2 us\"\nuntil = \"1 us\"", (29, 9), "\"1 us\"", &["out of range", "later than `from`"]),
    // Schemes.
    wrong("dt = \"auto\"", "scheme = \"rk5\"", (35, 10), "\"rk5\"", &["unknown scheme `rk5`", "did you mean `rk3`?", "\"multirate-rk4\"", "\"respa\""]),
    wrong("dt = \"auto\"", "scheme = \"rk4\"\nratio = 4", (36, 1), "ratio", &["`ratio` is not allowed in [time]", "\"multirate-rk4\""]),
    wrong("dt = \"auto\"", "alpha = 1", (35, 1), "alpha", &["`alpha` is not allowed in [time]", "rk3"]),
    wrong("dt = \"auto\"", "scheme = \"rk3\"\nalpha = 0", (36, 9), "0", &["out of range", "Heun"]),
    wrong("dt = \"auto\"", "scheme = \"rk4\"\ntolerance = 1", (36, 1), "tolerance", &["not allowed", "dormand-prince"]),
    wrong("dt = \"auto\"", "scheme = \"dormand-prince\"\ntolerance = 0", (36, 13), "0", &["above 0 and below 1"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk4\"\nfine = \"top\"", (33, 1), "[time]", &["[time] requires `ratio`"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk4\"\nratio = 0\nfine = \"top\"", (36, 9), "0", &["whole number from 1 to 1000"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk4\"\nratio = 2000\nfine = \"top\"", (36, 9), "2000", &["from 1 to 1000"]),
    wrong("dt = \"auto\"", "scheme = \"respa\"\nratio = 4", (33, 1), "[time]", &["requires one of `fine` and `adaptive`"]),
    wrong("[sets.top]", "[sets.some]\npoints = [1, \"7-3\"]\n[sets.top]", (16, 14), "\"7-3\"", &["out of range", "a range such as \"20-35\""]),
    wrong("[sets.top]", "[sets.some]\npoints = 1.5\n[sets.top]", (16, 10), "1.5", &["out of range", "a whole number"]),
    wrong("dt = \"auto\"", "scheme = \"respa\"\nratio = 4\nfine = \"tip\"", (37, 8), "\"tip\"", &["unknown set `tip`", "did you mean `top`?"]),
    wrong("dt = \"auto\"", "scheme = \"respa\"\nratio = 4\nfine = \"top\"\nadaptive = {}", (38, 12), "{}", &["`fine` and `adaptive` are given together"]),
    wrong("dt = \"auto\"", "scheme = \"respa\"\nratio = 4\nfine = \"top\"\npredictor = \"structured\"", (38, 1), "predictor", &["not allowed", "multirate-rk3"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk3\"\nratio = 4\nadaptive = { threshold = 1.2 }", (37, 26), "1.2", &["above 0 and below 1"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk3\"\nratio = 4\nadaptive = { after = 2 }", (37, 14), "after", &["unknown key `after` in [time.adaptive]", "`threshold`"]),
    wrong("dt = \"auto\"", "scheme = \"multirate-rk3\"\nratio = 4\nfine = \"top\"\ninterpolant = \"hermit\"", (38, 15), "\"hermit\"", &["did you mean `hermite`?"]),
    wrong("[sets.top]", "[[assign]]\nset = \"top\"\nstiffness = 0\n[sets.top]", (17, 13), "0", &["a positive number"]),
    // Sets by condition, listed points.
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "where = \"x > \"", (16, 9), "\"x > \"", &["the condition `x > ` cannot be used", "block == 2"]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "where = \"z > 0\"", (16, 9), "\"z > 0\"", &["unknown name `z`", "Variables: x, y, block"]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "block = 1.5", (16, 9), "1.5", &["a whole number of at least 0"]),
    wrong("layer = {", "where = \"x > 0\"\nlayer = {", (17, 9), "{ side", &["`layer` and `where` are given together", "`block`"]),
    wrong("\"plate\"\nsize = [\"100 mm\", \"40 mm\"]\n", "\"points\"\n", (3, 1), "[body]", &["[body] requires `file`"]),
    wrong("\"plate\"\nsize = [\"100 mm\", \"40 mm\"]\n", "\"points\"\nfile = \"a.txt\"\ndimension = 4\n", (6, 13), "4", &["allowed: 1, 2 or 3"]),
    wrong("\"plate\"\nsize = [\"100 mm\", \"40 mm\"]\n", "\"points\"\nfile = \"a.txt\"\n", (7, 1), "plane", &["`plane` is not allowed in [body]"]),
    // Several materials, static schemes.
    wrong("[sets.top]", "[materials.a]\ndensity = -1\nyoungs_modulus = 1\n[sets.top]", (16, 11), "-1", &["a positive number"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\nvolume_correction = \"linear\"\n[sets.top]", (18, 21), "\"linear\"", &["`volume_correction` in [materials.a] differs", "once, in [material]"]),
    wrong("[sets.top]", "[[interface]]\nrule = \"weaker\"\n[sets.top]", (15, 3), "interface", &["`interface` is not allowed", "interfaces require several materials"]),
    wrong("[sets.top]", "[[interface]]\nbetween = [\"b\", \"a\"]\ncritical_stretch = 1\n[materials.a]\ndensity = 1\nyoungs_modulus = 1\n[sets.top]", (16, 12), "\"b\"", &["unknown material `b`", "\"a\""]),
    wrong("fracture_energy", "fracture_calibration = \"grid\"\nfracture_energy", (13, 24), "\"grid\"", &["unknown fracture calibration `grid`", "\"lattice\" and \"continuum\""]),
    wrong("fracture_energy = \"135 J/m2\"", "fracture_calibration = \"lattice\"", (13, 1), "fracture_calibration", &["not allowed in [material]", "bonds without `fracture_energy` never break"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\nfracture_calibration = \"lattice\"\n[sets.top]", (18, 1), "fracture_calibration", &["not allowed", "never break"]),
    wrong("[sets.top]", "[[assign]]\nset = \"top\"\n[sets.top]", (15, 1), "[[assign]]", &["[assign.0] requires one of `material` and `stiffness`"]),
    wrong("[sets.top]", "[[assign]]\nset = \"tip\"\nstiffness = 2\n[sets.top]", (16, 7), "\"tip\"", &["unknown set `tip`", "did you mean `top`?"]),
    wrong("[sets.top]", "[[assign]]\nset = \"top\"\nmaterial = \"glue\"\n[sets.top]", (17, 12), "\"glue\"", &["unknown material `glue`", "\"default\""]),
    wrong("[sets.top]", "[[assign]]\nset = [\"top\"]\nstiffness = -1\n[sets.top]", (17, 13), "-1", &["a positive number"]),
    wrong("[sets.top]", "[materials.a]\nyoungs_modulus = 1\n[sets.top]", (15, 1), "[materials.a]", &["[materials.a] requires `density`"]),
    wrong("[sets.top]", "[materials.a]\nname = \"b\"\ndensity = 1\nyoungs_modulus = 1\n[sets.top]", (16, 1), "name", &["not allowed in [materials.a]", "the heading of the table"]),
    wrong("[sets.top]", "[materials.default]\ndensity = 1\nyoungs_modulus = 1\n[sets.top]", (15, 1), "[materials.default]", &["the name `default` cannot be used", "[material] has this name"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\ninfluence = { function = \"conical\" }\n[sets.top]", (18, 13), "{ function = \"conical\" }", &["`influence` in [materials.a] differs"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\nmodel = \"linear\"\n[sets.top]", (18, 9), "\"linear\"", &["`model` in [materials.a] differs"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\n[[interface]]\nbetween = [\"a\", \"default\"]\n[sets.top]", (18, 1), "[[interface]]", &["[interface.0] requires one of `rule`", "`fracture_energy`"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\n[[interface]]\nrule = \"weaker\"\nyoungs_modulus = 1\n[sets.top]", (20, 18), "1", &["`rule` and `youngs_modulus` are given together in [interface.0]"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\n[[interface]]\nrule = \"weaker\"\nfailure = \"stretch\"\n[sets.top]", (20, 1), "failure", &["not allowed", "state-based"]),
    wrong("[sets.top]", "[materials.a]\ndensity = 1\nyoungs_modulus = 1\n[[interface]]\nrule = \"weaker\"\n[[interface]]\nfracture_energy = 1\n[sets.top]", (20, 1), "[[interface]]", &["[interface.1] requires `between`"]),
    wrong("fracture_energy", "surface_correction = \"force\"\nfracture_energy", (13, 22), "\"force\"", &["unknown surface correction `force`", "\"energy\" and \"ghosts\""]),
    wrong("dt = \"auto\"", "scheme = \"adaptive-dynamic-relaxation\"\ndt = 1", (36, 1), "dt", &["`dt` is not allowed in [time]", "set load_steps"]),
    wrong("dt = \"auto\"", "scheme = \"adaptive-dynamic-relaxation\"\ndamping = 3", (36, 11), "3", &["\"adaptive\", or a number above 0 and below 2"]),
    wrong("dt = \"auto\"", "scheme = \"adaptive-dynamic-relaxation\"\ntolerance = 0", (36, 13), "0", &["residual relative to loads"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\ntolerance = 2", (36, 13), "2", &["residual relative to loads"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\nnewton_steps = 4000", (36, 16), "4000", &["from 1 to 1000"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\nrigid_modes = \"keep\"", (36, 15), "\"keep\"", &["rigid", "refuse", "fix"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\ncontrol = { quantity = \"CMOD\", rate = 0 }", (36, 39), "0", &["a speed other than 0"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\nbreaking = \"event\"\ncontrol = { quantity = \"CMOD\", rate = 1 }", (37, 1), "control", &["[[time.stop_when]]"]),
    wrong("dt = \"auto\"", "scheme = \"static\"\nbreaking = \"first\"", (36, 12), "\"first\"", &["breaking rule", "worst-first", "all", "event"]),
    wrong("dt = \"auto\"", "newton_steps = 4", (35, 1), "newton_steps", &["not allowed", "scheme = \"static\""]),
    wrong("dt = \"auto\"", "load_steps = 4", (35, 1), "load_steps", &["not allowed", "a static scheme: \"adaptive-dynamic-relaxation\", \"fire\" or \"static\""]),
    wrong("dt = \"auto\"", "scheme = \"fire\"\ndamping = 0.1", (36, 1), "damping", &["`damping` is not allowed in [time]", "scheme = \"adaptive-dynamic-relaxation\""]),
    wrong("dt = \"auto\"", "scheme = \"fire\"\ndt = 1", (36, 1), "dt", &["`dt` is not allowed in [time]", "set load_steps"]),
    wrong("fields = {", "fragments = { smallest = 1 }\nfields = {", (38, 26), "1", &["out of range", "a fraction of the body's mass"]),
    // Profiles.
    wrong("fields = { interval = \"0.5 us\" }\n", "fields = { interval = \"0.5 us\" }\n[[output.profile]]\nname = \"a/b\"\nfield = \"Damage\"\nfrom = [0, 0]\nto = [1, 0]\n", (40, 8), "\"a/b\"", &["it is part of a file's name", "letters, digits"]),
    wrong("fields = { interval = \"0.5 us\" }\n", "fields = { interval = \"0.5 us\" }\n[[output.profile]]\nname = \"a\"\nfield = \"Damage\"\nfrom = [0, 0]\nto = [0, 0]\n", (43, 6), "[0, 0]", &["out of range", "a place other than `from`"]),
    // State-based materials.
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\n", (9, 1), "[material]", &["elastic constants", "two of Young's modulus, Poisson's ratio, bulk modulus and shear modulus"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.5\n", (13, 17), "0.5", &["out of range", "above -1 and below 0.5"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\nshear_modulus = \"20 GPa\"\n", (9, 1), "[material]", &["must be below three times the shear modulus"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nbulk_modulus = \"10 GPa\"\n", (9, 1), "[material]", &["the bulk modulus is 10.0 GPa, but", "give two constants"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nmodulus = \"lattice\"\n", (14, 1), "modulus", &["`modulus` is not allowed in [material]", "exact on every lattice"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nsurface_correction = \"volume\"\n", (14, 22), "\"volume\"", &["out of range", "6 to 15 % too stiff"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nfailure = \"energy\"\n", (14, 11), "\"energy\"", &["unknown failure criterion `energy`", "\"bond-energy\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nfailure = \"bond-energy\"\nstretch_definition = \"iso\"\n", (15, 1), "stretch_definition", &["not allowed", "does not depend on it"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nstretch_definition = \"isotropic\"\n", (14, 22), "\"isotropic\"", &["unknown definition of the critical stretch `isotropic`", "\"closing\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nstrains = \"large\"\n", (14, 11), "\"large\"", &["unknown strains `large`", "\"finite\" and \"small\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\napproximation = \"exact\"\n", (14, 1), "approximation", &["not allowed", "green-strain"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\ninfluence = { function = \"tuned\" }\n", (14, 26), "\"tuned\"", &["`tuned` is out of range", "\"isotropic\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\ninfluence = { acts_on = \"stretch\" }\n", (14, 15), "acts_on", &["not allowed", "multiplies the bond extension"]),
    wrong("youngs_modulus = \"72 GPa\"\nhorizon = \"0.75 mm\"\nfracture_energy = \"135 J/m2\"\n\n[sets.top]", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhorizon = \"0.75 mm\"\n[[assign]]\nset = \"top\"\nstiffness = 2\n[sets.top]", (17, 1), "stiffness", &["not allowed", "other elastic constants"]),
    wrong("youngs_modulus = \"72 GPa\"\nhorizon = \"0.75 mm\"\nfracture_energy = \"135 J/m2\"\n\n[sets.top]", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhorizon = \"0.75 mm\"\n[materials.a]\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = 0.6\n[sets.top]", (18, 17), "0.6", &["above -1 and below 0.5"]),
    wrong("youngs_modulus = \"72 GPa\"\nhorizon = \"0.75 mm\"\nfracture_energy = \"135 J/m2\"\n\n[sets.top]", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhorizon = \"0.75 mm\"\n[materials.a]\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = 0.1\nfailure = \"stretch\"\n[sets.top]", (19, 1), "failure", &["not allowed", "never break"]),
    wrong("youngs_modulus = \"72 GPa\"\nhorizon = \"0.75 mm\"\nfracture_energy = \"135 J/m2\"\n\n[sets.top]", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhorizon = \"0.75 mm\"\n[[interface]]\nrule = \"weaker\"\n[materials.a]\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = 0.1\n[sets.top]", (16, 1), "rule", &["not allowed", "constants of its own material"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "failure = \"stretch\"\n", (13, 1), "failure", &["not allowed", "never break"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = 135\nfailure = \"bond-energy\"\n", (14, 11), "\"bond-energy\"", &["unknown failure criterion `bond-energy`", "\"strength\""]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = 135\nfailure = \"strength\"\n", (9, 1), "[material]", &["`tensile_strength`"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = 135\nfailure = \"strength\"\ntensile_strength = 1e6\nstrength_surface = \"strain_1\"\n", (16, 20), "\"strain_1\"", &["of the stress of a point"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = 135\nstrength_surface = \"rankine\"\n", (14, 1), "strength_surface", &["not allowed", "failure = \"strength\""]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = 135\nfailure = \"strength\"\ntensile_strength = 1e6\nsoftening = { law = \"linear\", onset_stretch = 1e-4 }\n", (16, 31), "onset_stretch", &["not allowed", "when the stress reaches"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nviscosity = [{ share = 1, time = \"1 s\" }]\n", (14, 24), "1", &["out of range", "between 0 and 1"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nviscosity = [{ share = 0.6, time = 1 }, { share = 0.4, time = 2 }]\n", (9, 1), "[material]", &["the sum of the shares of all viscous terms is 1", "below 1"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nviscosity = [{ share = 0.6, time = 0 }]\n", (14, 36), "0", &["out of range", "positive"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nviscosity = [{ share = 0.6, time = 1 }]\nyield_stress = 1\n", (15, 1), "yield_stress", &["not allowed", "viscous or plastic"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"0 MPa\"\n", (14, 16), "\"0 MPa\"", &["out of range", "positive"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"1 MPa\"\nhardening = -1\n", (15, 13), "-1", &["out of range", "zero or a positive modulus"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhardening = 1\n", (14, 1), "hardening", &["not allowed", "yield_stress"]),
    wrong("[time]\n", "[thermal]\nexpansion = \"12e-6 1/s\"\ntemperature = 300\nreference = 293\n[time]\n", (34, 13), "\"12e-6 1/s\"", &["a coefficient of thermal expansion", "12e-6 1/K"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = \"300 m\"\nreference = 293\n[time]\n", (35, 15), "\"300 m\"", &["a temperature", "293.15 K"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = { expression = \"300 + z\" }\nreference = 293\n[time]\n", (35, 30), "\"300 + z\"", &["`z`"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = 300\n[time]\n", (33, 1), "[thermal]", &["reference"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\nreference = 293\n[time]\n", (33, 1), "[thermal]", &["`temperature`", "`file`"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\nreference = 293\nfile = 3\n[time]\n", (36, 8), "3", &["a string in quotes"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = 300\nreference = 293\nmaterial = [{ name = \"lead\", expansion = 1e-5 }]\n[time]\n", (37, 22), "\"lead\"", &["lead", "default"]),
    wrong("[time]\n", "[thermal]\nconductivity = -1\nspecific_heat = 460\ntemperature = 300\n[time]\n", (34, 16), "-1", &["out of range", "at least 0"]),
    wrong("[time]\n", "[thermal]\nconductivity = \"45 W/m\"\nspecific_heat = 460\ntemperature = 300\n[time]\n", (34, 16), "\"45 W/m\"", &["a thermal conductivity", "45 W/m/K"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\ntemperature = 300\n[time]\n", (33, 1), "[thermal]", &["specific_heat"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\nexpansion = 1e-5\n[time]\n", (33, 1), "[thermal]", &["reference"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\nscheme = \"implicit\"\n[time]\n", (37, 10), "\"implicit\"", &["explicit", "backward-euler"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\nbroken_conductance = 2\n[time]\n", (37, 22), "2", &["out of range", "0 to 1"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\ndissipation = 1.2\n[time]\n", (37, 15), "1.2", &["out of range", "0 to 1"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\nscheme = \"steady\"\ndissipation = 0.9\n[time]\n", (38, 1), "dissipation", &["not allowed", "stores no heat", "backward-euler"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = 300\nreference = 293\ndissipation = 0.9\n[time]\n", (37, 1), "dissipation", &["not allowed", "conductivity"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = { expression = \"300 + t\" }\n[time]\n", (36, 30), "\"300 + t\"", &["`t`"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\n[[thermal.condition]]\nset = \"top\"\n[time]\n", (37, 1), "[[thermal.condition]]", &["`temperature`", "`flux`", "`convection`"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\n[[thermal.condition]]\nset = \"bottom\"\nflux = 1\n[time]\n", (38, 7), "\"bottom\"", &["bottom", "top"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\n[[thermal.condition]]\nset = \"top\"\nradiation = { emissivity = 2, ambient = 300 }\n[time]\n", (39, 28), "2", &["out of range", "0 to 1"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\n[[thermal.condition]]\nset = \"top\"\nconvection = { coefficient = 5 }\n[time]\n", (39, 14), "{ coefficient = 5 }", &["ambient"]),
    wrong("[time]\n", "[thermal]\nconductivity = 45\nspecific_heat = 460\ntemperature = 300\n[[thermal.condition]]\nset = \"top\"\nsource = 1\narea = 1\n[time]\n", (40, 1), "area", &["not allowed", "flux"]),
    wrong("[time]\n", "[thermal]\nexpansion = 1e-5\ntemperature = 300\nreference = 293\nstep = 1\n[time]\n", (37, 1), "step", &["not allowed", "conductivity"]),
    wrong("dt = \"auto\"", "scheme = \"thermal\"", (33, 1), "[time]", &["dt"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nsoftening = { law = \"cubic\", onset_stretch = 1e-4 }\n", (14, 21), "\"cubic\"", &["unknown softening law `cubic`", "\"exponential\""]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nsoftening = { law = \"linear\", onset_stretch = 0 }\n", (14, 47), "0", &["out of range", "positive stretch"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nsoftening = { law = \"trilinear\", onset_stretch = 1e-4, knee_force = 1 }\n", (14, 69), "1", &["out of range", "below 1"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nsoftening = { law = \"linear\" }\n", (9, 1), "[material]", &["`tensile_strength`", "`softening.onset_stretch`"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\ntensile_strength = \"5 MPa\"\n", (14, 1), "tensile_strength", &["not allowed", "softening = { law"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\ntensile_strength = \"5 MPa\"\nsoftening = { law = \"linear\", onset_stretch = 1e-4 }\n", (14, 1), "tensile_strength", &["not allowed", "`onset_stretch`", "one of the two"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "tensile_strength = \"5 MPa\"\nsoftening = { law = \"linear\" }\n", (13, 1), "tensile_strength", &["not allowed", "never break"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\ntensile_strength = 0\nsoftening = { law = \"linear\" }\n", (14, 20), "0", &["positive"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\ntensile_strength = \"5 J/m2\"\nsoftening = { law = \"linear\" }\n", (14, 20), "\"5 J/m2\"", &["not a force per area"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\ntensile_strength = 1\n", (14, 1), "tensile_strength", &["not allowed", "softening"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"state-based\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nsoftening = { law = \"linear\", onset_stretch = 1e-4 }\n", (14, 1), "softening", &["not allowed", "proportional to the stretch"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nscatter = { shape = 0.1 }\n", (14, 21), "0.1", &["out of range", "0.5 to 1000"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "fracture_energy = \"135 J/m2\"\nscatter = { shape = 5, of = \"modulus\" }\n", (14, 29), "\"modulus\"", &["critical_stretch", "fracture_energy"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\nyield_stress = 1\n", (12, 1), "yield_stress", &["not allowed", "state-based"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\nstrains = \"small\"\n", (12, 1), "strains", &["not allowed", "state-based"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nlaw = \"hooke\"\n", (14, 7), "\"hooke\"", &["unknown elastic law `hooke`", "\"neo-hooke\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nstabilisation = \"full\"\n", (14, 17), "\"full\"", &["unknown stabilisation `full`", "\"isotropic\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nyield_stress = 0\n", (14, 16), "0", &["positive"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nhardening = \"1 GPa\"\n", (14, 1), "hardening", &["not allowed", "requires `yield_stress`"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nyield_stress = 1\nhardening = -1\n", (15, 13), "-1", &["out of range", "softening is not supported"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nyield_stress = \"100 MPa\"\nlaw = \"neo-hooke\"\n", (15, 7), "\"neo-hooke\"", &["out of range", "logarithmic strains"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nstrains = \"small\"\n", (14, 1), "strains", &["not allowed", "finite strains"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nsurface_correction = \"energy\"\n", (14, 1), "surface_correction", &["not allowed", "shape tensor"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nfailure = \"energy\"\n", (14, 11), "\"energy\"", &["unknown failure criterion `energy`", "\"bond-energy\"", "\"principal-stress\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = \"72 GPa\"\npoisson_ratio = 0.3\nstrength = \"1 MPa\"\n", (14, 1), "strength", &["not allowed", "principal-stress"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"correspondence\"\npoisson_ratio = 0.3\nfailure = \"principal-stress\"\nstrength = 0\n", (16, 12), "0", &["out of range", "positive"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\nstrength = \"1 MPa\"\n", (12, 1), "strength", &["not allowed", "correspondence"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"state-based\"\npoisson_ratio = 0.3\nfailure = \"expression\"\n", (9, 1), "[material]", &["`criterion`"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"state-based\"\npoisson_ratio = 0.3\nfailure = \"expression\"\ncriterion = \"stress_zz\"\n", (16, 13), "\"stress_zz\"", &["unknown name `stress_zz`", "stress_xx"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"correspondence\"\npoisson_ratio = 0.3\nfailure = \"expression\"\ncriterion = \"2\"\n", (16, 13), "\"2\"", &["depends on no stress or strain"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"state-based\"\npoisson_ratio = 0.3\nfailure = \"expression\"\ncriterion = \"stress_1/1e6\"\nfracture_energy = 1\n", (17, 1), "fracture_energy", &["not allowed", "break by `criterion`"]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"state-based\"\npoisson_ratio = 0.3\ncriterion = \"stress_1/1e6\"\n", (15, 1), "criterion", &["not allowed", "requires failure = \"expression\""]),
    wrong("fracture_energy = \"135 J/m2\"\n", "model = \"state-based\"\npoisson_ratio = 0.3\nfailure = \"expression\"\nstrength = 1\ncriterion = \"stress_1/1e6\"\n", (16, 1), "strength", &["not allowed", "requires failure = \"principal-stress\""]),
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\ncriterion = \"stress_1\"\n", (12, 1), "criterion", &["not allowed", "state-based"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\nlaw = \"neo-hooke\"\n", (12, 1), "law", &["not allowed", "correspondence"]),
    // Anisotropy.
    wrong("youngs_modulus = \"72 GPa\"\n", "youngs_modulus = \"72 GPa\"\nanisotropy = { stiffness = 1 }\n", (12, 1), "anisotropy", &["not allowed", "correspondence"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyoungs_modulus = 1\nanisotropy = { youngs_modulus = [2, 1, 1], poisson_ratio = [0.1, 0.1, 0.1], shear_modulus = [1, 1, 1] }\n", (12, 1), "youngs_modulus", &["not allowed", "`anisotropy` contains all elastic constants"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nanisotropy = { youngs_modulus = [2, 1, 1], shear_modulus = [1, 1, 1] }\n", (12, 14), "{ youngs_modulus = [2, 1, 1], shear_modulus = [1, 1, 1] }", &["requires `poisson_ratio`"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nanisotropy = { youngs_modulus = [2, 1, 1], poisson_ratio = [2, 0.1, 0.1], shear_modulus = [1, 1, 1] }\n", (12, 14), "{ youngs_modulus = [2, 1, 1], poisson_ratio = [2, 0.1, 0.1], shear_modulus = [1, 1, 1] }", &["positive energy"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nanisotropy = { youngs_modulus = [2, 1, 1], poisson_ratio = [0.1, 0.1, 0.1], shear_modulus = [1, 1] }\n", (12, 93), "[1, 1]", &["three moduli"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nanisotropy = { stiffness = [[1, 0], [0, 1]] }\n", (12, 28), "[[1, 0], [0, 1]]", &["six rows of six moduli"]),
    wrong("youngs_modulus = \"72 GPa\"\n", "model = \"correspondence\"\nyield_stress = 1\nanisotropy = { youngs_modulus = [2, 1, 1], poisson_ratio = [0.1, 0.1, 0.1], shear_modulus = [1, 1, 1] }\n", (12, 1), "yield_stress", &["not allowed", "elastic"]),
    // Stop conditions.
    wrong("[output]", "[[time.stop_when]]\nset = \"top\"\n[output]", (37, 1), "[[time.stop_when]]", &["[time.stop_when.0] requires one of `reaction_below`, `damage_above` and `condition`"]),
    wrong("[output]", "[[time.stop_when]]\nset = \"tip\"\ndamage_above = 0.9\n[output]", (38, 7), "\"tip\"", &["unknown set `tip`", "did you mean `top`?"]),
    wrong("[output]", "[[time.stop_when]]\nset = \"top\"\nreaction_below = 2\n[output]", (39, 18), "2", &["out of range", "fraction of the largest reaction"]),
    wrong("[output]", "[[time.stop_when]]\nset = \"top\"\ndamage_above = 1\n[output]", (39, 16), "1", &["out of range", "below 1"]),
    wrong("[output]", "[[time.stop_when]]\nset = \"top\"\nreaction_below = 0.1\ndamage_above = 0.9\n[output]", (40, 16), "0.9", &["`reaction_below` and `damage_above` are given together"]),
    // Prescribed motions with jumps.
    wrong("velocity = [0, \"free\"]", "displacement = [1, \"free\"]\nfunction = { kind = \"expression\", expression = \"step(t-1e-6)\" }", (24, 48), "\"step(t-1e-6)\"", &["no derivative in time", "`step(t-1e-6)`", "kind = \"table\""]),
    wrong("velocity = [0, \"free\"]", "displacement = [1, \"free\"]\nfunction = { kind = \"expression\", expression = \"abs(t-1e-6)\" }", (24, 48), "\"abs(t-1e-6)\"", &["no derivative in time", "kind = \"table\""]),
    // Boundaries.
    wrong("[time]", "[[boundary]]\nkind = \"absorbent\"\nside = \"-x\"\n[time]", (34, 8), "\"absorbent\"", &["unknown kind of boundary `absorbent`", "did you mean `absorbing`?"]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-y\"\n[time]", (35, 8), "\"-y\"", &["unknown side `-y`", "\"-x\" and \"+x\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\n[time]", (33, 1), "[[boundary]]", &["[boundary.0] requires `side`"]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\nhistory = \"long\"\n[time]", (36, 11), "\"long\"", &["unknown history `long`", "\"blocked\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\nhistory = \"blocked\"\ntolerance = 1e-9\n[time]", (37, 1), "tolerance", &["not allowed", "\"exponentials\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\nhistory = \"direct\"\nverify = true\n[time]", (37, 1), "verify", &["not allowed", "\"exponentials\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\nhistory = \"exponentials\"\nmethod = \"semi-discrete\"\n[time]", (36, 11), "\"exponentials\"", &["out of range", "\"discrete\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\nmethod = \"exact\"\n[time]", (36, 10), "\"exact\"", &["unknown method `exact`", "\"semi-discrete\""]),
    wrong("[time]", "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\ntolerance = 2\n[time]", (36, 13), "2", &["above 1e-14 and below 1"]),
    wrong("[time]", "[[boundary]]\nkind = \"damping-layer\"\nside = \"+x\"\n[time]", (33, 1), "[[boundary]]", &["[boundary.0] requires `thickness`"]),
    wrong("[time]", "[[boundary]]\nkind = \"damping-layer\"\nside = \"+x\"\nthickness = \"1 mm\"\nreflection = 2\n[time]", (37, 14), "2", &["above 1e-12 and below 1"]),
    wrong("[time]", "[[boundary]]\nkind = \"damping-layer\"\nside = \"+x\"\nthickness = \"1 mm\"\npower = -1\n[time]", (37, 9), "-1", &["from 0 to 10"]),
    wrong("[time]", "[[boundary]]\nkind = \"open\"\n[time]", (33, 1), "[[boundary]]", &["[boundary.0] requires `side`"]),
    wrong("[time]", "[[boundary]]\nkind = \"open\"\nside = \"+z\"\n[time]", (35, 8), "\"+z\"", &["unknown side `+z`", "\"+y\"", "\"all\""]),
    wrong("[time]", "[[boundary]]\nkind = \"open\"\nside = [\"+x\", \"+x\"]\n[time]", (35, 8), "[\"+x\", \"+x\"]", &["each once"]),
    wrong("[time]", "[[boundary]]\nkind = \"open\"\nside = \"+x\"\ncells = 12\nthickness = \"1 mm\"\n[time]", (37, 13), "\"1 mm\"", &["`cells`", "`thickness`"]),
    wrong("[time]", "[[boundary]]\nkind = \"open\"\nside = \"+x\"\nreflection = 0.1\n[time]", (36, 1), "reflection", &["`reflection`"]),
    // Refinement.
    wrong("[material]", "[[body.refine]]\nball = { centre = [0, 0], radius = 1 }\n[material]", (9, 1), "[[body.refine]]", &["[body.refine.0] requires `ratio`"]),
    wrong("[material]", "[[body.refine]]\nratio = 2\n[material]", (9, 1), "[[body.refine]]", &["[body.refine.0] requires one of", "`ball`"]),
    wrong("[material]", "[[body.refine]]\nall = true\nratio = 1\n[material]", (11, 9), "1", &["from 2 to 16"]),
    // Anisotropic spacing.
    wrong("spacing = \"0.25 mm\"", "spacing = [\"0.25 mm\", 0]", (6, 23), "0", &["a positive number"]),
    wrong("spacing = \"0.25 mm\"", "spacing = [\"0.25 mm\"]", (6, 11), "[\"0.25", &["has 1 entry", "a length, or one length per axis"]),
    wrong("spacing = \"0.25 mm\"", "spacing = [\"0.25 mm\", \"0.2 mm\"]\nrefine = [{ all = true, ratio = 2 }]", (7, 1), "refine", &["equal spacings along all axes"]),
    wrong("spacing = \"0.25 mm\"\nplane = \"strain\"", "spacing = [\"0.25 mm\", \"0.2 mm\"]\nplane = \"strain\"\nhole = [{ layer = { side = \"+y\", cells = 1 } }]", (8, 42), "1", &["no uniform spacing"]),
    // Sizes and spacings.
    wrong("size = [\"100 mm\", \"40 mm\"]", "size = [\"100 mm\", \"40 mm\", 1]", (5, 8), "[\"100 mm", &["has 3 entries", "for this number of entries use shape = \"block\""]),
    wrong("size = [\"100 mm\", \"40 mm\"]", "size = [1]", (5, 8), "[1]", &["shape = \"bar\""]),
    // Types of values.
    wrong("size = [\"100 mm\", \"40 mm\"]", "size = 5", (5, 8), "5", &["expected a list with one entry per dimension", "0.25 mm"]),
    wrong("\"0.25 mm\"\nplane", "true\nplane", (6, 11), "true", &["expected a length such as \"0.25 mm\"", "found true or false (`true`)"]),
    wrong("[output]", "allow_unstable = \"yes\"\n[output]", (37, 18), "\"yes\"", &["expected true or false, without quotes, found a string (`yes`)"]),
    wrong("segment = [[", "ends = true\nsegment = [[", (19, 8), "true", &["one of \"closed\", \"open\""]),
    wrong("{ interval = \"0.5 us\" }", "\"often\"", (38, 10), "\"often\"", &["a table, found a string (`often`)"]),
    wrong("title = \"plate\"", "title = 2024-01-01", (1, 9), "2024-01-01", &["a date", "a string in quotes"]),
    // Quantities.
    wrong("\"72 GPa\"", "\"72 GJ\"", (11, 18), "\"72 GJ\"", &["`72 GJ` is not a modulus", "a modulus such as \"72 GPa\" or a plain number in Pa"]),
    wrong("\"72 GPa\"", "\"72 GPA\"", (11, 18), "\"72 GPA\"", &["unknown unit `GPA` in `72 GPA`", "did you mean `GPa`?"]),
    wrong("\"72 GPa\"", "\"stiff\"", (11, 18), "\"stiff\"", &["`stiff` is not a number", "72 GPa"]),
    wrong("\"72 GPa\"", "nan", (11, 18), "nan", &["`nan` is not a number"]),
    wrong("\"72 GPa\"", "-inf", (11, 18), "-inf", &["`-inf` is not a number"]),
    wrong("\"72 GPa\"", "\"-72 GPa\"", (11, 18), "\"-72 GPa\"", &["`-72 GPa` is out of range", "a positive number"]),
    wrong("\"46 us\"", "0", (34, 7), "0", &["`0` is out of range", "positive"]),
    wrong("dt = \"auto\"", "dt = 0.0", (35, 6), "0.0", &["`0.0` is out of range"]),
    wrong("dt = \"auto\"", "dt = \"automatic\"", (35, 6), "\"automatic\"", &["`automatic` is not a number", "or \"auto\""]),
    wrong("dt = \"auto\"", "safety = 1.5", (35, 10), "1.5", &["`1.5` is out of range", "above 0 and at most 1"]),
    wrong("\"0.75 mm\"", "\"0.1 mm\"", (12, 11), "\"0.1 mm\"", &["at least one spacing"]),
    wrong("horizon = \"0.75 mm\"", "horizon_ratio = 0.5", (12, 17), "0.5", &["a number of at least 1"]),
    wrong("{ interval = \"0.5 us\" }", "{ every = 0 }", (38, 20), "0", &["`0` is out of range", "whole number of at least 1"]),
    wrong("{ interval = \"0.5 us\" }", "{ every = 1.5 }", (38, 20), "1.5", &["whole number"]),
    wrong("{ interval = \"0.5 us\" }", "{ interval = 1, every = 2 }", (38, 34), "2", &["`interval` and `every` are given together in [output.fields]", "`count`"]),
    // Vectors.
    wrong("\"40 mm\"]\nspacing", "\"40 mm\", 1]\nspacing", (5, 8), "[\"100 mm\"", &["has 3 entries", "2 entries, one per dimension"]),
    wrong("at = [\"50 mm\", \"20 mm\"]", "at = [1]", (31, 6), "[1]", &["`[1]` has 1 entry", "2 entries"]),
    wrong("traction = [0,", "traction = [0, 0,", (27, 12), "[0, 0,", &["3 entries"]),
    wrong("[0, \"free\"]", "[\"free\", \"free\"]", (23, 12), "[\"free\"", &["all components are free"]),
    wrong("[0, \"free\"]", "[0, \"fre\"]", (23, 16), "\"fre\"", &["`fre` is not a number", "a velocity"]),
    // Words and names.
    wrong("\"plate\"\nsize", "\"plaet\"\nsize", (4, 9), "\"plaet\"", &["unknown shape `plaet`", "did you mean `plate`?", "\"bar\", \"plate\", \"disc\", \"block\", \"cylinder\", \"ball\", \"icosphere\""]),
    wrong("\"strain\"", "\"strian\"", (7, 9), "\"strian\"", &["did you mean `strain`?", "\"stress\" and \"strain\""]),
    wrong("set = \"top\"\nvelocity", "set = \"topp\"\nvelocity", (22, 7), "\"topp\"", &["unknown set `topp`", "did you mean `top`?", "\"all\" and \"top\""]),
    wrong("[sets.top]", "[sets.all]", (15, 7), "all", &["`all` cannot be used", "reserved for the set of all points"]),
    wrong("\"+y\"", "\"+z\"", (16, 18), "\"+z\"", &["unknown side `+z`", "\"-x\", \"+x\", \"-y\" and \"+y\""]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "layer = { side = \"+y\" }", (16, 9), "{ side", &["requires one of `depth` and `cells`"]),
    wrong("layer = {", "all = true\nlayer = {", (17, 9), "{ side", &["`all` and `layer` are given together", "`complement`"]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "cylinder = { centre = [0, 0], radius = 1 }", (16, 1), "cylinder", &["`cylinder` requires a 3D body", "a `ball` is a disc"]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "box = { min = [1, 0], max = [0, 1] }", (16, 29), "[0, 1]", &["not below the lower corner"]),
    wrong("layer = { side = \"+y\", depth = \"0.25 mm\" }", "polygon = { corners = [[0, 0], [1, 1]] }", (16, 23), "[[0, 0]", &["at least 3 corners"]),
    wrong("[time]", "[[activation]]\nset = \"top\"\n[time]", (33, 1), "[[activation]]", &["active_from", "path"]),
    wrong("[time]", "[[activation]]\nset = \"tip\"\nactive_from = 1\n[time]", (34, 7), "\"tip\"", &["unknown set `tip`"]),
    wrong("[time]", "[[activation]]\npath = \"scan.txt\"\nradius = 0\n[time]", (35, 10), "0", &["a positive number"]),
    wrong("[time]", "[[activation]]\nactive_from = { expression = \"t\" }\n[time]", (34, 30), "\"t\"", &["unknown name `t`", "x, y"]),
    wrong("[time]", "[[probe]]\nname = \"middle\"\nset = \"all\"\n[time]", (34, 8), "\"middle\"", &["the name `middle` cannot be used", "another probe has this name"]),
    wrong("fields =", "picture = [{ field = \"Displacement_z\" }]\nfields =", (38, 22), "\"Displacement_z\"", &["unknown field `Displacement_z`", "\"Displacement_x\""]),
    wrong("{ interval = \"0.5 us\" }", "{ every = 2, names = [\"Stress_xx\"] }", (38, 32), "\"Stress_xx\"", &["whole fields"]),
    wrong("{ interval = \"0.5 us\" }", "{ every = 2, names = [\"Damage\", \"Velocity\", \"Damage\"] }", (38, 54), "\"Damage\"", &["each field once"]),
    wrong("fields =", "history = { every = 1, extremes = [\"Damage\", \"Damage\"] }\nfields =", (38, 46), "\"Damage\"", &["each field once"]),
    wrong("fields =", "history = { every = 1, extremes = [\"Demage\"] }\nfields =", (38, 36), "\"Demage\"", &["did you mean `Damage`?"]),
    wrong("fields =", "picture = [{ field = \"Stress_zz\" }]\nfields =", (38, 22), "\"Stress_zz\"", &["unknown field `Stress_zz`", "did you mean `Stress_xx`?"]),
    wrong("fields =", "picture = [{ field = \"Damage\", range = [1, 0] }]\nfields =", (38, 40), "[1, 0]", &["the first smaller"]),
    wrong("fields =", "picture = [{ field = \"Damage\", animation = 12 }]\nfields =", (38, 44), "12", &["true or false"]),
    wrong("fields =", "picture = [{ field = \"Damage\", edges = 1 }]\nfields =", (38, 40), "1", &["true or false"]),
    // Errors of the library.
    wrong("fracture_energy", "poisson_ratio = 0.3\nfracture_energy", (13, 17), "0.3", &["Poisson's ratio 0.3", "plane strain", "0.25"]),
    wrong("fracture_energy", "influence = { function = \"power\", exponent = -9 }\nfracture_energy", (13, 13), "{ function", &["exponent -9", "allowed: more than"]),
    wrong("fracture_energy", "influence = { function = \"tuned\", decay = 0 }\nfracture_energy", (13, 43), "0", &["`0` is out of range", "rad per spacing (usual: 1), or \"none\""]),
    wrong("[\"50 mm\", \"20 mm\"]]", "[0, 0.02]]", (18, 1), "[[crack]]", &["no usable surface"]),
    wrong("\"2440 kg/m3\"", "\"2440 kg/m3", (10, 22), "", &["not valid TOML"]),
    wrong("shape = \"plate\"", "shape = \"plate\"\nshape = \"bar\"", (5, 1), "shape", &["duplicate key"]),
];

#[rustfmt::skip]
const WRONG_SURFACES: &[Wrong] = &[
    wrong("\"icosphere\"", "\"icosfere\"", (2, 9), "\"icosfere\"", &["unknown shape", "did you mean `icosphere`?", "torus"]),
    wrong("radius = 1\n", "radius = 0\n", (4, 10), "0", &["a positive number"]),
    wrong("level = 2", "level = 30", (1, 1), "[body]", &["level of the icosphere"]),
    wrong("radius = 1\n", "radius = 1\nspacing = 1\n", (5, 1), "spacing", &["`spacing` is not allowed in [body]", "it requires shape = \"bar\", \"plate\""]),
    wrong("radius = 1\n", "radius = 1\nlength = 1\n", (5, 1), "length", &["`length` is not allowed in [body]", "\"bar\" or \"capsule\""]),
    wrong("radius = 1\n", "radius = 1\nareas = \"barycentre\"\n", (5, 9), "\"barycentre\"", &["did you mean `barycentric`?"]),
    wrong("\"edge\"", "\"edges\"", (7, 10), "\"edges\"", &["exact, edge, edge-diagonals, steiner(1)"]),
    wrong("method = \"edge\"", "method = \"edge\"\nball = \"euclidean\"", (8, 8), "\"euclidean\"", &["did you mean `euclid`?", "\"geodesic\""]),
    wrong("alpha = 0.5", "alpha = 1", (12, 9), "1", &["above 0 and below 1"]),
    wrong("alpha = 0.5", "alpha = 0", (12, 9), "0", &["above 0 and below 1"]),
    wrong("alpha = 0.5\n", "", (9, 1), "[material]", &["[material] requires `alpha`"]),
    wrong("p = 3", "p = 1.5", (13, 5), "1.5", &["at least 2"]),
    wrong("horizon = 0.8", "horizon = 0.01", (14, 11), "0.01", &["mean edge length"]),
    wrong("\"power\"", "\"linear\"", (10, 9), "\"linear\"", &["unknown model", "power"]),
    wrong("horizon = 0.8", "horizon = 0.8\nself_interaction = true", (15, 20), "true", &["p = 2"]),
    wrong("horizon = 0.8", "horizon = 0.8\nbond = \"rod\"", (15, 8), "\"rod\"", &["\"displacement\"", "\"chord\""]),
    wrong("horizon = 0.8", "horizon = 0.8\nyoungs_modulus = 1", (15, 1), "youngs_modulus", &["unknown key"]),
    wrong("\"1 kg/m2\"", "\"1 kg/m3\"", (11, 11), "\"1 kg/m3\"", &["a mass per area"]),
    wrong("radius = 0.1, seed", "radius = -1, seed", (17, 30), "-1", &["a positive number"]),
    wrong("random_velocity = { radius = 0.1, seed = 3 }", "file = \"u.txt\"\nvelocity = [0, 0, 1]", (18, 1), "velocity", &["`velocity` is not allowed", "`file` contains both displacement and velocity"]),
    wrong("random_velocity = { radius = 0.1, seed = 3 }", "file = 3", (17, 8), "3", &["a string in quotes"]),
    wrong("random_velocity = { radius = 0.1, seed = 3 }", "set = \"all\"", (16, 1), "[[initial]]", &["requires one of `displacement`, `velocity`, `random_velocity` and `file`"]),
    wrong("seed = 3", "seed = 3, generator = \"mt19937\"", (17, 57), "\"mt19937\"", &["splitmix64"]),
    wrong("[[load]]", "[[crack]]\nsection = 1\n[[load]]", (19, 3), "crack", &["pre-cracks in 2-manifolds"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\nbeta = 0.6", (27, 8), "0.6", &["from 0 to 0.5"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\ngamma = 0.4", (27, 9), "0.4", &["from 0.5 to 1"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\ndepth = 3", (27, 1), "depth", &["anderson"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\nsolver = \"anderson\"\ndepth = 9", (28, 9), "9", &["from 1 to 8"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\nbeta = 0\nsolver = \"newton-krylov\"", (27, 8), "0", &["above 0"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\nnorm = \"l1\"", (27, 8), "\"l1\"", &["\"l2\"", "area-weighted"]),
    wrong("scheme = \"newmark\"", "scheme = \"newmark\"\niterations = 0", (27, 14), "0", &["from 1 to 1000000"]),
    wrong("scheme = \"newmark\"", "scheme = \"rk4\"\nsolver = \"anderson\"", (27, 1), "solver", &["newmark"]),
    wrong("scheme = \"newmark\"", "scheme = \"discrete-gradient\"\ntolerance = 1", (27, 13), "1", &["1e-14"]),
];

fn rejection(text: &str) -> DeckError {
    match Deck::parse(text, "plate.toml", &[]) {
        Ok(_) => panic!("this invalid deck is accepted:\n{text}"),
        Err(error) => error,
    }
}

#[test]
fn the_valid_deck_is_accepted() {
    Deck::parse(RIGHT, "plate.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn errors_report_location_and_advice() {
    explained(RIGHT, WRONG, &|text| {
        Deck::parse(text, "plate.toml", &[]).map(|_| ())
    });
}

#[test]
fn errors_of_surfaces_report_location_and_advice() {
    let read = |text: &str| Deck::parse(text, "plate.toml", &[]).map(|_| ());
    read(SURFACE).unwrap_or_else(|error| panic!("{error}"));
    explained(SURFACE, WRONG_SURFACES, &read);
}

#[test]
fn many_problems_are_found_quickly_and_counted() {
    let began = std::time::Instant::now();
    let mut keys: String = (0..40_000)
        .map(|k| format!("unknown_{k} = {k}\n"))
        .collect();
    keys += RIGHT;
    let error = rejection(&keys);
    assert_eq!(error.problems().len(), 40_000);
    let message = error.to_string();
    assert!(message.ends_with("and 39950 more"), "{message}");
    let loads: String = (0..40_000)
        .map(|k| format!("[[load]]\nset = \"no_{k}\"\nbody_force = [1, 0]\n"))
        .collect();
    let error = rejection(&format!("{RIGHT}{loads}"));
    assert_eq!(error.problems().len(), 40_000);
    assert!(began.elapsed().as_secs() < 20, "{:?}", began.elapsed());
}

#[test]
fn long_texts_are_cut_in_messages() {
    let long = "x+".repeat(500_000);
    for (replace, by) in [
        (
            "traction = [0, \"12 MPa\"]",
            format!("traction = [0, {{ expression = \"{long}\" }}]"),
        ),
        ("\"strain\"", format!("\"{long}\"")),
        (
            "set = \"top\"\nvelocity",
            format!("set = \"{long}\"\nvelocity"),
        ),
        ("title =", format!("\"{long}\" =")),
        ("\"0.75 mm\"", format!("\"1 {}\"", "m".repeat(100_000))),
    ] {
        let message = rejection(&RIGHT.replace(replace, &by)).to_string();
        assert!(
            message.len() < 2000,
            "{} characters: {:.300}",
            message.len(),
            message
        );
    }
}

#[test]
fn all_problems_are_found_at_once_and_in_order() {
    let text = RIGHT
        .replace("spacing =", "spaceing =")
        .replace("72 GPa", "72 Gpa")
        .replace("\"free\"", "\"fre\"")
        .replace("dt = \"auto\"", "dt = -1\nscheme = \"euler\"");
    let error = rejection(&text);
    let lines: Vec<usize> = error
        .problems()
        .iter()
        .map(|problem| problem.location().line())
        .collect();
    assert_eq!(lines, [6, 11, 23, 35, 36], "{error}");
    assert!(error.to_string().starts_with("5 problems"));
    assert_eq!(error.related().unwrap().count(), 5);
    assert!(error.labels().is_none());
}

#[test]
fn a_single_problem_is_a_diagnostic_with_its_text() {
    let error = rejection(&RIGHT.replace("\"strain\"", "\"strian\""));
    let [problem] = error.problems() else {
        panic!("{error}")
    };
    assert!(matches!(problem.subject(), Fault::UnknownWord { .. }));
    for diagnostic in [&error as &dyn Diagnostic, problem] {
        let label = diagnostic.labels().unwrap().next().unwrap();
        assert_eq!(label.len(), "\"strian\"".len());
        let text = diagnostic
            .source_code()
            .unwrap()
            .read_span(label.inner(), 0, 0)
            .unwrap();
        assert_eq!(text.name(), Some("plate.toml"));
        assert!(
            std::str::from_utf8(text.data())
                .unwrap()
                .contains("\"strian\"")
        );
        assert_eq!((text.line(), text.column()), (6, 8));
    }
    let help = problem.help().unwrap().to_string();
    assert_eq!(
        help,
        "did you mean `strain`? allowed: \"stress\" and \"strain\""
    );
    assert_eq!(problem.to_string(), "unknown plane state `strian`");
}

/// Fragments of decks for mutations.
fn piece() -> impl Strategy<Value = String> {
    prop_oneof![
        "[\\[\\]{}=.,\"'#\n a-zA-Z0-9µ-]{0,12}",
        proptest::sample::select(COMPLETE.lines().map(String::from).collect::<Vec<_>>()),
        proptest::sample::select(vec![
            "inf",
            "nan",
            "-1",
            "0",
            "1e400",
            "\"\"",
            "\"free\"",
            "\"open\"",
            "[]",
            "{}",
            "[[]]",
            "true",
            "\"1 mm\"",
            "99999999999999999999",
            "1979-05-27",
            "\"disc\"",
            "\"bar\"",
            "\"block\"",
        ])
        .prop_map(String::from),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn mutated_decks_never_panic(
        cuts in proptest::collection::vec((0.0..1.0f64, 0usize..40, piece()), 1..4),
        lines in any::<bool>(),
    ) {
        let mut text = COMPLETE.to_owned();
        for (position, length, piece) in cuts {
            let boundary = |mut at: usize, text: &str| {
                at = at.min(text.len());
                while !text.is_char_boundary(at) {
                    at -= 1;
                }
                at
            };
            let mut start = boundary((position * text.len() as f64) as usize, &text);
            let mut end = boundary(start + length, &text);
            if lines {
                // Replace the value of a line, which most often leaves valid TOML.
                start = text[start..].find("= ").map_or(start, |at| start + at + 2);
                end = text[start..].find('\n').map_or(text.len(), |at| start + at);
            }
            text.replace_range(start..end, &piece);
        }
        if let Err(error) = Deck::parse(&text, "mutated.toml", &[]) {
            prop_assert!(!error.problems().is_empty());
            for problem in error.problems() {
                let at = problem.location();
                prop_assert!(at.line() >= 1 && at.line() <= text.matches('\n').count() + 1);
                prop_assert!(!problem.to_string().is_empty());
            }
        }
    }

    #[test]
    fn arbitrary_text_and_overrides_never_panic(text in ".{0,80}", path in "[a-z0-9.]{0,20}", value in ".{0,20}") {
        let _ = Deck::parse(&text, "any.toml", &[]);
        let _ = Deck::parse(COMPLETE, "any.toml", &[format!("{path}={value}"), text]);
    }

    #[test]
    fn arbitrary_values_never_panic(
        key in proptest::sample::select(vec![
            "body", "body.shape", "body.size.0", "body.hole.1.intersection.0.box.min", "material.influence.table.1.0",
            "material.damage", "sets.top", "crack.0.segment", "crack.1.ends", "initial.0.velocity", "constraint.0.velocity.1",
            "load.1.area", "probe.0.at", "time.dt", "output.picture.1.range", "output.fields", "checkpoint",
        ]),
        value in piece(),
    ) {
        if let Err(error) = Deck::parse(COMPLETE, "deck.toml", &[format!("{key}={value}")]) {
            prop_assert!(!error.problems().is_empty());
        }
    }
}

#[test]
fn a_horizon_ratio_needs_a_known_spacing() {
    let mesh =
        "shape = \"mesh\"\nfile = \"a.msh\"\nunit = \"mm\"\ndimension = 2\nplane = \"strain\"";
    let deck = |more: &str| {
        let text = RIGHT.replace(BODY, &format!("{mesh}{more}"));
        let text = text.replace("horizon = \"0.75 mm\"", "horizon_ratio = 3");
        Deck::parse(&text, "deck.toml", &[])
    };
    let error = deck("").unwrap_err().to_string();
    assert!(error.contains("deck.toml:13:1"), "{error}");
    assert!(error.contains("`horizon_ratio` is not allowed"), "{error}");
    assert!(error.contains("set `horizon` to a length"), "{error}");
    assert!(deck("\nspacing = \"0.25 mm\"").is_ok());
}
