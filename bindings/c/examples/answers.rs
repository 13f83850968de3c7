//! Writes random queries to one file, and the answers that tests/answers.c has to reproduce to another one. The answers
//! come from single queries in Rust: `answers SCENE BACKEND COUNT QUERIES ANSWERS`.

use nalgebra::Point3;
use p2m_backends::{BackendEntry, BuildSettings};
use p2m_core::{ClosestPoint, PrimitiveSet, QueryOptions};
use p2m_field::sign::Normals;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, scene, backend, count, queries_file, answers_file] = &arguments[..] else {
        return Err("answers SCENE BACKEND COUNT QUERIES ANSWERS".into());
    };
    let soup = p2m_mixed::read_scene(scene.as_ref())?.soup;
    let entry = BackendEntry::find(backend).ok_or("no such backend")?;
    let index = entry.build(Arc::clone(&soup), &BuildSettings::default())?.index;
    let normals = Normals::new(&soup);

    // Points of a box that is twice as large as the box of the scene, by a linear congruential generator.
    let bounds = soup.aabb();
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut point =
        || Point3::from(bounds.min + (bounds.max - bounds.min).map(|length| length * (2.0 * random() - 0.5)));
    let queries: Vec<Point3<f64>> = (0..count.parse()?).map(|_| point()).collect();
    let mut columns: [Vec<u8>; 7] = Default::default();
    for query in &queries {
        let closest = index.closest_point_with(query, &QueryOptions::default()).ok_or("no answer")?;
        let normal = normals.at(closest.primitive, closest.feature).map_or([f64::NAN; 3], Into::into);
        columns[0].extend(closest.distance.to_ne_bytes());
        columns[1].extend(closest.primitive.number().to_ne_bytes());
        columns[2].extend(closest.point.iter().flat_map(|x| x.to_ne_bytes()));
        columns[3].push(closest.feature.code());
        columns[4].extend(closest.barycentric.iter().flat_map(|x| x.to_ne_bytes()));
        columns[5].extend(closest.lower_bound.to_ne_bytes());
        columns[6].extend(normal.iter().flat_map(|x| x.to_ne_bytes()));
    }
    let numbers = queries.iter().flat_map(|query| query.iter().flat_map(|x| x.to_ne_bytes()));
    std::fs::write(queries_file, numbers.collect::<Vec<u8>>())?;
    Ok(std::fs::write(answers_file, columns.concat())?)
}
