//! Tests of signs, fields and Hausdorff distances, in one program so that shared code is compiled once.

mod fields;
mod hausdorff;
mod sign_families;
mod signs;
