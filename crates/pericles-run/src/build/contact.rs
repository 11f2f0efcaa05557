//! Contact between points, and impactors.

use pericles::space::PointCloud;
use pericles::time::State;
use pericles::{PointScalar, System};
use pericles_contact::{
    ClosedMesh, ContactBodies, ContactLaw, ContactPairs, ContactStiffness, Friction, Impactor,
    ImpactorMotion, Inertia, PairLaw, PointContact, Pose, Shape, usual_overlap,
};
use pericles_deck::{
    BuildError, Caution, Contact, ContactCaution, Fault, ImpactorInertia, ImpactorShape, KeyPath,
    ModelWarning, Remark, Solid,
};

use pericles_mesh::fill::TriangleSurface;

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::rejection::{at, at_path};
use super::resources::Resources;
use super::rotation::{UNIT, product, times, upright};

/// The constants of the materials: the body's material and the others in the order of the deck.
pub(super) type AllConstants<'a> = (Option<&'a MaterialConstants>, &'a [MaterialConstants]);

/// Contact of an assembled model, for the time step and warnings.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactFacts {
    /// The highest frequency of a single contact, 1/s; 0 without contact.
    pub(super) frequency: f64,
    /// The largest relative speed of pieces and impactors at the start, m/s.
    pub(super) speed: f64,
}

