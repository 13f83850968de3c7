//! k-DOP tree: bounding volumes of K slab directions, following the design of the package of CGAL.
