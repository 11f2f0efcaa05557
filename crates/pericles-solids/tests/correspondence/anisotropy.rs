//! Anisotropic materials: engineering constants, rotations, and the speeds of plane waves.

use std::f64::consts::TAU;
use std::sync::Arc;

use pericles::material::StressState;
use pericles::space::PointCloud;
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Orthotropy, Stabilisation, Stiffness,
};

use crate::bodies::{force, largest, lattice, material, operator, wave};

/// A carbon-fibre ply, in units of 10 GPa.
pub const PLY: Orthotropy = Orthotropy {
    young: [14.0, 1.0, 0.9],
    poisson: [0.3, 0.25, 0.4],
    shear: [0.5, 0.45, 0.35],
};

/// Returns the rotation about an axis by an angle, from its columns by the formula of Rodrigues.
fn turn(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let n = axis.map(|x| x / length);
    let cross = |v: [f64; 3]| {
        [
            n[1] * v[2] - n[2] * v[1],
            n[2] * v[0] - n[0] * v[2],
            n[0] * v[1] - n[1] * v[0],
        ]
    };
    let column = |b: usize| -> [f64; 3] {
        let unit: [f64; 3] = std::array::from_fn(|a| if a == b { 1.0 } else { 0.0 });
        let (once, twice) = (cross(unit), cross(cross(unit)));
        std::array::from_fn(|a| unit[a] + angle.sin() * once[a] + (1.0 - angle.cos()) * twice[a])
    };
    let columns: [[f64; 3]; 3] = std::array::from_fn(column);
    std::array::from_fn(|a| std::array::from_fn(|b| columns[b][a]))
}

/// A ply with general axes, whose 21 constants are not zero.
pub fn oblique() -> Stiffness {
    let turn = turn([1.0, -2.0, 0.7], 0.8);
    Stiffness::orthotropic(&PLY).unwrap().turned(&turn)
}

/// A ply that is rotated within the plane.
pub fn in_plane(angle: f64) -> Stiffness {
    let ply = Stiffness::orthotropic(&PLY).unwrap();
    ply.turned(&turn([0.0, 0.0, 1.0], angle))
}

fn anisotropic(
    stiffness: Stiffness,
    horizon: f64,
    control: Stabilisation,
) -> CorrespondenceMaterial {
    CorrespondenceMaterial {
        anisotropy: Some(stiffness),
        ..material(0.3, horizon, ElasticLaw::StVenantKirchhoff, control)
    }
}

fn close(found: f64, expected: f64, scale: f64, tolerance: f64) {
    let error = (found - expected).abs() / scale;
    assert!(error < tolerance, "{found} {expected}: {error:e}");
}

/// In uniaxial stress the strains are those of the engineering constants; the stress of these strains is uniaxial.
#[test]
fn the_stiffness_of_an_orthotropic_solid_has_its_engineering_constants() {
    let stiffness = Stiffness::orthotropic(&PLY).unwrap();
    let ([e1, e2, e3], [n12, n13, n23]) = (PLY.young, PLY.poisson);
    let strains = [
        [1.0 / e1, -n12 / e1, -n13 / e1],
        [-n12 / e1, 1.0 / e2, -n23 / e2],
        [-n13 / e1, -n23 / e2, 1.0 / e3],
    ];
    for (along, strain) in strains.into_iter().enumerate() {
        let mut tensor = [[0.0; 3]; 3];
        (0..3).for_each(|c| tensor[c][c] = strain[c]);
        let stress = stiffness.stress(&tensor);
        for (a, row) in stress.iter().enumerate() {
            for (b, found) in row.iter().enumerate() {
                let expected = if a == along && b == along { 1.0 } else { 0.0 };
                close(*found, expected, 1.0, 1e-13);
            }
        }
    }
    for ([a, b], shear) in [[0, 1], [0, 2], [1, 2]].into_iter().zip(PLY.shear) {
        let mut tensor = [[0.0; 3]; 3];
        (tensor[a][b], tensor[b][a]) = (0.5, 0.5);
        close(stiffness.stress(&tensor)[a][b], shear, shear, 1e-13);
    }
}

