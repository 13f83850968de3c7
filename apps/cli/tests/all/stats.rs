//! Tests of `p2m stats`.

use crate::common::{SCENE, failure, path, table};
use p2m_mixed::read_scene;
use serde_json::Value;
use std::fs;

#[test]
fn every_backend_says_what_it_is_made_of() {
    for (backend, has_lists) in [("brute", false), ("aabb", false), ("kdop", false), ("octree", true), ("p2m", true)] {
        let text = table(&["stats", SCENE, "--backend", backend, "--queries", "500"]);
        let line = |name: &str| text.lines().find(|line| line.starts_with(name)).map(str::to_owned);
        assert!(line("backend").is_some_and(|line| line.contains(backend)), "{text}");
        assert_eq!((line("lists").is_some(), line("volume").is_some()), (has_lists, has_lists), "{text}");
        assert_eq!(text.lines().filter(|line| line.starts_with("queries")).count(), 2, "{text}");
        assert_eq!(line("memory").is_some(), backend != "brute", "{text}");

        let report: Value =
            serde_json::from_str(&table(&["stats", SCENE, "--backend", backend, "--queries", "500", "--json"]))
                .unwrap();
        assert_eq!((&report["p2m"], &report["backend"]), (&"stats".into(), &backend.into()));
        let number = |at: &str| report.pointer(at).and_then(Value::as_f64).unwrap_or(-1.0);
        assert_eq!(report["queries"], 500);
        for place in ["in_box", "on_scene"] {
            let [nodes, packets, primitives] =
                ["nodes", "packets", "primitives"].map(|n| number(&format!("/{place}/{n}/mean")));
            let most = number(&format!("/{place}/primitives/max"));
            assert!(most >= primitives && most <= 4080.0, "{report}");
            assert!(primitives >= 1.0, "{report}");
            match backend {
                "brute" => assert_eq!([nodes, packets, primitives], [0.0, 0.0, 4080.0]),
                "p2m" => assert!((1.0..4.0).contains(&nodes) && packets > 0.0, "{report}"),
                "octree" => assert!(nodes < 1.0 && packets > 0.0, "{report}"),
                _ => assert!(nodes > 1.0 && packets > 1.0 && primitives < 10.0, "{report}"),
            }
        }
        if has_lists {
            let lengths = ["median", "percentile_90", "percentile_99", "max"].map(|n| number(&format!("/lists/{n}")));
            assert!(lengths.is_sorted() && lengths[0] >= 1.0, "{report}");
            assert!(number("/lists/mean") <= lengths[3] && number("/lists/count") > 100.0, "{report}");
            assert!(number("/in_box/list") >= 1.0 && number("/in_box/without_list") < 0.5, "{report}");
            let parts = report["memory"].as_object().unwrap().values().map(|bytes| bytes.as_f64().unwrap());
            assert_eq!(parts.sum::<f64>(), number("/cells/bytes") + number("/cells/tree_bytes"));
            let stages = report["stages"].as_object().unwrap();
            let sum: f64 = stages.values().map(|seconds| seconds.as_f64().unwrap()).sum();
            assert_eq!(stages.len(), if backend == "p2m" { 5 } else { 2 });
            assert!(sum > 0.0 && sum <= number("/seconds/build"), "{report}");
            assert!(line("stages").is_some_and(|line| line.contains("tree")), "{text}");
        } else {
            assert!(report["lists"].is_null() && report["in_box"]["list"].is_null(), "{report}");
        }
    }
}

