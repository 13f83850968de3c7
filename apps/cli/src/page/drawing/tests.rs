//! Pictures have the expected content at every scale.

use super::{Panel, View, box_edges, write_picture_ply, write_svg};
use nalgebra::Point3;
use p2m_core::{Aabb, Element};

fn unit() -> Aabb<f64> {
    Aabb { min: Point3::origin(), max: Point3::new(1.0, 2.0, 4.0) }
}

#[test]
fn a_box_has_twelve_edges_four_of_each_side() {
    let edges: Vec<_> = box_edges(&unit()).collect();
    for (axis, length) in [1.0, 2.0, 4.0].into_iter().enumerate() {
        let along: Vec<_> =
            edges.iter().filter(|[a, b]| b[axis] - a[axis] == length && (b - a).norm() == length).collect();
        assert_eq!(along.len(), 4);
    }
    let mut starts: Vec<_> = edges.iter().map(|e| format!("{e:?}")).collect();
    starts.sort();
    starts.dedup();
    assert_eq!(starts.len(), 12);
}

fn svg(panels: &[Panel], backdrop: &[Point3<f64>], view: View) -> String {
    let mut bytes = Vec::new();
    write_svg(panels, backdrop, view, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Returns every pair of numbers after M and L.
fn places(svg: &str) -> Vec<[f64; 2]> {
    let paths = svg.split("d=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let points = paths.flat_map(|path| path.split(['M', 'L']).skip(1));
    points
        .map(|p| {
            let mut numbers = p.trim_end_matches("h0").split(' ').map(|n| n.parse().unwrap());
            [numbers.next().unwrap(), numbers.next().unwrap()]
        })
        .collect()
}

#[test]
fn panels_are_titled_and_everything_lies_in_them() {
    let panel = |title: &str| Panel { title: title.to_owned(), lines: box_edges(&unit()).collect() };
    for view in [View::Isometric, View::Front, View::Side, View::Top] {
        for scale in [1.0, 1e-310, 1e307] {
            let mut panels = [panel("level 0"), panel("a < b & c"), panel("2"), panel("3"), panel("4")];
            for p in panels.iter_mut().flat_map(|p| &mut p.lines).flatten() {
                *p *= scale;
            }
            let text = svg(&panels, &[Point3::origin()], view);
            assert_eq!((text.matches("<g ").count(), text.matches("<use").count()), (5, 5));
            assert!(text.contains("viewBox=\"0 0 1200 600\"") && text.contains("a &lt; b &amp; c"));
            let places = places(&text);
            assert_eq!(places.len(), 1 + 5 * 24);
            assert!(places.iter().flatten().all(|x| (0.0..=300.0).contains(x)), "{view:?} {scale}");
            // The longest side fills most of the height of a panel in all views except that from above.
            let heights = places.iter().map(|p| p[1]);
            let extent = heights.clone().fold(0.0, f64::max) - heights.fold(300.0, f64::min);
            assert!(extent > if view == View::Top { 100.0 } else { 140.0 }, "{view:?} {extent}");
        }
    }
}

#[test]
fn up_is_up_and_right_is_right() {
    let line = |to: [f64; 3]| Panel { title: String::new(), lines: vec![[Point3::origin(), Point3::from(to)]] };
    let [right, front_up, top_up] =
        [([1.0, 0.0, 0.0], View::Front), ([0.0, 0.0, 1.0], View::Front), ([0.0, 1.0, 0.0], View::Top)].map(
            |(to, view)| {
                let places = places(&svg(&[line(to)], &[], view));
                [places[1][0] - places[0][0], places[1][1] - places[0][1]]
            },
        );
    assert!(right[0] > 100.0 && right[1] == 0.0);
    assert!(front_up[1] < -100.0 && front_up[0] == 0.0);
    assert!(top_up[1] < -100.0 && top_up[0] == 0.0);
}

#[test]
fn nothing_and_a_single_point_can_be_drawn() {
    assert!(svg(&[], &[], View::Isometric).ends_with("</svg>\n"));
    let point = Panel { title: "one".to_owned(), lines: vec![[Point3::new(7.0, 8.0, 9.0); 2]] };
    assert_eq!(places(&svg(&[point], &[], View::Side)), [[150.0; 2]; 2]);
}

#[test]
fn a_ply_file_holds_the_lines_as_edges() {
    let panels = [
        Panel { title: "a".into(), lines: box_edges(&unit()).collect() },
        Panel { title: "b".into(), lines: vec![[Point3::origin(); 2]] },
    ];
    let mut bytes = Vec::new();
    write_picture_ply(&panels, &mut bytes).unwrap();
    let scene = p2m_mixed::read_ply(bytes.as_slice(), "picture.ply").unwrap();
    let lines: Vec<_> = panels.iter().flat_map(|p| &p.lines).flatten().copied().collect();
    assert_eq!(scene.soup.positions(), lines);
    assert_eq!(scene.soup.segments().len(), 13);
    assert_eq!(scene.soup.elements().last(), Some(Element::Segment([24, 25])));
}
