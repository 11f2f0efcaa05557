//! Physical groups: names, entities and elements.

use std::collections::{BTreeMap, HashMap};

use super::numbers::{Numbers, Version};
use crate::fault::Fault;
use crate::raw::NamedList;
use crate::scan::Words;

/// Physical groups of a file, each identified by a dimension and a positive tag.
#[derive(Debug, Default)]
pub(super) struct Groups {
    names: HashMap<(i64, u64), String>,
    /// Group tags of each entity, by dimension and tag of the entity.
    entities: HashMap<(i64, i64), Vec<u64>>,
    members: BTreeMap<(i64, u64), Vec<u32>>,
}

impl Groups {
    /// Reads `$PhysicalNames`: dimension, tag and quoted name on each line.
    pub(super) fn read_names(&mut self, words: &mut Words<'_>) -> Result<(), Fault> {
        let count = words.count("group names", 3)?;
        for _ in 0..count {
            let dimension = words.number("a dimension")?;
            let tag: i64 = words.number("a group tag")?;
            let rest: Vec<&str> = words.rest_of_line().collect();
            let name = rest.join(" ");
            let name = name.trim_matches('"').to_owned();
            self.names.insert((dimension, tag.unsigned_abs()), name);
        }
        Ok(())
    }

    /// Reads `$Entities`: the groups of each entity.
    pub(super) fn read_entities(&mut self, numbers: &mut Numbers<'_>) -> Result<(), Fault> {
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = numbers.count(Version::Four, "entities", 8)?;
        }
        self.read_blocks(numbers, counts, false)
    }

    /// Reads `$PartitionedEntities`: entities with additional dimension and tag of a parent entity and a list
    /// of partitions.
    pub(super) fn read_partitioned(&mut self, numbers: &mut Numbers<'_>) -> Result<(), Fault> {
        numbers.length("partitions")?;
        for _ in 0..numbers.length("ghost entities")? {
            numbers.int()?;
            numbers.int()?;
        }
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = numbers.count(Version::Four, "entities", 8)?;
        }
        self.read_blocks(numbers, counts, true)
    }

    fn read_blocks(
        &mut self,
        numbers: &mut Numbers<'_>,
        counts: [usize; 4],
        partitioned: bool,
    ) -> Result<(), Fault> {
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = numbers.int()?;
                if partitioned {
                    // Dimension and tag of the parent, then the partitions.
                    numbers.int()?;
                    numbers.int()?;
                    for _ in 0..numbers.length("partitions")? {
                        numbers.int()?;
                    }
                }
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    numbers.real()?;
                }
                let mut tags = Vec::new();
                for _ in 0..numbers.length("groups")? {
                    // The sign of a tag gives the orientation.
                    tags.push(numbers.int()?.unsigned_abs());
                }
                if !tags.is_empty() {
                    self.entities.insert((dimension, tag), tags);
                }
                if dimension > 0 {
                    for _ in 0..numbers.length("boundaries")? {
                        numbers.int()?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the group tags of an entity.
    pub(super) fn of_entity(&self, dimension: i64, tag: i64) -> Vec<u64> {
        let tags = self.entities.get(&(dimension, tag));
        tags.cloned().unwrap_or_default()
    }

    /// Adds a cell to a group.
    pub(super) fn add(&mut self, dimension: usize, tag: u64, cell: u32) {
        let members = self.members.entry((dimension as i64, tag)).or_default();
        if members.last() != Some(&cell) {
            members.push(cell);
        }
    }

    /// Returns the groups with members, by dimension and tag.
    pub(super) fn lists(self) -> Vec<NamedList> {
        let Self { names, members, .. } = self;
        let list = |(key, members): ((i64, u64), Vec<u32>)| NamedList {
            name: names
                .get(&key)
                .cloned()
                .unwrap_or_else(|| format!("group {}", key.1)),
            members,
        };
        members.into_iter().map(list).collect()
    }
}
