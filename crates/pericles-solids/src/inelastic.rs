//! Viscoelastic and elastoplastic state-based solids.
