//! The backend that an input selects.

use super::bytes::Bytes;
use p2m::core::Isa;
use p2m::interception::Domain;
use p2m::kdop::Directions;
use p2m::{
    AabbTree, BoxQuery, BuildError, BuildIndex, CertifiedQuery, ClosestPoint, KdopTree, NearQuery, OctreeIndex,
    OctreeOptions, P2mIndex, P2mOptions, PrimitiveSet, RayQuery, Real, Soup,
};

/// An index that answers the queries of all backends.
pub trait Index<T: Real>: ClosestPoint<T> + NearQuery<T> + CertifiedQuery<T> + Sync {}
impl<T: Real, I: ClosestPoint<T> + NearQuery<T> + CertifiedQuery<T> + Sync> Index<T> for I {}

/// An index that also answers ray and box queries.
pub trait Tree<T: Real>: Index<T> + RayQuery<T> + BoxQuery<T> {}
impl<T: Real, I: Index<T> + RayQuery<T> + BoxQuery<T>> Tree<T> for I {}

/// The names of the trees.
pub const TREES: [&str; 4] = ["aabb", "kdop-6", "kdop-14", "kdop-26"];
/// The names of the other backends, which answer only closest-point queries.
pub const OTHERS: [&str; 2] = ["octree", "p2m"];

type Built<'a, I> = Result<(&'static str, Box<I>), BuildError>;

fn isa(bytes: &mut Bytes<'_>) -> Isa {
    let mut available = Isa::available();
    // The number zero selects the best instruction set.
    available.reverse();
    bytes.pick(&available)
}

fn kdop<'a, T: Real, const K: usize>(soup: &'a Soup<T>, isa: Isa) -> Result<Box<dyn Tree<T> + 'a>, BuildError>
where
    Directions<K>: Default,
{
    Ok(Box::new(KdopTree::<T, _, K>::new(soup)?.with_isa(isa)))
}

/// Builds a tree, with any instruction set.
///
/// # Errors
/// Returns the errors of the build.
pub fn tree<'a, T: Real>(bytes: &mut Bytes<'_>, soup: &'a Soup<T>) -> Built<'a, dyn Tree<T> + 'a> {
    let (name, isa) = (bytes.pick(&TREES), isa(bytes));
    let built = match name {
        "aabb" => Box::new(AabbTree::<T, _>::new(soup)?.with_isa(isa)),
        "kdop-6" => kdop::<T, 6>(soup, isa)?,
        "kdop-14" => kdop::<T, 14>(soup, isa)?,
        _ => kdop::<T, 26>(soup, isa)?,
    };
    Ok((name, built))
}

/// Builds an index of any backend, with any instruction set and some options. Half of all numbers select a tree.
///
/// # Errors
/// Returns the errors of the build.
pub fn index<'a, T: Real>(bytes: &mut Bytes<'_>, soup: &'a Soup<T>) -> Built<'a, dyn Index<T> + 'a> {
    let number = bytes.below(2 * TREES.len());
    let Some(name) = number.checked_sub(TREES.len()).map(|number| OTHERS[number % OTHERS.len()]) else {
        let (name, built) = tree(&mut Bytes::new(&[number as u8, bytes.byte()]), soup)?;
        return Ok((name, built));
    };
    let isa = isa(bytes);
    let built: Box<dyn Index<T> + 'a> = match name {
        "octree" => {
            let usual = OctreeOptions::default();
            let options = match bytes.below(4) {
                0 | 1 => usual,
                2 => usual.with_domain(Domain::Box(soup.aabb().to_f64())),
                _ => usual.with_domain(Domain::Band(f64::from(bytes.byte()) * 0.125)).with_resolution(1.0),
            };
            Box::new(OctreeIndex::build(soup, &options)?.with_isa(isa))
        }
        _ => {
            let usual = P2mOptions::default();
            let options = match bytes.below(3) {
                0 => usual,
                1 => usual.with_max_list_packets(2048).with_max_extra_sites(2.0),
                _ => usual.with_max_extra_sites(0.0),
            };
            Box::new(P2mIndex::build(soup, &options)?.with_isa(isa))
        }
    };
    Ok((name, built))
}
