//! Bodies that allow contact.

use crate::declaration::Check;
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
    }
}
