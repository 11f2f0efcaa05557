//! Prints the rows of a study as a table.

use pericles_run::units::{percent, quantity, significant};

use crate::row::{Agreement, Row, Rule};

const HEADER: [&str; 6] = [
    "case",
    "printed",
    "expected",
    "computed",
    "tolerance",
    "verdict",
];

/// Formats the table with notes below it.
pub fn table(rows: &[Row]) -> String {
    let mut cells = vec![HEADER.map(str::to_owned)];
    let mut notes = Vec::new();
    for row in rows {
        let mut case = row.case.clone();
        if !row.note.is_empty() {
            notes.push(&row.note);
            case += &format!(" [{}]", notes.len());
        }
        let number = |value: Option<f64>| value.map_or("-".into(), |value| shown(value, &row.unit));
        let range = |[low, high]: [f64; 2]| {
            format!("{} to {}", shown(low, &row.unit), shown(high, &row.unit))
        };
        let tolerance = match (row.expected, row.rule) {
            (_, Rule::Measured(_)) => "measured".into(),
            (None, _) => "-".into(),
            (_, Rule::Absolute(tolerance)) => format!("± {}", shown(tolerance, &row.unit)),
            (_, Rule::Relative(tolerance)) => format!("± {}", percent(tolerance)),
            (_, Rule::AtMost) => "at most".into(),
            (_, Rule::AtLeast) => "at least".into(),
        };
        let verdict = match (row.pass(), row.agreement()) {
            (_, Some(Agreement::Inside)) => "inside",
            (_, Some(Agreement::Partly)) => "partly inside",
            (_, Some(Agreement::Outside)) => "outside",
            (None, None) => "-",
            (Some(true), None) => "holds",
            (Some(false), None) => "FAILS",
        };
        let expected = match row.rule {
            Rule::Measured(measured) => range(measured),
            _ => number(row.expected),
        };
        let spread = row.spread.map(|spread| format!(" ({})", range(spread)));
        cells.push([
            case,
            number(row.printed),
            expected,
            number(row.computed) + &spread.unwrap_or_default(),
            tolerance,
            verdict.into(),
        ]);
    }
    let width: Vec<usize> = (0..HEADER.len())
        .map(|k| cells.iter().map(|line| line[k].chars().count()).max())
        .map(Option::unwrap_or_default)
        .collect();
    let mut text = String::new();
    for (number, line) in cells.iter().enumerate() {
        let padded: Vec<String> = line
            .iter()
            .zip(&width)
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        text += padded.join(" | ").trim_end();
        text += "\n";
        if number == 0 {
            let rules: Vec<String> = width.iter().map(|width| "-".repeat(*width)).collect();
            text += &rules.join("-|-");
            text += "\n";
        }
    }
    for (number, note) in notes.iter().enumerate() {
        text += &format!("[{}] {note}\n", number + 1);
    }
    text
}

fn shown(value: f64, unit: &str) -> String {
    match unit {
        "" => significant(value, 4),
        // Angles are given in degrees, and speeds without prefixes for comparison.
        "°" => format!("{value:.1}°"),
        "m/s" => format!("{value:.0} m/s"),
        _ => quantity(value, unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_notes_numbered() {
        let rows = [
            Row::new("branching: x", "m", Some(0.0667)).within(0.0659, 4e-3),
            Row::new("s₀", "", Some(0.00181))
                .within_share(0.001809, 0.002)
                .printed(0.0013)
                .note("too small by √2"),
            Row::new("arms", "", None).within(2.0, 0.0),
            Row::new("cost", "s", Some(f64::NAN)),
            Row::new("error", "", Some(0.25)).judged(0.5, Rule::AtMost),
            Row {
                spread: Some([1.0, 3.0]),
                ..Row::new("peak", "N", Some(2.5)).measured([1.0, 2.0])
            },
        ];
        let text = table(&rows);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 9, "{text}");
        let cells = |line: usize| -> Vec<&str> { lines[line].split('|').map(str::trim).collect() };
        assert_eq!(
            cells(2),
            [
                "branching: x",
                "-",
                "65.9 mm",
                "66.7 mm",
                "± 4.00 mm",
                "holds"
            ]
        );
        assert_eq!(
            cells(3),
            [
                "s₀ [1]",
                "0.001300",
                "0.001809",
                "0.001810",
                "± 0.20 %",
                "holds"
            ]
        );
        assert_eq!(cells(4), ["arms", "-", "2.000", "-", "± 0", "FAILS"]);
        assert_eq!(cells(5), ["cost", "-", "-", "NaN s", "-", "-"]);
        assert_eq!(
            cells(6),
            ["error", "-", "0.5000", "0.2500", "at most", "holds"]
        );
        assert_eq!(
            cells(7),
            [
                "peak",
                "-",
                "1.00 N to 2.00 N",
                "2.50 N (1.00 N to 3.00 N)",
                "measured",
                "partly inside"
            ]
        );
        assert_eq!(lines[8], "[1] too small by √2");
        let bars: Vec<usize> = lines[2..8]
            .iter()
            .map(|line| line.chars().take_while(|&c| c != '|').count())
            .collect();
        assert!(bars.windows(2).all(|pair| pair[0] == pair[1]), "{text}");
    }
}
