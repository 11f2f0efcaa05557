//! Checks that a surface is a closed manifold with well-shaped triangles.

use super::half_edges::{origins, sorted_by_edge};
use super::weld::same_places;
use super::{HalfEdges, Surface, SurfaceError};
use pericles::vector::{cross, dot};

/// Smallest allowed triangle area as a fraction of the square of the surface's largest side.
const SMALLEST_AREA: f64 = 1e-12;

/// Vertices closer than this fraction of the surface's largest side count as duplicates.
const SAME_PLACE: f64 = 1e-12;

/// Optional relaxations of the surface checks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SurfaceChecks {
    /// Allow boundary edges (edges with one triangle).
    pub open: bool,
    /// Allow several disconnected components.
    pub several_components: bool,
    /// Fix inconsistent triangle orientation instead of returning an error.
    pub flip: bool,
}

/// Connected component of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of edges with one triangle.
    pub boundary_edges: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Enclosed volume, m³; meaningless for an open component.
    pub volume: f64,
}

impl Component {
    /// Euler characteristic V − E + F.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }

    /// Genus g (number of handles), from V − E + F = 2 − 2g; for closed components only.
    pub fn genus(&self) -> Option<i64> {
        (self.boundary_edges == 0).then(|| (2 - self.euler()) / 2)
    }
}

/// Properties of a checked surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceReport {
    /// Number of edges.
    pub edges: usize,
    /// Number of edges with one triangle.
    pub boundary_edges: usize,
    /// Number of triangles whose orientation was reversed.
    pub flipped: usize,
    /// Connected components in descending order of size.
    pub components: Vec<Component>,
    /// Smallest and largest angle of the triangles, rad.
    pub angles: [f64; 2],
    /// Shortest, median and longest edge, m.
    pub edge_lengths: [f64; 3],
    /// Total area of the triangles, m².
    pub area: f64,
    /// Enclosed volume, m³.
    pub volume: f64,
}

impl Surface {
    /// Checks the surface and returns it with its properties. Conditions, in this order: no degenerate
    /// triangle, no duplicate vertices, no vertex without a triangle; two triangles per edge; consistent
    /// orientation of neighbouring triangles; one fan of triangles per vertex; one component; outward
    /// orientation.
    ///
    /// # Errors
    /// The first violated condition, with the number of violations and the first of them.
    pub fn checked(mut self, checks: SurfaceChecks) -> Result<(Self, SurfaceReport), SurfaceError> {
        self.check_triangles()?;
        self.check_vertices()?;
        self.check_edges(checks.open)?;
        let mut flipped = if checks.flip { self.orient()? } else { 0 };
        let half_edges = HalfEdges::new(&self)?;
        self.check_fans(&half_edges)?;
        let part = parts(&half_edges);
        let count = part.iter().max().map_or(0, |&last| last as usize + 1);
        let volumes = self.volumes(&part, count);
        if checks.flip {
            flipped += self.turn_out(&half_edges, &part, &volumes);
        }
        let half_edges = HalfEdges::new(&self)?;
        let components = self.components(&half_edges, &part, count);
        if let ([first, second, ..], false) = (&components[..], checks.several_components) {
            return Err(SurfaceError::SeveralComponents {
                components: components.len(),
                sizes: [first.triangles, second.triangles],
            });
        }
        let boundary_edges = components.iter().map(|part| part.boundary_edges).sum();
        let volume = self.volume();
        if boundary_edges == 0 && volume <= 0.0 {
            return Err(SurfaceError::InsideOut { volume });
        }
        let report = SurfaceReport {
            edges: components.iter().map(|part| part.edges).sum(),
            boundary_edges,
            flipped,
            components,
            angles: self.angle_range(),
            edge_lengths: self.edge_lengths(),
            area: self.area(),
            volume,
        };
        Ok((self, report))
    }

    fn largest_side(&self) -> f64 {
        let [low, high] = self.bounds();
        (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max)
    }

