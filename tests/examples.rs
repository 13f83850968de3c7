//! Runs the example programs and checks their output.
#![cfg(all(feature = "bvh", feature = "instances", feature = "interception", feature = "kdop", feature = "scene"))]

use p2m::{AabbTree, ClosestPoint};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the folder of the compiled examples, which is beside the folder of tests.
fn folder() -> PathBuf {
    let test = std::env::current_exe().expect("a program");
    test.ancestors().nth(2).expect("a folder of builds").join("examples")
}

/// Runs an example in the root folder of the project, and returns its output.
fn output(name: &str, arguments: &[&str]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = folder().join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let made = |path: &Path| path.metadata().and_then(|metadata| metadata.modified()).ok();
    // `cargo test` builds examples, but `cargo test --test examples` does not.
    let is_new = made(&program) > made(&root.join("examples").join(format!("{name}.rs")));
    assert!(is_new, "{} is missing or old: cargo build --examples makes it", program.display());
    let output = Command::new(&program).args(arguments).current_dir(root).output().expect("a program that runs");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// Returns the numbers in a text, in order.
fn numbers(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || ".-e".contains(c)))
        .filter_map(|word| word.trim_end_matches('.').parse().ok())
        .collect()
}

#[test]
fn a_cloud_is_wrapped_onto_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let wrap = folder.path().join("wrap.ply");
    let text = output("shrink_wrap", &["scenes/knot_and_cables.obj", wrap.to_str().expect("text")]);
    let found = numbers(&text);
    assert!(found[0] == 1002.0 && found[1] > 0.0 && found[1] < found[3] && found[3] < found[2], "{text}");
    assert!(text.contains("on the scene up to rounding: true"), "{text}");
    assert_eq!(p2m::scene::read_scene(&wrap).expect("written").soup.triangles().len(), 2_000);
}

#[test]
fn cables_have_room_beside_the_tube() {
    let text = output("clearance", &[]);
    assert!(text.starts_with("480 pipes beside 3600 triangles"), "{text}");
    // Wider pipes reduce the clearance by the difference of the radii.
    let clearance = |text: &str| numbers(text.lines().nth(1).expect("a line"))[0];
    let wide = output("clearance", &["scenes/knot_and_cables.obj", "0.03"]);
    assert!((clearance(&text) - clearance(&wide) - 0.01).abs() < 2e-6, "{text}{wide}");
    // The clearance is at least the distance between points of the axes, and hardly more.
    let scene = p2m::scene::read_scene("scenes/knot_and_cables.obj".as_ref()).expect("carried").soup;
    let index = AabbTree::new(scene.triangle_set()).expect("valid");
    let distances = scene.segments().iter().flat_map(|s| {
        let [a, b] = s.map(|i| scene.positions()[i as usize]);
        (0..=50).map(move |i| a + (b - a) * (f64::from(i) / 50.0))
    });
    let sampled = distances.filter_map(|p| index.closest_point(&p)).map(|c| c.distance).fold(f64::MAX, f64::min);
    let found = clearance(&text) + 0.02;
    assert!(found <= sampled + 1e-6 && found > sampled - 1e-2, "{found} and {sampled}");
}

#[test]
fn tracks_are_snapped_to_their_streets() {
    let text = output("snap_track", &[]);
    // Every 50th position is too far away.
    assert!(text.starts_with("800 places beside 3280 parts of streets\n784 are on a street, 16 on none"), "{text}");
    let right = numbers(text.lines().nth(2).expect("a line"))[0];
    assert!((650.0..=784.0).contains(&right), "{text}");
}

#[test]
fn an_octahedron_moved_along_a_diagonal_is_as_far_as_it_was_moved() {
    let folder = tempfile::tempdir().expect("a folder");
    let octahedron = |name: &str, x: f64| {
        let vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
            .map(|[dx, y, z]| format!("v {} {y} {z}\n", x + f64::from(dx)));
        let faces = ["1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"];
        let path = folder.path().join(name);
        std::fs::write(&path, vertices.concat() + &faces.map(|face| format!("f {face}\n")).concat()).expect("written");
        path.to_str().expect("text").to_owned()
    };
    let (here, there) = (octahedron("here.obj", 0.0), octahedron("there.obj", 0.25));
    assert_bounds(&output("hausdorff", &[&here, &there]), 0.25, 1e-3);
}

/// Asserts that the bounds of a Hausdorff distance contain a value and are close to each other.
fn assert_bounds(text: &str, expected: f64, tolerance: f64) {
    let found = numbers(text);
    let (lower, upper) = (found[0], found[1]);
    assert!(lower <= expected + 1e-15 && expected - 1e-15 <= upper && upper - lower <= tolerance, "{text}");
}

#[test]
fn a_sphere_that_is_moved_is_as_far_as_it_was_moved() {
    assert_bounds(&output("hausdorff", &[]), 0.5, 1e-3);
    let scene = "scenes/knot_and_cables.obj";
    assert_bounds(&output("hausdorff", &[scene, scene, "0"]), 0.0, 1e-14);
}

#[test]
fn boxes_on_circles_pass_a_sensor_and_a_beam() {
    // The only box begins on the axis, with its inner face 0.4 from the sensor, and turns about it once, by 6 degrees
    // per step.
    let text = output("moving_boxes", &["1", "61"]);
    assert!(text.starts_with("box 0 comes nearest to the sensor: 0.400000 in step 0\n"), "{text}");
    // The beam is 0.2 beside the axis. The box is 0.209 beside the axis after one step, and 0.416 after two.
    assert_eq!(numbers(text.lines().nth(1).expect("a line")), [1.0, 61.0], "{text}");
    let many = output("moving_boxes", &[]);
    assert!(numbers(many.lines().nth(1).expect("a line"))[0] > 1.0, "{many}");
}

#[test]
fn the_examples_of_the_manual_run() {
    assert!(output("kdop_distance", &[]).contains("at a distance of"));
    assert!(!output("kdop_ray", &[]).is_empty());
}
