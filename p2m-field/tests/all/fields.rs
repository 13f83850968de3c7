//! Every value of a distance field has to be the answer of a single query, whatever method fills the field.

use base64::Engine as _;
use nalgebra::Point3;
use p2m_bvh::AabbTree;
use p2m_core::{Aabb, BruteForce, ClosestPoint, PrimitiveSet, Soup};
use p2m_field::sign::{SignRule, SignedDistance};
use p2m_field::{
    CandidateLists, FieldOptions, Grid, GridError, RefineOptions, distances, distances_by_lists, refined,
    signed_distances, signed_distances_by_lists, slice, write_field,
};
use p2m_interception::{OctreeIndex, P2mIndex};
use p2m_mixed::generate::{IcoSphere, KnotAndCables, TorusKnot, ico_sphere, knot_and_cables, torus_knot};
use p2m_testkit::{amount, is_deep};
use std::sync::atomic::{AtomicUsize, Ordering};

fn knot() -> Soup<f64> {
    torus_knot(&TorusKnot { rings: 60, sides: 8, ..Default::default() }).expect("valid")
}

fn samples(grid: &Grid) -> impl Iterator<Item = Point3<f64>> + '_ {
    let [x, y, _] = grid.counts();
    (0..grid.len()).map(move |n| grid.point([n % x, n / x % y, n / (x * y)]))
}

#[test]
fn fields_are_single_answers_by_every_index_and_on_all_threads() {
    let soup = if is_deep() { knot_and_cables(&KnotAndCables::default()).expect("valid") } else { knot() };
    // The size is a multiple neither of slabs nor of batches, and larger than one of each. In shallow tests the grid
    // reaches far above the scene for that.
    let around = Grid::around(&soup.aabb(), amount(69, 13), 1.3).expect("a box");
    let high = Grid::new(around.origin(), around.spacing(), [13, 11, 19]).expect("finite");
    let grid = amount(around, high);
    let brute = BruteForce::new(&soup).expect("valid");
    let tree = AabbTree::new(&soup).expect("valid");
    let expected: Vec<f32> =
        samples(&grid).map(|sample| tree.closest_point(&sample).expect("not empty").distance as f32).collect();
    for (n, sample) in samples(&grid).enumerate().step_by(amount(997, 97)) {
        assert_eq!(expected[n], brute.closest_point(&sample).expect("not empty").distance as f32);
    }
    let octree = OctreeIndex::new(&soup).expect("valid");
    let p2m = P2mIndex::new(&soup).expect("valid");
    {
        for parallel in [true, false] {
            let options = FieldOptions::default().with_parallel(parallel);
            let done = AtomicUsize::new(0);
            let progress = |points| {
                done.fetch_add(points, Ordering::Relaxed);
            };
            assert!(distances(&tree, &grid, &options, &progress).as_ref() == Ok(&expected));
            assert_eq!(done.into_inner(), grid.len());
            assert!(distances(&octree, &grid, &options, &|_| ()).as_ref() == Ok(&expected));
            assert!(distances(&p2m, &grid, &options, &|_| ()).as_ref() == Ok(&expected));
        }
    }
    let lists = CandidateLists::new(&soup).expect("plain");
    for parallel in [true, false] {
        let done = AtomicUsize::new(0);
        let progress = |points| {
            done.fetch_add(points, Ordering::Relaxed);
        };
        let options = FieldOptions::default().with_parallel(parallel);
        assert!(distances_by_lists(&lists, &grid, &options, &progress).as_ref() == Ok(&expected));
        assert_eq!(done.into_inner(), grid.len());
    }
}

/// Fields of models of all kinds, around the whole model and close to its surface, where values have few digits in
/// common with the distance from zero.
#[test]
fn fields_by_lists_are_those_of_a_tree_on_models() {
    for name in [
        "lines.obj",
        "scan.obj",
        "slivers.stl",
        "mixed.obj",
        "city_far_from_origin.obj",
        "non_manifold.ply",
        "zero_area.off",
        "rings_lines.obj",
        "bunny.obj",
        "gear_skewed_57k_rotated.ply",
        "mixed_armadillo_camel_wireframe.obj",
        "political_borders_lines.obj",
        "rotterdam_city_far_from_origin.obj",
        "heavily_nonmanifold.obj",
        "degenerate_sliding.off",
        "zero_area_triangle.stl",
    ] {
        let Some(path) = p2m_testkit::model_file(name) else { continue };
        let soup = p2m_mixed::read_scene(&path).expect("a scene").soup;
        let tree = AabbTree::new(&soup).expect("valid");
        let lists = CandidateLists::new(&soup).expect("plain");
        let bounds = soup.aabb();
        let corner = soup.positions()[soup.positions().len() / 2];
        let close = (bounds.max - bounds.min) * 1e-3;
        let close = Aabb { min: corner - close, max: corner + close };
        for (bounds, resolution) in [(bounds, amount(33, 9)), (close, amount(17, 7))] {
            let grid = Grid::around(&bounds, resolution, 1.3).expect("a box");
            let expected = distances(&tree, &grid, &FieldOptions::default(), &|_| ()).expect("memory");
            let found = distances_by_lists(&lists, &grid, &FieldOptions::default(), &|_| ()).expect("memory");
            let differ = expected.iter().zip(&found).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            assert_eq!(differ, 0, "{name}, {} points", grid.len());
        }
    }
}

