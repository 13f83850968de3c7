//! p2m-testkit
