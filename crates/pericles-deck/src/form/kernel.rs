//! Serialised form of influence functions.

use pericles::kernel::{ActsOn, ClassOffset, ClassTable, Influence, InfluenceFunction};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Described, described};

#[derive(Serialize, Deserialize)]
#[serde(remote = "Influence", deny_unknown_fields)]
struct InfluenceForm {
    #[serde(with = "crate::form")]
    function: InfluenceFunction,
    #[serde(with = "crate::form")]
    acts_on: ActsOn,
}

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "InfluenceFunction",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InfluenceFunctionForm {
    Constant,
    Conical,
    Inverse,
    Power {
        exponent: f64,
    },
    Gaussian {
        length: f64,
        #[serde(default)]
        cutoff: Option<f64>,
    },
    Tabulated {
        table: Vec<(f64, f64)>,
    },
    Cosines {
        wavenumber: f64,
        coefficients: Vec<f64>,
    },
    Classes(#[serde(with = "crate::form")] ClassTable),
}

described!(Influence: InfluenceForm, InfluenceFunction: InfluenceFunctionForm);

/// Serialised form of a table of lattice classes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ClassTableForm {
    dimension: usize,
    spacing: f64,
    table: Vec<(ClassOffset, f64)>,
}

impl Described for ClassTable {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let form = ClassTableForm {
            dimension: self.dimension(),
            spacing: self.spacing(),
            table: self.entries().to_vec(),
        };
        form.serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let form = ClassTableForm::deserialize(deserializer)?;
        Self::new(form.dimension, form.spacing, &form.table).map_err(D::Error::custom)
    }
}
