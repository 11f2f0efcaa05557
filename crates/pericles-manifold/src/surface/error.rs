//! Errors of surface validation.

impl From<SurfaceError> for pericles::PericlesError {
    fn from(error: SurfaceError) -> Self {
        Self::Extension(Box::new(error))
    }
}

/// Reason why a surface is invalid. Vertices and triangles have the numbers under which they were given, from
/// 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// A shape parameter is outside its range.
    #[error("{quantity} is {value}; allowed: {allowed}")]
    Parameter {
        /// Name of the parameter.
        quantity: &'static str,
        /// Value given.
        value: f64,
        /// Allowed values.
        allowed: &'static str,
    },
    /// No triangles.
    #[error("the surface has no triangles; at least four are needed to enclose something")]
    Empty,
    /// Too many vertices or triangles to number.
    #[error(
        "the surface has {count} {what}; the largest allowed number is {limit}. Use a coarser surface"
    )]
    TooLarge {
        /// "vertices" or "triangles".
        what: &'static str,
        /// Number given.
        count: usize,
        /// Largest allowed number.
        limit: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has the coordinate {value}; coordinates must be finite numbers")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// The coordinate given.
        value: f64,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {vertex}, but the surface has vertices 0 to {} only", vertices - 1)]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// Its corner.
        vertex: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// Edges with one triangle.
    #[error(
        "the surface is open: {edges} edge(s) belong to one triangle only, the first joins vertices {} and {}; close \
        the surface or allow open surfaces (the theory assumes closed ones)", first[0], first[1]
    )]
    Open {
        /// Number of edges.
        edges: usize,
        /// Vertices of the first.
        first: [usize; 2],
    },
    /// Edges with more than two triangles.
    #[error(
        "the surface is not a manifold: {edges} edge(s) belong to more than two triangles, the first joins vertices \
        {} and {} and belongs to {triangles}; every edge must belong to two", first[0], first[1]
    )]
    NonManifoldEdge {
        /// Number of edges.
        edges: usize,
        /// Vertices of the first.
        first: [usize; 2],
        /// Number of triangles of the first.
        triangles: usize,
    },
    /// Parts of the surface meet in a vertex only.
    #[error(
        "{vertices} vertex(es) join parts of the surface that meet in a point only, the first is vertex {first}; the \
        triangles around a vertex must form one fan"
    )]
    BowTie {
        /// Number of vertices.
        vertices: usize,
        /// The first vertex.
        first: usize,
    },
    /// Neighbouring triangles have opposite orientations.
    #[error(
        "triangle orientation is inconsistent: {edges} edge(s) run in the same direction in both of their triangles, \
        the first joins vertices {} and {}; order all corners counter-clockwise seen from outside, or enable `flip`", first[0], first[1]
    )]
    Flipped {
        /// Number of edges.
        edges: usize,
        /// Vertices of the first.
        first: [usize; 2],
    },
    /// The surface is not orientable.
    #[error(
        "the surface is one-sided (like a Klein bottle): its triangles cannot be oriented consistently"
    )]
    OneSided,
    /// All triangles are oriented inwards.
    #[error(
        "the triangles run clockwise seen from outside (the enclosed volume is {}); reverse all of them, \
        or enable `flip`", pericles::units::quantity(*volume, "m³")
    )]
    InsideOut {
        /// The enclosed volume, m³.
        volume: f64,
    },
    /// Degenerate triangles.
    #[error(
        "{triangles} triangle(s) are degenerate, the first is triangle {first} with an area of {} m²; at least \
        {} m² are required (1e-12 of the square of the surface's size)",
        pericles::units::significant(*area, 3), pericles::units::significant(*limit, 3)
    )]
    Degenerate {
        /// Number of triangles.
        triangles: usize,
        /// The first triangle.
        first: usize,
        /// Its area, m².
        area: f64,
        /// The smallest area allowed, m².
        limit: f64,
    },
    /// Duplicate vertices.
    #[error(
        "{vertices} vertex(es) coincide with another one, the first two are {} and {}; weld them", first[0], first[1]
    )]
    Duplicate {
        /// Number of vertices.
        vertices: usize,
        /// The first pair.
        first: [usize; 2],
    },
    /// Vertices without triangles.
    #[error(
        "{vertices} vertex(es) belong to no triangle, the first is vertex {first}; remove them"
    )]
    Unreferenced {
        /// Number of vertices.
        vertices: usize,
        /// The first vertex.
        first: usize,
    },
    /// The surface is disconnected.
    #[error(
        "the surface has {components} disconnected components, of {} and {} triangles …; keep one of them, or allow \
        several", sizes[0], sizes[1]
    )]
    SeveralComponents {
        /// Number of components.
        components: usize,
        /// Number of triangles of the two largest.
        sizes: [usize; 2],
    },
    /// A Euclidean ball contains parts of the surface that are far apart along it.
    #[error(
        "vertices {} and {} are {} apart in space, within the horizon, but more than {} along the \
        surface: the Euclidean ball joins opposite walls; use the geodesic ball or a smaller horizon",
        vertices[0], vertices[1],
        pericles::units::quantity(*chord, "m"), pericles::units::quantity(*reach, "m")
    )]
    Folded {
        /// The vertices, as numbered in the input.
        vertices: [usize; 2],
        /// Straight distance between them, m.
        chord: f64,
        /// Longest accepted path, m.
        reach: f64,
    },
}
