//! Counts of wrong answers of a subject in a family of cases.

/// Errors above this multiple of u M are no roundings: it is twice the bound that is proved for our kernel.
pub(super) const ROUNDING: f64 = 16.0;

/// The counts of one subject in one family.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// The number of answers that were checked.
    pub(super) cases: u64,
    /// The largest finite error, in u M.
    pub(super) worst: f64,
    /// The number of errors above [`ROUNDING`].
    pub(super) beyond: u64,
    /// The number of answers that are NaN, infinite for a distance in range, or missing.
    pub(super) failed: u64,
    /// The number of panics.
    pub(super) panicked: u64,
    /// The number of primitives that are not the nearest, beyond rounding.
    pub(super) wrong_ids: u64,
}

impl Counts {
    /// Adds an answer with its error, which is infinite if the answer is not a number.
    pub(super) fn add(&mut self, error: f64) {
        self.cases += 1;
        if error.is_finite() {
            self.worst = self.worst.max(error);
            self.beyond += u64::from(error > ROUNDING);
        } else {
            self.failed += 1;
        }
    }

    /// Adds the counts of `other`.
    pub(super) fn merge(&mut self, other: &Self) {
        let Self { cases, worst, beyond, failed, panicked, wrong_ids } = other;
        self.cases += cases;
        self.worst = self.worst.max(*worst);
        self.beyond += beyond;
        self.failed += failed;
        self.panicked += panicked;
        self.wrong_ids += wrong_ids;
    }

    /// Formats the cell of a table: the largest error, and the fraction of answers that are wrong in other ways.
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
