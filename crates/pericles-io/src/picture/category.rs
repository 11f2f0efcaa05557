//! Colours and legend of identification numbers.

use super::bitmap::Rgb;
use super::colour::{CURVES, NO_VALUE};
use pericles::units::significant;

/// A colour of a picture of identification numbers.
#[derive(Debug, Clone)]
pub(super) struct Category {
    /// The number; NaN for all numbers without a colour of their own.
    pub(super) number: f64,
    pub(super) colour: Rgb,
    pub(super) label: String,
}

impl Category {
    /// Returns the legend of identification numbers, the most frequent ones first. A number without a name is
    /// shown itself.
    pub(super) fn legend(values: &[f64], names: &[String]) -> Vec<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let groups = sorted.chunk_by(|a, b| a == b);
        let mut groups: Vec<(f64, usize)> = groups.map(|group| (group[0], group.len())).collect();
        // The sort is stable: equally frequent numbers remain in ascending order.
        groups.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let share = |count: usize| {
            let percent = 100.0 * count as f64 / sorted.len() as f64;
            format!("({} %)", significant(percent, 2))
        };
        let name = |number: f64| match names.get(number as usize) {
            Some(name) => name.clone(),
            None => number.to_string(),
        };
        let named = groups.len().min(CURVES.len());
        let own = groups[..named].iter().zip(CURVES);
        let mut entries: Vec<Self> = own
            .map(|(&(number, count), colour)| Self {
                number,
                colour,
                label: format!("{} {}", name(number), share(count)),
            })
            .collect();
        let others: usize = groups[named..].iter().map(|(_, count)| count).sum();
        if others > 0 {
            entries.push(Self {
                number: f64::NAN,
                colour: NO_VALUE,
                label: format!("others {}", share(others)),
            });
        }
        entries
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::{ColourBar, Sizes};
    use super::super::style::PictureStyle;
    use super::*;

    #[test]
    fn the_most_frequent_numbers_have_colours_of_their_own() {
        let mut values: Vec<f64> = (0..20).map(f64::from).collect();
        values.extend([7.0; 70]);
        values.extend([3.0; 10]);
        let entries = Category::legend(&values, &[]);
        let labels: Vec<&str> = entries.iter().map(|entry| entry.label.as_str()).collect();
        assert_eq!(labels[..3], ["7 (71 %)", "3 (11 %)", "0 (1.0 %)"]);
        assert_eq!(*labels.last().unwrap(), "others (12 %)");
        assert_eq!(entries.len(), 9);
        let bar = ColourBar::of_numbers(&values, &[]);
        assert_eq!(bar.colour(7.0), CURVES[0]);
        assert_eq!(bar.colour(15.0), NO_VALUE);
        assert_eq!(
            bar.ticks(400.0, &Sizes::of(&PictureStyle::default()))
                .major
                .len(),
            9
        );
    }

    #[test]
    fn numbers_are_shown_by_their_names() {
        let names = ["body".to_owned(), "top".to_owned()];
        let entries = Category::legend(&[0.0, 0.0, 0.0, 1.0, 2.0], &names);
        let labels: Vec<&str> = entries.iter().map(|entry| entry.label.as_str()).collect();
        assert_eq!(labels, ["body (60 %)", "top (20 %)", "2 (20 %)"]);
    }
}
