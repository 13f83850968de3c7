//! The measuring loop that `p2m tradeoff` and p2m-bench share: rounds in turns, medians, tables, and the origin of figures.

mod csv_line;
mod median_range;
mod provenance;
pub mod queries;
pub mod rounds;
mod table;

pub use csv_line::csv_line;
pub use median_range::MedianRange;
pub use provenance::Provenance;
pub use table::Table;
