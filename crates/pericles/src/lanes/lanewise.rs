//! Lane-by-lane arithmetic of arrays.

/// Implements `+ − × ÷` and negation for a type with its lanes in an array `self.0` and a function `from_fn`;
/// inside its implementation of [`Vector`](super::Vector), `max` and `min`.
macro_rules! lanewise {
    ($lanes:ident) => {
        lanewise!($lanes: Add, add, +);
        lanewise!($lanes: Sub, sub, -);
        lanewise!($lanes: Mul, mul, *);
        lanewise!($lanes: Div, div, /);

        impl std::ops::Neg for $lanes {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self::from_fn(|k| -self.0[k])
            }
        }
    };
    ($lanes:ident: $trait:ident, $method:ident, $op:tt) => {
        impl std::ops::$trait for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::from_fn(|k| self.0[k] $op other.0[k])
            }
        }
    };
    (max and min) => {
        lanewise!(max, >);
        lanewise!(min, <);
    };
    ($method:ident, $op:tt) => {
        #[inline(always)]
        fn $method(self, other: Self) -> Self {
            Self::from_fn(|k| {
                if self.0[k] $op other.0[k] {
                    self.0[k]
                } else {
                    other.0[k]
                }
            })
        }
    };
}
pub(super) use lanewise;
