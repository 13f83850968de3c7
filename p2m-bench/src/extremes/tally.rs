//! What a subject got wrong in a family of cases.

/// Errors above so many u M are no roundings: twice what is proved for ours.
pub(crate) const ROUNDING: f64 = 16.0;

/// Of one subject and one family.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    /// Answers that were looked at.
    pub(super) cases: u64,
    /// Of those that are numbers, the largest error in u M.
    pub(super) worst: f64,
    /// Errors above [`ROUNDING`].
    pub(super) beyond: u64,
    /// NaN, infinity for what is in range, or no answer.
    pub(super) failed: u64,
    /// Panics.
    pub(super) panicked: u64,
    /// Another primitive than the nearest, beyond rounding.
    pub(super) wrong_ids: u64,
}

impl Tally {
    /// An answer whose error that is; infinite if it is no number.
    pub(super) fn add(&mut self, error: f64) {
        self.cases += 1;
        if error.is_finite() {
            self.worst = self.worst.max(error);
            self.beyond += u64::from(error > ROUNDING);
        } else {
            self.failed += 1;
        }
    }

    /// Both together.
    pub(super) fn merge(&mut self, other: &Self) {
        let Self { cases, worst, beyond, failed, panicked, wrong_ids } = other;
        self.cases += cases;
        self.worst = self.worst.max(*worst);
        self.beyond += beyond;
        self.failed += failed;
        self.panicked += panicked;
        self.wrong_ids += wrong_ids;
    }

    /// Its cell of a table: the largest error, and what else went wrong in parts of all.
    pub(super) fn cell(&self) -> String {
        if self.cases + self.panicked == 0 {
            return "-".to_owned();
        }
        let worst = match self.worst {
            0.0 => "0".to_owned(),
            w if w < 100.0 => format!("{w:.2}"),
            w => format!("{w:.0e}"),
        };
        let all = (self.cases + self.panicked) as f64;
        let part = |count: u64, what: &str| (count > 0).then(|| format!(", {what} {}", percent(count as f64 / all)));
        let parts = [part(self.failed, "fails"), part(self.panicked, "panics"), part(self.wrong_ids, "wrong id")];
        parts.into_iter().flatten().fold(worst, |text, part| text + &part)
    }
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent < 0.1 { "< 0.1 %".to_owned() } else { format!("{percent:.1} %") }
}