impl Assembler<'_> {
    /// Adds the contact of the model to a system.
    pub(super) fn add_contact(
        &self,
        system: &mut System,
        (discretisation, state): (&Discretisation, &State),
        constants: AllConstants<'_>,
        resources: &Resources<'_>,
    ) -> Result<ContactFacts, BuildError> {
        let Some(solid) = self.model.body.solid() else {
            return Ok(ContactFacts::default());
        };
        let pieces = solid.shape.pieces().len();
        if self.model.contact.is_none() && pieces > 1 {
            self.warn("body.piece", Caution::NoContact { pieces });
        }
        if self.model.contact.is_none() && self.model.impactors.is_empty() {
            return Ok(ContactFacts::default());
        }
        let contact = self.model.contact.unwrap_or_default();
        let law = law(&contact);
        let bodies = self.contact_bodies(solid, discretisation, constants)?;
        let cloud = &discretisation.cloud;
        if self.model.contact.is_some() {
            PointContact::new(cloud.clone(), law, bodies.clone())
                .and_then(|points| system.add_interaction(Box::new(points)))
                .map_err(|error| at("contact", error))?;
            if law.friction.is_some() && cloud.dimension() > 1 {
                self.warn(
                    "contact.friction",
                    Caution::Contact(ContactCaution::FrictionTorque),
                );
            }
        }
        for (k, impactor) in self.model.impactors.iter().enumerate() {
            let path = KeyPath::from("impactor").index(k);
            let (shape, pose) = self.impactor_shape(&path, impactor, resources)?;
            self.warnings.extend(small_impactor(&path, &shape, cloud));
            let motion = impactor_motion((&path, impactor), self.model.time.end)?;
            let one = Impactor::new(
                impactor.name.clone(),
                shape,
                pose,
                motion,
                cloud.clone(),
                law,
                bodies.clone(),
            )
            .map_err(|error| at(&path, error))?;
            system
                .add_interaction(Box::new(one))
                .map_err(|error| at(&path, error))?;
        }
        let density = &bodies.density;
        let facts = ContactFacts {
            frequency: system.single_contact_frequency(density),
            speed: self.impact_speed(system, cloud, state),
        };
        self.check_impact(solid, &contact, facts, constants);
        Ok(facts)
    }

    /// Returns pieces and materials of the points.
    fn contact_bodies(
        &self,
        solid: &Solid,
        discretisation: &Discretisation,
        (own, others): AllConstants<'_>,
    ) -> Result<ContactBodies, BuildError> {
        let Discretisation {
            cloud, grids, sets, ..
        } = discretisation;
        // Warnings about materials were reported when the forces were built.
        let (of_point, density) = self.materials_of_points(&solid.material, (cloud, sets))?;
        let young: Vec<f64> = own
            .into_iter()
            .chain(others)
            .map(|one| one.young())
            .collect();
        let horizons = std::iter::once(solid.material.horizon());
        let others = self.model.materials.iter();
        let horizons: Vec<f64> = horizons
            .chain(others.map(|other| other.model.horizon()))
            .collect();
        let material = |i: usize| of_point.as_ref().map_or(0, |all| usize::from(all[i]));
        let points = cloud.len();
        let ratio = |i: usize| f64::from(grids.ratios[usize::from(grids.of_point[i])]);
        let horizon = |i: usize| horizons[material(i)] / ratio(i);
        let modulus = |i: usize| young.get(material(i)).copied().unwrap_or(young[0]);
        let all = |value: &dyn Fn(usize) -> f64| match of_point.is_some() || grids.ratios.len() > 1
        {
            true => PointScalar::PerPoint((0..points).map(value).collect()),
            false => PointScalar::Uniform(value(0)),
        };
        Ok(ContactBodies {
            piece: (0..points).map(|i| cloud.piece(i)).collect(),
            young: all(&modulus),
            horizon: all(&horizon),
            density,
        })
    }

    /// Returns the shape of an impactor in its own frame and its place.
    fn impactor_shape(
        &self,
        path: &KeyPath,
        impactor: &pericles_deck::Impactor,
        resources: &Resources<'_>,
    ) -> Result<(Shape, Pose), BuildError> {
        let turned = impactor
            .rotation
            .as_ref()
            .map_or(UNIT, |rotation| rotation.matrix());
        let (shape, frame, middle) = match &impactor.shape {
            ImpactorShape::Ball { radius } => (Shape::Ball { radius: *radius }, UNIT, ORIGIN),
            ImpactorShape::Box { size } => {
                let half = size.map(|side| 0.5 * side);
                (Shape::Box { half }, UNIT, ORIGIN)
            }
            ImpactorShape::Cylinder {
                radius,
                height,
                axis,
            } => {
                let shape = Shape::Cylinder {
                    radius: *radius,
                    half_height: 0.5 * height,
                };
                (shape, upright(*axis), ORIGIN)
            }
            ImpactorShape::HalfSpace { normal } => (Shape::HalfSpace, upright(*normal), ORIGIN),
            ImpactorShape::Surface { path: file, unit } => {
                let key = path.key("file");
                let file = resources.beside(file);
                let mesh = self.read_mesh(key.clone(), &file, resources)?;
                let wrong = |reason: String| {
                    let reason = format!("{}: {reason}", file.display());
                    at_path(&key, Fault::BadMesh { reason })
                };
                mesh.check().map_err(|error| wrong(error.to_string()))?;
                let surface = TriangleSurface::of_mesh(&mesh, *unit);
                let surface = surface.map_err(|error| wrong(error.to_string()))?;
                // The triangles of some formats, such as STL, have vertices of their own.
                let (surface, reversed) = surface.repaired();
                self.warnings.extend(reversed.map(|reversed| {
                    let problem = reversed.to_string();
                    Remark::new(key.clone(), Caution::Mesh { problem })
                }));
                let vertices = surface.positions().to_vec();
                let closed = ClosedMesh::new(vertices, surface.triangles().to_vec());
                let closed = closed.map_err(|error| wrong(error.to_string()))?;
                let middle = centroid(&closed);
                (Shape::Mesh(closed), UNIT, middle)
            }
        };
        // The centre of mass stays where it is when the impactor is rotated.
        let moved = times(&turned, middle);
        let centre = std::array::from_fn(|c| impactor.centre[c] + middle[c] - moved[c]);
        let rotation = product(&turned, &frame);
        Ok((shape, Pose { centre, rotation }))
    }

    /// Returns the largest relative speed of pieces and impactors at the start. All processes must call it together.
    fn impact_speed(&self, system: &System, cloud: &PointCloud, state: &State) -> f64 {
        let (n, domain) = (cloud.len(), cloud.domain());
        let last = cloud.pieces().iter().max().copied().unwrap_or(0);
        let pieces = domain.max(f64::from(last)) as u32 + 1;
        let total = |piece: u32, of: &(dyn Fn(usize) -> f64 + Sync)| {
            domain.sum(n, |i| match cloud.piece(i) == piece {
                true => cloud.volumes()[i] * of(i),
                false => 0.0,
            })
        };
        let mut momentum = Vec::new();
        let mut mass = Vec::new();
        for piece in 0..pieces {
            mass.push(total(piece, &|_| 1.0));
            momentum.push(std::array::from_fn(|c| match c < cloud.dimension() {
                true => total(piece, &|i| state.v[c * n + i]),
                false => 0.0,
            }));
        }
        let mut all: Vec<[f64; 3]> = (momentum.iter().zip(&mass))
            .filter(|(_, m)| **m > 0.0)
            .map(|(p, m): (&[f64; 3], _)| p.map(|x| x / m))
            .collect();
        let impactors = system.interactions();
        let impactors = impactors.filter_map(|one| one.downcast_ref::<Impactor>());
        all.extend(impactors.map(|one| one.reading().velocity));
        let apart =
            |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt();
        let pairs = all.iter().enumerate();
        pairs
            .flat_map(|(k, a)| all[..k].iter().map(move |b| apart(a, b)))
            .fold(0.0, f64::max)
    }

    /// Warns of impacts so fast that points may pass each other.
    fn check_impact(
        &self,
        solid: &Solid,
        contact: &Contact,
        facts: ContactFacts,
        (own, _): AllConstants<'_>,
    ) {
        /// Overlap in spacings above which points may pass each other.
        const LARGE: f64 = 0.5;
        if self.model.time.scheme.is_static() {
            return;
        }
        let (Some(own), Some(spacing)) = (own, solid.shape.spacing()) else {
            return;
        };
        let wave_speed = (own.young() / solid.material.density()).sqrt();
        let ratio = solid.material.horizon() / spacing;
        let overlap = match contact.stiffness {
            pericles_deck::ContactStiffness::Relative(stiffness) => {
                usual_overlap(facts.speed, wave_speed, ratio, stiffness)
            }
            pericles_deck::ContactStiffness::Absolute(_) => 0.0,
        };
        if overlap > LARGE {
            let caution = ContactCaution::FastImpact {
                speed: facts.speed,
                wave_speed,
                overlap,
            };
            self.warn("contact.stiffness", Caution::Contact(caution));
        }
    }

    /// Warns of steps above `longest` (s), which resolve contacts badly, and of steps in which a bond is stretched by more than the critical stretch.
    pub(super) fn check_contact_step(
        &self,
        (dt, longest): (f64, f64),
        facts: ContactFacts,
        own: Option<&MaterialConstants>,
        spacing: f64,
    ) {
        if self.model.time.scheme.is_static() {
            return;
        }
        if dt > longest * (1.0 + 1e-9) {
            let caution = ContactCaution::FewContactSteps { dt, longest };
            self.warn("time.dt", Caution::Contact(caution));
        }
        let critical = own.map_or(f64::INFINITY, MaterialConstants::critical_stretch);
        let stretched = facts.speed * dt / spacing;
        if stretched > critical {
            let caution = ContactCaution::CoarseImpact {
                speed: facts.speed,
                times: stretched / critical,
            };
            self.warn("time.dt", Caution::Contact(caution));
        }
    }
}

