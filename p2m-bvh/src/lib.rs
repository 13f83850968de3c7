//! p2m-bvh
