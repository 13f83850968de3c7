//! The generated scene equals the file that was made from it.

use p2m_core::Element;
use p2m_mixed::generate::{KnotAndCables, knot_and_cables};
use p2m_mixed::{read_scene, write_obj};
use std::collections::HashMap;
use std::path::Path;

#[test]
fn the_committed_scene_is_what_the_generator_makes() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/knot_and_cables.obj"));
    let soup = knot_and_cables(&KnotAndCables::default()).unwrap();
    let mut text = Vec::new();
    write_obj(&soup.clone().into(), &mut text).unwrap();
    assert!(text == std::fs::read(path).unwrap(), "p2m generate knot-and-cables --out scenes/knot_and_cables.obj");
    assert_eq!(*read_scene(path).unwrap().soup, soup);
}

#[test]
fn the_tube_is_closed_and_oriented_outwards() {
    for (rings, sides) in [(3, 3), (40, 5), (150, 12)] {
        let options = KnotAndCables { rings, sides, cables: 0, ..Default::default() };
        let soup = knot_and_cables(&options).unwrap();
        assert_eq!(soup.triangles().len(), 2 * (rings * sides) as usize);
        let mut edges = HashMap::new();
        for [a, b, c] in soup.triangles() {
            for edge in [[a, b], [b, c], [c, a]] {
                assert!(edges.insert(edge, ()).is_none(), "an edge is used twice in the same direction");
            }
        }
        assert!(edges.keys().all(|[a, b]| edges.contains_key(&[*b, *a])), "every edge has its other side");
        if rings > 30 {
            let p = |i: u32| soup.positions()[i as usize].coords;
            let volume: f64 = soup.triangles().iter().map(|&[a, b, c]| p(a).dot(&p(b).cross(&p(c)))).sum();
            assert!(volume > 0.0, "{volume}");
        }
    }
}

#[test]
fn cables_are_polylines_apart_from_the_tube() {
    let options = KnotAndCables { rings: 3, sides: 3, cables: 4, cable_segments: 10 };
    let soup = knot_and_cables(&options).unwrap();
    let segments: Vec<_> =
        soup.elements().filter_map(|e| if let Element::Segment(s) = e { Some(s) } else { None }).collect();
    assert_eq!(segments.len(), 40);
    for cable in segments.chunks(10) {
        assert!(cable.windows(2).all(|pair| pair[0][1] == pair[1][0]));
    }
    assert!(soup.positions().iter().flat_map(|p| p.iter()).all(|x| x.abs() < 4.0));
    assert!(knot_and_cables(&KnotAndCables { rings: 1 << 20, sides: 1 << 20, ..Default::default() }).is_err());
}
