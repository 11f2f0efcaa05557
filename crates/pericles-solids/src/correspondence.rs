//! Correspondence materials: forces from the stress of a deformation gradient.
