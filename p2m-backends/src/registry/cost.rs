//! The cost model of an index: its expected time and memory per node, packet and primitive that a choice counts.
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
    /// The fineness of cells, as a factor of the default resolution; `None` for the default one.
    pub finer: Option<f64>,
    /// The time of the build per primitive.
    pub build: f64,
    /// The memory besides the scene, in bytes per primitive.
    pub bytes: f64,
    /// The fraction of `bytes` from which on the index still pays, with coarser cells.
    pub least_bytes: f64,
    /// The time of a query per primitive of the scene, if it examines all of them.
    pub primitive: f64,
    /// The times of a query per node that it would visit and per packet that it would filter in a tree of boxes.
    pub work: [f64; 2],
    /// The same per node and per packet that are counted in the index itself, if a choice may build it to count them.
    pub counted: Option<[f64; 2]>,
    /// The time of a query outside of the box of a scene of triangles, where a cell often knows the answer: a fraction
    /// of the time in a tree of boxes, and a time for the fourth root of the number of primitives. `None` if it is the
    /// same as inside.
    pub outside: Option<[f64; 2]>,
}

impl Cost {
    /// The cost of a tree of boxes.
    pub(crate) const BOXES: Self = Self::new(370.0, 65.0, [34.0, 45.0]);

    /// Makes a cost from the time of the build and the bytes per primitive, and the times per node and per packet.
    pub(crate) const fn new(build: f64, bytes: f64, work: [f64; 2]) -> Self {
        let (primitive, least_bytes) = (0.0, 1.0);
        Self { finer: None, build, bytes, least_bytes, primitive, work, counted: None, outside: None }
    }
}