    fn check_triangles(&self) -> Result<(), SurfaceError> {
        let limit = SMALLEST_AREA * self.largest_side().powi(2);
        let small = |&(_, area): &(usize, f64)| area.is_nan() || area <= limit;
        let mut degenerate = self.triangle_areas().enumerate().filter(small);
        let Some((first, area)) = degenerate.next() else {
            return Ok(());
        };
        Err(SurfaceError::Degenerate {
            triangles: 1 + degenerate.count(),
            first,
            area,
            limit,
        })
    }

    fn check_vertices(&self) -> Result<(), SurfaceError> {
        let mut duplicates = same_places(&self.positions, SAME_PLACE * self.largest_side())
            .into_iter()
            .enumerate()
            .filter(|&(vertex, first)| vertex != first as usize);
        if let Some((second, first)) = duplicates.next() {
            return Err(SurfaceError::Duplicate {
                vertices: 1 + duplicates.count(),
                first: [first as usize, second].map(|v| self.user_number(v)),
            });
        }
        let mut used = vec![false; self.len()];
        for &vertex in self.triangles.iter().flatten() {
            used[vertex as usize] = true;
        }
        let mut unused = (0..self.len()).filter(|&vertex| !used[vertex]);
        match unused.next() {
            None => Ok(()),
            Some(first) => Err(SurfaceError::Unreferenced {
                vertices: 1 + unused.count(),
                first: self.user_number(first),
            }),
        }
    }

    fn check_edges(&self, open: bool) -> Result<(), SurfaceError> {
        let name = |edge: [u32; 2]| edge.map(|v| self.user_number(v as usize));
        let (mut crowded, mut lonely) = (Vec::new(), Vec::new());
        for group in sorted_by_edge(&origins(self)).chunk_by(|a, b| a.0 == b.0) {
            match group.len() {
                1 => lonely.push(group[0].0),
                2 => {}
                triangles => crowded.push((group[0].0, triangles)),
            }
        }
        if let Some(&(edge, triangles)) = crowded.first() {
            return Err(SurfaceError::NonManifoldEdge {
                edges: crowded.len(),
                first: name(edge),
                triangles,
            });
        }
        match lonely.first() {
            Some(&edge) if !open => Err(SurfaceError::Open {
                edges: lonely.len(),
                first: name(edge),
            }),
            _ => Ok(()),
        }
    }

    fn check_fans(&self, half_edges: &HalfEdges) -> Result<(), SurfaceError> {
        let several =
            |&vertex: &usize| half_edges.fan(vertex).len() < half_edges.around(vertex).len();
        let mut torn = (0..self.len()).filter(several);
        match torn.next() {
            None => Ok(()),
            Some(first) => Err(SurfaceError::BowTie {
                vertices: 1 + torn.count(),
                first: self.user_number(first),
            }),
        }
    }

