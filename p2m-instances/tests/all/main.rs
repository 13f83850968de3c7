//! Compares scenes of instances with indexes over all moved vertices, bit for bit.

mod agreement;
mod edges;
mod models;
mod pairs;
mod reference;
mod rounded_pairs;
