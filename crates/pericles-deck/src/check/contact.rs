//! Range checks of `[contact]` and `[[impactor]]`.

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
        for (k, impactor) in model.impactors.iter().enumerate() {
            let key = KeyPath::from("impactor").index(k);
            let known = model.impactors[..k]
                .iter()
                .any(|other| other.name == impactor.name);
            let allowed = "allowed: a name that no other impactor has";
            self.within(!known, key.key("name"), &impactor.name, allowed);
        }
    }
}
