//! The shader of the forces of a stencil: forces of all nodes, and failure of bonds.

use std::fmt::Write as _;

use pericles::operator::StencilLaw;

use crate::body::{Body, Bond, Critical};
use crate::precision::Precision;

/// Coefficients of φ(t)/t = 1/((1+t) + √(1+t)) in ascending order: the polynomial of the loops of the processor, whose relative
/// error is below 1e-14 for |t| ≤ 0.02.
const PHI: [f64; 7] = [
    0.5,
    -0.3750000000013755,
    0.3125000000012991,
    -0.27343747249067285,
    0.2460937240188067,
    -0.22572346562446355,
    0.20960254454644783,
];
/// Largest |t| of the polynomial.
const REACH: f64 = 0.02;
/// Bonds whose dissipated energy exceeds this multiple of their energy at the critical stretch, or is negative, need a shorter
/// step: the processor corrects the motion of their ends.
const RESOLVED: f64 = 4.0;

const AXES: [char; 3] = ['x', 'y', 'z'];

/// Appends the shader `force`.
pub(super) fn write(text: &mut String, body: &Body, precision: Precision) {
    let writer = Writer { body, precision };
    writer.pull(text);
    if body.breaks() {
        writer.lose(text);
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

    /// The pull of a bond with the strain t relative to its stiffness.
    fn pull(&self, text: &mut String) {
        let number = |value| self.number(value);
        match self.body.law {
            StencilLaw::Linear => text.push_str("fn pull(t: real) -> real {\n    return t;\n}\n"),
            StencilLaw::BondStretch => {
                let mut polynomial = number(PHI[6]);
                for coefficient in PHI[..6].iter().rev() {
                    polynomial = format!("({polynomial} * t + {})", number(*coefficient));
                }
                let (one, reach) = (number(1.0), number(REACH));
                let _ = write!(
                    text,
                    "fn pull(t: real) -> real {{\n    if (abs(t) > {reach}) {{\n        return t / (({one} + t) + sqrt({one} + t));\n    }}\n    return {polynomial} * t;\n}}\n"
                );
            }
        }
    }

    /// Decides whether a bond breaks at the end of the step, and records half of the energy that it dissipates.
    fn lose(&self, text: &mut String) {
        let vectors: String = self
            .axes()
            .map(|(_, axis)| format!(", x{axis}: real, {axis}: real"))
            .collect();
        let _ = write!(
            text,
            "fn lose(place: u32, i: u32, other: u32, j: u32, square: real, stiffness: real{vectors}) -> bool {{\n"
        );
        text.push_str("    let here = lists[FLAGS + place];\n    let there = lists[FLAGS + other];\n    if (((here | there) & HELD) != 0u) {\n        return false;\n    }\n");
        let stretch = match self.body.critical {
            Critical::Uniform(stretch) => self.number(stretch),
            Critical::Pairs { scatters, .. } => {
                let table =
                    "numbers[STRETCH + (here >> MATERIAL) * MATERIALS + (there >> MATERIAL)]";
                match scatters {
                    false => table.to_owned(),
                    true => format!(
                        "{table} * ({} * (numbers[STRENGTH + place] + numbers[STRENGTH + other]))",
                        self.number(0.5)
                    ),
                }
            }
        };
        let dot = |a: &str, b: &str| {
            let terms = self.axes().map(|(_, c)| {
                format!(
                    "{} * {}",
                    a.replace('@', &c.to_string()),
                    b.replace('@', &c.to_string())
                )
            });
            terms.collect::<Vec<_>>().join(" + ")
        };
        let (half, two) = (self.number(0.5), self.number(2.0));
        let _ = writeln!(text, "    let stretch = {stretch};");
        let measure = match self.body.law {
            StencilLaw::Linear => dot("x@", "@"),
            StencilLaw::BondStretch => dot("@", "(x@ + x@ + @)"),
        };
        let _ = writeln!(text, "    let measure = {measure};");
        let threshold = match self.body.law {
            StencilLaw::Linear => "stretch".to_owned(),
            StencilLaw::BondStretch => format!("(stretch * ({two} + stretch))"),
        };
        let _ = writeln!(
            text,
            "    if (!(measure > {threshold} * square)) {{\n        return false;\n    }}"
        );
        for (c, axis) in self.axes() {
            let at = |point: &str| format!("v[{c}u * PITCH + {point}]");
            let _ = writeln!(
                text,
                "    let v{axis} = difference({}, {});",
                at("j"),
                at("i")
            );
        }
        match self.body.law {
            StencilLaw::Linear => {
                let _ = writeln!(
                    text,
                    "    let energy = {half} * measure * measure / square;\n    let power = measure / square * ({});",
                    dot("x@", "v@")
                );
            }
            StencilLaw::BondStretch => {
                let _ = writeln!(
                    text,
                    "    let reference = sqrt(square);\n    let deformed = sqrt(square + measure);\n    let elongation = measure / (deformed + reference);\n    let energy = {half} * elongation * elongation;\n    let power = elongation / deformed * ({});",
                    dot("(x@ + @)", "v@")
                );
            }
        }
        let dt = "rounded(length_of(now.number))";
        let _ = writeln!(
            text,
            "    let dissipated = energy - {half} * {dt} * power;\n    let critical = {half} * stretch * stretch * square;\n    if (dissipated < ZERO || dissipated > {} * critical) {{\n        atomicMin(&control[0], now.number);\n    }}\n    lost[place] += {half} * stiffness * dissipated;\n    return true;\n}}",
            self.number(RESOLVED)
        );
    }

    fn force(&self, text: &mut String) {
        let body = self.body;
        text.push_str("@compute @workgroup_size(GROUP_X, GROUP_Y, GROUP_Z)\nfn force(@builtin(global_invocation_id) id: vec3<u32>) {\n    let place = place_of(id);\n    if (place == NOWHERE) {\n        return;\n    }\n    if ((lists[FLAGS + place] & OWN) == 0u || atomicLoad(&control[0]) < now.number) {\n        return;\n    }\n    let i = MARGIN + place;\n");
        for (c, axis) in self.axes() {
            let _ = writeln!(
                text,
                "    let u{axis} = u[{c}u * PITCH + i];\n    var f{axis} = ZERO;"
            );
        }
        if body.has_factors {
            text.push_str("    let row = lists[FACTOR_ROW + place / 8u];\n    let factors = FACTORS + row * FACTOR_LENGTH + place % 8u;\n");
        }
        let words = body.words();
        for word in 0..words {
            let name = format!("m{word}");
            let _ = writeln!(
                text,
                "    var {name} = bits[{word}u * PLACES + place];\n    let old{word} = {name};"
            );
            let bonds = body.bonds.iter().enumerate();
            for (k, bond) in bonds.skip(32 * word).take(32) {
                self.bond(text, &name, k, bond);
            }
            if body.breaks() {
                let _ = writeln!(
                    text,
                    "    if ({name} != old{word}) {{\n        bits[{word}u * PLACES + place] = {name};\n    }}"
                );
            }
        }
        let density = match body.has_densities {
            true => "numbers[DENSITY + place] * ",
            false => "",
        };
        for (c, axis) in self.axes() {
            let _ = writeln!(text, "    a[{c}u * PITCH + i] = {density}f{axis};");
        }
        text.push_str("}\n");
    }

    fn bond(&self, text: &mut String, word: &str, k: usize, bond: &Bond) {
        let body = self.body;
        let bit = 1u32 << (k % 32);
        let beside = |from: &str| match bond.shift {
            shift if shift < 0 => format!("{from} - {}u", -shift),
            shift => format!("{from} + {shift}u"),
        };
        let _ = writeln!(text, "    {{\n        let j = {};", beside("i"));
        let xi = |c: usize| self.number(bond.xi[c]);
        for (c, axis) in self.axes() {
            let _ = writeln!(
                text,
                "        let {axis} = difference(u[{c}u * PITCH + j], u{axis});"
            );
        }
        let growth = self.axes().map(|(c, axis)| match body.law {
            StencilLaw::Linear => format!("{} * {axis}", xi(c)),
            StencilLaw::BondStretch => {
                format!("{axis} * ({} + {axis})", self.number(2.0 * bond.xi[c]))
            }
        });
        let growth: Vec<String> = growth.collect();
        let _ = writeln!(text, "        let q = {};", growth.join(" + "));
        let mut stiffness = self.number(bond.stiffness);
        if body.has_factors {
            stiffness = format!("{stiffness} * numbers[factors + {}u]", 8 * k);
        }
        let _ = writeln!(text, "        var on = ({word} & {bit}u) != 0u;");
        if body.breaks() {
            let vectors: String = self
                .axes()
                .map(|(c, axis)| format!(", {}, {axis}", xi(c)))
                .collect();
            let watched = self.number(body.smallest_threshold() * bond.square);
            let density = match body.has_densities {
                true => "numbers[DENSITY + place] * ",
                false => "",
            };
            let _ = writeln!(
                text,
                "        if (on && q > {watched}) {{\n            if (lose(place, i, {}, j, {}, {density}{stiffness}{vectors})) {{\n                {word} &= {}u;\n                on = false;\n            }}\n        }}",
                beside("place"),
                self.number(bond.square),
                !bit
            );
        }
        let _ = writeln!(
            text,
            "        let f = select(ZERO, {stiffness} * pull(q * {}), on);",
            self.number(bond.inverse_square)
        );
        for (c, axis) in self.axes() {
            let along = match body.law {
                StencilLaw::Linear => xi(c),
                StencilLaw::BondStretch => format!("({} + {axis})", xi(c)),
            };
            let _ = writeln!(text, "        f{axis} += f * {along};");
        }
        text.push_str("    }\n");
    }
}
