//! Facts of meshes, neighbours and probes.

use pericles::observe::Probe;
use pericles_mesh::Summary;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::list::{Facts, Section};
use crate::build::{Assembly, MeshBody};
use crate::units::{count, quantity, significant};

impl Facts {
    /// Adds element types, volume and sizes, and a line per set of each mesh.
    pub(super) fn meshes(&mut self, assembly: &Assembly) {
        let (mut pieces, mut sets) = (Vec::new(), Vec::new());
        for body in &assembly.meshes.all {
            let summary = Summary::new(&body.mesh, &body.points, body.unit);
            pieces.extend(self.mesh(body, &summary));
            sets.extend(self.mesh_sets(body, &summary));
        }
        self.unprinted(Section::Mesh)
            .entries("piece_meshes", &pieces, false)
            .entries("mesh_sets", &sets, false);
    }

    /// Adds a mesh; returns the values of the mesh of a piece.
    fn mesh(&mut self, body: &MeshBody, summary: &Summary) -> Option<Value> {
        let section = Section::Mesh;
        let kinds: Vec<String> = (summary.kinds.iter())
            .map(|(kind, number)| format!("{} {}", count(*number as u64), kind.word(*number)))
            .collect();
        let outside = match summary.in_no_group {
            0 => String::new(),
            some => format!("; {} points in no group", count(some as u64)),
        };
        let kinds = format!("{}{outside}", kinds.join(", "));
        let elements: Vec<Value> = (summary.kinds.iter())
            .map(|(kind, number)| json!({ "kind": kind.to_string(), "count": number }))
            .collect();
        let [least, mean, most] = summary.sizes.map(|size| quantity(size, "m"));
        let sizes = format!("{least} to {most}, mean {mean}");
        let volume = format!("{} m³", significant(summary.volume, 5));
        let Some(piece) = body.piece() else {
            self.line(section, "mesh", kinds)
                .checked("elements", "", elements)
                .checked("points_in_no_group", "", summary.in_no_group);
            self.line(section, "mesh volume", volume)
                .checked("mesh_volume", "m3", summary.volume);
            self.line(section, "element size", sizes)
                .checked("element_size", "m", summary.sizes);
            return None;
        };
        let text = format!("{piece}: {kinds}; {volume}; element size {sizes}");
        self.line(section, "mesh of piece", text);
        Some(json!({
            "piece": piece,
            "elements": elements,
            "points_in_no_group": summary.in_no_group,
            "volume": summary.volume,
            "element_size": summary.sizes,
        }))
    }

    /// Adds the sets of a mesh; returns their values.
    fn mesh_sets(&mut self, body: &MeshBody, summary: &Summary) -> Vec<Value> {
        /// Largest number of sets; `pericles mesh` lists all.
        const SETS: usize = 20;
        let sets = summary.sets.iter().take(SETS);
        let entries = sets.map(|set| {
            let area = set.area.map_or(String::new(), |area| {
                format!(", area {} m²", significant(area, 5))
            });
            let name = body.name_in_decks(&set.name);
            let text = format!("{name}: {} points{area}", count(set.points as u64));
            self.line(Section::Mesh, "mesh set", text);
            json!({ "name": name, "points": set.points, "area": set.area })
        });
        entries.collect()
    }

    /// Adds the smallest, mean and largest number of intact bonds of a point, if the operator gives access to single bonds.
    pub(super) fn neighbours(&mut self, assembly: &Assembly) {
        let Some(bonds) = assembly.system.operator().capabilities().bonds else {
            return;
        };
        let count_of = |i: usize| {
            let mut count = 0u64;
            bonds.for_each_undeformed(i, &mut |_| count += 1);
            (count, count, count)
        };
        let join = |a: (u64, u64, u64), b: (u64, u64, u64)| (a.0.min(b.0), a.1.max(b.1), a.2 + b.2);
        let points = (0..assembly.cloud.len()).into_par_iter();
        let (least, most, sum) = points.map(count_of).reduce(|| (u64::MAX, 0, 0), join);
        let mean = sum as f64 / assembly.cloud.len() as f64;
        let text = format!(
            "{} to {} per point, {} on average",
            count(least),
            count(most),
            significant(mean, 3)
        );
        let value = json!({ "least": least, "mean": mean, "most": most });
        self.line(Section::Mesh, "neighbours", text)
            .checked("neighbours", "", value);
    }

    /// Adds the locations of the probes: a point, or the mean over a set.
    pub(super) fn probes(&mut self, assembly: &Assembly) {
        let entries = assembly.probes.iter().map(|probe: &Probe| {
            let mut value = json!({ "name": probe.name, "points": probe.points.len() });
            let text = match probe.points[..] {
                [point] => {
                    let place = assembly.cloud.point(point as usize);
                    let place = &place[..assembly.cloud.dimension()];
                    let shown: Vec<String> = place.iter().map(|x| quantity(*x, "m")).collect();
                    value["place"] = json!(place);
                    format!("{} at ({})", probe.name, shown.join(", "))
                }
                _ => format!(
                    "{}: mean over {} points",
                    probe.name,
                    count(probe.points.len() as u64)
                ),
            };
            ("probe", text, value)
        });
        self.list(Section::Probes, "probes", false, entries);
    }
}
