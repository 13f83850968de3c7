//! The cost that an index is expected to have, in the terms of what a choice counts.
//!
//! The constants in the registry were fitted to the times of batches over scenes of 6,000 to 870,000 primitives
//! ([docs/measurements/auto.md], [docs/measurements/speed.csv]). What they decide is the ratio of builds to queries,
//! which differs less between processors than the times do.
//!
//! [docs/measurements/auto.md]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/auto.md
//! [docs/measurements/speed.csv]: https://github.com/p2m-rs/p2m/blob/main/docs/measurements/speed.csv

/// The expected cost of an index, in nanoseconds on one thread and in bytes.
///
/// The work of a query is counted in a tree of boxes over the scene: the nodes that it visits, and the packets of
/// primitives that it filters. The other indexes save a part of that work.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Cost {
    /// The factor of the default resolution of cells; `None` for the default one.
    pub finer: Option<f64>,
    /// The time of the build, for each primitive.
    pub build: f64,
    /// The bytes besides the scene, for each primitive.
    pub bytes: f64,
    /// The part of these bytes within which it still pays, with coarser cells.
    pub least_bytes: f64,
    /// The time of a query for each primitive of the scene, if it examines all of them.
    pub primitive: f64,
    /// The times of a query for each node that it would visit, and each packet that it would filter, in a tree of boxes.
    pub work: [f64; 2],
    /// The same for nodes and packets that are counted in the index itself, if a choice may build it to count them.
    pub counted: Option<[f64; 2]>,
    /// What a query takes outside of the box of a scene of triangles, where a cell often knows the answer: a part of
    /// its time in a tree of boxes, and a time for the fourth root of the number of primitives. `None` for the same as
    /// inside.
    pub outside: Option<[f64; 2]>,
}

impl Cost {
    /// That of a tree of boxes.
    pub(crate) const BOXES: Self = Self::new(370.0, 65.0, [34.0, 45.0]);

    /// The cost with a time of the build and bytes for each primitive, and times for each node and each packet.
    pub(crate) const fn new(build: f64, bytes: f64, work: [f64; 2]) -> Self {
        let (primitive, least_bytes) = (0.0, 1.0);
        Self { finer: None, build, bytes, least_bytes, primitive, work, counted: None, outside: None }
    }
}
