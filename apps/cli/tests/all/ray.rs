//! Tests of `p2m ray`: tables, modes, other formats and summaries.

use crate::common::*;
use std::fs;
use tempfile::TempDir;

const HITS: &str = "ray,ox,oy,oz,dx,dy,dz,parameter,x,y,z,primitive,side,w0,w1,w2";

/// A scene of a unit square in two triangles at z = 0, one at z = -1 that faces down, a segment and a point above.
const SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 0 2 -1\nv 2 1 -1\nv 0 .5 1\nv 1 .5 1\nv .5 .5 2\n\
    f 1 2 3\nf 1 3 4\nf 5 6 7\nl 8 9\np 10\n";

/// Returns the records of a table without its header.
fn rows(table: &str) -> Vec<Vec<&str>> {
    table.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

#[test]
fn backends_and_threads_give_the_same_table() {
    for sample in [&["--random", "400"][..], &["--random", "300", "--seed", "9", "--box-scale", "1.5", "--line"]] {
        for mode in ["intersects", "first", "all", "count", "crossings"] {
            let run =
                |more: &[&str]| table(&[&["ray", SCENE, "--mode", mode, "--radius", "0.02"], sample, more].concat());
            let expected = run(&["--backend", "brute"]);
            assert!(expected.lines().count() > 80 && expected.starts_with("ray,ox,oy,oz,dx,dy,dz,"), "{mode}");
            assert!(run(&["--backend", "aabb"]) == expected, "{mode}");
            assert!(run(&["--backend", "kdop"]) == expected, "{mode}");
            for faces in ["6", "14", "18", "26", "scene"] {
                assert!(run(&["--backend", "kdop", "--k", faces]) == expected, "{mode} {faces}");
            }
            assert!(
                run(&["--threads", "1"]) == expected && run(&["--threads", "3", "--out", "-"]) == expected,
                "{mode}"
            );
        }
    }
    let seeds = ["0", "1"].map(|seed| table(&["ray", SCENE, "--random", "5", "--seed", seed]));
    assert_ne!(seeds[0], seeds[1]);
    assert_eq!(seeds[0], table(&["ray", SCENE, "--random", "5", "--mode", "first"]));
}

#[test]
fn objects_are_named_in_tables() {
    let folder = TempDir::new().unwrap();
    let named = SQUARES.replace("f 5 6 7", "o floor\nf 5 6 7").replace("l 8 9", "o wire\nl 8 9");
    let scene = write(&folder, "s.obj", named);
    let rays = write(&folder, "r.csv", "0.2,0.3,5,0,0,-1\n1.1,1,5,0,0,-1\n9,9,9,1,0,0\n");
    let table = table(&["ray", &scene, "--rays", &rays]);
    let ends: Vec<_> = table.lines().map(|line| line.split(',').next_back().unwrap()).collect();
    assert_eq!(ends, ["object", "", "floor", ""]);
    assert!(table.starts_with(&format!("{HITS},object\n")), "{table}");
}

#[test]
fn modes_agree_with_one_another() {
    let run = |mode: &str| table(&["ray", SCENE, "--random", "500", "--radius", "0.05", "--mode", mode]);
    let [met, any, first, all, count] = ["intersects", "any", "first", "all", "count"].map(run);
    let [met, any, first, all, count] = [&met, &any, &first, &all, &count].map(|table| rows(table));
    assert!(all.len() > 200);
    assert!(all.iter().any(|hit| hit[12] == "along") && all.iter().any(|hit| hit[12] == "back"));
    for ray in 0..500 {
        let hits: Vec<_> = all.iter().filter(|hit| hit[0] == ray.to_string()).collect();
        assert_eq!(count[ray][7], hits.len().to_string());
        assert_eq!(met[ray][7], u8::from(!hits.is_empty()).to_string());
        match hits.first() {
            None => assert!(first[ray][7..] == [""; 9] && any[ray][7..] == [""; 9]),
            Some(nearest) => assert!(first[ray] == **nearest && hits.contains(&&any[ray])),
        }
        let key = |hit: &[&str]| (hit[7].parse::<f64>().unwrap(), hit[11].parse::<u32>().unwrap());
        assert!(hits.is_sorted_by(|a, b| key(a) < key(b)));
    }
}

#[test]
fn given_rays_are_answered_in_their_order() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", SQUARES);
    let rays =
        write(&folder, "r.csv", "x,y,z,dx,dy,dz\n.5,.5,3,0,0,-1\n5,5,5,1,0,0\n0.75,0.25,-3,0,0,2\n.5,.5,-.5,0,0,-1\n");
    let ask = |more: &[&str]| table(&[&["ray", &scene, "--rays", &rays], more].concat());
    let start = ["0,0.5,0.5,3.0,0.0,0.0,-1.0,", "1,5.0,5.0,5.0,1.0,0.0,0.0,", "2,0.75,0.25,-3.0,0.0,0.0,2.0,"];
    let last = "3,0.5,0.5,-0.5,0.0,0.0,-1.0,0.5,0.5,0.5,-1.0,2,back,0.625,0.125,0.25\n";
    assert_eq!(
        ask(&[]),
        format!(
            "{HITS}\n{}1.0,0.5,0.5,2.0,4,along,1.0,0.0,0.0\n{},,,,,,,,\n{}1.5,0.75,0.25,0.0,0,back,0.25,0.5,0.25\n{last}",
            start[0], start[1], start[2]
        )
    );
    // The ray hits the point, the segment, both triangles on their diagonal, and the triangle below.
    let all = ask(&["--mode", "all"]);
    let [primitives, sides] = [11, 12].map(|column| rows(&all).iter().map(|row| row[column]).collect::<Vec<_>>());
    assert_eq!(primitives, ["4", "3", "0", "1", "2", "0", "2"]);
    assert_eq!(sides, ["along", "along", "front", "front", "back", "back", "back"]);
    let numbers = |more: &[&str]| rows(&ask(more)).iter().map(|row| row[7].parse().unwrap()).collect::<Vec<u32>>();
    assert_eq!(numbers(&["--mode", "count"]), [5, 0, 1, 1]);
    assert_eq!(numbers(&["--mode", "count", "--line"]), [5, 0, 1, 5]);
    assert_eq!(numbers(&["--mode", "crossings", "--line"])[0], 2);
    assert_eq!(numbers(&["--mode", "do"]), [1, 0, 1, 1]);
    assert_eq!(numbers(&["--mode", "count", "--min", "2", "--max", "3"]), [3, 0, 0, 0]);
    assert_eq!(numbers(&["--mode", "count", "--line", "--max", "0"]), [0, 0, 0, 4]);
    assert_eq!(numbers(&["--mode", "count", "--min=-inf", "--max", "-0.5"]), [0, 0, 0, 4]);
    assert_eq!(numbers(&["--mode", "count", "--min", "-1", "--max", "0.6"]), [0, 0, 0, 3]);
    assert_eq!(numbers(&["--mode", "count", "--radius", "0.25"]), [5, 0, 2, 1]);
}

