//! Tests of `p2m boxes`.

use crate::common::{SCENE, p2m};

#[test]
fn levels_and_leaves_are_drawn_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    for (levels, panels) in [("3", Some(4)), ("0", Some(1)), ("64", None)] {
        let out = folder.path().join("boxes.svg");
        let run =
            p2m(&["boxes", SCENE, "--levels", levels, "--out", out.to_str().unwrap(), "--up", "y", "--view", "front"]);
        assert_eq!(run.code, 0, "{}", String::from_utf8_lossy(&run.stderr));
        let (titles, svg) = (String::from_utf8(run.stderr).unwrap(), std::fs::read_to_string(&out).unwrap());
        let drawn = titles.lines().count();
        assert_eq!((panels.unwrap_or(drawn), svg.matches("<text").count()), (drawn, drawn), "{titles}");
        if panels.is_none() {
            // The deepest level is the last one, and shows the leaves.
            let counts: Vec<_> = titles.lines().rev().map(|title| title.split(": ").nth(1)).collect();
            assert!(counts[0] == counts[1] && counts[1] != counts[2], "{titles}");
        }
        for title in titles.lines() {
            assert!(svg.contains(&format!(">{title}</text>")), "{title}");
        }
        if levels == "3" {
            // There is one root, and a node has at most eight children.
            let counts: Vec<usize> = titles
                .lines()
                .map(|title| title.split([':', ' ']).filter_map(|word| word.parse().ok()).next_back().unwrap())
                .collect();
            assert_eq!(counts[..2], [1, 8], "{titles}");
            assert!(counts[1] < counts[2] && counts[2] <= 64 && counts[2] < counts[3], "{titles}");
        }
    }
}

#[test]
fn the_boxes_of_a_level_hold_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("boxes.PLY");
    assert_eq!(p2m(&["boxes", SCENE, "--levels", "1", "--out", out.to_str().unwrap()]).code, 0);
    let [picture, scene] = [out.as_path(), SCENE.as_ref()].map(|p| p2m_mixed::read_scene(p).unwrap().soup);
    let bounds = p2m_core::PrimitiveSet::aabb(&scene);
    // The root is followed by its children. Boxes are rounded outwards by at most 2^-22 of the scene's size.
    let slack = (bounds.max - bounds.min).max() * 2f64.powi(-22);
    for drawn in [&picture.positions()[..24], &picture.positions()[24..]] {
        let all = p2m_core::Aabb::from_points(drawn);
        assert!(all.contains(&bounds) && (bounds.min - all.min).max() < slack && (all.max - bounds.max).max() < slack);
    }
    assert_eq!(picture.segments().len() % 12, 0);
}

#[test]
fn polytopes_of_the_k_dop_tree_hold_the_scene_and_fit_closer() {
    let folder = tempfile::tempdir().unwrap();
    let scene = p2m_mixed::read_scene(SCENE.as_ref()).unwrap().soup;
    let sums = ["6", "14", "26", "scene"].map(|k| {
        let out = folder.path().join(format!("{k}.ply"));
        let run = p2m(&["boxes", SCENE, "--levels", "0", "--k", k, "--out", out.to_str().unwrap()]);
        let titles = String::from_utf8(run.stderr).unwrap();
        let lines: Vec<_> = titles.lines().collect();
        assert!(lines[0].starts_with("leaves: ") && lines[0].ends_with(" polytopes"), "{titles}");
        // The reason is printed if the directions were derived from the scene.
        assert_eq!(lines[1..].iter().filter(|line| line.starts_with("k-DOPs: ")).count(), usize::from(k == "scene"));
        let picture = p2m_mixed::read_scene(&out).unwrap().soup;
        let all = p2m_core::Aabb::from_points(picture.positions());
        assert!(all.contains(&p2m_core::PrimitiveSet::aabb(&scene)), "{k}");
        // The mean distance from corners of polytopes to the scene is smaller if they fit more closely.
        let index = p2m_bvh::AabbTree::<f64, _>::build_with(&scene, &Default::default()).unwrap();
        let distance = |p: &nalgebra::Point3<f64>| p2m_core::ClosestPoint::closest_point(&index, p).unwrap().distance;
        picture.positions().iter().map(distance).sum::<f64>() / picture.positions().len() as f64
    });
    assert!(sums[0] > sums[1] && sums[1] > sums[2], "{sums:?}");
}

#[test]
fn other_extensions_and_the_scene_itself_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.ply");
    std::fs::write(&scene, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n").unwrap();
    let before = std::fs::read(&scene).unwrap();
    for (out, message) in [("x.png", ".svg or .ply"), ("x", ".svg or .ply"), ("scene.ply", "it is an input")] {
        let run = p2m(&["boxes", scene.to_str().unwrap(), "--out", folder.path().join(out).to_str().unwrap()]);
        assert_eq!(run.code, 1);
        assert!(String::from_utf8_lossy(&run.stderr).contains(message), "{out}");
    }
    assert_eq!(std::fs::read(&scene).unwrap(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
