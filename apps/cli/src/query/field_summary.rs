//! The summary of a distance field, as text for people or as JSON for programs.

use crate::index::SignReport;
use crate::io::json;
use p2m_field::Grid;
use p2m_mixed::statistics::figure::{Count, Length, Time};
use serde_json::{Value, json};
use std::time::Duration;

/// The content of the file.
pub(crate) enum ComputedField {
    /// The values of a grid.
    Grid(Vec<f32>),
    /// The cells of an octree.
    Cells(Vec<p2m_field::Cell>),
}

/// The summary of a field.
pub(crate) struct FieldSummary<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) field: &'a ComputedField,
    /// The rule that decides signs, if there are signs.
    pub(crate) signs: Option<SignReport>,
    pub(crate) threads: usize,
    /// The time to fill the grid or to cut the cells.
    pub(crate) field_time: Duration,
}

impl FieldSummary<'_> {
    /// Returns the least and the largest value, and the numbers of negative and of undefined values.
    fn values(&self) -> (f64, f64, usize, usize) {
        let all: Box<dyn Iterator<Item = f64>> = match self.field {
            ComputedField::Grid(values) => Box::new(values.iter().map(|x| f64::from(*x))),
            ComputedField::Cells(cells) => Box::new(cells.iter().flat_map(|cell| cell.values)),
        };
        all.fold((f64::INFINITY, f64::NEG_INFINITY, 0, 0), |(min, max, inside, undefined), x| {
            (min.min(x), max.max(x), inside + usize::from(x < 0.0), undefined + usize::from(x.is_nan()))
        })
    }

    /// Returns the part of a report about the field.
    pub(crate) fn json(&self) -> Value {
        let (min, max, inside, undefined) = self.values();
        let origin: [f64; 3] = self.grid.origin().into();
        let (grid, cells) = match self.field {
            ComputedField::Grid(_) => {
                let counts = self.grid.counts();
                (json!({ "counts": counts, "origin": origin, "spacing": self.grid.spacing() }), Value::Null)
            }
            ComputedField::Cells(cells) => (Value::Null, json!(cells.len())),
        };
        json!({
            "grid": grid,
            "cells": cells,
            "sign_rule": self.signs.map(|signs| signs.rule),
            "values": { "min": json::number(min), "max": json::number(max), "inside": inside, "undefined": undefined },
            "threads": self.threads,
        })
    }

    /// Returns lines about the field for people.
    #[allow(clippy::cast_precision_loss, reason = "numbers for people to read")]
    pub(crate) fn text(&self) -> String {
        let (min, max, inside, undefined) = self.values();
        let time = Time(self.field_time);
        let field = match self.field {
            ComputedField::Grid(values) => {
                let [x, y, z] = self.grid.counts();
                let each = self.field_time.as_nanos() as f64 / values.len() as f64;
                let [at_x, at_y, at_z] = <[f64; 3]>::from(self.grid.origin()).map(Length);
                let (threads, spacing) = (self.threads, Length(self.grid.spacing()));
                let plural = if threads == 1 { "" } else { "s" };
                format!(
                    "field    {x} x {y} x {z} points, {spacing} apart, from {at_x} {at_y} {at_z}\n\
                     filled   in {time} on {threads} thread{plural}: {each:.0} ns per point\n"
                )
            }
            ComputedField::Cells(cells) => format!("field    {} cells, cut in {time}\n", Count(cells.len() as u64)),
        };
        let signs = self.signs.map(|signs| {
            let [inside, undefined] = [inside, undefined].map(|count| Count(count as u64));
            format!("; {inside} values inside, {undefined} undefined\n{}", signs.text())
        });
        let signs = signs.unwrap_or_else(|| "\n".to_owned());
        format!("{field}distance min {}, max {}{signs}", Length(min), Length(max))
    }
}
