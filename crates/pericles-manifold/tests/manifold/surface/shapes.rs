//! Shapes, their measures, and invalid surfaces.

use std::f64::consts::PI;

use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks, SurfaceError};

fn checked(surface: Surface) -> (Surface, pericles_manifold::surface::SurfaceReport) {
    surface.checked(SurfaceChecks::default()).unwrap()
}

fn rejected(surface: Surface, checks: SurfaceChecks) -> SurfaceError {
    surface.checked(checks).unwrap_err()
}

#[test]
fn the_icosphere_has_the_published_measures() {
    // Computed for Coclite, Coclite, Maddalena, Politi (2022), section 5.
    let (sphere, report) = checked(Surface::icosphere(3, 1.0).unwrap());
    assert_eq!(
        (sphere.len(), report.edges, sphere.triangles().len()),
        (642, 1920, 1280)
    );
    assert!((sphere.area() - 12.506492733969928).abs() < 1e-12);
    assert!((sphere.volume() - 4.152740817093058).abs() < 1e-12);
    let areas = sphere.vertex_areas(AreaRule::Barycentric);
    let (low, high) = (
        areas.iter().copied().fold(1.0, f64::min),
        areas.iter().copied().fold(0.0, f64::max),
    );
    assert!((low - 0.0151380682).abs() < 1e-10 && (high - 0.0226815464).abs() < 1e-10);
    let [shortest, _, longest] = report.edge_lengths;
    assert!((shortest - 0.1382831735).abs() < 1e-10 && (longest - 0.1646471600).abs() < 1e-10);
    for pole in [1.0, -1.0] {
        assert!(
            sphere
                .positions()
                .iter()
                .any(|x| x[0] == 0.0 && x[1] == 0.0 && x[2] == pole)
        );
    }
    assert_eq!(
        geodesic_pairs(&sphere, 0.5, GeodesicMethod::Edge)
            .unwrap()
            .len(),
        22740
    );
}

#[test]
fn shapes_are_closed_and_converge_in_area_and_volume() {
    let (r, l) = (0.3, 1.1);
    let shapes: [(Surface, i64, f64, f64); 5] = [
        (
            Surface::icosphere(4, 2.0).unwrap(),
            0,
            16.0 * PI,
            32.0 / 3.0 * PI,
        ),
        (
            Surface::uv_sphere(80, 39, 1.0).unwrap(),
            0,
            4.0 * PI,
            4.0 / 3.0 * PI,
        ),
        (
            Surface::torus(1.0, r, 90, 40).unwrap(),
            1,
            4.0 * PI * PI * r,
            2.0 * PI * PI * r * r,
        ),
        (
            Surface::capsule(r, l, 64).unwrap(),
            0,
            2.0 * PI * r * (l + 2.0 * r),
            PI * r * r * (l + 4.0 / 3.0 * r),
        ),
        // Oblate, a = 2c: area 2πa² (1 + (1 − e²)/e artanh e).
        (
            Surface::ellipsoid(4, [1.0, 1.0, 0.5]).unwrap(),
            0,
            {
                let e = 0.75f64.sqrt();
                2.0 * PI * (1.0 + 0.25 / e * e.atanh())
            },
            2.0 / 3.0 * PI,
        ),
    ];
    for (surface, genus, area, volume) in shapes {
        let (surface, report) = checked(surface);
        assert_eq!(report.components.len(), 1);
        assert_eq!(report.components[0].genus(), Some(genus));
        assert!(
            (surface.area() / area - 1.0).abs() < 5e-3,
            "{} {area}",
            surface.area()
        );
        assert!(
            (surface.volume() / volume - 1.0).abs() < 1e-2,
            "{} {volume}",
            surface.volume()
        );
        for rule in [AreaRule::Barycentric, AreaRule::MixedVoronoi] {
            let sum: f64 = surface.vertex_areas(rule).iter().sum();
            assert!((sum / surface.area() - 1.0).abs() < 1e-12);
        }
        // Gauss–Bonnet: Σ (2π − total angle) = 2π χ.
        let curvature: f64 = surface
            .total_angles()
            .iter()
            .map(|angle| 2.0 * PI - angle)
            .sum();
        assert!((curvature - 4.0 * PI * (1 - genus) as f64).abs() < 1e-9);
    }
}

#[test]
fn cotangents_give_twice_the_mean_curvature_of_a_sphere() {
    let sphere = Surface::icosphere(4, 2.0).unwrap();
    let areas = sphere.vertex_areas(AreaRule::MixedVoronoi);
    let weights = sphere.cotangents();
    let x = sphere.positions();
    let mut laplacian = vec![[0.0; 3]; sphere.len()];
    for (&[a, b], weight) in weights.edges.iter().zip(&weights.weights) {
        for c in 0..3 {
            let flow = weight * (x[b as usize][c] - x[a as usize][c]);
            laplacian[a as usize][c] += flow;
            laplacian[b as usize][c] -= flow;
        }
    }
    for i in 0..sphere.len() {
        for c in 0..3 {
            // Δx = −2 x / R².
            assert!((laplacian[i][c] / areas[i] + 0.5 * x[i][c]).abs() < 0.01);
        }
    }
}

fn tetrahedron() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    (
        vec![
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ],
        vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    )
}

/// Two tetrahedra with `shared` common corners, the second pointing away along (a, a, a).
fn two(shared: usize) -> Surface {
    let (mut x, mut t) = tetrahedron();
    let (y, s) = tetrahedron();
    let new: Vec<u32> = (0..4u32)
        .map(|v| {
            if (v as usize) < shared {
                v
            } else {
                v + 4 - shared as u32
            }
        })
        .collect();
    x.extend(y[shared..].iter().map(|p| p.map(|c| c + 5.0)));
    t.extend(s.iter().map(|t| t.map(|v| new[v as usize])));
    Surface::new(x, t).unwrap()
}