#[test]
fn answers_come_in_every_format_and_ask_again() {
    let folder = TempDir::new().unwrap();
    for mode in ["intersects", "first", "all", "count", "crossings"] {
        let ask = ["ray", SCENE, "--mode", mode];
        let expected = table(&[&ask[..], &["--random", "50"]].concat());
        for format in ["npy", "ply", "csv", "NPY"] {
            let out = path(&folder, &format!("{mode}.{format}"));
            assert_eq!(table(&[&ask[..], &["--random", "50", "--out", &out]].concat()), "");
            if mode != "all" {
                // The file of answers is a file of the same rays.
                assert_eq!(table(&[&ask[..], &["--rays", &out]].concat()), expected, "{mode} {format}");
            }
            let arguments = [&ask[..], &["--random", "50", "--out-format", format]].concat();
            assert_eq!(p2m(&arguments).stdout, fs::read(&out).unwrap(), "{mode} {format}");
        }
    }
    let message = failure(&["ray", SCENE, "--random", "50", "--out", &path(&folder, "a.vtk")], 1);
    assert!(message.contains("expected one of csv, npy, ply, or name the format with --out-format"), "{message}");
}

#[test]
fn files_of_rays_come_in_every_format() {
    let folder = TempDir::new().unwrap();
    let mut expected = None;
    for (name, content) in [
        ("r.xyz", "# so\n0.1 .2 3 0 0 -1\n1 1 1 -1 -1 -1\n"),
        ("r.csv", "dx;dy;dz;ox;oy;oz\n0;0;-1;.1;.2;3\n-1;-1;-1;1;1;1\n"),
        ("without.csv", "0.1,.2,3,0,0,-1\n1,1,1,-1,-1,-1\n"),
        (
            "r.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
            property float nx\nproperty float ny\nproperty float nz\nend_header\n0.1 .2 3 0 0 -1\n1 1 1 -1 -1 -1\n",
        ),
    ] {
        let rays = write(&folder, name, content);
        let answers = table(&["ray", SCENE, "--rays", &rays]);
        assert_eq!(answers.lines().count(), 3);
        assert_eq!(*expected.get_or_insert(answers.clone()), answers, "{name}");
        let output =
            p2m_with(&["ray", SCENE, "--rays", "-", "--rays-format", name.split_once('.').unwrap().1], content);
        assert_eq!(text(&output.stdout), answers, "{name}");
    }
}

