//! Range checks of `[contact]` and `[[impactor]]`.

use super::ranges::Check;
use crate::contact::{ContactLaw, ContactPairs, ContactStiffness};
use crate::impactor::{ImpactorInertia, ImpactorMotion, ImpactorShape};
use crate::key_path::KeyPath;
use crate::model::Model;

impl Check {
    pub(super) fn contact(&mut self, model: &Model) {
        let key = KeyPath::from("contact");
        let any = model.contact.is_some() || !model.impactors.is_empty();
        let allowed = "allowed: bodies with volume; contact of 2-manifolds is not supported";
        let right = model.body.solid().is_some() || !any;
        self.within(right, key.clone(), "contact", allowed);
        let periodic = model
            .body
            .solid()
            .is_some_and(|solid| solid.shape.is_periodic());
        let allowed = "allowed: bodies that are not periodic; contact through periodic faces is not supported";
        self.within(!(periodic && any), key.clone(), "contact", allowed);
        if let Some(contact) = &model.contact {
            if let ContactLaw::Power(p) = contact.law {
                let allowed = "allowed: at least 1";
                self.within(p >= 1.0 && p.is_finite(), key.key("exponent"), p, allowed);
            }
            let (ContactStiffness::Relative(stiffness) | ContactStiffness::Absolute(stiffness)) =
                contact.stiffness;
            self.positive(key.key("stiffness"), stiffness);
            self.positive(key.key("distance"), contact.distance);
            let most = if contact.pairs == ContactPairs::All {
                0.9
            } else {
                1.0
            };
            let allowed = "allowed: above 0 and at most 1, or 0.9 with pairs = \"all\"";
            let right = contact.closing > 0.0 && contact.closing <= most;
            self.within(right, key.key("closing"), contact.closing, allowed);
            let right = contact.damping >= 0.0 && contact.damping.is_finite();
            self.within(
                right,
                key.key("damping"),
                contact.damping,
                "allowed: at least 0",
            );
            if let Some(friction) = contact.friction {
                let key = key.key("friction");
                let right = friction.coefficient >= 0.0 && friction.coefficient.is_finite();
                let allowed = "allowed: at least 0";
                self.within(right, key.key("coefficient"), friction.coefficient, allowed);
                self.positive(key.key("speed"), friction.speed);
            }
        }
        let dimension = model.body.dimension();
        for (k, impactor) in model.impactors.iter().enumerate() {
            let key = KeyPath::from("impactor").index(k);
            match &impactor.shape {
                ImpactorShape::Ball { radius } => self.positive(key.key("radius"), *radius),
                ImpactorShape::Box { size } => {
                    for (c, side) in size.iter().take(dimension).enumerate() {
                        self.positive(key.key("size").index(c), *side);
                    }
                }
                ImpactorShape::Cylinder { radius, height, .. } => {
                    self.positive(key.key("radius"), *radius);
                    self.positive(key.key("height"), *height);
                }
                ImpactorShape::HalfSpace { normal } => {
                    let right = normal.iter().any(|&x| x != 0.0);
                    let allowed = "allowed: a nonzero vector";
                    self.within(right, key.key("normal"), "zero", allowed);
                }
                ImpactorShape::Surface { unit, .. } => self.positive(key.key("unit"), *unit),
            }
            if let ImpactorMotion::Free { inertia, .. } = &impactor.motion {
                match inertia {
                    ImpactorInertia::Density(density) => {
                        self.positive(key.key("density"), *density);
                    }
                    ImpactorInertia::Mass { mass, .. } => self.positive(key.key("mass"), *mass),
                }
                let right = !matches!(impactor.shape, ImpactorShape::HalfSpace { .. });
                let allowed = "allowed: \"prescribed\" for a half-space";
                self.within(right, key.key("motion"), "free", allowed);
            }
            let known = model.impactors[..k]
                .iter()
                .any(|other| other.name == impactor.name);
            let allowed = "allowed: a name that no other impactor has";
            self.within(!known, key.key("name"), &impactor.name, allowed);
        }
    }
}
