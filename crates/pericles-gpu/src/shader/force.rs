//! The shaders of the forces of a stencil: forces of all nodes, and failure of bonds.
//!
//! The passes over bonds are written out; the energy that a point of a solid loses with its bonds is computed by a loop over the
//! offsets, because few points need it.

use std::fmt::Write as _;

use pericles::operator::StencilLaw;

use crate::body::{Body, Bond, Critical};
use crate::precision::Precision;

/// Bonds whose dissipated energy exceeds this multiple of their energy at the critical stretch, or is negative, need a shorter
/// step: the processor corrects the motion of their ends.
const RESOLVED: f64 = 4.0;

const AXES: [char; 3] = ['x', 'y', 'z'];

const HEAD: &str = "    let place = place_of(id);
    if (place == NOWHERE) {
        return;
    }
    if ((lists[FLAGS + place] & OWN) == 0u || atomicLoad(&control[0]) < now.number) {
        return;
    }
    let i = MARGIN + place;
";

/// Appends the shader `force`, and for solids the shader `dilate` of the pass over points.
pub(super) fn write(text: &mut String, body: &Body, precision: Precision) {
    let writer = Writer { body, precision };
    writer.kinematics(text);
    if body.breaks() {
        writer.fails(text);
        match body.is_solid() {
            true => writer.lose_of_point(text),
            false => writer.lose_bond(text),
        }
    }
    if body.is_solid() {
        writer.dilate(text);
    }
    writer.force(text);
}

struct Writer<'a> {
    body: &'a Body,
    precision: Precision,
}

