//! Queries for near primitives.

use crate::instance::{Instance, shape, size};
use crate::instances::Instances;
use nalgebra::Point3;
use p2m_core::kernel::power_of_two;
use p2m_core::pair::PairQuery;
use p2m_core::storage::Writer;
use p2m_core::{
    AnyIndex, BatchAnswer, Best, BoxQuery, CertifiedQuery, ClosestPoint, Collector, IndexStats, Near, NearQuery,
    Primitive, PrimitiveId, QueryOptions, RayQuery, Real, Shape,
};

/// The factor 1 + 16 u, by which a value of a few roundings becomes an upper bound.
const ROUND_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
/// A square of f64 below this one may have lost digits, so that it excludes nothing: 2^-800.
const MIN_SQUARE: f64 = power_of_two(-800);

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Offers to a collector every primitive that it could want. `query` is finite.
    fn visit<C: Collector>(&self, query: &Point3<T>, collector: &mut C) {
        let query = query.map(T::to_f64);
        let Some(tree) = &self.tree else {
            return self.instances.iter().for_each(|instance| search_instance::<T, I, C>(instance, &query, collector));
        };
        let boxes = tree.tree.set();
        let mut visit = |id: PrimitiveId, _: &[[f64; 3]]| {
            search_instance::<T, I, C>(&self.instances[boxes[id.index()].position], &query, collector);
            distance_limit(collector)
        };
        // The box of an instance is not above the key of a primitive inside, so its distance needs no margin.
        tree.tree.search_near(&query, &mut Near::shrinking(f64::INFINITY, f64::INFINITY, &mut visit));
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> Instances<T, I> {
    /// Offers the primitive of an id, if the scene has it.
    fn offer_primitive(&self, id: Option<PrimitiveId>, query: &Point3<T>, best: &mut Best<T>) {
        if let Some((instance, local)) = id.and_then(|id| self.owner_of(id)) {
            offer::<T, I, _>(instance, local, &[], &query.map(T::to_f64), best);
        }
    }
}

/// Returns the distance above which a collector needs nothing, or NaN if it needs nothing at all.
fn distance_limit(collector: &impl Collector) -> f64 {
    collector.prune_above().sqrt() * ROUND_UP
}

/// Offers to a collector every primitive of an instance that it could want.
fn search_instance<T: Real, I: AnyIndex<T> + ?Sized, C: Collector>(
    instance: &Instance<I>,
    query: &Point3<f64>,
    collector: &mut C,
) {
    let moved_back = Point3::from(instance.motion.apply_inverse((*query).into()));
    let local = moved_back.map(T::round_from_f64);
    let rounded = local.map(T::to_f64);
    let margin = instance.margin(size((*query).into())) + size((rounded - moved_back).into()) * ROUND_UP;
    // A query or a margin beyond the range of the scalar leaves nothing to search by.
    if !(rounded.iter().all(|x| x.is_finite()) && margin.is_finite()) {
        return instance.local_ids().for_each(|id| offer(instance, id, &[], query, collector));
    }
    let radius = distance_limit(collector) + margin;
    // The comparison is false for a radius of NaN, whose search ends before it begins.
    if instance.object.bounds.lower_bound(&rounded) > (radius * radius * ROUND_UP).max(MIN_SQUARE) {
        return;
    }
    // The best primitive of the object bounds the best distance up to one margin, and any other primitive errs by one
    // margin as well. Collectors of several primitives may want farther ones still. Near ties that a collector keeps
    // differ by two errors of the kernel, for which the margins have room.
    let is_single = collector.is_single_nearest();
    let slack = if is_single { 2.0 * margin + collector.near_tie_slack() } else { f64::INFINITY };
    let mut visit = |id: PrimitiveId, vertices: &[[f64; 3]]| {
        offer(instance, id, vertices, query, collector);
        distance_limit(collector) + margin
    };
    instance.object.index.search_near(&local, &mut Near::shrinking(radius, slack, &mut visit));
}

/// Offers a moved primitive to a collector. `vertices` are those in the frame of the object, if they are known.
fn offer<T: Real, I: AnyIndex<T> + ?Sized, C: Collector>(
    instance: &Instance<I>,
    local: PrimitiveId,
    vertices: &[[f64; 3]],
    query: &Point3<f64>,
    collector: &mut C,
) {
    let id = instance.scene_id(local);
    let moved = instance.moved(local, vertices);
    if collector.take_vertices(id, moved.vertices()) {
        return;
    }
    let square = if collector.keeps_near_ties() { f64::INFINITY } else { collector.prune_above_for_id(id) };
    if let Some(projection) = shape(&moved).project_within(query, square) {
        collector.offer(id, projection);
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> ClosestPoint<T> for Instances<T, I> {
    fn search(&self, query: &Point3<T>, best: &mut Best<T>) {
        self.offer_primitive(best.hint(), query, best);
        self.visit(query, best.minimum());
    }

    /// Answers queries in their order. Each search begins with the primitive of the last answer, which is near if the
    /// queries are in a spatial order.
    fn answer_queries(
        &self,
        queries: &[Point3<T>],
        options: &QueryOptions<T>,
        answered: &mut dyn FnMut(usize, BatchAnswer<'_, T>),
    ) {
        let template = Best::new(options);
        let mut last = None;
        for (i, query) in queries.iter().enumerate() {
            let mut best = template.clone();
            if query.iter().all(|x| x.is_finite()) {
                // Another candidate may change an approximate answer.
                self.offer_primitive(last.filter(|_| !options.is_approximate()), query, &mut best);
                self.search(query, &mut best);
                last = best.minimum().distance_and_primitive().map(|(_, id)| id);
            }
            answered(i, best.found());
        }
    }
}

impl<T: Real, I: AnyIndex<T> + ?Sized> NearQuery<T> for Instances<T, I> {
    fn search_near(&self, query: &Point3<T>, near: &mut Near<'_>) {
        self.visit(query, near);
    }
}

impl<I: AnyIndex<f64> + ?Sized> CertifiedQuery<f64> for Instances<f64, I> {
    fn shape(&self, id: PrimitiveId) -> Option<Shape<f64>> {
        self.owner_of(id).map(|(instance, local)| shape(&instance.moved(local, &[])))
    }
}

/// Queries count the moved primitives that are evaluated, and neither nodes nor packets.
impl<T: Real, I: AnyIndex<T> + ?Sized> IndexStats<T> for Instances<T, I> {
    /// Returns the memory of the instances and of the tree of their boxes. Indexes are not included.
    fn parts(&self) -> Vec<(&'static str, usize)> {
        let names: usize = self.instances.iter().map(Instance::name_bytes).sum();
        let boxes =
            |tree: &crate::instances::InstanceTree| tree.tree.memory() + std::mem::size_of_val(&tree.tree.set()[..]);
        vec![
            ("instances", std::mem::size_of_val(&self.instances[..]) + names),
            ("tree", self.tree.as_ref().map_or(0, boxes)),
        ]
    }
}

/// A scene has no saved form.
impl<I: AnyIndex<f64> + ?Sized> AnyIndex<f64> for Instances<f64, I> {
    fn save<'s>(&'s self, _: &mut Writer<'s>) {}

    fn primitive_count(&self) -> usize {
        self.count_primitives()
    }

    fn memory_bytes(&self) -> usize {
        self.parts().iter().map(|(_, bytes)| bytes).sum()
    }

    fn as_ray_query(&self) -> Option<&(dyn RayQuery<f64> + Sync)> {
        Some(self)
    }

    fn as_box_query(&self) -> Option<&(dyn BoxQuery<f64> + Sync)> {
        Some(self)
    }

    fn as_pair_query(&self) -> Option<&(dyn PairQuery<f64> + Sync)> {
        Some(self)
    }
}
