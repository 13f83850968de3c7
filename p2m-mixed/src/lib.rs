//! p2m-mixed
