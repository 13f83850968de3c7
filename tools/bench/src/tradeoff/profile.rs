//! The scenes and the amount of work of the page.

use crate::scene::Scene;
use anyhow::Result;
use p2m_mixed::generate::{
    KnotAndCables, MixedSizes, SkewedGear, TorusKnot, Transform, knot_and_cables, mixed_sizes, skewed_gear, torus_knot,
};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Effort;
use std::path::Path;

/// The source of a scene, and a remark about it.
pub(super) struct SceneSource {
    /// The name of a file among the models, or of a generated scene.
    name: &'static str,
    /// The generated scene that stands in for a missing file.
    otherwise: &'static str,
    /// The remark on the page.
    pub(super) about: &'static str,
}

/// The measurements of the page.
pub(super) struct Profile {
    /// The scenes; the first one is queried by several threads as well.
    pub(super) scenes: &'static [SceneSource],
    /// The number of queries in a set.
    pub(super) queries: usize,
    /// The number of times that each index is built.
    pub(super) builds: usize,
    /// The rounds of queries.
    pub(super) effort: Effort,
    /// The numbers of triangles of the torus knot that is swept.
    pub(super) sizes: &'static [u32],
    /// The number of queries in a batch on several threads.
    pub(super) batch: usize,
}

/// The query sets of the page.
pub(super) const SETS: [QuerySet; 4] = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface];

/// Describes a query set in a sentence.
pub(super) fn about(set: QuerySet) -> &'static str {
    match set {
        QuerySet::Box10 => "Uniform in the box of the scene scaled by 10: mostly far away.",
        QuerySet::Box1 => "Uniform in the box of the scene scaled by 1.05: as on a grid around it.",
        QuerySet::Near => {
            "Random points of the scene, moved off it along the normal by 1 % of the diagonal of its box (the standard deviation of a normal distribution)."
        }
        QuerySet::Surface => {
            "Random points of the scene itself: distances are roundings only, and errors are given in u M."
        }
        _ => "A set of the harness.",
    }
}

const KNOT: &str = "knot and cables";
const TORUS: &str = "torus knot";
const SIZES: &str = "mixed sizes";
const GEAR: &str = "skewed gear, turned";

const DRAGON: SceneSource =
    SceneSource { name: "dragon_100k.obj", otherwise: TORUS, about: "A scanned figure: small triangles of even size." };
const WIREFRAME: SceneSource = SceneSource {
    name: "mixed_armadillo_camel_wireframe.obj",
    otherwise: SIZES,
    about: "Triangles and segments in one scene: a scanned figure, and the edges of another one.",
};
const CARRIED: SceneSource = SceneSource {
    name: KNOT,
    otherwise: KNOT,
    about: "Generated: a tube of triangles with cables of segments around it.",
};

/// The measurements of the whole page, which is docs/report.html unless another folder is named.
pub(super) const FULL: Profile = Profile {
    scenes: &[
        DRAGON,
        SceneSource { name: "dragon_871k.ply", otherwise: TORUS, about: "The same figure in full resolution." },
        WIREFRAME,
        CARRIED,
        SceneSource {
            name: "gear_skewed_57k_rotated.ply",
            otherwise: GEAR,
            about: "Long, thin triangles that lie askew: hard for boxes along the axes.",
        },
        SceneSource {
            name: "thingi10k_1514499_slivers.stl",
            otherwise: GEAR,
            about: "A part from a printing site: most of its triangles are slivers.",
        },
        SceneSource { name: "political_borders_lines.obj", otherwise: SIZES, about: "Segments alone." },
        SceneSource {
            name: "rotterdam_city_far_from_origin.obj",
            otherwise: TORUS,
            about: "A city hundreds of kilometres from the origin of its coordinates.",
        },
    ],
    queries: 100_000,
    builds: 3,
    effort: Effort { rounds: 5, seconds: 0.08 },
    sizes: &[10_000, 40_000, 160_000, 640_000],
    batch: 1_000_000,
};

/// A profile of the whole page with fewer scenes and queries.
pub(super) const QUICK: Profile = Profile {
    scenes: &[DRAGON, WIREFRAME, CARRIED],
    queries: 15_000,
    builds: 1,
    effort: Effort { rounds: 5, seconds: 0.03 },
    sizes: &[3_000, 12_000, 48_000],
    batch: 100_000,
};

impl SceneSource {
    /// Reads the scene from the models, or generates its replacement if the file is missing.
    pub(super) fn read(&self, models: &Path) -> Result<Scene> {
        let path = models.join(self.name);
        if path.is_file() { Scene::read(&path) } else { generated(self.otherwise) }
    }
}

/// Generates the scene of that name.
fn generated(name: &str) -> Result<Scene> {
    let soup = match name {
        TORUS => torus_knot(&TorusKnot::default())?,
        SIZES => mixed_sizes(&MixedSizes::default())?,
        GEAR => Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&skewed_gear(&SkewedGear::default())?)?,
        _ => knot_and_cables(&KnotAndCables::default())?,
    };
    Scene::new(name.to_owned(), soup)
}

/// Generates a torus knot of about `triangles` triangles of even shape.
pub(super) fn knot_of(triangles: u32) -> Result<Scene> {
    // The default knot has about 16 times as many rings as sides, and two triangles for each ring and side.
    let sides = (triangles / 32).isqrt().max(3);
    let soup = torus_knot(&TorusKnot { rings: triangles / 2 / sides, sides, ..Default::default() })?;
    Scene::new(format!("torus knot of {}", soup.triangles().len()), soup)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_models_there_are_scenes_all_the_same() {
        let read = |source: &SceneSource| source.read(Path::new("nowhere")).unwrap();
        let names: Vec<String> = QUICK.scenes.iter().map(|source| read(source).name).collect();
        assert_eq!(names, [TORUS, SIZES, KNOT]);
        assert!(SETS.iter().all(|set| about(*set).len() > 20));
    }

    #[test]
    fn knots_have_about_as_many_triangles() {
        for size in [3_000, 48_000] {
            let knot = knot_of(size).unwrap();
            assert!(knot.len().abs_diff(size as usize) < size as usize / 20, "{}", knot.len());
        }
    }
}