#[test]
fn there_are_no_lists_of_what_is_out_of_range_or_not_its_vertices() {
    let point = |x: f64| [p2m_core::Point::new(Point3::new(x, 0.0, 0.0))];
    assert!(CandidateLists::new(&point(1e75)).is_some());
    assert!(CandidateLists::new(&point(1e76)).is_none() && CandidateLists::new(&point(f64::NAN)).is_none());
    let far = Grid::new(Point3::new(0.0, 1e76, 0.0), 1.0, [2, 2, 2]).expect("valid");
    let near = point(1.0);
    let lists = CandidateLists::new(&near).expect("plain");
    assert_eq!(distances_by_lists(&lists, &far, &FieldOptions::default(), &|_| ()), Err(GridError::Range));

    struct Ball;
    impl p2m_core::Primitive<f64> for Ball {
        fn aabb(&self) -> Aabb<f64> {
            Aabb { min: Point3::new(-1.0, -1.0, -1.0), max: Point3::new(1.0, 1.0, 1.0) }
        }
        fn project(&self, query: &Point3<f64>) -> p2m_core::Projection {
            p2m_core::Projection::new(query, *query, p2m_core::Feature::Face, [1.0, 0.0, 0.0], 0.0)
        }
        fn intersect_ray(&self, _: &p2m_core::Ray) -> Option<p2m_core::RayHit> {
            unreachable!("no rays are cast")
        }
    }
    assert!(CandidateLists::new(&[Ball]).is_none());
}

#[test]
fn bands_are_cut_from_whole_fields() {
    let soup = knot();
    let grid = Grid::around(&soup.aabb(), amount(53, 21), 1.5).expect("a box");
    let tree = AabbTree::new(&soup).expect("valid");
    let full_field = distances(&tree, &grid, &FieldOptions::default(), &|_| ()).expect("memory");
    let lists = CandidateLists::new(&soup).expect("plain");
    for band in [0.0, 1e-3, 0.05, 0.3, 100.0] {
        let counted = Counted(&tree, AtomicUsize::new(0));
        let options = FieldOptions::default().with_band(band);
        let found = distances(&counted, &grid, &options, &|_| ()).expect("memory");
        let expected: Vec<f32> = full_field.iter().map(|x| x.min(band as f32)).collect();
        assert!(found == expected, "{band}");
        let counted = counted.1.into_inner();
        println!("{counted} of {} points asked for a band of {band}", grid.len());
        if band < 0.06 {
            assert!(counted < grid.len() / 4, "{band}: {counted} of {}", grid.len());
        }
        assert!(distances_by_lists(&lists, &grid, &options, &|_| ()).as_ref() == Ok(&expected), "{band}");
    }
}

/// An index that counts its queries.
struct Counted<'a, I>(&'a I, AtomicUsize);

impl<I: ClosestPoint<f64>> ClosestPoint<f64> for Counted<'_, I> {
    fn search(&self, query: &Point3<f64>, best: &mut p2m_core::Best<f64>) {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.search(query, best);
    }
}

/// Checks that fields have the signs of single answers, with and without a band.
fn has_signs_of_answers(
    soup: &Soup<f64>,
    signed: &SignedDistance<AabbTree<f64, &Soup<f64>>, &Soup<f64>>,
    min_inside: usize,
) {
    // The grid passes through the middle, where the sign of an open surface changes far from it.
    let grid = Grid::around(&soup.aabb(), amount(47, 9), 1.2).expect("a box");
    let value = |sample: Point3<f64>, band: f64| {
        let answer = signed.closest_point(&sample).expect("not empty");
        answer.distance().map_or(f32::NAN, |d| d.clamp(-band, band) as f32).to_bits()
    };
    for band in [f64::INFINITY, 0.05] {
        let expected: Vec<u32> = samples(&grid).map(|sample| value(sample, band)).collect();
        let inside = expected.iter().filter(|x| f32::from_bits(**x) < 0.0).count();
        assert!(inside > min_inside, "{inside}");
        let found = signed_distances(signed, &grid, &FieldOptions::default().with_band(band), &|_| ()).expect("memory");
        assert!(found.iter().map(|x| x.to_bits()).eq(expected.iter().copied()), "{band}");
        let lists = CandidateLists::new(soup).expect("plain");
        let options = FieldOptions::default().with_band(band);
        let found = signed_distances_by_lists(&lists, signed, &grid, &options, &|_| ()).expect("memory");
        assert!(found.iter().map(|x| x.to_bits()).eq(expected.iter().copied()), "{band} by lists");
    }
}

