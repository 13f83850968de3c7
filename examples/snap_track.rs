//! Snaps a track to a network of lines, as a navigation device does: each position moves to the closest point of the
//! network, unless that is too far.
//!
//! `cargo run --release --example snap_track`. The network is a grid of streets, and the track is a walk along some of
//! them with the errors of a receiver, so the correct street is known.

use nalgebra::Point3;
use p2m::{ClosestPoint, KdopTree, PrimitiveId, QueryOptions, Segment};

const STREETS: u32 = 40;
const BLOCK: f64 = 100.0;
/// The largest distance of a position from its street.
const MAX_DISTANCE: f64 = 20.0;

/// Returns segments of streets, one between any two neighbouring crossings.
fn streets() -> Vec<Segment<f64>> {
    let at = |i: u32, j: u32| Point3::new(f64::from(i) * BLOCK, f64::from(j) * BLOCK, 0.0);
    let along = (0..=STREETS).flat_map(|j| (0..STREETS).map(move |i| Segment::new(at(i, j), at(i + 1, j))));
    let across = (0..=STREETS).flat_map(|i| (0..STREETS).map(move |j| Segment::new(at(i, j), at(i, j + 1))));
    along.chain(across).collect()
}

/// Returns the positions of a staircase through the grid, ten in each block, and whether each is on a street.
fn track() -> Vec<(Point3<f64>, bool)> {
    let mut positions = Vec::new();
    for step in 0..2 * STREETS {
        let (x, y, is_along) = (step.div_ceil(2), step / 2, step % 2 == 0);
        for part in 0..10 {
            // Errors are up to 15 metres, and 30 at every 50th position.
            let number = f64::from(step * 10 + part);
            let error = if (step * 10 + part) % 50 == 45 { 30.0 } else { 15.0 * (number * 1.7).sin() };
            let way = f64::from(part) * BLOCK / 10.0 + BLOCK / 20.0;
            let (x, y) = (f64::from(x) * BLOCK, f64::from(y) * BLOCK);
            let position =
                if is_along { Point3::new(x + way, y + error, 0.0) } else { Point3::new(x + error, y + way, 0.0) };
            positions.push((position, is_along));
        }
    }
    positions
}

/// Returns for each position the primitive that it is on, if there is one. The previous primitive is a hint, because
/// it is near.
fn snap<I: ClosestPoint<f64>>(index: &I, track: impl Iterator<Item = Point3<f64>>) -> Vec<Option<(PrimitiveId, f64)>> {
    let mut options = QueryOptions::default().with_max_distance(MAX_DISTANCE);
    track
        .map(|position| {
            let answer = index.closest_point_with(&position, &options)?;
            options = options.with_hint(answer.primitive);
            Some((answer.primitive, answer.distance))
        })
        .collect()
}

fn main() -> anyhow::Result<()> {
    let streets = streets();
    let index = KdopTree::<f64, _, 6>::new(&streets)?;
    let track = track();
    let snapped = snap(&index, track.iter().map(|(position, _)| *position));
    let on_a_street = snapped.iter().flatten().count();
    let is_along = |id: &PrimitiveId| id.index() < (STREETS * (STREETS + 1)) as usize;
    let right = track.iter().zip(&snapped).filter(|((_, along), s)| s.is_some_and(|(id, _)| is_along(&id) == *along));
    println!("{} places beside {} parts of streets", track.len(), streets.len());
    println!("{on_a_street} are on a street, {} on none", track.len() - on_a_street);
    println!("{} of them on the right one", right.count());
    let sum: f64 = snapped.iter().flatten().map(|(_, distance)| distance).sum();
    println!("{:.3} metres from it on average", sum / on_a_street.max(1) as f64);
    Ok(())
}
