//! Tables of answers: their columns, and files of them in any format.
//!
//! | format | a record |
//! |---|---|
//! | CSV | is a line. Numbers have the fewest digits that read back as the same number |
//! | NPY | is a record of a structured array of shape `(count,)`, little-endian and without gaps |
//! | PLY | is a vertex of a point cloud, binary and little-endian, which viewers can colour by a property |
//!
//! A file contains the queries, so it can be read as a file of the same queries. Records are encoded on several threads,
//! and written in order by one.

mod columns;
mod rays;
mod records;
#[cfg(test)]
mod tests;
mod values;

pub(crate) use columns::{AnswerColumn, AnswerEncoder, AnswerRecord};
pub(crate) use rays::{HitEncoder, NumberEncoder};
pub(crate) use records::{Header, Table};

p2m_core::formats! {
    /// The file formats of answers.
    AnswerFormat {
        /// This is a text table.
        Csv = "csv",
        /// This is a structured array of NumPy.
        Npy = "npy",
        /// This is a point cloud of the queries, which have the answers as properties.
        Ply = "ply",
    }
}
