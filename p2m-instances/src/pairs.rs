//! Queries for the primitives nearest to a shape.
