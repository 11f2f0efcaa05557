//! `anisotropy`: elastic constants and axes of anisotropic correspondence materials.

use pericles::Result;
use pericles::material::GivenConstants;
use pericles_deck_derive::DeckTable;
use pericles_solids::correspondence::{Orthotropy, Stiffness};
use serde::{Deserialize, Serialize};

use crate::body::{Rotation, check_axis};
use crate::quantity::Quantity;
use crate::range::{Range, from_to};
use crate::reader::{Item, Table};
use crate::region;

/// Anisotropic elastic constants, instead of `youngs_modulus` and `poisson_ratio`: the engineering constants of an orthotropic
/// material, or `stiffness`. The law is St Venant–Kirchhoff's, S = C : E, and the material is elastic.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = (), exactly_one("youngs_modulus", "stiffness"), verify = accept)]
pub struct Anisotropy {
    /// Young's moduli E₁, E₂, E₃ along the material axes.
    #[serde(default)]
    #[deck(with = moduli)]
    pub youngs_modulus: Option<[f64; 3]>,
    /// Poisson's ratios ν₁₂, ν₁₃, ν₂₃: ν₁₂ is minus the strain along axis 2 over that along axis 1 in tension along axis 1.
    #[serde(default)]
    #[deck(
        with = ratios,
        required_if(youngs_modulus.is_some_and(Option::is_some)),
        forbid_if(youngs_modulus == Some(&None), OF_ORTHOTROPIC)
    )]
    pub poisson_ratio: Option<[f64; 3]>,
    /// Shear moduli G₁₂, G₁₃, G₂₃.
    #[serde(default)]
    #[deck(
        with = moduli,
        required_if(youngs_modulus.is_some_and(Option::is_some)),
        forbid_if(youngs_modulus == Some(&None), OF_ORTHOTROPIC)
    )]
    pub shear_modulus: Option<[f64; 3]>,
    /// Stiffness C in the material axes: six rows of six moduli for the components 11, 22, 33, 23, 13, 12, with shear strains
    /// 2ε. Symmetric and positive definite.
    #[serde(default)]
    #[deck(with = rows)]
    pub stiffness: Option<[[f64; 6]; 6]>,
    /// Angle by which the material axes are rotated from x, y and z, anticlockwise about `axis`: "30 deg", or a number in
    /// radians.
    #[deck(quantity = Number, range = ANGLES, default = 0.0)]
    pub angle: f64,
    /// Axis of the rotation, of any length. 2D bodies have a plane of symmetry and rotate about z.
    #[deck(with = axis, check = check_axis, default = [0.0, 0.0, 1.0])]
    pub axis: [f64; 3],
}

const OF_ORTHOTROPIC: &str = "it requires `youngs_modulus`; `stiffness` contains all constants";

/// Angles of a full turn in both directions.
const ANGLES: Range = from_to(-std::f64::consts::TAU, std::f64::consts::TAU)
    .described("an angle from -360 to 360 degrees");

fn axis<S>(item: &Item<'_>, _: S) -> Option<[f64; 3]> {
    region::direction(item, Some(3))
}

/// Reads entries for three axes.
fn three(
    item: &Item<'_>,
    expected: &str,
    read: impl Fn(&Item<'_>) -> Option<f64>,
) -> Option<[f64; 3]> {
    let read: Vec<Option<f64>> = item.exactly(3, expected)?.iter().map(read).collect();
    Some([read[0]?, read[1]?, read[2]?])
}

fn moduli<S>(item: &Item<'_>, _: S) -> Option<[f64; 3]> {
    three(item, "three moduli", |entry| {
        entry.positive(Quantity::Modulus)
    })
}

fn ratios<S>(item: &Item<'_>, _: S) -> Option<[f64; 3]> {
    three(item, "three ratios", |entry| {
        entry.quantity(Quantity::Number)
    })
}

/// Reads six rows of six moduli.
fn rows<S>(item: &Item<'_>, _: S) -> Option<[[f64; 6]; 6]> {
    let row = |row: &Item<'_>| -> Option<[f64; 6]> {
        let entries = row.exactly(6, "a row of six moduli")?;
        let read = entries
            .iter()
            .map(|entry| entry.quantity(Quantity::Modulus));
        let read: Vec<Option<f64>> = read.collect();
        let row: Option<Vec<f64>> = read.into_iter().collect();
        row?.try_into().ok()
    };
    let entries = item.exactly(6, "six rows of six moduli")?;
    // All rows are read before an error ends the function.
    let read: Vec<Option<[f64; 6]>> = entries.iter().map(row).collect();
    let rows: Option<Vec<[f64; 6]>> = read.into_iter().collect();
    rows?.try_into().ok()
}

/// Rejects constants for which a strain has no positive energy.
fn accept<S>(table: &Table<'_>, anisotropy: &Anisotropy, _: S) -> Option<()> {
    table.accept(anisotropy.stiffness()).map(|_| ())
}

impl Anisotropy {
    /// Returns the stiffness in the axes of the body.
    ///
    /// # Errors
    /// Constants for which a strain has no positive energy.
    pub fn stiffness(&self) -> Result<Stiffness> {
        let own = match (self.youngs_modulus, self.poisson_ratio, self.shear_modulus) {
            (Some(young), Some(poisson), Some(shear)) => Stiffness::orthotropic(&Orthotropy {
                young,
                poisson,
                shear,
            })?,
            _ => Stiffness::new(self.stiffness.unwrap_or([[0.0; 6]; 6]))?,
        };
        let axes = Rotation {
            angle: self.angle,
            axis: self.axis,
            centre: None,
        };
        Ok(own.turned(&axes.matrix()))
    }

    /// Returns the constants of Voigt's average over all orientations, which state the scale of the stiffness.
    ///
    /// # Errors
    /// The errors of [`Anisotropy::stiffness`].
    pub fn average(&self) -> Result<GivenConstants> {
        let [bulk, shear] = self.stiffness()?.average();
        Ok(GivenConstants {
            bulk: Some(bulk),
            shear: Some(shear),
            ..GivenConstants::default()
        })
    }
}
