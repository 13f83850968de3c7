//! What a scene of several kinds costs: sets of one kind, and a tree for each kind.

use crate::backends::{aabb_options, build, id_of};
use crate::contender::{Absent, Answer, Contender, Prepared, Ready};
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{BuildIndex, ClosestPoint, Indexed, PrimitiveId, PrimitiveSet, QueryOptions, Triangle};

/// The AABB tree over the triangles written out, where there is nothing else.
pub(crate) fn aabb_of_triangles(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let set = triangles(scene)?;
    let triangles: Vec<Triangle<f64>> = (0..set.len()).map(|i| set.get(PrimitiveId::new(i))).collect();
    Ok(Prepared { build: Box::new(|| build::<f64, AabbTree<_, _>, _>(triangles, &aabb_options())), borrowed: 0 })
}

/// The AABB tree over the scene's set of triangles, where there is nothing else.
pub(crate) fn aabb_of_set(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let set = triangles(scene)?;
    let build = move || build::<f64, AabbTree<_, _>, _>(set, &aabb_options());
    Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
}

fn triangles(scene: &Scene) -> Result<Indexed<'_, f64, 3>, Absent> {
    let set = scene.double.triangle_set();
    if set.len() < scene.len() {
        return Err(Absent("the scene has other primitives than triangles".to_owned()));
    }
    Ok(set)
}

/// A tree of one kind, and the ids of the primitives in the scene.
struct OfKind<'a> {
    index: Box<dyn ClosestPoint<f64> + Sync + 'a>,
    ids: Vec<PrimitiveId>,
}

/// A tree for each kind that a scene has, that of the most primitives first.
struct ByKind<'a>(Vec<OfKind<'a>>);

impl<'a> ByKind<'a> {
    fn add<const N: usize>(
        &mut self,
        set: Indexed<'a, f64, N>,
        ids: impl Iterator<Item = PrimitiveId>,
    ) -> Result<(), Absent>
    where
        Indexed<'a, f64, N>: PrimitiveSet<f64>,
    {
        if !set.is_empty() {
            let index = AabbTree::build(set, &aabb_options()).map_err(|error| Absent(error.to_string()))?;
            self.0.push(OfKind { index: Box::new(index), ids: ids.collect() });
        }
        Ok(())
    }
}

impl Contender for ByKind<'_> {
    type Scalar = f64;

    /// Each tree is asked within what the ones before have found. Equal distances that are not equal before rounding are
    /// not told apart, as the one tree does; no query here has any.
    fn query(&self, query: &Point3<f64>) -> Answer {
        let mut best = None;
        for OfKind { index, ids } in &self.0 {
            let reach = best.map_or(f64::INFINITY, |(distance, _)| distance);
            let found = index.closest_point_with(query, &QueryOptions::default().with_max_distance(reach));
            let found = found.map(|found| (found.distance, ids[found.primitive.index()]));
            best = match (best, found) {
                (Some(best), Some(found)) if best <= found => Some(best),
                (best, found) => found.or(best),
            };
        }
        best.map_or(Answer::NONE, |(distance, id)| Answer { distance, id: id_of(id) })
    }
}

/// An AABB tree for each kind.
pub(crate) fn aabb_by_kind(scene: &Scene) -> Result<Prepared<'_>, Absent> {
    let soup = &scene.double;
    let build = move || {
        let mut trees = ByKind(Vec::new());
        trees.add(soup.triangle_set(), soup.triangle_ids())?;
        trees.add(soup.segment_set(), soup.segment_ids())?;
        trees.add(soup.point_set(), soup.point_ids())?;
        trees.0.sort_by_key(|tree| std::cmp::Reverse(tree.ids.len()));
        Ok(Box::new(trees) as Ready<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
}
