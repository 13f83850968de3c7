//! The changes that `p2m convert` and `p2m generate` apply to scenes.

use crate::io::usage::{finite, positive, usage};
use crate::io::{Progress, Streams, Unit};
use p2m_core::{Element, PrimitiveSet, Soup};
use p2m_mixed::generate::{GenerateError, Subdivide, Transform, gapped, penetrating, subdivide};
use p2m_mixed::{Object, Scene};
use serde::Serialize;
use serde_json::{Value, json};
use std::sync::Arc;

/// The changes to a scene, in the order in which they are applied. Reports have them by these names.
#[derive(clap::Args, Serialize)]
#[command(next_help_heading = "Changes, applied in this order")]
pub(crate) struct Modifiers {
    /// Split each triangle into four and each segment into two, N times
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    subdivide: Option<u32>,

    /// Move new midpoints by up to A edge lengths while subdividing; A is at most 0.5
    #[arg(long, value_name = "A", value_parser = finite, allow_negative_numbers = true, requires = "subdivide")]
    displace: Option<f64>,

    /// Seed of the displacements
    #[arg(long, value_name = "K", default_value_t = Subdivide::default().seed, allow_negative_numbers = true, requires = "displace")]
    #[serde(skip)]
    displace_seed: u64,

    /// Shrink each primitive about its centroid by this factor
    #[arg(long, value_name = "F", value_parser = finite, allow_negative_numbers = true, conflicts_with = "penetrate")]
    gap: Option<f64>,

    /// Enlarge each primitive about its centroid by this factor
    #[arg(long, value_name = "F", value_parser = finite, allow_negative_numbers = true)]
    penetrate: Option<f64>,

    /// Rotate about the x axis
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_negative_numbers = true)]
    rotate_x: Option<f64>,

    /// Rotate about the y axis
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_negative_numbers = true)]
    rotate_y: Option<f64>,

    /// Rotate about the z axis
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_negative_numbers = true)]
    rotate_z: Option<f64>,

    /// Scale about the origin
    #[arg(long, value_name = "F", value_parser = positive, allow_negative_numbers = true)]
    scale: Option<f64>,

    /// Move by this vector
    #[arg(long, value_names = ["X", "Y", "Z"], num_args = 3, value_parser = finite, allow_negative_numbers = true)]
    translate: Option<Vec<f64>>,
}

/// The paragraph of the help about these options.
pub(crate) const ORDER: &str = "\
Transformations are applied in the order in which the help lists them. For another order, chain runs: p2m convert \
a.obj - --to ply --rotate-z 30 | p2m convert - b.obj --from ply --subdivide 1.";

impl Modifiers {
    /// Returns the scene after all changes. The parts of a subdivided primitive keep its name.
    pub(crate) fn apply(&self, streams: &Streams, scene: Scene) -> anyhow::Result<Scene> {
        self.changed(streams, scene).map_err(refused)
    }

    fn changed(&self, streams: &Streams, mut scene: Scene) -> Result<Scene, GenerateError> {
        if let Some(levels) = self.subdivide {
            let _progress = Progress::start(streams, "subdividing", None, Unit::None);
            let options = Subdivide { levels, amplitude: self.displace.unwrap_or(0.0), seed: self.displace_seed };
            let objects = subdivided_objects(&scene, levels);
            let soup = subdivide(&scene.soup, &options)?;
            scene = with_soup(&scene, soup, objects);
        }
        let resized = match (self.gap, self.penetrate) {
            (Some(factor), _) => Some(gapped(&scene.soup, factor)?),
            (_, Some(factor)) => Some(penetrating(&scene.soup, factor)?),
            _ => None,
        };
        if let Some(soup) = resized {
            let objects = scene.objects.clone();
            scene = with_soup(&scene, soup, objects);
        }
        if let Some(transform) = self.transform() {
            scene.soup = Arc::new(transform.apply(&scene.soup)?);
        }
        Ok(scene)
    }

    fn transform(&self) -> Option<Transform> {
        let mut transform = Transform::default();
        let rotations = [
            (self.rotate_x, Transform::rotated_x as fn(Transform, f64) -> Transform),
            (self.rotate_y, Transform::rotated_y),
            (self.rotate_z, Transform::rotated_z),
            (self.scale, Transform::scaled),
        ];
        for (amount, change) in rotations {
            transform = amount.map_or(transform, |amount| change(transform, amount));
        }
        if let Some(&[x, y, z]) = self.translate.as_deref() {
            transform = transform.translated([x, y, z]);
        }
        (transform != Transform::default()).then_some(transform)
    }

    /// Returns the requested changes in the order in which they are applied.
    pub(crate) fn json(&self) -> Value {
        let Value::Object(all) = json!(self) else { return Value::Null };
        let requested = all.into_iter().filter(|(_, value)| !value.is_null());
        requested.map(|(change, value)| json!({ "change": change, "by": value })).collect()
    }
}

/// Returns a scene with other primitives. The list of skipped records stays.
fn with_soup(scene: &Scene, soup: Soup<f64>, objects: Vec<Object>) -> Scene {
    let mut changed = Scene::from(soup);
    changed.objects = objects;
    changed.skipped.clone_from(&scene.skipped);
    (changed.unit, changed.is_flat) = (scene.unit, scene.is_flat);
    changed
}

/// Returns the ranges of the parts of named primitives after this number of subdivisions. The parts of each primitive
/// follow one another where the primitive was.
fn subdivided_objects(scene: &Scene, levels: u32) -> Vec<Object> {
    if scene.objects.is_empty() {
        return Vec::new();
    }
    // The subdivision itself refuses too many parts.
    let parts = |element| match element {
        Element::Point(_) => 1,
        Element::Segment(_) => 1usize.checked_shl(levels).unwrap_or(usize::MAX),
        Element::Triangle(_) => 1usize.checked_shl(2 * levels.min(100)).unwrap_or(usize::MAX),
    };
    let mut starts = Vec::with_capacity(scene.soup.len() + 1);
    let mut next = 0usize;
    for element in scene.soup.elements() {
        starts.push(next);
        next = next.saturating_add(parts(element));
    }
    starts.push(next);
    let moved = |o: &Object| Object { name: o.name.clone(), ids: starts[o.ids.start]..starts[o.ids.end] };
    scene.objects.iter().map(moved).collect()
}

/// Converts an error of an option into one of usage.
pub(crate) fn refused(error: GenerateError) -> anyhow::Error {
    match error {
        GenerateError::Build(_) | GenerateError::Memory { .. } => {
            anyhow::Error::from(error).context("the scene cannot be made")
        }
        _ => usage(error.to_string()),
    }
}
