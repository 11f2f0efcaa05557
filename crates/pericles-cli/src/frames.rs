//! Selection of output times.

use std::str::FromStr;

use pericles_run::FieldFile;

/// A selection of output times.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Frames {
    /// All.
    All,
    /// The first.
    First,
    /// The last.
    Last,
    /// The output times nearest to these times, s.
    Near(Vec<f64>),
}

impl Frames {
    /// Returns the indices of the selected states, in ascending order and without repetition; `states` are ordered in
    /// time.
    pub(crate) fn among(&self, states: &[FieldFile]) -> Vec<usize> {
        let Some(last) = states.len().checked_sub(1) else {
            return Vec::new();
        };
        let nearest = |time: &f64| {
            let distance = |k: &usize| (states[*k].time - time).abs();
            (0..=last).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let mut numbers: Vec<usize> = match self {
            Self::All => (0..=last).collect(),
            Self::First => vec![0],
            Self::Last => vec![last],
            Self::Near(times) => times.iter().filter_map(nearest).collect(),
        };
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let times: Option<Vec<f64>> = text.split(',').map(pericles_deck::seconds).collect();
        match (text, times) {
            ("all", _) => Ok(Self::All),
            ("first", _) => Ok(Self::First),
            ("last", _) => Ok(Self::Last),
            (_, Some(times)) => Ok(Self::Near(times)),
            _ => Err("expected all, first, last, or times such as \"20 us\" or 1e-5,2e-5".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn output_times_are_selected_once_each() {
        let states: Vec<FieldFile> = [0.0, 1e-6, 2e-6, 3e-6]
            .map(|time| FieldFile {
                time,
                path: "a.vtu".into(),
            })
            .into();
        let among = |text: &str| text.parse::<Frames>().unwrap().among(&states);
        assert_eq!(among("all"), [0, 1, 2, 3]);
        assert_eq!(among("last"), [3]);
        assert_eq!(among("2.2 us,0,1.9 us"), [0, 2]);
        assert_eq!(among("1"), [3]);
        assert!("soon".parse::<Frames>().is_err() && "1 m".parse::<Frames>().is_err());
        assert!(Frames::Last.among(&[]).is_empty());
    }
}