#[test]
fn the_picture_has_each_primitive_with_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let out = path(&folder, "lists.ply");
    let scene = read_scene(SCENE.as_ref()).unwrap().soup;
    for backend in ["p2m", "aabb"] {
        table(&["stats", SCENE, "--backend", backend, "--queries", "10", "--out", &out]);
        let picture = read_scene(out.as_ref()).unwrap().soup;
        assert_eq!((picture.triangles().len(), picture.segments().len()), (3600, 480));
        let corners = |soup: &p2m_core::Soup<f64>| {
            let bits = |i: u32| -> [u64; 3] { soup.positions()[i as usize].coords.map(f64::to_bits).into() };
            let mut all: Vec<_> = soup.triangles().iter().map(|t| t.map(bits)).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(corners(&picture), corners(&scene));
        // The header has the least and the largest number, and colours differ.
        let bytes = fs::read(&out).unwrap();
        let head = String::from_utf8_lossy(&bytes[..400]).into_owned();
        let range = head.lines().find_map(|line| line.strip_prefix("comment value: ")).unwrap().to_owned();
        let ends: Vec<f64> = range.split(" to ").map(|x| x.parse().unwrap()).collect();
        assert!(ends[0] >= 1.0 && ends[0] < ends[1], "{range}");
        let start = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let mut colours: Vec<_> = (0..picture.positions().len()).map(|i| &bytes[start + 35 * i + 24..][..3]).collect();
        colours.sort_unstable();
        colours.dedup();
        assert!(colours.len() > 3, "{backend}");
    }
}

#[test]
fn the_png_shows_the_scene_in_colours() {
    let folder = tempfile::tempdir().unwrap();
    let out = path(&folder, "lists.PNG");
    table(&["stats", SCENE, "--backend", "p2m", "--queries", "10", "--out", &out, "--width", "120", "--eye=-1,0.5,1"]);
    let mut reader = png::Decoder::new(std::io::BufReader::new(fs::File::open(&out).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((frame.width, frame.color_type), (120, png::ColorType::Rgb));
    let pixels: Vec<&[u8]> = bytes.chunks_exact(3).collect();
    let white = pixels.iter().filter(|p| **p == [255; 3]).count();
    // Some pixels have more blue than red by this much, and others more red than blue.
    let leans = |p: &[u8], more: usize, less: usize| p[more].saturating_sub(p[less]) > 60;
    let [blue, red] = [[2, 0], [0, 2]].map(|[more, less]| pixels.iter().filter(|p| leans(p, more, less)).count());
    assert!(white * 10 > pixels.len() && white * 10 < pixels.len() * 9, "{white} of {}", pixels.len());
    assert!(blue > 20 && red > 20, "{blue} {red}");
}

#[test]
fn saved_indexes_have_statistics_and_wrong_usage_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = path(&folder, "scene.p2m");
    table(&["build", SCENE, "--backend", "octree", "--out", &file]);
    let own = table(&["stats", &file, "--queries", "100"]);
    let built = table(&["stats", SCENE, "--backend", "octree", "--queries", "100"]);
    let lists = |text: &str| {
        text.lines()
            .filter(|l| l.starts_with("lists") || l.starts_with("queries"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(lists(&own), lists(&built));
    assert!(own.contains("memory   that of the file"), "{own}");
    assert!(failure(&["stats", SCENE, "--backend", "p2m", "--k", "6"], 2).contains("--k is for --backend kdop"));
    assert!(failure(&["stats", SCENE, "--out", "lists.svg"], 1).contains("ends in .ply or .png"));
    for eye in ["0,1,0", "1,2", "a,b,c", "inf,0,0"] {
        assert!(failure(&["stats", SCENE, "--out", "lists.png", "--eye", eye], 2).contains("that lead sideways"));
    }
    assert!(failure(&["stats", SCENE, "--k", "6"], 2).contains("--k is for --backend kdop"));
    assert!(failure(&["stats", &file, "--k", "6"], 2).contains("--k is for --backend kdop"));
    assert!(table(&["stats", SCENE, "--backend", "kdop", "--k", "6"]).contains("backend  kdop, 6 faces"));
    let empty = crate::common::write(&folder, "empty.obj", "# nothing\n");
    let text = table(&["stats", &empty, "--backend", "p2m"]);
    assert!(text.contains("the scene is empty"), "{text}");
}
