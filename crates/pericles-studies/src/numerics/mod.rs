//! Studies of the program's own numerics, against references computed by other means.

mod highest_frequency;

use crate::study::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 1] = [highest_frequency::STUDY];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Row;
    use crate::study::Context;

    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        for study in &STUDIES {
            let rows = (study.run)(&context).unwrap();
            let failed: Vec<Row> = rows
                .into_iter()
                .filter(|row| row.pass() == Some(false))
                .collect();
            assert!(failed.is_empty(), "{}: {failed:#?}", study.id);
        }
    }
}
