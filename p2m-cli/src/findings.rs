//! What came of rays: for people on the standard error, or for programs as JSON.

use crate::summary::Spread;
use p2m_core::Hit;
use serde_json::{Value, json};
use std::fmt;

/// Statistics of what rays meet.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    rays: u64,
    /// Those that meet anything.
    hitting: u64,
    /// Of the hits, if they were asked for.
    parameters: Spread,
    numbers: Option<Numbers>,
}

/// Statistics of a number for each ray.
#[derive(Debug)]
struct Numbers {
    /// How a line about them begins.
    label: &'static str,
    min: u64,
    max: u64,
    total: u64,
}

impl Findings {
    /// Of modes in which every ray has a number, which the summary calls `label`.
    pub(crate) fn with_numbers(label: &'static str) -> Self {
        Self { numbers: Some(Numbers { label, min: u64::MAX, max: 0, total: 0 }), ..Self::default() }
    }

    /// A ray with so many hits, crossings or whatever is counted.
    pub(crate) fn add(&mut self, number: u64) {
        self.rays += 1;
        self.hitting += u64::from(number > 0);
        if let Some(numbers) = &mut self.numbers {
            numbers.min = numbers.min.min(number);
            numbers.max = numbers.max.max(number);
            numbers.total += number;
        }
    }

    /// A ray with these hits.
    pub(crate) fn add_hits(&mut self, hits: &[Hit]) {
        self.add(hits.len() as u64);
        hits.iter().for_each(|hit| self.parameters.add(hit.parameter));
    }

    pub(crate) fn rays(&self) -> u64 {
        self.rays
    }

    #[allow(clippy::cast_precision_loss, reason = "more rays and hits than 2^53 are out of reach")]
    fn mean(&self, numbers: &Numbers) -> f64 {
        numbers.total as f64 / self.rays as f64
    }

    /// The report, without what was asked.
    pub(crate) fn json(&self) -> Value {
        let numbers = self.numbers.as_ref().filter(|_| self.rays > 0).map(|numbers| {
            json!({ "total": numbers.total, "min": numbers.min, "max": numbers.max, "mean": self.mean(numbers) })
        });
        json!({
            "rays": self.rays,
            "hitting": self.hitting,
            "missing": self.rays - self.hitting,
            "numbers": numbers,
            "parameter": self.parameters.json(),
        })
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "hitting  {}, missing {}", self.hitting, self.rays - self.hitting)?;
        if let Some(numbers) = self.numbers.as_ref().filter(|_| self.rays > 0) {
            let Numbers { label, min, max, total } = numbers;
            writeln!(f, "{label:9}{total}, per ray min {min}, max {max}, mean {:?}", self.mean(numbers))?;
        }
        if self.parameters.count() > 0 {
            writeln!(f, "at t     {}", self.parameters)?;
        }
        Ok(())
    }
}
