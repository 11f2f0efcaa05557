//! Lines of `check` about a mesh.

use pericles_mesh::Summary;
use pericles_run::units::{count, quantity, significant};
use pericles_run::{Assembly, MeshBody};
use serde_json::json;

use super::line::Line;

/// Element types, volume and sizes, and a line per set of the mesh.
pub(super) fn mesh(assembly: &Assembly) -> Vec<Line> {
    let Some(body) = &assembly.mesh else {
        return Vec::new();
    };
    let MeshBody { mesh, points, unit } = &**body;
    let summary = Summary::new(mesh, points, *unit);
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
    let mut lines = vec![
        Line::new("mesh", format!("{}{outside}", kinds.join(", ")))
            .with("elements", elements.collect::<Vec<_>>())
            .with("points_in_no_group", summary.in_no_group),
        Line::new(
            "mesh volume",
            format!("{} m³", significant(summary.volume, 5)),
        )
        .with("mesh_volume", summary.volume),
        Line::new("element size", format!("{least} to {most}, mean {mean}"))
            .with("element_size", summary.sizes.to_vec()),
    ];
    /// Largest number of listed sets; `pericles mesh` lists all.
    const SETS: usize = 20;
    for set in summary.sets.iter().take(SETS) {
        let area = set.area.map_or(String::new(), |area| {
            format!(", area {} m²", significant(area, 5))
        });
        let text = format!("{}: {} points{area}", set.name, count(set.points as u64));
        let value = json!({ "name": set.name, "points": set.points, "area": set.area });
        lines.push(Line::new("mesh set", text).with_entry("mesh_sets", value));
    }
    lines
}
