//! Words of `body.shape`.

use super::surface::SurfaceKind;

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
    Surface(SurfaceKind),
}

/// All words with their values.
pub(super) const KINDS: [(&str, Kind); 16] = [
    ("bar", Kind::Bar),
    ("plate", Kind::Plate),
    ("disc", Kind::Disc),
    ("block", Kind::Block),
    ("cylinder", Kind::Cylinder),
    ("ball", Kind::Ball),
    ("icosphere", Kind::Surface(SurfaceKind::Icosphere)),
    ("uv-sphere", Kind::Surface(SurfaceKind::UvSphere)),
    ("ellipsoid", Kind::Surface(SurfaceKind::Ellipsoid)),
    ("torus", Kind::Surface(SurfaceKind::Torus)),
    ("capsule", Kind::Surface(SurfaceKind::Capsule)),
    ("surface", Kind::Surface(SurfaceKind::File)),
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
            Self::Points | Self::Mesh | Self::Surface(_) => 3,
        }
    }
}
