//! Indexes over scenes of one kind of primitive, and a tree for each kind in scenes of several kinds.

use crate::backend::{Answer, BenchIndex, BoxedIndex, Prepared, Unavailable};
use crate::our_indexes::{aabb_options, id_of, over_set};
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{
    BuildIndex, ClosestPoint, KindSet, PrimitiveId, PrimitiveSet, QueryOptions, Soup, Triangle, TriangleSet,
};

/// Prepares the AABB tree over a vector of triangles, for scenes without other primitives.
pub(crate) fn aabb_of_triangles(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let set = triangles(scene)?;
    let triangles: Vec<Triangle<f64>> = (0..set.len()).map(|i| set.get(PrimitiveId::new(i))).collect();
    over_set(triangles, 0, |set| AabbTree::build(set, &aabb_options()))
}

/// Prepares the AABB tree over the scene's set of triangles, for scenes without other primitives.
pub(crate) fn aabb_of_set(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let set = triangles(scene)?;
    over_set(set, scene.double_bytes, |set| AabbTree::build(set, &aabb_options()))
}

fn triangles(scene: &Scene) -> Result<TriangleSet<&Soup<f64>>, Unavailable> {
    let set = scene.double.triangle_set();
    if set.len() < scene.len() {
        return Err(Unavailable("the scene has other primitives than triangles".to_owned()));
    }
    Ok(set)
}

/// A tree over the primitives of one kind, with their ids in the scene.
struct KindTree<'a> {
    index: Box<dyn ClosestPoint<f64> + Sync + 'a>,
    ids: Vec<PrimitiveId>,
}

/// One tree for each kind of primitive in a scene, in decreasing order of their sizes.
struct KindTrees<'a>(Vec<KindTree<'a>>);

impl<'a> KindTrees<'a> {
    fn add<const N: usize>(
        &mut self,
        set: KindSet<&'a Soup<f64>, N>,
        ids: impl Iterator<Item = PrimitiveId>,
    ) -> Result<(), Unavailable>
    where
        KindSet<&'a Soup<f64>, N>: PrimitiveSet<f64>,
    {
        if !set.is_empty() {
            let index = AabbTree::build(set, &aabb_options()).map_err(|error| Unavailable(error.to_string()))?;
            self.0.push(KindTree { index: Box::new(index), ids: ids.collect() });
        }
        Ok(())
    }
}

impl BenchIndex for KindTrees<'_> {
    type Scalar = f64;

    /// Queries each tree within the distance that the previous ones found. Unlike the single tree, this does not decide
    /// between computed distances that are equal although the keys differ; no query of the harness has such a tie.
    fn query(&self, query: &Point3<f64>) -> Answer {
        let mut best = None;
        for KindTree { index, ids } in &self.0 {
            let max_distance = best.map_or(f64::INFINITY, |(distance, _)| distance);
            let found = index.closest_point_with(query, &QueryOptions::default().with_max_distance(max_distance));
            let found = found.map(|found| (found.distance, ids[found.primitive.index()]));
            best = match (best, found) {
                (Some(best), Some(found)) if best <= found => Some(best),
                (best, found) => found.or(best),
            };
        }
        best.map_or(Answer::NONE, |(distance, id)| Answer { distance, id: id_of(id) })
    }
}

/// Prepares an AABB tree for each kind of primitive.
pub(crate) fn aabb_by_kind(scene: &Scene) -> Result<Prepared<'_>, Unavailable> {
    let soup = &*scene.double;
    let build = move || {
        let mut trees = KindTrees(Vec::new());
        trees.add(soup.triangle_set(), soup.triangle_ids())?;
        trees.add(soup.segment_set(), soup.segment_ids())?;
        trees.add(soup.point_set(), soup.point_ids())?;
        trees.0.sort_by_key(|tree| std::cmp::Reverse(tree.ids.len()));
        Ok(Box::new(trees) as BoxedIndex<'_>)
    };
    Ok(Prepared { build: Box::new(build), borrowed: scene.double_bytes })
}