impl Writer<'_> {
    fn number(&self, value: f64) -> String {
        self.precision.literal(value)
    }

    fn axes(&self) -> impl Iterator<Item = (usize, char)> + Clone {
        AXES[..self.body.dimension].iter().copied().enumerate()
    }

    /// The sum over the axes of a text in which `@` stands for the axis.
    fn sum(&self, term: &str) -> String {
        let terms = self
            .axes()
            .map(|(_, axis)| term.replace('@', &axis.to_string()));
        terms.collect::<Vec<_>>().join(" + ")
    }

    /// A text in which `@` stands for the axis, for each axis.
    fn each(&self, text: &str) -> String {
        let texts = self.axes().map(|(c, axis)| {
            text.replace('@', &axis.to_string())
                .replace('#', &c.to_string())
        });
        texts.collect()
    }

    fn is_linear(&self) -> bool {
        self.body.law == StencilLaw::Linear
    }

    /// The functions `pull`, φ, and `stretch`, ψ, of the strain t of a bond.
    fn kinematics(&self, text: &mut String) {
        let mut function = |name: &str, coefficients: &[f64; 7], exact: &str| {
            let number = |value| self.number(value);
            if self.is_linear() {
                let _ = writeln!(text, "fn {name}(t: real) -> real {{\n    return t;\n}}");
                return;
            }
            let mut polynomial = number(coefficients[6]);
            for coefficient in coefficients[..6].iter().rev() {
                polynomial = format!("({polynomial} * t + {})", number(*coefficient));
            }
            let exact = exact.replace('1', &number(1.0));
            let _ = writeln!(
                text,
                "fn {name}(t: real) -> real {{\n    if (abs(t) > {}) {{\n        return t / {exact};\n    }}\n    return {polynomial} * t;\n}}",
                number(StencilLaw::REACH)
            );
        };
        function("pull", &StencilLaw::PHI, "((1 + t) + sqrt(1 + t))");
        if self.body.is_solid() {
            function("stretch_of", &StencilLaw::PSI, "(1 + sqrt(1 + t))");
        }
    }

    /// The arguments that are vectors of a bond: ξ (`x@`) and η (`@`).
    fn vectors(&self) -> String {
        self.each(", x@: real, @: real")
    }

    /// The function `fails`: the critical stretch of a bond if it exceeds it, else a negative number.
    fn fails(&self, text: &mut String) {
        let _ = write!(
            text,
            "fn fails(place: u32, other: u32, square: real{}) -> real {{
    let here = lists[FLAGS + place];
    let there = lists[FLAGS + other];
    if (((here | there) & HELD) != 0u) {{
        return -ONE;
    }}
",
            self.vectors()
        );
        let stretch = match self.body.critical {
            Critical::Uniform(stretch) => self.number(stretch),
            Critical::Pairs { scatters, .. } => {
                let table =
                    "numbers[STRETCH + (here >> MATERIAL) * MATERIALS + (there >> MATERIAL)]";
                match scatters {
                    false => table.to_owned(),
                    true => format!(
                        "{table} * (HALF * (numbers[STRENGTH + place] + numbers[STRENGTH + other]))"
                    ),
                }
            }
        };
        let (measure, threshold) = match self.is_linear() {
            true => (self.sum("x@ * @"), "stretch".to_owned()),
            false => (
                self.sum("@ * (x@ + x@ + @)"),
                format!("(stretch * ({} + stretch))", self.number(2.0)),
            ),
        };
        let _ = writeln!(
            text,
            "    let stretch = {stretch};\n    if ({measure} > {threshold} * square) {{\n        return stretch;\n    }}\n    return -ONE;\n}}"
        );
    }

    /// Declares the relative mean velocity `v@` of the ends i and j of a bond.
    fn velocities(&self) -> String {
        self.each("    let v@ = difference(v[#u * PITCH + j], v[#u * PITCH + i]);\n")
    }

    /// The function `lose`: whether a bond breaks at the end of the step; half of the energy that it dissipates is recorded.
    fn lose_bond(&self, text: &mut String) {
        let arguments = self.each(", x@, @");
        let _ = write!(
            text,
            "fn lose(place: u32, i: u32, other: u32, j: u32, square: real, stiffness: real{}) -> bool {{
    let stretch = fails(place, other, square{arguments});
    if (stretch < ZERO) {{
        return false;
    }}
{}",
            self.vectors(),
            self.velocities()
        );
        let energy = match self.is_linear() {
            true => format!(
                "    let measure = {};\n    let energy = HALF * measure * measure / square;\n    let power = measure / square * ({});\n",
                self.sum("x@ * @"),
                self.sum("x@ * v@")
            ),
            false => format!(
                "    let measure = {};\n    let reference = sqrt(square);\n    let deformed = sqrt(square + measure);\n    let elongation = measure / (deformed + reference);\n    let energy = HALF * elongation * elongation;\n    let power = elongation / deformed * ({});\n",
                self.sum("@ * (x@ + x@ + @)"),
                self.sum("(x@ + @) * v@")
            ),
        };
        text.push_str(&energy);
        let _ = writeln!(
            text,
            "    let dissipated = energy - HALF * rounded(length_of(now.number)) * power;
    let critical = HALF * stretch * stretch * square;
    if (dissipated < ZERO || dissipated > {} * critical) {{
        atomicMin(&control[0], now.number);
    }}
    lost[place] += HALF * stiffness * dissipated;
    return true;
}}",
            self.number(RESOLVED)
        );
    }

    /// The function `lose_of_point`: the energy that a point of a solid dissipates with the bonds that break at the end of the
    /// step, by the rule of the loops of the processor (`Loss`): sums over all bonds and over the broken ones at the end of the step
    /// (index 0) and at its start (index 1).
    fn lose_of_point(&self, text: &mut String) {
        let words = self.body.words();
        let (stretch, contraction, along, before_along) = match self.is_linear() {
            true => ("t", "ONE", self.sum("x@ * v@"), self.sum("x@ * v@")),
            false => (
                "t / (ONE + sqrt(ONE + t))",
                "(ONE / sqrt(ONE + t))",
                self.sum("(x@ + @) * v@"),
                self.sum("(x@ + b@) * v@"),
            ),
        };
        let measure = |eta: &str| match self.is_linear() {
            true => self.sum("x@ * @").replace("* ", &format!("* {eta}")),
            false => {
                let term = format!("{eta}@ * (x@ + x@ + {eta}@)");
                self.sum(&term)
            }
        };
        let turned = self.sum("(x@ + @) * (x@ + b@)");
        let vectors = self.each("        let x@ = numbers[OFFSETS + 4u * k + #u];\n        let @ = difference(u[#u * PITCH + j], u[#u * PITCH + i]);\n        let v@ = difference(v[#u * PITCH + j], v[#u * PITCH + i]);\n");
        let before = self.each("        let b@ = @ - dt * v@;\n");
        let at = |index: u32, eta: &str, along: &str| {
            format!(
                "        {{
            let t = ({}) / square;
            let psi = {stretch};
            let rate = ({along}) * {contraction} / square;
            whole[{index}] += weight * psi;
            whole_rate[{index}] += weight * rate;
            psis[{index}] = psi;
            if (broken) {{
                part[{index}] += weight * psi;
                part_rate[{index}] += weight * rate;
                squares[{index}] += weight * psi * psi;
                square_rate[{index}] += weight * psi * rate;
            }}
        }}
",
                measure(eta)
            )
        };
        let (end, start) = (at(0, "", &along), at(1, "b", &before_along));
        let square = self.sum("x@ * x@");
        let arguments = self.each(", x@, @");
        let _ = write!(
            text,
            "fn lose_of_point(place: u32, i: u32, left: array<u32, {words}>, gone: array<u32, {words}>) {{
    var intact = left;
    var leaving = gone;
    let dt = rounded(length_of(now.number));
    var whole = array<real, 2>();
    var whole_rate = array<real, 2>();
    var part = array<real, 2>();
    var part_rate = array<real, 2>();
    var squares = array<real, 2>();
    var square_rate = array<real, 2>();
    var psis = array<real, 2>();
    // Weights of the broken bonds, and their fractions of the step.
    var share = ZERO;
    var shares = ZERO;
    var turned = false;
    for (var k = 0u; k < BONDS; k++) {{
        let bit = 1u << (k % 32u);
        let broken = (leaving[k / 32u] & bit) != 0u;
        if (!broken && (intact[k / 32u] & bit) == 0u) {{
            continue;
        }}
        let j = i + lists[SHIFTS + k];
{vectors}{before}        let square = {square};
        let weight = numbers[OFFSETS + 4u * k + 3u] * square;
{end}{start}        if (broken) {{
            let critical = fails(place, place + lists[SHIFTS + k], square{arguments});
            let crossing = clamp((critical - psis[1]) / (psis[0] - psis[1]), ZERO, ONE);
            share += weight * psis[0] * psis[0];
            shares += weight * psis[0] * psis[0] * crossing;
            turned = turned || ({turned}) < ZERO;
        }}
    }}
    var energy = array<real, 2>();
    var power = array<real, 2>();
    for (var k = 0u; k < 2u; k++) {{
        let factor = numbers[DILATATION + place];
        let theta = factor * whole[k];
        let theta_rate = factor * whole_rate[k];
        let loss = factor * part[k];
        let loss_rate = factor * part_rate[k];
        let rest = theta - loss;
        let bulk = numbers[BULK + place];
        let stiffness = numbers[STIFFNESS + place];
        energy[k] = HALF * bulk * loss * (theta + rest) + HALF * stiffness * squares[k];
        power[k] = bulk * (loss_rate * rest + theta_rate * loss) + stiffness * square_rate[k];
    }}
    let dissipated = energy[0] - HALF * dt * power[0];
    var back = -HALF;
    if (share > ZERO) {{
        back = shares / share - ONE;
    }}
    let slope = dt * power[0];
    let limit = energy[0] + back * (slope + back * (energy[1] - energy[0] + slope));
    if (turned || limit < ZERO || dissipated < ZERO || dissipated > {} * limit) {{
        atomicMin(&control[0], now.number);
    }}
    lost[place] += {}dissipated;
}}
",
            self.number(RESOLVED),
            self.density()
        );
    }

    fn density(&self) -> &'static str {
        match self.body.has_densities {
            true => "numbers[DENSITY + place] * ",
            false => "",
        }
    }

    /// The start of a pass over bonds: name, and the displacement of the point.
    fn begin(&self, text: &mut String, name: &str) {
        let _ = write!(
            text,
            "@compute @workgroup_size(GROUP_X, GROUP_Y, GROUP_Z)\nfn {name}(@builtin(global_invocation_id) id: vec3<u32>) {{\n{HEAD}{}",
            self.each("    let u@ = u[#u * PITCH + i];\n")
        );
    }

    /// The pass over points of a solid: breaks bonds and computes p = (A/m) θ.
    fn dilate(&self, text: &mut String) {
        let body = self.body;
        self.begin(text, "dilate");
        text.push_str("    var extension = ZERO;\n");
        let words = body.words();
        if body.breaks() {
            let _ = writeln!(
                text,
                "    var left = array<u32, {words}>();\n    var gone = array<u32, {words}>();\n    var any = 0u;"
            );
        }
        for word in 0..words {
            let _ = writeln!(text, "    var m{word} = bits[{word}u * PLACES + place];");
            if body.breaks() {
                let _ = writeln!(text, "    left[{word}] = m{word};");
            }
            let bonds = body.bonds.iter().enumerate();
            for (k, bond) in bonds.skip(32 * word).take(32) {
                let bit = 1u32 << (k % 32);
                self.ends(text, bond);
                let _ = writeln!(text, "        var on = (m{word} & {bit}u) != 0u;");
                if body.breaks() {
                    let _ = writeln!(
                        text,
                        "        if (on && q > {}) {{\n            if (fails(place, {}, {}{}) >= ZERO) {{\n                m{word} &= {}u;\n                on = false;\n            }}\n        }}",
                        self.number(body.smallest_threshold() * bond.square),
                        beside("place", bond),
                        self.number(bond.square),
                        self.arguments(bond),
                        !bit
                    );
                }
                let _ = writeln!(
                    text,
                    "        extension += select(ZERO, {} * stretch_of(q * {}), on);\n    }}",
                    self.number(bond.stiffness * bond.square),
                    self.number(bond.inverse_square)
                );
            }
            if body.breaks() {
                let _ = writeln!(
                    text,
                    "    gone[{word}] = left[{word}] & ~m{word};\n    any |= gone[{word}];\n    if (gone[{word}] != 0u) {{\n        bits[{word}u * PLACES + place] = m{word};\n    }}"
                );
            }
        }
        if body.breaks() {
            text.push_str(
                "    if (any != 0u) {\n        lose_of_point(place, i, left, gone);\n    }\n",
            );
        }
        text.push_str("    pressures[i] = numbers[PRESSURE + place] * (numbers[DILATATION + place] * extension);\n}\n");
    }

    /// The constant ξ and the variable η of a bond as arguments.
    fn arguments(&self, bond: &Bond) -> String {
        let vectors = self
            .axes()
            .map(|(c, axis)| format!(", {}, {axis}", self.number(bond.xi[c])));
        vectors.collect()
    }

    /// Begins the block of a bond: its other end j, η and the measure q of its strain.
    fn ends(&self, text: &mut String, bond: &Bond) {
        let _ = writeln!(text, "    {{\n        let j = {};", beside("i", bond));
        text.push_str(&self.each("        let @ = difference(u[#u * PITCH + j], u@);\n"));
        let growth = self.axes().map(|(c, axis)| match self.is_linear() {
            true => format!("{} * {axis}", self.number(bond.xi[c])),
            false => format!("{axis} * ({} + {axis})", self.number(2.0 * bond.xi[c])),
        });
        let _ = writeln!(
            text,
            "        let q = {};",
            growth.collect::<Vec<_>>().join(" + ")
        );
    }

    /// The forces of all points; of bond-based materials also the failure of bonds.
    fn force(&self, text: &mut String) {
        let body = self.body;
        self.begin(text, "force");
        text.push_str(&self.each("    var f@ = ZERO;\n"));
        if body.has_factors() {
            text.push_str("    let row = lists[FACTOR_ROW + place / 8u];\n    let factors = FACTORS + row * FACTOR_LENGTH + place % 8u;\n");
        }
        if body.is_solid() {
            text.push_str("    let pressure = pressures[i];\n    let stiffness = numbers[STIFFNESS + place];\n");
        }
        let breaks = body.breaks() && !body.is_solid();
        for word in 0..body.words() {
            let _ = writeln!(text, "    var m{word} = bits[{word}u * PLACES + place];");
            if breaks {
                let _ = writeln!(text, "    let old{word} = m{word};");
            }
            let bonds = body.bonds.iter().enumerate();
            for (k, bond) in bonds.skip(32 * word).take(32) {
                self.bond(text, word, k, bond);
            }
            if breaks {
                let _ = writeln!(
                    text,
                    "    if (m{word} != old{word}) {{\n        bits[{word}u * PLACES + place] = m{word};\n    }}"
                );
            }
        }
        text.push_str(&self.each(&format!("    a[#u * PITCH + i] = {}f@;\n", self.density())));
        text.push_str("}\n");
    }

    fn bond(&self, text: &mut String, word: usize, k: usize, bond: &Bond) {
        let body = self.body;
        let bit = 1u32 << (k % 32);
        self.ends(text, bond);
        let mut stiffness = self.number(bond.stiffness);
        if body.has_factors() {
            stiffness = format!("{stiffness} * numbers[factors + {}u]", 8 * k);
        }
        let _ = writeln!(text, "        var on = (m{word} & {bit}u) != 0u;");
        let t = format!("q * {}", self.number(bond.inverse_square));
        let pull = match body.is_solid() {
            false => format!("pull({t})"),
            true => {
                let other = beside("place", bond);
                let _ = writeln!(
                    text,
                    "        let p = pressure + pressures[j];\n        let s = stiffness + numbers[STIFFNESS + {other}];"
                );
                match self.is_linear() {
                    true => format!("(p + {t} * s)"),
                    false => format!("(p + pull({t}) * (s - p))"),
                }
            }
        };
        if body.breaks() && !body.is_solid() {
            let _ = writeln!(
                text,
                "        if (on && q > {}) {{\n            if (lose(place, i, {}, j, {}, {}{stiffness}{})) {{\n                m{word} &= {}u;\n                on = false;\n            }}\n        }}",
                self.number(body.smallest_threshold() * bond.square),
                beside("place", bond),
                self.number(bond.square),
                self.density(),
                self.arguments(bond),
                !bit
            );
        }
        let _ = writeln!(
            text,
            "        let f = select(ZERO, {stiffness} * {pull}, on);"
        );
        for (c, axis) in self.axes() {
            let xi = self.number(bond.xi[c]);
            let along = match self.is_linear() {
                true => xi,
                false => format!("({xi} + {axis})"),
            };
            let _ = writeln!(text, "        f{axis} += f * {along};");
        }
        text.push_str("    }\n");
    }
}

/// The place of the neighbour of a bond.
fn beside(from: &str, bond: &Bond) -> String {
    match bond.shift {
        shift if shift < 0 => format!("{from} - {}u", -shift),
        shift => format!("{from} + {shift}u"),
    }
}