#[test]
fn signs_of_fields_are_those_of_single_answers() {
    let (soup, min_inside) = (knot(), amount(500, 3));
    let tree = |soup| AabbTree::new(soup).expect("valid");
    has_signs_of_answers(&soup, &SignedDistance::new(tree(&soup), &soup).expect("closed"), min_inside);
    let winding = SignedDistance::with_rule(tree(&soup), &soup, SignRule::Parity).expect("closed");
    has_signs_of_answers(&soup, &winding, min_inside);
    // The sign of half a ball changes far from the surface where it is open, and is undefined in between.
    let ball = ico_sphere(&IcoSphere { frequency: 8 }).expect("valid");
    let is_low = |t: &[u32; 3]| t.iter().all(|i| ball.positions()[*i as usize].x <= 0.0);
    let half_ball = ball.triangles().iter().filter(|t| is_low(t)).copied().collect();
    let half_ball = Soup::from_triangles(ball.positions().to_vec(), half_ball).expect("valid");
    let winding = SignedDistance::new(tree(&half_ball), &half_ball).expect("triangles");
    has_signs_of_answers(&half_ball, &winding, min_inside);
}

#[test]
fn an_empty_scene_is_infinitely_far() {
    let grid = Grid::new(Point3::origin(), 1.0, [3, 2, 2]).expect("valid");
    let empty: Soup<f64> = Soup::default();
    let tree = AabbTree::new(&empty).expect("valid");
    for band in [f64::INFINITY, 2.0] {
        let field = distances(&tree, &grid, &FieldOptions::default().with_band(band), &|_| ());
        assert_eq!(field, Ok(vec![f32::INFINITY; 12]));
        let lists = CandidateLists::new(&empty).expect("plain");
        let field = distances_by_lists(&lists, &grid, &FieldOptions::default().with_band(band), &|_| ());
        assert_eq!(field, Ok(vec![f32::INFINITY; 12]));
    }
}

