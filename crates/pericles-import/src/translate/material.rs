//! Blocks with their materials and damage models: `[material]`, or `[materials]` with `[[assign]]`.

use super::model::{Keys, Model, Plane};
use super::sets::Sets;
use super::solver::Solver;
use super::{Code, Source, names};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::table::{self, Table};
use crate::units::Quantity;

/// The materials of a body.
#[derive(Debug)]
pub(crate) struct Materials<'e> {
    /// Keys that all materials share.
    shared: Keys,
    all: Vec<Material<'e>>,
    pub(super) plane: Option<Plane>,
    /// Thickness, for a body in the plane.
    pub(super) thickness: f64,
}

/// A material of one or more blocks.
#[derive(Debug)]
struct Material<'e> {
    name: String,
    keys: Keys,
    origins: Vec<&'e Entry>,
    /// Names of the blocks, with the entries that define them.
    blocks: Vec<(String, &'e Entry)>,
}

impl<'e> Materials<'e> {
    pub(crate) fn read(source: &Source<'e>, solver: &Solver<'_>) -> Result<Self, Fault> {
        let root = source.root;
        let blocks = root.need(&["Blocks"])?;
        let models = root.find_any(&["Models", "Physics"]).unwrap_or(root);
        let listed = models.find_any(&["Material Models", "Materials"]);
        let listed = listed
            .ok_or_else(|| root.fault("the entry `Materials` or `Material Models` is missing"))?;
        let damages = models.find("Damage Models");
        let mut read = Self {
            shared: Vec::new(),
            all: Vec::new(),
            plane: None,
            thickness: 1.0,
        };
        for block in blocks.entries()? {
            let name = block.need(&["Material Model", "Material"])?;
            let material = referenced(listed, name)?;
            let damage = match (block.find("Damage Model"), damages) {
                (None, _) => None,
                (Some(name), Some(damages)) => Some((name, referenced(damages, name)?)),
                (Some(name), None) => return Err(name.fault("the file defines no damage models")),
            };
            read.add(source, solver, block, material, damage)?;
        }
        if read.all.is_empty() {
            return Err(blocks.fault("there are no blocks"));
        }
        Ok(read)
    }

    fn add(
        &mut self,
        source: &Source<'e>,
        solver: &Solver<'_>,
        block: &'e Entry,
        material: &'e Entry,
        damage: Option<(&'e Entry, &'e Entry)>,
    ) -> Result<(), Fault> {
        let model = Model::of(source.code, material)?;
        self.read_plane(source.code, material, damage)?;
        let shared = model.shared(source.code, material)?;
        if self.all.is_empty() {
            self.shared = shared;
        } else if self.shared != shared {
            material.differ("all materials of a deck have the model of the first block");
        }
        let density = block
            .find("Density")
            .map_or_else(|| material.need(&["Density"]), Ok)?;
        let horizon = match block.find("Horizon") {
            Some(horizon) => horizon,
            None => {
                let body = source.root.find("Discretization");
                let horizon = body.and_then(|body| body.find("Horizon"));
                horizon.map_or_else(|| block.need(&["Horizon"]), Ok)?
            }
        };
        let mut keys = vec![
            (
                "density",
                source.units.number(density.positive()?, Quantity::Density),
            ),
            (
                "horizon",
                source.units.number(horizon.positive()?, Quantity::Length),
            ),
        ];
        keys.extend(model.constants(source, material, self.plane)?);
        let mut origins = vec![block, material];
        if let Some((name, damage)) = damage {
            if solver.breaks {
                keys.extend(model.failure(source, damage)?);
                origins.push(damage);
            } else {
                name.refuse("the solver does not evaluate damage models");
            }
        }
        let blocks = match (block.find("Block ID"), block.find("Block Names")) {
            (Some(number), _) => vec![format!("block_{}", number.count()?)],
            (None, Some(list)) => names(list.text()?).map(str::to_owned).collect(),
            (None, None) => vec![block.key().to_owned()],
        };
        let blocks = blocks.into_iter().map(|name| (name, block));
        match self.all.iter_mut().find(|known| known.keys == keys) {
            Some(known) => {
                known.origins.extend(origins);
                known.blocks.extend(blocks);
            }
            None => {
                let is_taken = self.all.iter().any(|known| known.name == material.key());
                let name = if is_taken {
                    format!("{} of {}", material.key(), block.key())
                } else {
                    material.key().to_owned()
                };
                self.all.push(Material {
                    name,
                    keys,
                    origins,
                    blocks: blocks.collect(),
                });
            }
        }
        Ok(())
    }

    /// Reads plane stress or strain, and the thickness.
    fn read_plane(
        &mut self,
        code: Code,
        material: &Entry,
        damage: Option<(&Entry, &Entry)>,
    ) -> Result<(), Fault> {
        let plane = match code {
            Code::PeriLab => match material.find("Symmetry") {
                None => None,
                Some(symmetry) => {
                    let text = symmetry.text()?.to_lowercase();
                    let has = |word: &str| text.contains(word);
                    if !has("isotropic") || has("transverse") {
                        symmetry.refuse("anisotropic materials: see [material.anisotropy]");
                    }
                    match (has("plane stress"), has("plane strain")) {
                        (true, _) => Some(Plane::Stress),
                        (_, true) => Some(Plane::Strain),
                        _ => None,
                    }
                }
            },
            Code::Peridigm if material.is_set("Plane Stress")? => Some(Plane::Stress),
            Code::Peridigm if material.is_set("Plane Strain")? => Some(Plane::Strain),
            Code::Peridigm => None,
        };
        if plane.is_some() {
            if self.plane.is_some() && self.plane != plane {
                material.differ(
                    "a body has either plane stress or plane strain: that of the last block",
                );
            }
            self.plane = plane;
            let thickness = match code {
                Code::PeriLab => damage.and_then(|(_, damage)| damage.find("Thickness")),
                Code::Peridigm => Some(material.need(&["Height"])?),
            };
            if let Some(thickness) = thickness {
                self.thickness = thickness.positive()?;
            }
        }
        Ok(())
    }

    /// Returns the tables; sets of blocks are added to the sets.
    pub(crate) fn tables(self, sets: &Sets<'_>) -> Vec<Table> {
        let from = |table: Table, origins: &[&Entry]| {
            origins.iter().fold(table, |table, entry| table.from(entry))
        };
        if let [one] = &self.all[..] {
            let table = from(Table::new("[material]"), &one.origins);
            let table = table.key("name", table::text(&one.name));
            return vec![table.keys(self.shared).keys(one.keys.clone())];
        }
        let mut tables = vec![Table::new("[material]").keys(self.shared)];
        let mut assignments = Vec::new();
        for material in self.all {
            let heading = table::heading("materials", &material.name);
            tables.push(from(Table::new(heading), &material.origins).keys(material.keys));
            for (block, origin) in &material.blocks {
                sets.use_block(block, origin);
                let assign = Table::new("[[assign]]").key("set", table::text(block));
                assignments.push(assign.key("material", table::text(&material.name)));
            }
        }
        tables.extend(assignments);
        tables
    }
}

/// Returns the entry of a group that a name refers to.
fn referenced<'e>(group: &'e Entry, name: &Entry) -> Result<&'e Entry, Fault> {
    let wanted = name.text()?;
    let known = group.entries()?;
    let found = known.iter().find(|entry| is_same(entry.key(), wanted));
    found.ok_or_else(|| {
        let known: Vec<&str> = known.iter().map(Entry::key).collect();
        name.fault(format!(
            "`{wanted}` is not defined; {} has: {}",
            group.path(),
            known.join(", ")
        ))
    })
}
