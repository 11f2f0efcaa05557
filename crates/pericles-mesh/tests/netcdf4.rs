//! netCDF-4 (HDF5) Exodus files with the feature `netcdf4`; without it, the error message.
//!
//! The files are written by `validation/formats/make_netcdf4.py`: the mesh of `formats/files.rs`, written by
//! meshio and compressed by the netCDF library.

use std::path::Path;

use pericles_mesh::{Fault, Format, RawMesh};

const MESHIO: &[u8] = include_bytes!("files/meshio.exo");

fn read(content: &[u8], memory: u64) -> Result<RawMesh, Fault> {
    let format = Format::of(Path::new("mesh.exo")).unwrap();
    format.parse(content, memory, &|name| {
        Err(format!("{name} does not exist"))
    })
}

#[cfg(not(feature = "netcdf4"))]
#[test]
fn netcdf_4_is_rejected_with_advice_on_conversion_and_feature() {
    let message = read(MESHIO, 1 << 26).unwrap_err().to_string();
    for part in [
        "netCDF-4 (HDF5)",
        "CDF-1, CDF-2, CDF-5",
        "ncks -5 IN OUT",
        "the feature netcdf4",
    ] {
        assert!(message.contains(part), "{message}");
    }
}

#[cfg(feature = "netcdf4")]
mod with_feature {
    use pericles_mesh::{MeshPoints, PointOptions, SetKind};

    use super::*;

    const COMPRESSED: &[u8] = include_bytes!("files/compressed.exo");

    fn points(content: &[u8]) -> MeshPoints {
        let mesh = read(content, 1 << 26).unwrap_or_else(|fault| panic!("{fault}"));
        let points = mesh.points(&PointOptions::default()).unwrap();
        assert_eq!((points.len(), points.dimension), (2, 3));
        for (volume, expected) in points.volumes.iter().zip([1.0, 0.5]) {
            assert!((volume - expected).abs() < 1e-14);
        }
        let centroids = [[0.5; 3], [4.0 / 3.0, 1.0 / 3.0, 0.5]];
        for (x, expected) in points.positions.iter().zip(centroids) {
            assert!((0..3).all(|c| (x[c] - expected[c]).abs() < 1e-14), "{x:?}");
        }
        points
    }

    fn set(points: &MeshPoints, name: &str) -> (SetKind, Vec<u32>) {
        let found = points.set(name).unwrap_or_else(|| panic!("no set {name}"));
        (found.kind, found.points.clone())
    }

    #[test]
    fn a_meshio_file_gives_the_points_and_sets_of_its_mesh() {
        let points = points(MESHIO);
        // meshio numbers blocks from 0 and does not name them.
        assert_eq!(set(&points, "block_0"), (SetKind::Elements, vec![0]));
        assert_eq!(set(&points, "block_1"), (SetKind::Elements, vec![1]));
        assert_eq!(set(&points, "tip"), (SetKind::Nodes, vec![1]));
    }

    #[test]
    fn a_compressed_file_gives_the_same_points_sets_and_areas_as_the_classic_one() {
        let points = points(COMPRESSED);
        assert_eq!(set(&points, "left part"), (SetKind::Elements, vec![0]));
        assert_eq!(set(&points, "right"), (SetKind::Elements, vec![1]));
        assert_eq!(set(&points, "tip"), (SetKind::Nodes, vec![1]));
        assert_eq!(set(&points, "x0"), (SetKind::Faces, vec![0]));
        assert_eq!(points.set("x0").unwrap().area, Some(1.0));
        assert_eq!(set(&points, "elemset_3"), (SetKind::Elements, vec![0, 1]));
    }

    #[test]
    fn a_damaged_file_is_rejected() {
        for content in [&MESHIO[..9000], b"\x89HDF\r\n\x1a\n"] {
            let message = read(content, 1 << 26).unwrap_err().to_string();
            assert!(
                message.contains("netCDF-4 file cannot be read"),
                "{message}"
            );
        }
    }
}
