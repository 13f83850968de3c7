//! The counters of checks: errors of distances, and broken promises.

use p2m_testkit::truth::Truth;

/// The largest number of broken promises that are printed.
const SHOWN: usize = 20;

/// The range and the precision of a scalar.
#[derive(Clone, Copy)]
pub(super) struct Precision {
    pub(super) bits: u32,
    pub(super) smallest: f64,
    pub(super) largest: f64,
}

impl Precision {
    /// The precisions of f64 and of f32.
    pub(super) const ALL: [Self; 2] = [
        Self { bits: 53, smallest: f64::from_bits(1), largest: f64::MAX },
        Self { bits: 24, smallest: f32::from_bits(1) as f64, largest: f32::MAX as f64 },
    ];

    /// Returns the unit roundoff.
    pub(super) fn unit(self) -> f64 {
        2f64.powi(-self.bits.cast_signed())
    }

    /// Returns the error of a distance in units of u M. An infinite distance has no error if the true one is out of
    /// range.
    pub(super) fn error(self, truth: &Truth<'_>, distance: f64) -> f64 {
        if distance == f64::INFINITY && truth.is_at_least(self.largest) {
            return 0.0;
        }
        truth.error(distance, self.bits, self.smallest)
    }
}

/// The counters of one subject in one family.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// The number of answers that were checked.
    pub(super) cases: u64,
    /// The largest finite error, in units of u M.
    pub(super) worst: f64,
    /// The number of answers that are missing, NaN, or infinite for a distance in range.
    pub(super) failed: u64,
    /// The number of panics.
    pub(super) panicked: u64,
    /// The number of wrong answers to whether two primitives intersect.
    pub(super) wrong: u64,
}

impl Counts {
    /// Counts an answer with its error. The error is infinite for an answer that is not a number, and `None` for a
    /// panic.
    pub(super) fn add(&mut self, error: Option<f64>) {
        match error {
            Some(error) => {
                self.cases += 1;
                self.failed += u64::from(!error.is_finite());
                self.worst = if error.is_finite() { self.worst.max(error) } else { self.worst };
            }
            None => self.panicked += 1,
        }
    }

    /// Adds the counts of `other`.
    pub(super) fn merge(&mut self, other: &Self) {
        let Self { cases, worst, failed, panicked, wrong } = other;
        self.cases += cases;
        self.worst = self.worst.max(*worst);
        self.failed += failed;
        self.panicked += panicked;
        self.wrong += wrong;
    }

    /// Formats a cell of a table: the largest error, and the fraction of answers that are wrong in other ways.
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
        let parts = [part(self.failed, "fails"), part(self.panicked, "panics"), part(self.wrong, "wrong intersection")];
        parts.into_iter().flatten().fold(worst, |text, part| text + &part)
    }
}

/// Adds the counts of a table of the same size.
pub(super) fn merge_all(all: &mut [Counts], others: &[Counts]) {
    all.iter_mut().zip(others).for_each(|(counts, other)| counts.merge(other));
}

/// The broken promises, of which the first ones are printed.
#[derive(Default)]
pub(super) struct Broken {
    pub(super) count: u64,
    pub(super) shown: Vec<String>,
}

impl Broken {
    pub(super) fn add(&mut self, what: impl FnOnce() -> String) {
        self.count += 1;
        if self.shown.len() < SHOWN {
            self.shown.push(what());
        }
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.shown.extend(other.shown);
        self.shown.truncate(SHOWN);
    }
}

fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent < 0.1 { "< 0.1 %".to_owned() } else { format!("{percent:.1} %") }
}