#[test]
fn each_invalid_surface_has_its_own_message() {
    let strict = SurfaceChecks::default();
    let build = |x: Vec<[f64; 3]>, t: Vec<[u32; 3]>| Surface::new(x, t).unwrap();
    let (x, t) = tetrahedron();
    assert!(build(x.clone(), t.clone()).checked(strict).is_ok());

    let open = build(x.clone(), t[..3].to_vec());
    let error = rejected(open.clone(), strict);
    assert_eq!(
        error,
        SurfaceError::Open {
            edges: 3,
            first: [1, 2]
        }
    );
    assert!(
        error
            .to_string()
            .contains("3 edge(s) belong to one triangle only")
    );
    let allowed = SurfaceChecks {
        open: true,
        ..strict
    };
    assert_eq!(open.checked(allowed).unwrap().1.boundary_edges, 3);

    assert!(matches!(
        rejected(two(2), strict),
        SurfaceError::NonManifoldEdge {
            edges: 1,
            first: [0, 1],
            triangles: 4
        }
    ));
    assert_eq!(
        rejected(two(1), strict),
        SurfaceError::BowTie {
            vertices: 1,
            first: 0
        }
    );
    assert_eq!(
        rejected(two(0), strict),
        SurfaceError::SeveralComponents {
            components: 2,
            sizes: [4, 4]
        }
    );
    assert!(
        two(0)
            .checked(SurfaceChecks {
                several_components: true,
                ..strict
            })
            .is_ok()
    );

    let mut flipped = t.clone();
    flipped[2].swap(0, 1);
    assert_eq!(
        rejected(build(x.clone(), flipped.clone()), strict),
        SurfaceError::Flipped {
            edges: 3,
            first: [0, 1]
        }
    );
    let mut inside_out = t.clone();
    inside_out.iter_mut().for_each(|t| t.swap(0, 1));
    assert!(
        matches!(rejected(build(x.clone(), inside_out.clone()), strict), SurfaceError::InsideOut { volume } if volume < -2.0)
    );
    for (triangles, turned) in [(flipped, 1), (inside_out, 4)] {
        let flip = SurfaceChecks {
            flip: true,
            ..strict
        };
        let (surface, report) = build(x.clone(), triangles).checked(flip).unwrap();
        assert_eq!(report.flipped, turned);
        assert!((surface.volume() - 8.0 / 3.0).abs() < 1e-14);
    }

    // A Möbius strip of five quadrilaterals.
    let strip: Vec<[f64; 3]> = (0..10)
        .map(|k| {
            let (a, out) = (
                f64::from(k / 2) * 0.4 * PI,
                if k % 2 == 0 { 0.3 } else { -0.3 },
            );
            let radius = 1.0 + out * (0.5 * a).cos();
            [radius * a.cos(), radius * a.sin(), out * (0.5 * a).sin()]
        })
        .collect();
    let mut around: Vec<[u32; 3]> = (0..4)
        .flat_map(|k| {
            [
                [2 * k, 2 * k + 1, 2 * k + 2],
                [2 * k + 1, 2 * k + 3, 2 * k + 2],
            ]
        })
        .collect();
    around.extend([[8, 9, 1], [9, 0, 1]]);
    assert_eq!(
        rejected(
            build(strip, around),
            SurfaceChecks {
                open: true,
                flip: true,
                ..strict
            }
        ),
        SurfaceError::OneSided
    );

    let mut flat = x.clone();
    flat[3] = [0.0, 0.0, 0.0];
    flat[0] = [0.5, -0.5, -0.5];
    assert!(matches!(
        rejected(build(flat, t.clone()), strict),
        SurfaceError::Degenerate { first: 2, .. }
    ));
    let mut twice = x.clone();
    twice.push([1.0, 1.0, 1.0 + 1e-13]);
    assert_eq!(
        rejected(build(twice, t.clone()), strict),
        SurfaceError::Duplicate {
            vertices: 1,
            first: [0, 4]
        }
    );
    let mut lonely = x.clone();
    lonely.push([0.0; 3]);
    assert_eq!(
        rejected(build(lonely, t.clone()), strict),
        SurfaceError::Unreferenced {
            vertices: 1,
            first: 4
        }
    );

    assert!(matches!(
        Surface::new(x.clone(), vec![[0, 1, 4]]),
        Err(SurfaceError::NoSuchVertex {
            triangle: 0,
            vertex: 4,
            vertices: 4
        })
    ));
    assert!(matches!(
        Surface::new(vec![], vec![]),
        Err(SurfaceError::Empty)
    ));
    let mut infinite = x;
    infinite[2][1] = f64::NAN;
    assert!(matches!(
        Surface::new(infinite, t),
        Err(SurfaceError::NotFinite { vertex: 2, .. })
    ));
    for bad in [
        Surface::icosphere(11, 1.0),
        Surface::icosphere(2, 0.0),
        Surface::torus(0.3, 0.5, 9, 9),
        Surface::torus(3.0, 0.5, u32::MAX, u32::MAX),
        Surface::uv_sphere(u32::MAX, 2, 1.0),
        Surface::capsule(1e-9, 1e9, 7),
        Surface::capsule(1.0, 1.0, 3),
    ] {
        assert!(matches!(
            bad,
            Err(SurfaceError::Parameter { .. } | SurfaceError::TooLarge { .. })
        ));
    }
}