    /// Reverses triangles until neighbours agree, as few as possible in each component. Returns the number
    /// reversed.
    fn orient(&mut self) -> Result<usize, SurfaceError> {
        let origin = origins(self);
        // Neighbours, and whether the two must be oriented against each other.
        let mut neighbours: Vec<Vec<(u32, bool)>> = vec![Vec::new(); self.triangles.len()];
        for group in sorted_by_edge(&origin).chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a), (_, b)] = *group {
                let against = origin[a as usize] == origin[b as usize];
                neighbours[a as usize / 3].push((b / 3, against));
                neighbours[b as usize / 3].push((a / 3, against));
            }
        }
        let mut turned: Vec<Option<bool>> = vec![None; self.triangles.len()];
        let mut total = 0;
        for seed in 0..self.triangles.len() {
            if turned[seed].is_some() {
                continue;
            }
            turned[seed] = Some(false);
            let mut part = vec![seed];
            let mut done = 0;
            while done < part.len() {
                let triangle = part[done];
                done += 1;
                let turn = turned[triangle] == Some(true);
                for &(other, against) in &neighbours[triangle] {
                    match turned[other as usize] {
                        None => {
                            turned[other as usize] = Some(turn ^ against);
                            part.push(other as usize);
                        }
                        Some(found) if found != turn ^ against => {
                            return Err(SurfaceError::OneSided);
                        }
                        Some(_) => {}
                    }
                }
            }
            let many = part.iter().filter(|&&t| turned[t] == Some(true)).count();
            let other_way = 2 * many > part.len();
            for &triangle in &part {
                if (turned[triangle] == Some(true)) != other_way {
                    self.triangles[triangle].swap(1, 2);
                    total += 1;
                }
            }
        }
        Ok(total)
    }

    fn volumes(&self, part: &[u32], count: usize) -> Vec<f64> {
        let mut volumes = vec![0.0; count];
        for (triangle, &part) in self.triangles.iter().zip(part) {
            let [a, b, c] = self.corners(*triangle);
            volumes[part as usize] += dot(a, cross(b, c)) / 6.0;
        }
        volumes
    }

    /// Reverses closed components of negative volume.
    fn turn_out(&mut self, half_edges: &HalfEdges, part: &[u32], volumes: &[f64]) -> usize {
        let mut closed = vec![true; volumes.len()];
        for h in 0..half_edges.len() as u32 {
            if half_edges.twin(h) == HalfEdges::NONE {
                closed[part[h as usize / 3] as usize] = false;
            }
        }
        let mut turned = 0;
        for (triangle, &part) in self.triangles.iter_mut().zip(part) {
            if closed[part as usize] && volumes[part as usize] < 0.0 {
                triangle.swap(1, 2);
                turned += 1;
            }
        }
        turned
    }

    fn components(&self, half_edges: &HalfEdges, part: &[u32], count: usize) -> Vec<Component> {
        let empty = Component {
            vertices: 0,
            edges: 0,
            boundary_edges: 0,
            triangles: 0,
            volume: 0.0,
        };
        let mut components = vec![empty; count];
        for (component, volume) in components.iter_mut().zip(self.volumes(part, count)) {
            component.volume = volume;
        }
        let of = |half_edge: u32| part[half_edge as usize / 3] as usize;
        for vertex in 0..self.len() {
            components[of(half_edges.around(vertex)[0])].vertices += 1;
        }
        for h in half_edges.edges() {
            components[of(h)].edges += 1;
            if half_edges.twin(h) == HalfEdges::NONE {
                components[of(h)].boundary_edges += 1;
            }
        }
        for &part in part {
            components[part as usize].triangles += 1;
        }
        components.sort_by_key(|component| std::cmp::Reverse(component.triangles));
        components
    }

    fn edge_lengths(&self) -> [f64; 3] {
        let mut lengths: Vec<f64> = self
            .edges()
            .iter()
            .map(|&[a, b]| self.chord(a as usize, b as usize))
            .collect();
        lengths.sort_unstable_by(f64::total_cmp);
        [
            lengths[0],
            lengths[lengths.len() / 2],
            lengths[lengths.len() - 1],
        ]
    }
}

/// Component of each triangle, numbered by first triangle.
fn parts(half_edges: &HalfEdges) -> Vec<u32> {
    let triangles = half_edges.len() / 3;
    let mut part = vec![u32::MAX; triangles];
    let mut count = 0;
    let mut open = Vec::new();
    for seed in 0..triangles {
        if part[seed] != u32::MAX {
            continue;
        }
        part[seed] = count;
        open.push(seed as u32);
        while let Some(triangle) = open.pop() {
            for h in 3 * triangle..3 * triangle + 3 {
                let twin = half_edges.twin(h);
                if twin != HalfEdges::NONE && part[twin as usize / 3] == u32::MAX {
                    part[twin as usize / 3] = count;
                    open.push(twin / 3);
                }
            }
        }
        count += 1;
    }
    part
}
