//! The amount of work: all measurements in well under an hour, or a few of each kind in minutes.

/// A resolution of the model that is swept.
#[derive(Clone, Copy)]
pub(super) enum Resolution {
    /// Vertices are merged until about this many triangles are left.
    Coarsened(usize),
    /// The model is used as it is.
    Own,
    /// The model is coarsened to about this many triangles, each of which is divided into four and displaced a little.
    Subdivided(usize),
}

/// The measurements and models of the page.
pub(super) struct Profile {
    pub(super) queries: usize,
    pub(super) rounds: usize,
    pub(super) builds: usize,
    /// The models in place of the five of Tables 1 to 3 and Figure 13.
    pub(super) five: &'static [&'static str],
    /// The model in place of the Dragon of Figures 10 to 12 and 14 to 17.
    pub(super) swept: &'static str,
    pub(super) resolutions: &'static [Resolution],
    /// The boxes of queries of Figure 16, as multiples of that of the scene.
    pub(super) boxes: &'static [f64],
    /// The models with long lists of Table 3.
    pub(super) long: &'static [&'static str],
    /// The number of triangles of the spheres of Table 3.
    pub(super) sphere: u32,
    /// The models of Table 4.
    pub(super) pairs: &'static [&'static str],
    pub(super) pair_size: usize,
    /// The model that is torn apart.
    pub(super) torn: &'static str,
    /// The scene of triangles and segments.
    pub(super) mixed: Option<&'static str>,
    /// The models of Figures 20 to 22; an empty list stands for all models with at least `min_primitives` primitives.
    pub(super) scattered: Option<&'static [&'static str]>,
    pub(super) min_primitives: usize,
}

use Resolution::{Coarsened, Own, Subdivided};

/// The measurements of docs/paper.md.
pub(super) const FULL: Profile = Profile {
    queries: 100_000,
    rounds: 5,
    builds: 3,
    five: &["camel.off", "armadillo.obj", "sponza_66k.obj", "lucy_100k.ply", "dragon_871k.ply"],
    swept: "dragon_871k.ply",
    resolutions: &[
        Coarsened(10_000),
        Coarsened(25_000),
        Coarsened(50_000),
        Coarsened(100_000),
        Coarsened(200_000),
        Coarsened(400_000),
        Own,
        Subdivided(350_000),
    ],
    boxes: &[1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0],
    long: &["gear_skewed_57k.ply", "thingi10k_1514499_slivers.stl", "hotel_room_nonmanifold.ply"],
    sphere: 100_000,
    pairs: &["bunny.obj", "camel.off", "armadillo.obj", "lucy_100k.ply", "torus knot", "cylinder"],
    pair_size: 50_000,
    torn: "camel.off",
    mixed: Some("mixed_armadillo_camel_wireframe.obj"),
    scattered: None,
    min_primitives: 1000,
};

/// A profile with all tables and plots but fewer and smaller scenes.
pub(super) const QUICK: Profile = Profile {
    queries: 20_000,
    rounds: 5,
    builds: 1,
    five: &["camel.off", "bunny.obj"],
    swept: "bunny.obj",
    resolutions: &[Coarsened(3_000), Coarsened(10_000), Own],
    boxes: &[1.0, 3.0, 10.0, 100.0],
    long: &["thingi10k_1514499_slivers.stl"],
    sphere: 10_000,
    pairs: &["camel.off", "torus knot"],
    pair_size: 10_000,
    torn: "camel.off",
    mixed: None,
    scattered: Some(&["camel.off", "bunny.obj", "track_lines.obj", "thingi10k_1514499_slivers.stl"]),
    min_primitives: 0,
};