#[test]
fn a_closed_surface_is_left_as_often_as_entered() {
    let folder = TempDir::new().unwrap();
    let knot = path(&folder, "knot.ply");
    table(&["generate", "torus-knot", "--out", &knot]);
    let table = table(&["ray", &knot, "--random", "300", "--line", "--mode", "crossings"]);
    let crossings: Vec<u32> = rows(&table).iter().map(|row| row[7].parse().unwrap()).collect();
    assert!(crossings.iter().all(|n| n % 2 == 0) && crossings.iter().any(|n| *n > 2));
}

#[test]
fn the_summary_tells_what_was_done() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "s.obj", SQUARES);
    let rays = write(&folder, "r.xyz", ".5 .5 3 0 0 -1\n5 5 5 1 0 0\n0.75 0.25 -3 0 0 2\n");
    let summary = |mode: &str| text(&p2m(&["ray", &scene, "--rays", &rays, "--mode", mode, "--threads", "1"]).stderr);
    let lines = |mode: &str| {
        let summary = summary(mode);
        let lines: Vec<&str> = summary.lines().collect();
        assert_eq!(lines[0], format!("scene    {scene}"));
        assert_eq!(lines[1], "         3 triangles, 1 segment, 1 point");
        assert!(lines[2].starts_with("backend  aabb, built in "), "{summary}");
        assert!(lines[3].starts_with("rays     3 in ") && lines[3].contains(" on 1 thread: "), "{summary}");
        assert!(lines[3].contains(" ns per ray, ") && lines[3].ends_with(" rays/s"), "{summary}");
        assert_eq!(lines[4], "hitting  2, missing 1");
        lines[5..].join("|")
    };
    assert_eq!(lines("intersects"), "");
    assert_eq!(lines("first"), "at t     min 1, max 1.5, mean 1.25");
    assert_eq!(lines("any").split_once("min").unwrap().0, "at t     ");
    assert_eq!(lines("count"), "hits     6, per ray min 0, max 5, mean 2");
    assert_eq!(lines("crossings"), "crossed  3, per ray min 0, max 2, mean 1");
    assert_eq!(lines("all"), "hits     6, per ray min 0, max 5, mean 2|at t     min 1, max 4, mean 2.41667");
    let summary = text(&p2m(&["ray", SCENE, "--random", "5", "--backend", "kdop", "--k", "scene"]).stderr);
    assert!(summary.contains("\nk-DOPs   ") && summary.contains(" faces, built in "), "{summary}");
}

#[test]
fn an_empty_scene_is_hit_by_nothing() {
    let folder = TempDir::new().unwrap();
    let scene = write(&folder, "e.obj", "# nothing\n");
    for backend in ["brute", "aabb", "kdop"] {
        let output = p2m(&["ray", &scene, "--random", "3", "--backend", backend]);
        assert!(rows(&text(&output.stdout)).iter().all(|row| row[7..] == [""; 9]));
        let summary = text(&output.stderr);
        assert!(summary.contains("the scene is empty") && summary.ends_with("hitting  0, missing 3\n"), "{summary}");
        assert_eq!(
            table(&["ray", &scene, "--random", "3", "--mode", "all", "--backend", backend]),
            format!("{HITS}\n")
        );
    }
    assert_eq!(table(&["ray", SCENE, "--random", "0"]), format!("{HITS}\n"));
}

#[test]
fn the_json_summary_agrees_with_the_table() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "hits.csv");
    let arguments =
        ["ray", SCENE, "--random", "200", "--seed", "3", "--mode", "all", "--line", "--max", "7", "--threads", "2"];
    let mut report = json(&[&arguments[..], &["--out", &out, "--json"]].concat());
    let table = fs::read_to_string(&out).unwrap();
    let hits = rows(&table);
    let parameters: Vec<f64> = hits.iter().map(|hit| hit[7].parse().unwrap()).collect();
    let per_ray: Vec<usize> = (0..200).map(|ray| hits.iter().filter(|hit| hit[0] == ray.to_string()).count()).collect();
    let with_hit = per_ray.iter().filter(|n| **n > 0).count();
    assert!(report.as_object_mut().unwrap().shift_remove("seconds").unwrap()["query"].as_f64().unwrap() > 0.0);
    let expected = serde_json::json!({
        "p2m": "ray",
        "version": 4,
        "scene": {
            "file": SCENE,
            "format": "obj",
            "primitives": { "triangles": 3600, "segments": 480, "points": 0 },
            "skipped": [],
        },
        "backend": "aabb",
        "backend_reason": null,
        "loaded": false,
        "faces": null,
        "directions_reason": null,
        "threads": 2,
        "mode": "all",
        "range": { "min": null, "max": 7.0 },
        "radius": 0.0,
        "source": { "random": 200, "seed": 3, "box_scale": 1.05 },
        "rays": 200,
        "with_hit": with_hit,
        "without_hit": 200 - with_hit,
        "counts": {
            "total": hits.len(),
            "min": 0,
            "max": per_ray.iter().max(),
            "mean": hits.len() as f64 / 200.0,
        },
        "parameter": {
            "min": parameters.iter().fold(f64::INFINITY, |a, &b| a.min(b)),
            "max": parameters.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b)),
            "mean": parameters.iter().sum::<f64>() / parameters.len() as f64,
        },
        "out": { "file": out, "format": "csv", "bytes": table.len() },
    });
    assert_eq!(report, expected);
    let rays = write(&folder, "r.xyz", "9 9 9 1 0 0\n");
    let report = json(&["ray", SCENE, "--rays", &rays, "--out", &out, "--json"]);
    assert_eq!((&report["counts"], &report["parameter"]), (&serde_json::Value::Null, &serde_json::Value::Null));
    assert_eq!(report["source"], serde_json::json!({ "rays": rays }));
    assert_eq!(report["range"], serde_json::json!({ "min": 0.0, "max": null }));
}

