//! What can be wrong with a surface.

impl From<SurfaceError> for pericles::PericlesError {
    fn from(error: SurfaceError) -> Self {
        Self::Extension(Box::new(error))
    }
}

/// Why a surface is refused. Numbers of vertices and triangles are those under which they were given, from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// A parameter of a shape outside its range.
    #[error("{quantity} is {value}; allowed: {allowed}")]
    Parameter {
        /// What the number stands for.
        quantity: &'static str,
        /// The number given.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// No triangles.
    #[error("the surface has no triangles; at least four are needed to enclose something")]
    Empty,
    /// More vertices or triangles than can be numbered.
    #[error("the surface has {count} {what}; at most {limit} are possible")]
    TooLarge {
        /// Vertices or triangles.
        what: &'static str,
        /// How many.
        count: usize,
        /// The limit.
        limit: usize,
    },
    /// A coordinate that is no number.
    #[error("the coordinate {value} of vertex {vertex} is not a finite number")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// The coordinate given.
        value: f64,
    },
    /// A triangle with a corner that does not exist.
    #[error("triangle {triangle} has the corner {vertex}, but the surface has vertices 0 to {} only", vertices - 1)]
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
        "the surface is open: {edges} edge(s) belong to one triangle only, the first joins vertices {} and {}; close the surface or allow an open one \
         (the theory is that of closed surfaces)", first[0], first[1]
    )]
    Open {
        /// How many edges.
        edges: usize,
        /// The first.
        first: [usize; 2],
    },
    /// Edges with more than two triangles.
    #[error(
        "the surface is no manifold: {edges} edge(s) belong to more than two triangles, the first joins vertices {} and {} and belongs to \
         {triangles}; every edge must belong to two", first[0], first[1]
    )]
    NonManifoldEdge {
        /// How many edges.
        edges: usize,
        /// The first.
        first: [usize; 2],
        /// Triangles of the first.
        triangles: usize,
    },
    /// Vertices at which sheets touch.
    #[error(
        "{vertices} vertex(es) join sheets that touch in a point only, the first is vertex {first}; the triangles around a vertex must form one fan"
    )]
    BowTie {
        /// How many vertices.
        vertices: usize,
        /// The first.
        first: usize,
    },
    /// Neighbouring triangles of opposite orientation.
    #[error(
        "{edges} edge(s) are run in the same direction by both of their triangles, the first joins vertices {} and {}; turn triangles over so that all \
         run counter-clockwise seen from outside, or ask for flipping", first[0], first[1]
    )]
    Flipped {
        /// How many edges.
        edges: usize,
        /// The first.
        first: [usize; 2],
    },
    /// No orientation exists.
    #[error(
        "the surface has one side only (like a Klein bottle): its triangles cannot be oriented"
    )]
    OneSided,
    /// All triangles the wrong way round.
    #[error(
        "the triangles run clockwise seen from outside (the enclosed volume is {volume:e} m³); turn all of them over, or ask for flipping"
    )]
    InsideOut {
        /// The enclosed volume, m³.
        volume: f64,
    },
    /// Triangles without area.
    #[error(
        "{triangles} triangle(s) have (nearly) no area, the first is triangle {first} with {area:e} m²; at least {limit:e} m² are needed (1e-12 of the \
         square of the surface's size)"
    )]
    Degenerate {
        /// How many triangles.
        triangles: usize,
        /// The first.
        first: usize,
        /// Its area, m².
        area: f64,
        /// The smallest area allowed, m².
        limit: f64,
    },
    /// Vertices in the same place.
    #[error(
        "{vertices} vertex(es) lie where another one lies, the first two are {} and {}; weld them", first[0], first[1]
    )]
    Duplicate {
        /// How many vertices.
        vertices: usize,
        /// The first pair.
        first: [usize; 2],
    },
    /// Vertices without triangles.
    #[error(
        "{vertices} vertex(es) belong to no triangle, the first is vertex {first}; remove them"
    )]
    Unreferenced {
        /// How many vertices.
        vertices: usize,
        /// The first.
        first: usize,
    },
    /// Parts that do not hang together.
    #[error(
        "the surface has {components} parts that do not hang together, of {} and {} triangles …; give one of them, or allow several", sizes[0], sizes[1]
    )]
    SeveralComponents {
        /// How many.
        components: usize,
        /// Triangles of the two largest.
        sizes: [usize; 2],
    },
    /// A ball in space that holds parts of a surface that are far apart along it.
    #[error(
        "vertices {} and {} are {chord} m apart in space, within the horizon, but more than {reach} m along the surface: the Euclidean ball joins opposite walls; take the geodesic ball or a shorter horizon",
        .vertices[0], .vertices[1]
    )]
    Folded {
        /// Numbers of the vertices as they were given.
        vertices: [usize; 2],
        /// The straight line between them, m.
        chord: f64,
        /// The longest path that counts, m.
        reach: f64,
    },
}
