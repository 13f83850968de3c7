//! Measures speed against accuracy of backends, and reports it.
//!
//! A backend answers faster if it may be less accurate. [`settings`] lists the settings of accuracy. [`measure`] runs
//! all backends with all settings in turns, and compares their answers with the truth. A [`Curve`] has the results of
//! one backend, and a [`Point`] those of one of its settings. The results become a page ([`page`]), a table ([`text`])
//! or a record ([`record`]), and two records become a comparison ([`compare`]).
//!
//! ```
//! use nalgebra::Point3;
//! use p2m_core::{BruteForce, Point};
//! use p2m_tradeoff::queries::Queries;
//! use p2m_tradeoff::settings::SETTINGS;
//! use p2m_tradeoff::{Build, Competitor, Effort, Truth, measure};
//!
//! let sites = [Point::new(Point3::new(0.0, 0.0, 0.0)), Point::new(Point3::new(4.0, 0.0, 0.0))];
//! let index = BruteForce::new(&sites).unwrap();
//! let competitors: Vec<Competitor<'_>> = SETTINGS[..2]
//!     .iter()
//!     .map(|setting| Competitor::new("brute", &index, setting, Build::default()))
//!     .collect();
//! let queries = Queries::new(vec![Point3::new(0.0, 3.0, 0.0)]);
//! let truths = [Truth { distance: 3.0, residual: 0.0, max_vertex_distance: 3.0, id: 0 }];
//! let curves = measure(&competitors, &queries, &truths, &Effort { rounds: 5, seconds: 0.1 }, &|_| ());
//! assert_eq!(curves[0].points[0].errors.scaled.max, 0.0);
//! ```
#![forbid(unsafe_code)]

mod backend;
pub mod compare;
mod curve;
mod error;
mod errors;
#[cfg(test)]
mod fixtures;
mod measure;
pub mod page;
mod provenance;
mod quantiles;
pub mod queries;
pub mod record;
pub mod rounds;
pub mod settings;
mod table;
pub mod text;

pub use backend::{Answer, AnswerQueries, AnswerQuery, clock_nanoseconds};
pub use curve::{Build, Curve, Latency, Point, SceneFigures, SetFigures};
pub use error::RecordError;
pub use errors::{ErrorQuantiles, Errors, Truth};
pub use measure::{Competitor, Effort, measure};
pub use provenance::Provenance;
pub use quantiles::{MedianRange, RunningStats};
pub use record::csv_line;
pub use table::Table;