#[test]
fn what_is_no_ray_is_refused_with_its_place() {
    let folder = TempDir::new().unwrap();
    let hits = path(&folder, "hits.csv");
    for (name, content, why) in [
        ("a.csv", "x,y,z,dx,dy,dz\n0,0,0,0,0,1\n1,2,3,0,0,0\n", "a.csv:3: the direction of the ray is zero"),
        ("b.csv", "0,0,0,0,0,1\n0,0,nan,0,0,1\n", "b.csv:2: a coordinate of the ray is not finite"),
        ("c.csv", "x,y,z\n0,0,0\n", "c.csv:1: a ray needs 6 coordinates, found 3"),
        (
            "d.csv",
            "id,x,y,z,u,v,w\n",
            "d.csv:1: no coordinates among the columns id, x, y, z, u, v, w; they may be named ox,",
        ),
        ("e.xyz", "0 0 0 0 0 1\n0 0 0 1\n", "e.xyz:2: a ray needs 6 coordinates, found 4"),
        (
            "f.las",
            "",
            "f.las: unknown extension 'las', expected one of xyz, txt, asc, pts, csv, npy, ply, or name the format with --rays-format",
        ),
    ] {
        let rays = write(&folder, name, content);
        let message = failure(&["ray", SCENE, "--rays", &rays, "--out", &hits], 1);
        assert!(message.contains(why), "{message}");
        assert!(!fs::exists(&hits).unwrap());
    }
    let rays = write(&folder, "r.csv", "0,0,0,0,0,1\n");
    let message = failure(&["ray", SCENE, "--rays", &rays, "--out", &rays], 1);
    assert!(message.contains("it is an input"), "{message}");
}

#[test]
fn wrong_usage_is_told_what_is_wrong() {
    for (arguments, why) in [
        (&["--random", "1", "--min", "3", "--max", "2"][..], "no parameter lies between 3 and 2 (--min, --max)"),
        (&["--random", "1", "--line", "--max=-inf", "--min", "1"], "--min"),
        (&["--random", "1", "--min", "nan"], "not a number"),
        (&["--random", "1", "--radius", "-1"], "not a finite number from 0 up"),
        (&["--random", "1", "--radius", "inf"], "not a finite number from 0 up"),
        (&["--random", "1", "--k", "14"], "--k is for --backend kdop"),
        (&["--random", "1", "--backend", "octree"], "[possible values: brute, aabb, kdop]"),
        (&["--random", "1", "--mode", "last"], "[possible values: intersects, any, first, all, count, crossings]"),
        (&["--random", "1", "--json"], "add --out FILE"),
        (&["--random", "1", "--rays", "r.csv"], "cannot be used with"),
        (&["--rays", "r.csv", "--seed", "1"], "cannot be used with"),
        (&["--rays", "r.csv", "--box-scale", "2"], "cannot be used with"),
        (&["--rays", "-"], "add --rays-format xyz|txt|asc|pts|csv|npy|ply"),
        (&["--random", "1", "--threads", "0"], "is not in 1..=1024"),
        (&[], "required arguments"),
    ] {
        let message = failure(&[&["ray", SCENE], arguments].concat(), 2);
        assert!(message.contains(why), "{arguments:?}: {message}");
    }
    let message = failure(&["ray", "-", "--format", "obj", "--rays", "-", "--rays-format", "csv"], 2);
    assert!(message.contains("cannot be both the scene and the rays"), "{message}");
}
