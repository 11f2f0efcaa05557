//! Softening curves of bonds as a function of the materials of their ends.

use crate::error::Result;
use crate::material::{MaterialPairs, Softening, SofteningCurve};

/// Softening curves of all bonds of a list.
pub(super) struct Curves {
    /// Curve per pair of materials; a single one without classes. `None` for pairs whose bonds never break
    /// and stay elastic.
    table: Vec<Option<SofteningCurve>>,
    /// Materials and strengths of the sites.
    classes: Option<MaterialPairs>,
    /// Smallest stretch at which a bond softens.
    onset: f64,
}

impl Curves {
    /// Creates the curves of a softening law for bonds of one critical stretch, or for the given classes of
    /// sites, which may have onsets of their own.
    ///
    /// # Errors
    /// Errors of [`Softening::curve`].
    pub fn new(
        softening: &Softening,
        critical_stretch: f64,
        classes: Option<MaterialPairs>,
    ) -> Result<Self> {
        let curve_of = |onset: Option<f64>, stretch: f64| {
            let own = Softening {
                onset: onset.unwrap_or(softening.onset),
                ..*softening
            };
            match stretch.is_finite() {
                true => own.curve(stretch).map(Some),
                false => Ok(None),
            }
        };
        let table: Vec<Option<SofteningCurve>> = match &classes {
            Some(classes) => (classes.critical_stretches().iter().enumerate())
                .map(|(class, &stretch)| curve_of(classes.onset(class), stretch))
                .collect(),
            None => softening
                .curve(critical_stretch)
                .map(|curve| vec![Some(curve)]),
        }?;
        if table.iter().all(Option::is_none) {
            // Always an error: no bond can soften.
            softening.curve(f64::INFINITY)?;
        }
        let onsets = table.iter().flatten().map(SofteningCurve::onset);
        let weakest = classes
            .as_ref()
            .map_or(1.0, MaterialPairs::smallest_strength);
        Ok(Self {
            onset: weakest * onsets.fold(f64::INFINITY, f64::min),
            table,
            classes,
        })
    }

    /// Returns the smallest stretch at which a bond softens.
    pub fn smallest_onset(&self) -> f64 {
        self.onset
    }

    /// Returns the curve of a bond between two sites and the factor of its stretches (scattered strengths);
    /// `None` if the bond stays elastic.
    #[inline(always)]
    pub fn of(&self, a: usize, b: usize) -> Option<(&SofteningCurve, f64)> {
        match &self.classes {
            None => self.table[0].as_ref().map(|curve| (curve, 1.0)),
            Some(classes) => {
                let curve = self.table[classes.class(a, b)].as_ref()?;
                Some((curve, classes.strength(a, b)))
            }
        }
    }

    /// Returns the number of materials.
    pub fn materials(&self) -> usize {
        self.table.len().isqrt()
    }

    /// Returns the material number of a site and the factor of its strength.
    pub fn of_point(&self, site: usize) -> (usize, f64) {
        match &self.classes {
            None => (0, 1.0),
            Some(classes) => {
                let number = usize::from(classes.of_point()[site]);
                (number, classes.strength(site, site))
            }
        }
    }
}