const ORIGIN: [f64; 3] = [0.0; 3];

/// Converts the table of a deck to the law of the contact forces.
fn law(contact: &Contact) -> ContactLaw {
    ContactLaw {
        pairs: match contact.pairs {
            pericles_deck::ContactPairs::Unbonded => ContactPairs::Unbonded,
            pericles_deck::ContactPairs::Pieces => ContactPairs::Pieces,
            pericles_deck::ContactPairs::All => ContactPairs::All,
        },
        law: match contact.law {
            pericles_deck::ContactLaw::Linear => PairLaw::Linear,
            pericles_deck::ContactLaw::Power(exponent) => PairLaw::Power(exponent),
            pericles_deck::ContactLaw::Emu => PairLaw::Emu,
        },
        stiffness: match contact.stiffness {
            pericles_deck::ContactStiffness::Relative(factor) => ContactStiffness::Relative(factor),
            pericles_deck::ContactStiffness::Absolute(k) => ContactStiffness::Absolute(k),
        },
        distance: contact.distance,
        closing: contact.closing,
        damping: contact.damping,
        friction: contact.friction.map(|friction| Friction {
            coefficient: friction.coefficient,
            speed: friction.speed,
        }),
    }
}

fn impactor_motion(
    (path, impactor): (&KeyPath, &pericles_deck::Impactor),
    end: f64,
) -> Result<ImpactorMotion, BuildError> {
    Ok(match &impactor.motion {
        pericles_deck::ImpactorMotion::Free {
            inertia,
            velocity,
            spin,
        } => ImpactorMotion::Free {
            inertia: match *inertia {
                ImpactorInertia::Density(density) => Inertia::Density(density),
                ImpactorInertia::Mass { mass, inertia } => Inertia::Mass {
                    mass,
                    inertia: inertia.map(|moments| {
                        std::array::from_fn(|a| {
                            std::array::from_fn(|b| if a == b { moments[a] } else { 0.0 })
                        })
                    }),
                },
            },
            velocity: *velocity,
            spin: *spin,
        },
        pericles_deck::ImpactorMotion::Prescribed {
            kind,
            amplitude,
            function,
        } => ImpactorMotion::Prescribed {
            kind: *kind,
            amplitude: *amplitude,
            function: function
                .motion_function(*kind, end)
                .map_err(|fault| at_path(path.key("function"), fault))?,
        },
    })
}

/// Returns the centre of the volume of a closed mesh, from signed tetrahedra.
fn centroid(mesh: &ClosedMesh) -> [f64; 3] {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|k| mesh.vertices()[k as usize]);
        let six = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        volume += six;
        for k in 0..3 {
            moment[k] += 0.25 * six * (a[k] + b[k] + c[k]);
        }
    }
    moment.map(|entry| entry / volume)
}

/// Warns of an impactor that may pass between the points.
fn small_impactor(path: &KeyPath, shape: &Shape, cloud: &PointCloud) -> Option<ModelWarning> {
    let (half_width, spacing) = (
        shape.smallest_half_width(cloud.dimension()),
        cloud.spacing(),
    );
    let caution = ContactCaution::SmallImpactor {
        width: 2.0 * half_width,
        spacing,
    };
    let is_small = cloud.dimension() > 1 && half_width < 0.5 * spacing;
    is_small.then(|| Remark::new(path, Caution::Contact(caution)))
}
