//! The arguments about the accuracy of answers: two that trade accuracy for speed, and one that certifies answers.

use crate::answers::answer_each;
use crate::io::usage::finite_not_negative;
use nalgebra::Point3;
use p2m_core::batch::{self, BatchOptions};
use p2m_core::{CertifiedQuery, Closest, ClosestPoint, QueryOptions};
use serde::Serialize;

/// Reports have these arguments as they are here.
#[derive(clap::Args, Serialize)]
#[command(next_help_heading = "Accuracy")]
pub(crate) struct Accuracy {
    /// Allow a relative error of the distance: 0.01 is one per cent
    #[arg(long, value_name = "E", value_parser = finite_not_negative, allow_negative_numbers = true, conflicts_with = "certified")]
    epsilon: Option<f64>,

    /// Stop after N visits of nodes and packets, with the best answer so far
    ///
    /// The search always continues until it has an answer. With 0, an octree or a P2M index searches only the cell
    /// of the query.
    #[arg(long, alias = "budget", value_name = "N", value_parser = clap::value_parser!(u32), allow_negative_numbers = true, conflicts_with = "certified")]
    max_visits: Option<u32>,

    /// Find the nearest primitive in exact arithmetic, and round its distance once
    #[arg(long)]
    pub(crate) certified: bool,
}

impl Accuracy {
    /// Returns the options of queries, with these limits of accuracy and this largest distance.
    pub(crate) fn options(&self, max_distance: Option<f64>) -> QueryOptions<f64> {
        let defaults = QueryOptions::default();
        defaults
            .with_max_distance(max_distance.unwrap_or(defaults.max_distance))
            .with_epsilon(self.epsilon.unwrap_or(defaults.epsilon))
            .with_max_visits(self.max_visits.unwrap_or(defaults.max_visits))
    }

    /// Returns whether answers are exact and not certified, as those of batches are.
    pub(crate) fn is_default(&self) -> bool {
        !self.certified && self.epsilon.is_none() && self.max_visits.is_none()
    }

    /// Answers queries, certified or not, on all threads of the current pool.
    pub(crate) fn answer<I: ClosestPoint<f64> + CertifiedQuery<f64> + Sync + ?Sized>(
        &self,
        index: &I,
        queries: &[Point3<f64>],
        options: &QueryOptions<f64>,
    ) -> Vec<Option<Closest<f64>>> {
        if self.certified {
            return answer_each(queries, |query| {
                index.certified_closest_point(query, options).expect("primitives of scenes have vertices")
            });
        }
        let mut answers = vec![None; queries.len()];
        batch::closest_points_into(index, queries, options, &BatchOptions::default(), &mut answers);
        answers
    }
}
