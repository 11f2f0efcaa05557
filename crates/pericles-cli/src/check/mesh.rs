//! Lines of `check` about a mesh.

use pericles_mesh::Summary;
use pericles_run::units::{count, quantity, significant};
use pericles_run::{Assembly, MeshBody};
use serde_json::json;

use super::line::Line;

/// Element types, volume and sizes, and a line per set of the mesh.
pub(super) fn mesh(assembly: &Assembly) -> Vec<Line> {
    let meshes = assembly.meshes.all.iter();
    meshes.flat_map(of_mesh).collect()
}

fn of_mesh(body: &MeshBody) -> Vec<Line> {
    let summary = Summary::new(&body.mesh, &body.points, body.unit);
    let kinds: Vec<String> = summary
        .kinds
        .iter()
        .map(|(kind, number)| format!("{} {}", count(*number as u64), kind.word(*number)))
        .collect();
    let outside = match summary.in_no_group {
        0 => String::new(),
        some => format!("; {} points in no group", count(some as u64)),
    };
    let elements = summary.kinds.iter();
    let elements =
        elements.map(|(kind, number)| json!({ "kind": kind.to_string(), "count": number }));
    let [least, mean, most] = summary.sizes.map(|size| quantity(size, "m"));
    let volume = significant(summary.volume, 5);
    let mut lines = match body.piece() {
        None => vec![
            Line::new("mesh", format!("{}{outside}", kinds.join(", ")))
                .with("elements", elements.collect::<Vec<_>>())
                .with("points_in_no_group", summary.in_no_group),
            Line::new("mesh volume", format!("{volume} m³")).with("mesh_volume", summary.volume),
            Line::new("element size", format!("{least} to {most}, mean {mean}"))
                .with("element_size", summary.sizes.to_vec()),
        ],
        Some(piece) => {
            let value = json!({
                "piece": piece,
                "elements": elements.collect::<Vec<_>>(),
                "points_in_no_group": summary.in_no_group,
                "volume": summary.volume,
                "element_size": summary.sizes,
            });
            let text = format!(
                "{piece}: {}{outside}; {volume} m³; element size {least} to {most}, mean {mean}",
                kinds.join(", ")
            );
            vec![Line::new("mesh of piece", text).with_entry("piece_meshes", value)]
        }
    };
    /// Largest number of listed sets; `pericles mesh` lists all.
    const SETS: usize = 20;
    for set in summary.sets.iter().take(SETS) {
        let area = set.area.map_or(String::new(), |area| {
            format!(", area {} m²", significant(area, 5))
        });
        let name = body.name_in_decks(&set.name);
        let text = format!("{name}: {} points{area}", count(set.points as u64));
        let value = json!({ "name": name, "points": set.points, "area": set.area });
        lines.push(Line::new("mesh set", text).with_entry("mesh_sets", value));
    }
    lines
}
