//! Dimensions of physical quantities and their SI units.

/// Powers of kilogram, metre, second and kelvin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dimension {
    pub(crate) kg: i32,
    pub(crate) m: i32,
    pub(crate) s: i32,
    pub(crate) k: i32,
}

impl Dimension {
    pub(crate) const NONE: Self = Self::new(0, 0, 0);

    pub(crate) const fn new(kg: i32, m: i32, s: i32) -> Self {
        Self { kg, m, s, k: 0 }
    }

    /// A power of the kelvin.
    pub(crate) const fn kelvin(k: i32) -> Self {
        Self {
            kg: 0,
            m: 0,
            s: 0,
            k,
        }
    }

    /// The dimension per kelvin.
    pub(crate) const fn per_kelvin(self) -> Self {
        Self {
            k: self.k - 1,
            ..self
        }
    }

    /// The product with a power of another dimension.
    pub(crate) fn times(mut self, other: Self, power: i32) -> Self {
        self.add(other, power);
        self
    }

    /// A power, such as the square root; none if it is not a product of whole powers of units.
    pub(crate) fn to_power(self, power: f64) -> Option<Self> {
        let raised = |exponent: i32| {
            let raised = power * f64::from(exponent);
            let whole = raised.round();
            let right = (raised - whole).abs() < 1e-9 && whole.abs() < 1e6;
            right.then_some(whole as i32)
        };
        Some(Self {
            kg: raised(self.kg)?,
            m: raised(self.m)?,
            s: raised(self.s)?,
            k: raised(self.k)?,
        })
    }

    /// The SI unit as in tables: a common unit, or a quotient of powers such as `kg^2 m/s^3`; empty without a unit.
    pub(crate) fn name(self) -> String {
        const COMMON: [(&str, Dimension); 13] = [
            ("", Dimension::NONE),
            ("N", Dimension::new(1, 1, -2)),
            ("J", Dimension::new(1, 2, -2)),
            ("W", Dimension::new(1, 2, -3)),
            ("Pa", Dimension::new(1, -1, -2)),
            ("Pa/s", Dimension::new(1, -1, -3)),
            ("N/m", Dimension::new(1, 0, -2)),
            ("N/s", Dimension::new(1, 1, -3)),
            ("m2", Dimension::new(0, 2, 0)),
            ("m3", Dimension::new(0, 3, 0)),
            ("m/s2", Dimension::new(0, 1, -2)),
            ("kg/m3", Dimension::new(1, -3, 0)),
            ("m2/s2", Dimension::new(0, 2, -2)),
        ];
        if let Some((name, _)) = COMMON.iter().find(|(_, dimension)| *dimension == self) {
            return (*name).into();
        }
        let powers = [("kg", self.kg), ("m", self.m), ("s", self.s), ("K", self.k)];
        let part = |sign: i32| {
            let of_sign = powers.iter().filter(|(_, power)| power * sign > 0);
            let symbols = of_sign.map(|(symbol, power)| match power.abs() {
                1 => (*symbol).to_owned(),
                power => format!("{symbol}^{power}"),
            });
            symbols.collect::<Vec<_>>()
        };
        let above = match part(1).join(" ") {
            none if none.is_empty() => "1".into(),
            above => above,
        };
        let below = part(-1).into_iter().map(|symbol| format!("/{symbol}"));
        below.fold(above, |unit, symbol| unit + &symbol)
    }

    /// Multiplies by a power of another dimension.
    pub(crate) fn add(&mut self, other: Self, power: i32) {
        self.kg += other.kg * power;
        self.m += other.m * power;
        self.s += other.s * power;
        self.k += other.k * power;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::dimension_of;

    #[test]
    fn names_of_units_have_their_dimension() {
        for kg in -2..=2 {
            for m in -3..=3 {
                for s in -3..=2 {
                    let dimension = Dimension {
                        k: kg * m % 2,
                        ..Dimension::new(kg, m, s)
                    };
                    assert_eq!(dimension_of(&dimension.name()), Some(dimension));
                }
            }
        }
        for unit in ["mm", "%", "min", "GPa", "furlong", "m/"] {
            assert_eq!(dimension_of(unit), None, "{unit}");
        }
    }
}