/// Young's modulus of a ply at an angle θ to its fibres, of lamination theory:
/// 1/E_x = c⁴/E₁ + (1/G₁₂ − 2 ν₁₂/E₁) s² c² + s⁴/E₂.
#[test]
fn young_s_modulus_of_a_rotated_ply_is_that_of_lamination_theory() {
    let (young, ratio, shear) = (PLY.young, PLY.poisson[0], PLY.shear[0]);
    for angle in [0.0, 0.3, 0.9, 1.4] {
        let stiffness = in_plane(angle);
        stiffness.check(StressState::PlaneStress).unwrap();
        // The reduced stiffness for (ε_x, ε_y, γ); E_x is the inverse of the first entry of its inverse.
        let reduced: Vec<[f64; 3]> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .iter()
            .map(|[x, y, shear]| {
                let strain = [[*x, 0.5 * shear], [0.5 * shear, *y]];
                let stress = stiffness.body_stress(StressState::PlaneStress, &strain);
                [stress[0][0], stress[1][1], stress[0][1]]
            })
            .collect();
        let minor = reduced[1][1] * reduced[2][2] - reduced[1][2] * reduced[2][1];
        let cofactor =
            |a: usize, b: usize| reduced[1][a] * reduced[2][b] - reduced[1][b] * reduced[2][a];
        let determinant =
            reduced[0][0] * minor - reduced[0][1] * cofactor(0, 2) + reduced[0][2] * cofactor(0, 1);
        let (s, c) = angle.sin_cos();
        let compliance = c.powi(4) / young[0]
            + (1.0 / shear - 2.0 * ratio / young[0]) * s * s * c * c
            + s.powi(4) / young[1];
        close(
            determinant / minor,
            1.0 / compliance,
            1.0 / compliance,
            1e-12,
        );
    }
}

/// An isotropic stiffness, rotated, gives the forces of the isotropic material.
#[test]
fn an_isotropic_stiffness_has_the_forces_of_the_isotropic_material() {
    for (sides, state) in [
        (&[9.0, 8.0][..], StressState::PlaneStrain),
        (&[9.0, 8.0], StressState::PlaneStress),
        (&[6.0, 5.0, 5.0], StressState::Spatial),
    ] {
        let cloud = lattice(sides);
        for control in [
            Stabilisation::Isotropic,
            Stabilisation::Wan,
            Stabilisation::Silling,
        ] {
            let isotropic = material(0.3, 2.3, ElasticLaw::StVenantKirchhoff, control);
            let elastic = isotropic.solid.elastic.resolve(state).unwrap();
            let (young, ratio, shear) = (elastic.young(), elastic.poisson_ratio(), elastic.shear());
            let stiffness = Stiffness::orthotropic(&Orthotropy {
                young: [young; 3],
                poisson: [ratio; 3],
                shear: [shear; 3],
            })
            .unwrap()
            .turned(&turn([0.3, 1.0, 2.0], 1.1));
            let u = wave(&cloud, 0.05);
            let expected = force(&*operator(&cloud, &isotropic, state), &u);
            let found = force(
                &*operator(&cloud, &anisotropic(stiffness, 2.3, control), state),
                &u,
            );
            let size = largest(&expected);
            for (a, b) in found.iter().zip(&expected) {
                close(*a, *b, size, 1e-12);
            }
        }
    }
}

/// Returns −f/(k² a) of plane waves with wave vector k on a periodic lattice, extrapolated to long waves from three sizes; waves
/// of unit displacement along each axis are the columns of Christoffel's tensor Γ_il = C_ijkl n_j n_k.
fn acoustic<const D: usize>(
    stiffness: Stiffness,
    state: StressState,
    direction: [i32; D],
    sides: impl Fn(f64) -> [f64; D],
) -> [[f64; D]; D] {
    let of_length = |length: f64| -> [[f64; D]; D] {
        let cloud = PointCloud::clone(&lattice(&sides(length)));
        let cloud = Arc::new(cloud.with_periodic_faces().unwrap());
        let material = anisotropic(stiffness, 3.0 * (1.0 + 1e-9), Stabilisation::Isotropic);
        let operator = operator(&cloud, &material, state);
        let n = cloud.len();
        let wave = direction.map(|m| TAU * f64::from(m) / length);
        let square: f64 = wave.iter().map(|k| k * k).sum();
        let shape: Vec<f64> = (0..n)
            .map(|i| {
                let point = cloud.point(i);
                let phase: f64 = wave.iter().zip(point).map(|(k, x)| k * x).sum();
                phase.cos()
            })
            .collect();
        let norm: f64 = shape.iter().map(|x| x * x).sum();
        let mut columns = [[0.0; D]; D];
        for along in 0..D {
            let mut moved = vec![0.0; D * n];
            moved[along * n..(along + 1) * n].copy_from_slice(&shape);
            let (rest, mut out) = (vec![0.0; D * n], vec![0.0; D * n]);
            operator.tangent_into(0.0, &rest, &moved, &mut out);
            for c in 0..D {
                let part: f64 = (0..n).map(|i| shape[i] * out[c * n + i]).sum();
                columns[c][along] = -part / (norm * square);
            }
        }
        columns
    };
    let [coarse, medium, fine] = [64.0, 128.0, 256.0].map(of_length);
    // The error is even in the wave number: extrapolation removes its second and fourth power.
    let entry =
        |a: usize, b: usize| (64.0 * fine[a][b] - 20.0 * medium[a][b] + coarse[a][b]) / 45.0;
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
}

