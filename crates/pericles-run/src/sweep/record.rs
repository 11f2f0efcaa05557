//! Record of a sweep: the deck, the values of its keys, and the runs of all combinations.

use std::path::PathBuf;

use pericles_io::file_stem;
use serde::{Deserialize, Serialize};

use super::axis::Axis;
use crate::deck_text::DeckText;

/// The content of `sweep.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    pub(super) deck: DeckText,
    pub(super) axes: Vec<Axis>,
    /// The folder of another run, or its checkpoint, from which all runs start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) from: Option<PathBuf>,
}

/// One combination of values.
pub(crate) struct Member {
    /// The name of its folder.
    pub(crate) name: String,
    /// One value per key.
    pub(crate) values: Vec<String>,
    /// The deck with these values.
    pub(crate) deck: DeckText,
}

impl Record {
    /// Returns all combinations; the last axis varies fastest.
    pub(super) fn members(&self) -> Vec<Member> {
        let mut combinations = vec![Vec::new()];
        for axis in &self.axes {
            let extended = combinations.iter().flat_map(|values: &Vec<String>| {
                axis.values.iter().map(move |value| {
                    let mut values = values.clone();
                    values.push(value.clone());
                    values
                })
            });
            combinations = extended.collect();
        }
        let mut members: Vec<Member> = Vec::new();
        for values in combinations {
            let mut name = self.name(&values);
            // Names may coincide after the replacement of characters that are not allowed in file names.
            if members.iter().any(|member| member.name == name) {
                name += &format!("-{}", members.len() + 1);
            }
            members.push(self.member(name, values));
        }
        members
    }

    fn name(&self, values: &[String]) -> String {
        let parts: Vec<String> = (self.axes.iter().zip(values))
            .map(|(axis, value)| format!("{}={value}", axis.name()))
            .collect();
        file_stem(&parts.join(","), "+-.=,")
    }

    fn member(&self, name: String, values: Vec<String>) -> Member {
        let mut deck = self.deck.clone();
        let sets = self.axes.iter().zip(&values);
        deck.overrides
            .extend(sets.map(|(axis, value)| format!("{}={value}", axis.key)));
        Member { name, values, deck }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::Inputs;

    #[test]
    fn every_combination_has_its_own_folder() {
        let record = Record {
            deck: DeckText {
                file: "a.toml".into(),
                source: String::new(),
                overrides: vec!["time.end=1".into()],
                step: None,
                inputs: Inputs::default(),
                amended: Vec::new(),
            },
            axes: vec![
                "body.spacing=1 mm,1/mm".parse().unwrap(),
                "m=3,4".parse().unwrap(),
            ],
            from: None,
        };
        let members = record.members();
        let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
        assert_eq!(
            names,
            [
                "spacing=1_mm,m=3",
                "spacing=1_mm,m=4",
                "spacing=1_mm,m=3-3",
                "spacing=1_mm,m=4-4"
            ]
        );
        assert_eq!(
            members[1].deck.overrides,
            ["time.end=1", "body.spacing=1 mm", "m=4"]
        );
    }
}
