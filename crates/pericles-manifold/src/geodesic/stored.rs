//! Cache of geodesic pairs.

use super::{GeodesicMethod, GeodesicPairs, geodesic_pairs};
use crate::surface::Surface;
use pericles::Result;
use pericles::cache::{Cache, Key};
use pericles::{Archive, Values};

/// Cache kind; the number changes when the computed distances change.
const KIND: &str = "geodesics-1";

/// As [`geodesic_pairs`], using a cache. The key contains the surface, the horizon and the method, to the last
/// bit.
///
/// # Errors
/// As [`geodesic_pairs`].
pub fn geodesic_pairs_cached(
    surface: &Surface,
    delta: f64,
    method: GeodesicMethod,
    cache: &dyn Cache,
) -> Result<GeodesicPairs> {
    let corners: Vec<u64> = surface
        .triangles()
        .iter()
        .flatten()
        .map(|&v| u64::from(v))
        .collect();
    let key = Key::new(KIND)
        .text(&method.to_string())
        .f64s(&[delta])
        .f64s(surface.positions().as_flattened())
        .u64s(&corners);
    let stored = cache
        .load(&key)
        .and_then(|archive| unpacked(&archive, surface.len(), delta));
    if let Some(pairs) = stored {
        return Ok(pairs);
    }
    let pairs = geodesic_pairs(surface, delta, method)?;
    cache.store(&key, &packed(&pairs));
    Ok(pairs)
}

/// Packs each pair once, from the vertex with the lower number.
fn packed(pairs: &GeodesicPairs) -> Archive {
    let (mut counts, mut neighbours, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
    for vertex in 0..pairs.vertices() {
        let (row, distances) = pairs.row(vertex);
        let above = row.partition_point(|&neighbour| (neighbour as usize) < vertex);
        counts.push((row.len() - above) as u64);
        neighbours.extend(
            row[above..]
                .iter()
                .flat_map(|neighbour| neighbour.to_le_bytes()),
        );
        lengths.extend_from_slice(&distances[above..]);
    }
    let mut archive = Archive::default();
    archive.put("counts", Values::U64(counts));
    archive.put("neighbours", Values::U8(neighbours));
    archive.put("distances", Values::F64(lengths));
    archive
}

/// Unpacks pairs; `None` if the arrays are not as [`packed`] writes them for this number of vertices and this
/// horizon.
fn unpacked(archive: &Archive, vertices: usize, delta: f64) -> Option<GeodesicPairs> {
    let counts = archive.u64s("counts").ok()?;
    let lengths = archive.f64s("distances").ok()?;
    let Some(Values::U8(bytes)) = archive.arrays().get("neighbours") else {
        return None;
    };
    let (neighbours, []) = bytes.as_chunks::<4>() else {
        return None;
    };
    if counts.len() != vertices || neighbours.len() != lengths.len() {
        return None;
    }
    let mut entries = neighbours
        .iter()
        .map(|bytes| u32::from_le_bytes(*bytes))
        .zip(lengths.iter().copied());
    let mut rows = Vec::with_capacity(vertices);
    for (vertex, &count) in counts.iter().enumerate() {
        let row: Vec<(u32, f64)> = entries
            .by_ref()
            .take(usize::try_from(count).ok()?)
            .collect();
        let ascending = row.is_sorted_by(|a, b| a.0 < b.0);
        let possible = |&(neighbour, distance): &(u32, f64)| {
            neighbour as usize > vertex
                && (neighbour as usize) < vertices
                && distance > 0.0
                && distance < delta
        };
        if row.len() as u64 != count || !ascending || !row.iter().all(possible) {
            return None;
        }
        rows.push(row);
    }
    entries
        .next()
        .is_none()
        .then(|| GeodesicPairs::symmetric(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    /// A cache of one entry that counts what is stored.
    #[derive(Default)]
    struct Memory(Mutex<Vec<(Key, Archive)>>);

    impl Cache for Memory {
        fn load(&self, key: &Key) -> Option<Archive> {
            let entries = self.0.lock().unwrap();
            entries
                .iter()
                .rev()
                .find(|(other, _)| other == key)
                .map(|(_, archive)| archive.clone())
        }

        fn store(&self, key: &Key, arrays: &Archive) {
            self.0.lock().unwrap().push((key.clone(), arrays.clone()));
        }
    }

    #[test]
    fn cached_pairs_are_reused_and_invalid_ones_recomputed() {
        let cache = Memory::default();
        let stored = || cache.0.lock().unwrap().len();
        let sphere = Surface::icosphere(2, 1.0).unwrap();
        let pairs = |surface: &Surface, delta, method| {
            geodesic_pairs_cached(surface, delta, method, &cache).unwrap()
        };
        let first = pairs(&sphere, 0.7, GeodesicMethod::Exact);
        assert_eq!(
            first,
            geodesic_pairs(&sphere, 0.7, GeodesicMethod::Exact).unwrap()
        );
        assert_eq!(first, pairs(&sphere, 0.7, GeodesicMethod::Exact));
        assert_eq!(stored(), 1);
        pairs(&sphere, 0.7, GeodesicMethod::Edge);
        pairs(&sphere, 0.7001, GeodesicMethod::Exact);
        pairs(
            &Surface::icosphere(2, 1.0 + 1e-15).unwrap(),
            0.7,
            GeodesicMethod::Exact,
        );
        assert_eq!(stored(), 4);
        for wrong in [
            ("counts", Values::U64(vec![3; 162])),
            ("counts", Values::U64(vec![u64::MAX; 162])),
            ("neighbours", Values::U8(vec![1; 4 * first.len() / 2])),
            ("neighbours", Values::U8(vec![1; 7])),
            ("distances", Values::F64(vec![0.8; first.len() / 2])),
            ("distances", Values::U8(vec![])),
        ] {
            let (key, mut archive) = cache.0.lock().unwrap()[0].clone();
            archive.put(wrong.0, wrong.1);
            cache.store(&key, &archive);
            let before = stored();
            assert_eq!(first, pairs(&sphere, 0.7, GeodesicMethod::Exact));
            assert_eq!(stored(), before + 1);
        }
    }
}
