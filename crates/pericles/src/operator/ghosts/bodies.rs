//! Construction of forces with ghost layers.

use super::force::GhostForce;
use super::layer::{GhostLayer, breaking, rejected};
use crate::error::Result;
use crate::family::BondList;
use crate::material::{SolidSurface, SurfaceCorrection};
use crate::operator::{
    AssembledBonds, BondBody, BondForm, CompositeBody, Feature, LinearSolidBody,
};

impl LinearSolidBody<'_> {
    /// Returns the operator with a ghost layer in the free cells of the lattice.
    pub(in crate::operator) fn with_ghosts(&self, form: BondForm) -> Result<AssembledBonds> {
        let horizon = self.constants.horizon;
        let layer = GhostLayer::on_lattice(self.cloud, horizon, self.volume_correction)?;
        self.with_ghost_layer(layer, form)
    }

    /// Returns the operator with a ghost layer. Ghosts have a separate material without stiffness, so that
    /// they store no energy.
    ///
    /// # Errors
    /// Errors of [`LinearSolidBody::operator`]; breakable bonds; points whose neighbours lie on a line or in
    /// a plane.
    pub fn with_ghost_layer(&self, layer: GhostLayer, form: BondForm) -> Result<AssembledBonds> {
        let classes = self.classes()?;
        if classes.can_break() {
            return Err(breaking());
        }
        let classes = classes.among(layer.body(), layer.cloud().len())?;
        let extended = layer.cloud().clone();
        let body = LinearSolidBody {
            cloud: &extended,
            classes: Some(&classes),
            surface: SolidSurface::None,
            no_fail: &[],
            ..self.clone()
        };
        let assembled = body.operator(form)?;
        let (bonds, _) = body.families()?;
        let force = GhostForce::new(self.cloud.clone(), layer, &bonds, assembled.operator)?;
        Ok(AssembledBonds {
            operator: Box::new(force),
            ..assembled
        })
    }
}

impl CompositeBody<'_> {
    /// Returns the operator with a ghost layer in the free cells of the lattice.
    pub(in crate::operator) fn with_ghosts(&self, form: BondForm) -> Result<AssembledBonds> {
        let material = self.body.material;
        let (horizon, correction) = (material.horizon, material.volume_correction);
        let layer = GhostLayer::on_lattice(self.body.cloud, horizon, correction)?;
        self.with_ghost_layer(layer, form)
    }

    /// Returns the operator with a ghost layer. Ghosts have the material of the nearest point. A bond to a
    /// ghost has half of the stiffness, because only the half of its energy at the point of the body counts.
    ///
    /// # Errors
    /// Errors of [`CompositeBody::operator`]; breakable bonds, inclusions; points whose neighbours lie on a
    /// line or in a plane.
    pub fn with_ghost_layer(&self, layer: GhostLayer, form: BondForm) -> Result<AssembledBonds> {
        if self.features().has(Feature::Breaking) || self.softening.is_some() {
            return Err(breaking());
        }
        if !self.body.stiffness.is_empty() {
            return Err(rejected(
                "ghost points do not support inclusions; assign a material to a set of points instead",
            ));
        }
        let extended = layer.cloud().clone();
        let mut stiffness = vec![0.0; extended.len()];
        for &place in layer.body() {
            stiffness[place as usize] = 1.0;
        }
        let bonds = self.bonds_among(&layer)?;
        let classes = self.classes.map(|classes| {
            let of_place = nearest_materials(&layer, &bonds, classes.of_point());
            classes.at(of_place, Vec::new())
        });
        let whole = CompositeBody {
            body: BondBody {
                cloud: &extended,
                no_fail: &[],
                stiffness: &[],
                ..self.body.clone()
            },
            classes: classes.as_ref(),
            correction: SurfaceCorrection::None,
            softening: None,
            strengths: &[],
        };
        let halved = CompositeBody {
            body: BondBody {
                stiffness: &stiffness,
                ..whole.body.clone()
            },
            ..whole.clone()
        };
        let assembled = halved.operator(form)?;
        let whole = whole.operator(assembled.form)?.operator;
        let cloud = self.body.cloud.clone();
        let force = GhostForce::new(cloud, layer, &bonds, assembled.operator)?;
        Ok(AssembledBonds {
            operator: Box::new(force.with_energy_densities(whole)),
            ..assembled
        })
    }

    /// Returns the families of the body with its ghosts.
    fn bonds_among(&self, layer: &GhostLayer) -> Result<BondList> {
        let body = BondBody {
            cloud: layer.cloud(),
            ..self.body.clone()
        };
        Ok(body.families()?.0)
    }
}

/// Returns the material index at each place. Ghosts have the index of the nearest point, the first of several.
fn nearest_materials(layer: &GhostLayer, bonds: &BondList, of_point: &[u8]) -> Vec<u8> {
    let numbers = layer.numbers();
    let of_ghost = |place: usize| {
        let family = bonds.family(place);
        let points = family.filter_map(|(_, other)| Some((numbers[other]?, other)));
        let nearest = points.min_by(|a, b| {
            let length = |other: usize| bonds.length(place, other);
            length(a.1).total_cmp(&length(b.1)).then(a.0.cmp(&b.0))
        });
        nearest.map_or(0, |(point, _)| of_point[point as usize])
    };
    (0..layer.cloud().len())
        .map(|place| match numbers[place] {
            Some(point) => of_point[point as usize],
            None => of_ghost(place),
        })
        .collect()
}
