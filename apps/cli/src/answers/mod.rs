//! The queries of a run, the loop that answers them, and the summary of the answers.

pub(crate) mod args;
pub(crate) mod blocks;
pub(crate) mod queries;
pub(crate) mod running_stats;
pub(crate) mod summary;

use p2m_mixed::AnswerColumn;

/// Returns columns with that of signed distances after that of distances, if there are signs.
pub(crate) fn with_signed(mut columns: Vec<AnswerColumn>, has_signs: bool) -> Vec<AnswerColumn> {
    if has_signs {
        let distance = columns.iter().position(|column| *column == AnswerColumn::Distance);
        columns.insert(distance.map_or(columns.len(), |at| at + 1), AnswerColumn::Signed);
    }
    columns
}
