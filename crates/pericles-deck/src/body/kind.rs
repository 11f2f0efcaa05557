//! Words of `body.shape`.

/// A word of `body.shape`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Bar,
    Plate,
    Disc,
    Block,
    Cylinder,
    Ball,
    Points,
    Mesh,
    Solid,
    Outline,
    /// A parametric 2-manifold.
    Surface,
    SurfaceFile,
}

/// All words with their values.
pub(super) const KINDS: [(&str, Kind); 16] = [
    ("bar", Kind::Bar),
    ("plate", Kind::Plate),
    ("disc", Kind::Disc),
    ("block", Kind::Block),
    ("cylinder", Kind::Cylinder),
    ("ball", Kind::Ball),
    ("icosphere", Kind::Surface),
    ("uv-sphere", Kind::Surface),
    ("ellipsoid", Kind::Surface),
    ("torus", Kind::Surface),
    ("capsule", Kind::Surface),
    ("surface", Kind::SurfaceFile),
    ("points", Kind::Points),
    ("mesh", Kind::Mesh),
    ("solid", Kind::Solid),
    ("outline", Kind::Outline),
];

impl Kind {
    pub(super) fn dimension(self) -> usize {
        match self {
            Self::Bar => 1,
            Self::Plate | Self::Disc | Self::Outline => 2,
            Self::Block | Self::Cylinder | Self::Ball | Self::Solid => 3,
            // Points and meshes have a key for it.
            Self::Points | Self::Mesh | Self::Surface | Self::SurfaceFile => 3,
        }
    }
}