/// In the long-wave limit waves have the speeds of Christoffel's equation, Γ a = ρ c² a, whatever their direction and
/// polarisation: the whole tensor agrees to 1e-6.
#[test]
fn long_waves_have_the_speeds_of_christoffel_s_equation() {
    let stiffness = oblique();
    let size = stiffness.largest();
    for (direction, sides) in [
        ([1, 0, 0], [1.0, 0.0, 0.0]),
        ([0, 1, 0], [0.0, 1.0, 0.0]),
        ([0, 0, 1], [0.0, 0.0, 1.0]),
    ] {
        let sides = |length: f64| sides.map(|x| if x > 0.0 { length } else { 8.0 });
        let found = acoustic(stiffness, StressState::Spatial, direction, sides);
        let n = direction.map(f64::from);
        for along in 0..3 {
            // The stress of the strain sym(a ⊗ n), applied to n.
            let strain: [[f64; 3]; 3] = std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    let [here, there] =
                        [(a, b), (b, a)].map(|(a, b)| if a == along { n[b] } else { 0.0 });
                    0.5 * (here + there)
                })
            });
            let stress = stiffness.stress(&strain);
            for c in 0..3 {
                let expected: f64 = (0..3).map(|b| stress[c][b] * n[b]).sum();
                close(found[c][along], expected, size, 1e-6);
            }
        }
    }
    let stiffness = in_plane(0.4);
    for state in [StressState::PlaneStrain, StressState::PlaneStress] {
        for direction in [[1, 0], [1, 1], [2, -1]] {
            let found = acoustic(stiffness, state, direction, |length| [length; 2]);
            let [x, y] = direction.map(f64::from);
            let n = [x, y].map(|x_| x_ / x.hypot(y));
            for along in 0..2 {
                let strain: [[f64; 2]; 2] = std::array::from_fn(|a| {
                    std::array::from_fn(|b| {
                        let [here, there] =
                            [(a, b), (b, a)].map(|(a, b)| if a == along { n[b] } else { 0.0 });
                        0.5 * (here + there)
                    })
                });
                let stress = stiffness.body_stress(state, &strain);
                for c in 0..2 {
                    let expected: f64 = (0..2).map(|b| stress[c][b] * n[b]).sum();
                    close(found[c][along], expected, size, 1e-6);
                }
            }
        }
    }
}

#[test]
fn impossible_constants_are_rejected() {
    let reason =
        |orthotropy: Orthotropy| Stiffness::orthotropic(&orthotropy).unwrap_err().to_string();
    let error = reason(Orthotropy {
        poisson: [4.0, 0.25, 0.4],
        ..PLY
    });
    assert!(error.contains("positive energy"), "{error}");
    let mut rows = [[0.0; 6]; 6];
    (0..6).for_each(|k| rows[k][k] = 1.0);
    rows[0][3] = 0.1;
    let error = Stiffness::new(rows).unwrap_err().to_string();
    assert!(
        error.contains("symmetric") && error.contains("C14"),
        "{error}"
    );
    let error = oblique()
        .check(StressState::PlaneStrain)
        .unwrap_err()
        .to_string();
    assert!(error.contains("plane of symmetry"), "{error}");
    assert!(in_plane(0.7).check(StressState::Uniaxial).is_err());
}
