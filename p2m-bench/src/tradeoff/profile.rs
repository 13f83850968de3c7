//! Which scenes are measured, and how much.

use crate::scene::Scene;
use anyhow::Result;
use p2m_mixed::generate::{
    KnotAndCables, MixedSizes, SkewedGear, TorusKnot, Transform, knot_and_cables, mixed_sizes, skewed_gear, torus_knot,
};
use p2m_testkit::queries::QuerySet;
use p2m_tradeoff::Effort;
use std::path::Path;

/// A scene, and what is special about it.
pub(super) struct Place {
    /// The name of a file among the models, or of what is generated.
    name: &'static str,
    /// In place of a file that is not there, what is generated.
    otherwise: &'static str,
    /// For the page.
    pub(super) about: &'static str,
}

/// What is measured.
pub(super) struct Profile {
    /// Scenes; the first is asked by several threads as well.
    pub(super) scenes: &'static [Place],
    /// Queries of a set.
    pub(super) queries: usize,
    /// Builds of each index.
    pub(super) builds: usize,
    /// Rounds of queries.
    pub(super) effort: Effort,
    /// Numbers of triangles of the torus knot that is swept.
    pub(super) sizes: &'static [u32],
    /// Queries of a batch on several threads.
    pub(super) batch: usize,
}

/// The sets of queries.
pub(super) const SETS: [QuerySet; 4] = [QuerySet::Box10, QuerySet::Box1, QuerySet::Near, QuerySet::Surface];

/// What a set is, in a sentence.
pub(super) fn about(set: QuerySet) -> &'static str {
    match set {
        QuerySet::Box10 => "Uniform in the box of the scene scaled by 10: mostly far away.",
        QuerySet::Box1 => "Uniform in the box of the scene scaled by 1.05: as on a grid around it.",
        QuerySet::Near => {
            "Random places of the scene, moved off it along the normal by 1 % of the diagonal of its box (the standard deviation of a normal distribution)."
        }
        QuerySet::Surface => {
            "Random places of the scene itself: distances are nothing but roundings, and errors to be read in u M."
        }
        _ => "A set of the harness.",
    }
}

const KNOT: &str = "knot and cables";
const TORUS: &str = "torus knot";
const SIZES: &str = "mixed sizes";
const GEAR: &str = "skewed gear, turned";

const DRAGON: Place =
    Place { name: "dragon_100k.obj", otherwise: TORUS, about: "A scanned figure: small triangles of even size." };
const WIREFRAME: Place = Place {
    name: "mixed_armadillo_camel_wireframe.obj",
    otherwise: SIZES,
    about: "Triangles and segments in one scene: a scanned figure, and the edges of another one.",
};
const CARRIED: Place =
    Place { name: KNOT, otherwise: KNOT, about: "Generated: a tube of triangles with cables of segments around it." };

/// What the whole page has, which is docs/report.html unless another folder is named.
pub(super) const FULL: Profile = Profile {
    scenes: &[
        DRAGON,
        Place { name: "dragon_871k.ply", otherwise: TORUS, about: "The same figure in full resolution." },
        WIREFRAME,
        CARRIED,
        Place {
            name: "gear_skewed_57k_rotated.ply",
            otherwise: GEAR,
            about: "Long, thin triangles that lie askew: hard for boxes along the axes.",
        },
        Place {
            name: "thingi10k_1514499_slivers.stl",
            otherwise: GEAR,
            about: "A part from a printing site: most of its triangles are slivers.",
        },
        Place { name: "political_borders_lines.obj", otherwise: SIZES, about: "Segments alone." },
        Place {
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

/// The same page in less time, with less in it.
pub(super) const QUICK: Profile = Profile {
    scenes: &[DRAGON, WIREFRAME, CARRIED],
    queries: 15_000,
    builds: 1,
    effort: Effort { rounds: 5, seconds: 0.03 },
    sizes: &[3_000, 12_000, 48_000],
    batch: 100_000,
};

impl Place {
    /// The scene: of the models if it is there.
    pub(super) fn read(&self, models: &Path) -> Result<Scene> {
        let path = models.join(self.name);
        if path.is_file() { Scene::read(&path) } else { generated(self.otherwise) }
    }
}

/// A scene that is made.
fn generated(name: &str) -> Result<Scene> {
    let soup = match name {
        TORUS => torus_knot(&TorusKnot::default())?,
        SIZES => mixed_sizes(&MixedSizes::default())?,
        GEAR => Transform::default().rotated_x(45.0).rotated_y(45.0).apply(&skewed_gear(&SkewedGear::default())?)?,
        _ => knot_and_cables(&KnotAndCables::default())?,
    };
    Scene::new(name.to_owned(), soup)
}

/// A torus knot of about so many triangles, with even ones.
pub(super) fn knot_of(triangles: u32) -> Result<Scene> {
    // The usual knot has rings and sides in the ratio of 16 to 1 or so, and two triangles for each of both.
    let sides = (triangles / 32).isqrt().max(3);
    let soup = torus_knot(&TorusKnot::default().with_rings(triangles / 2 / sides).with_sides(sides))?;
    Scene::new(format!("torus knot of {}", soup.triangles().len()), soup)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_models_there_are_scenes_all_the_same() {
        let read = |place: &Place| place.read(Path::new("nowhere")).unwrap();
        let names: Vec<String> = QUICK.scenes.iter().map(|place| read(place).name).collect();
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