/// Closed surfaces are so large or so small that f32 barely represents distances.
#[test]
fn signs_by_lists_are_right_where_f32_has_no_digits() {
    let cube = |side: f64| {
        let corner = |i: u32| Point3::from([0, 1, 2].map(|k| f64::from(i >> k & 1) * side));
        let faces = [
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        Soup::from_triangles((0..8).map(corner).collect(), faces.to_vec()).expect("valid")
    };
    for (side, low, spacing) in [(1e40, -5e38, 1e39), (1e-44, -0.8e-45, 1.3e-45), (1.0, -0.25, 0.1)] {
        let soup = cube(side);
        let tree = |soup| AabbTree::new(soup).expect("valid");
        let signed = SignedDistance::new(tree(&soup), &soup).expect("closed");
        let winding = SignedDistance::with_rule(tree(&soup), &soup, SignRule::Parity).expect("closed");
        let lists = CandidateLists::new(&soup).expect("plain");
        let grid = Grid::new(Point3::from([low; 3]), spacing, [12; 3]).expect("valid");
        let options = FieldOptions::default();
        let bits = |field: Vec<f32>| field.into_iter().map(f32::to_bits).collect::<Vec<_>>();
        let expected = bits(signed_distances(&signed, &grid, &options, &|_| ()).expect("memory"));
        assert!(expected.iter().any(|x| f32::from_bits(*x).is_sign_negative()), "{side:e}");
        let found = bits(signed_distances_by_lists(&lists, &signed, &grid, &options, &|_| ()).expect("memory"));
        assert!(found == expected, "{side:e}");
        let found = bits(signed_distances_by_lists(&lists, &winding, &grid, &options, &|_| ()).expect("memory"));
        let single = bits(signed_distances(&winding, &grid, &options, &|_| ()).expect("memory"));
        assert!(found == single, "{side:e} by winding numbers");
    }
}

#[test]
fn grids_of_any_shape_are_filled() {
    let soup = knot();
    let tree = AabbTree::new(&soup).expect("valid");
    let lists = CandidateLists::new(&soup).expect("plain");
    for counts in [[1, 1, 1], [1, 97, 1], [130, 1, 1], [1, 1, 33], [3, 5, 17], [65, 64, 1], [2, 300, 16]] {
        let grid = Grid::new(Point3::new(-1.0, -0.5, -0.3), 0.03, counts).expect("valid");
        let expected = distances(&tree, &grid, &FieldOptions::default(), &|_| ());
        assert!(distances_by_lists(&lists, &grid, &FieldOptions::default(), &|_| ()) == expected, "{counts:?}");
    }
}

#[test]
fn refined_cells_tile_their_cube_and_follow_the_surface() {
    let ball = ico_sphere(&IcoSphere { frequency: amount(16, 6) }).expect("valid");
    let signed = SignedDistance::new(AabbTree::new(&ball).expect("valid"), &ball).expect("closed");
    let distance = |sample: &Point3<f64>| signed.closest_point(sample).and_then(|s| s.distance()).expect("defined");
    let mut last = 0;
    for error in amount(vec![0.1, 0.02, 0.004], vec![0.1, 0.02]) {
        let cells = refined(&ball.aabb(), &distance, &RefineOptions::new(error));
        let side = (ball.aabb().max - ball.aabb().min).max();
        let volume: f64 = cells.iter().map(|cell| cell.size.powi(3)).sum();
        assert!((volume / side.powi(3) - 1.0).abs() < 1e-9, "{volume}");
        assert!(cells.len() > last, "{error}: {} cells", cells.len());
        last = cells.len();
        // The positions are near the surface, where no sample of the field is.
        let mut worst = 0.0f64;
        for cell in &cells {
            for n in 0..27 {
                let steps = [n % 3, n / 3 % 3, n / 9].map(|s| f64::from(s) * 0.35 + 0.1);
                let sample = Point3::from([0, 1, 2].map(|k| cell.origin[k] + cell.size * steps[k]));
                let value = distance(&sample);
                if value.abs() < cell.size / 4.0 {
                    worst = worst.max((cell.value(&sample) - value).abs());
                }
            }
        }
        println!("{} cells for {error}, at most {worst:.4} off near the surface", cells.len());
        assert!(worst < 1.5 * error, "{error}: {worst}");
    }
    // The refinement is not finer than requested.
    let coarse = refined(&ball.aabb(), &distance, &RefineOptions::new(1e-9).with_depth(3));
    assert!(coarse.len() <= 512 && coarse.iter().any(|cell| cell.size < 0.3));
    let far = RefineOptions::new(0.1).with_relative(0.01);
    assert!(
        refined(&ball.aabb(), &distance, &far).len() > refined(&ball.aabb(), &distance, &RefineOptions::new(0.1)).len()
    );
}

#[test]
fn files_and_slices_have_every_value_in_its_place() {
    let grid = Grid::new(Point3::new(1.0, 2.0, 3.0), 0.25, [3, 2, 4]).expect("valid");
    let values: Vec<f32> = (0..24u8).map(f32::from).collect();
    let file = |format| {
        let mut bytes = Vec::new();
        write_field(&grid, &values, format, &mut bytes).expect("memory");
        bytes
    };
    let raw = file(p2m_field::FieldFormat::Raw);
    assert_eq!(raw.len(), 96);
    let npy = file(p2m_field::FieldFormat::Npy);
    let header = String::from_utf8_lossy(&npy[10..npy.len() - 96]).into_owned();
    assert!(header.starts_with("{'descr': '<f4', 'fortran_order': True, 'shape': (3, 2, 4), }"), "{header}");
    assert!(npy.len() % 64 == 32 && npy.ends_with(&raw));
    let vti = file(p2m_field::FieldFormat::Vti);
    let text = String::from_utf8_lossy(&vti);
    assert!(text.contains("WholeExtent=\"0 2 0 1 0 3\" Origin=\"1.0 2.0 3.0\" Spacing=\"0.25 0.25 0.25\""), "{text}");
    // The number of bytes and the values are encoded together.
    let start = text.find("\n_").expect("the data") + 2;
    let end = start + text[start..].find('\n').expect("a line");
    let data = base64::engine::general_purpose::STANDARD.decode(&text[start..end]).expect("base64");
    assert_eq!((&data[..8], &data[8..]), (&96u64.to_le_bytes()[..], &raw[..]));
    assert!(write_field(&grid, &values[1..], p2m_field::FieldFormat::Raw, Vec::new()).is_err());

    // One value is inside, and one is NaN.
    let mut values = vec![4.0f32; 24];
    values[grid.number([2, 0, 1])] = -4.0;
    values[grid.number([0, 1, 1])] = f32::NAN;
    let ([width, height], pixels) = slice(&grid, &values, 2, 1);
    assert_eq!((width, height, pixels.len()), (513, 342, 3 * 513 * 342));
    let pixel = |x: usize, y: usize| &pixels[3 * (y * width + x)..][..3];
    assert_eq!(pixel(0, 0), [153; 3]); // The value above, to the left, is NaN.
    assert!(pixel(512, 341)[0] > 200 && pixel(512, 341)[2] < 40); // The value below, to the right, is inside.
    assert!(pixel(0, 341)[2] > 150 && pixel(0, 341)[0] < 50);
}
