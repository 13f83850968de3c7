//! Tests of `p2m deviation`.

use crate::common::*;
use p2m_testkit::{all_model_files, normal_number, rng};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A cube from 0 to 2, whose triangles face outwards.
const CUBE: &str = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn statistic(report: &Value, key: &str) -> f64 {
    report["statistics"][key].as_f64().unwrap_or_else(|| panic!("{key}: {report}"))
}

#[test]
fn outside_is_positive_and_inside_negative() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let scan = write(&folder, "scan.xyz", "1 1 3\n1 1 1.5\n1 1 2\n3 1 1\n");
    let report = json(&["deviation", &scan, &cube, "--tolerance", "0.5", "--json"]);
    assert_eq!((statistic(&report, "mean"), statistic(&report, "min"), statistic(&report, "max")), (0.375, -0.5, 1.0));
    assert_eq!((statistic(&report, "mean_absolute"), statistic(&report, "rms")), (0.625, 0.75));
    assert_eq!((&report["above"], &report["below"], &report["limit"]), (&2.into(), &0.into(), &1.5.into()));
    assert_eq!((&report["sign_rule"], &report["missing"]), (&"winding".into(), &0.into()));
    let text = table(&["deviation", &scan, &cube, "--tolerance", "0.25", "--unit", "mm"]);
    for line in ["mean                                0.375 mm", "below -0.25 mm                      1 (25 %)"] {
        assert!(text.contains(line), "{text}");
    }
    // Without signs, and with the standard input as the scan.
    let arguments = ["deviation", "-", &cube, "--scan-format", "xyz", "--unsigned", "--json"];
    let output = p2m_with(&arguments, fs::read(&scan).unwrap());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (statistic(&report, "mean"), &report["signed"], &report["sign_rule"]),
        (0.625, &false.into(), &Value::Null)
    );
}

#[test]
fn the_table_is_that_of_query_with_signs() {
    let folder = TempDir::new().unwrap();
    let (knot, ball) = (path(&folder, "knot.ply"), path(&folder, "ball.ply"));
    let (table_path, expected) = (path(&folder, "table.csv"), path(&folder, "expected.csv"));
    table(&["generate", "torus-knot", "--out", &knot]);
    table(&["generate", "ico-sphere", "--out", &ball]);
    table(&["deviation", &ball, &knot, "--out", &table_path]);
    table(&["query", &knot, "--points", &ball, "--signed", "--out", &expected]);
    assert_eq!(fs::read_to_string(table_path).unwrap(), fs::read_to_string(expected).unwrap());
    for backend in ["kdop", "octree", "p2m"] {
        let reports = [&["--threads", "1"][..], &["--backend", backend]]
            .map(|options| json(&[&["deviation", &ball, &knot, "--json"], options].concat())["statistics"].clone());
        assert_eq!(reports[0], reports[1], "{backend}");
    }
}

#[test]
fn coloured_files_have_the_deviations_and_the_faces() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let larger = write(&folder, "larger.obj", CUBE.replace("2 2 2", "2 2 3"));
    let cloud = path(&folder, "cloud.ply");
    table(&["deviation", &larger, &cube, "--limit", "1", "--out", &cloud]);
    let bytes = fs::read(&cloud).unwrap();
    let header_end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = text(&bytes[..header_end]);
    assert!(header.contains("element vertex 8\n") && header.contains("element face 12\n"), "{header}");
    assert!(header.contains("property double deviation\nproperty uchar red\nproperty uchar green\n"), "{header}");
    let record = |i: usize| &bytes[header_end + 35 * i..][..35];
    let deviation = |i: usize| f64::from_le_bytes(record(i)[24..32].try_into().unwrap());
    assert_eq!([0, 6, 7].map(deviation), [0.0, 1.0, 0.0]);
    assert_eq!([&record(0)[32..], &record(6)[32..]], [[0xf4, 0xf1, 0xea], [0x7a, 0x0a, 0x22]]);
    // The file reads back as the scan, and so does the file of a cloud.
    let report = json(&["deviation", &cloud, &cube, "--json"]);
    assert_eq!((&report["deviations"], statistic(&report, "max")), (&8.into(), 1.0));
    let points = write(&folder, "points.csv", "x,y,z\n1,1,3\n");
    table(&["deviation", &points, &cube, "--out", &cloud]);
    assert_eq!(json(&["deviation", &cloud, &cube, "--json"])["deviations"], 1);
}

#[test]
fn a_page_has_the_deviations() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let page = path(&folder, "page.html");
    table(&["deviation", &cube, &cube, "--unit", "metres", "--out", &page]);
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("\"deviations\":{\"total\":8,") && html.contains("\"unit\":\"metres\""));
    assert!(html.contains("8 deviations, positive outside: mean 0 metres"));
}

#[test]
fn scans_that_are_empty_equal_or_not_finite_have_statistics() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let empty = write(&folder, "empty.xyz", "");
    let report = json(&["deviation", &empty, &cube, "--tolerance", "1", "--json"]);
    assert_eq!((&report["deviations"], &report["statistics"]["mean"]), (&0.into(), &Value::Null));
    let text = table(&["deviation", &empty, &cube]);
    assert_eq!(text, "points with a deviation  0\npoints without one       0\n");
    for out in ["empty.csv", "empty.ply", "empty.html"] {
        table(&["deviation", &empty, &cube, "--out", &path(&folder, out)]);
    }
    let report = json(&["deviation", &cube, &cube, "--json"]);
    assert_eq!((statistic(&report, "rms"), &report["limit"]), (0.0, &1.0.into()));
    // A vertex that nothing uses may be infinite.
    let scan = write(&folder, "odd.obj", format!("{CUBE}v inf 0 0\nv 1 1 3\n"));
    let report = json(&["deviation", &scan, &cube, "--json"]);
    assert_eq!((&report["deviations"], &report["missing"]), (&9.into(), &1.into()));
    // A point of a file of points may not be.
    // Depth cameras write rows that are not finite, in all formats of points.
    let binary = |kind: &str| {
        let mut file = kind.as_bytes().to_vec();
        for x in [0.0, 0.0, 3.0, f64::NAN, f64::NAN, f64::NAN, 1.0, 1.0, 1.5] {
            file.extend(f64::to_le_bytes(x));
        }
        file
    };
    let description = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 3), }          \n";
    let npy = [b"\x93NUMPY\x01\0", &(description.len() as u16).to_le_bytes()[..], &binary(description)].concat();
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n\
        property double z\nend_header\n";
    for (name, content) in [
        ("nan.xyz", b"0 0 3\nnan nan nan\n1 1 1.5\n".to_vec()),
        ("nan.csv", b"x,y,z\n0,0,3\nnan,nan,nan\n1,1,1.5\n".to_vec()),
        ("nan.npy", npy),
        ("nan.ply", binary(ply)),
    ] {
        let scan = write(&folder, name, content);
        let report = json(&["deviation", &scan, &cube, "--json"]);
        assert_eq!((&report["deviations"], &report["missing"]), (&2.into(), &1.into()), "{name}");
        assert_eq!((statistic(&report, "min"), statistic(&report, "max")), (-0.5, 1.0), "{name}");
        let answers = table(&["query", &cube, "--points", &scan, "--columns", "query,distance"]);
        let rows: Vec<&str> = answers.lines().skip(1).collect();
        assert_eq!((rows.len(), rows[0], rows[2]), (3, "0.0,0.0,3.0,1.0", "1.0,1.0,1.5,0.5"), "{name}");
        assert_eq!(rows[1].to_lowercase(), "nan,nan,nan,", "{name}");
        let page = path(&folder, "page.html");
        let output = p2m(&["view", &cube, "--points", &scan, "--out", &page]);
        assert!(self::text(&output.stderr).contains("1 of 3 points are not finite and are left out"), "{name}");
        assert_eq!(output.code, 0, "{name}");
    }
    let nothing = write(&folder, "nothing.off", "OFF\n0 0 0\n");
    let report = json(&["deviation", &cube, &nothing, "--json"]);
    assert_eq!((&report["deviations"], &report["missing"]), (&0.into(), &8.into()));
}

#[test]
fn what_has_no_sign_is_told() {
    let folder = TempDir::new().unwrap();
    let open = write(&folder, "open.obj", CUBE.replace("f 5 6 7 8\n", ""));
    let scan = write(&folder, "scan.xyz", "1 1 -1\n");
    let output = p2m(&["deviation", &scan, &open]);
    assert_eq!(output.code, 0);
    assert!(text(&output.stderr).contains("warning  ") && text(&output.stderr).contains("the surface is open"));
    assert_eq!(text(&p2m(&["deviation", &scan, &open, "--sign", "winding"]).stderr).matches("warning").count(), 0);
    assert!(failure(&["deviation", &scan, &open, "--sign", "parity"], 1).contains("see --sign and --unsigned"));
    let cables = write(&folder, "cables.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
    assert!(failure(&["deviation", &scan, &cables], 1).contains("add --unsigned"));
    let report = json(&["deviation", &scan, &cables, "--unsigned", "--json"]);
    assert_eq!(statistic(&report, "max"), 2f64.sqrt());
    assert!(failure(&["deviation", &scan, &open, "--out", "-"], 2).contains("--out FILE"));
    assert!(failure(&["deviation", &scan, &open, "--out", "a.npy"], 1).contains("expected one of csv, ply, html"));
    assert!(failure(&["deviation", &scan, &open, "--out", &scan], 1).contains("unknown extension"));
    let csv = write(&folder, "scan.csv", "1,1,1\n");
    assert!(failure(&["deviation", &csv, &open, "--out", &csv], 1).contains("it is an input"));
    failure(&["deviation", &scan, &open, "--unsigned", "--sign", "parity"], 2);
    failure(&["deviation", "-", "-"], 2);
    for limit in ["0", "-1", "nan"] {
        failure(&["deviation", &scan, &open, "--limit", limit], 2);
    }
}

/// Noise along the normals of a scan comes back as the mean and the root mean square of the deviations.
#[test]
fn deviations_of_a_noisy_scan_are_the_noise() {
    let is_scan = |path: &PathBuf| path.ends_with("dragon_100k.obj") || path.ends_with("scan.obj");
    for scan in all_model_files().into_iter().filter(is_scan) {
        check_noise(&scan);
    }
}

fn check_noise(mesh: &Path) {
    let content = fs::read_to_string(mesh).unwrap();
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().skip(1).map(|w| w.parse().unwrap()).collect() };
    let of = |kind: &str| content.lines().filter(|line| line.starts_with(kind)).map(numbers).collect::<Vec<_>>();
    let (vertices, faces) = (of("v "), of("f "));
    let vertex = |i: f64| nalgebra::Vector3::from_row_slice(&vertices[i as usize - 1]);
    let (mut rng, sigma) = (rng("noisy dragon", 0), 1e-5);
    let (mut scan, mut sum, mut squares, mut count) = (String::new(), 0.0, 0.0, 0.0);
    for face in faces.iter().step_by(20) {
        let [a, b, c] = [0, 1, 2].map(|k| vertex(face[k]));
        let noise = sigma * normal_number(&mut rng);
        let point = (a + b + c) / 3.0 + (b - a).cross(&(c - a)).normalize() * noise;
        writeln!(scan, "{} {} {}", point.x, point.y, point.z).unwrap();
        (sum, squares, count) = (sum + noise, squares + noise * noise, count + 1.0);
    }
    let folder = TempDir::new().unwrap();
    let scan = write(&folder, "scan.xyz", scan);
    let report = json(&["deviation", &scan, mesh.to_str().unwrap(), "--json"]);
    let (mean, rms) = (sum / count, f64::sqrt(squares / count));
    assert_eq!((report["deviations"].as_f64(), &report["sign_rule"]), (Some(count), &"winding".into()));
    assert!((statistic(&report, "mean") - mean).abs() < 0.01 * sigma, "{mean}: {report}");
    assert!((statistic(&report, "rms") - rms).abs() < 0.01 * sigma, "{rms}: {report}");
}

#[test]
fn other_units_and_other_places_are_noticed() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let warning = |points: &str| {
        let output = p2m(&["deviation", &write(&folder, "scan.xyz", points), &cube]);
        assert_eq!(output.code, 0);
        text(&output.stderr).lines().find(|line| line.starts_with("warning")).map(str::to_owned)
    };
    let of_units = "warning  one of the scan and the scene is about 1000 times as large: millimetres and metres?";
    assert_eq!(warning("0 0 0\n2000 2000 2000\n").as_deref(), Some(of_units));
    assert!(warning("0 0 0\n50.8 50.8 50.8\n").is_some_and(|warning| warning.contains("25.4 times")));
    assert!(warning("9 0 0\n10 1 1\n").is_some_and(|warning| warning.contains("lie apart")));
    assert_eq!(warning("0 0 0\n2 2 2.1\nnan 0 0\n"), None);
    assert_eq!(warning("5 0 0\n5 1 1\n"), None);
}

#[test]
fn a_requirement_decides_the_verdict_and_the_exit_code() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let scan = write(&folder, "scan.xyz", "1 1 3\n1 1 1.5\n1 1 2\n1 1 2.1\nnan 0 0\n");
    let run = |required: &str, more: &[&str]| {
        let base = ["deviation", &scan, &cube, "--tolerance", "0.25", "--require", required];
        p2m(&[&base[..], more].concat())
    };
    let output = run("50", &["--unit", "mm"]);
    assert_eq!(output.code, 0);
    let table = text(&output.stdout);
    assert!(table.ends_with("PASS: 50 % within +-0.25 mm, 50 % required\n"), "{table}");
    assert!(table.contains("beyond 0.75 mm                      1 (25 %)\n"), "{table}");
    let output = run("50.1", &[]);
    assert_eq!((output.code, text(&output.stdout).contains("FAIL: 50 % within")), (3, true));
    assert!(!text(&output.stderr).contains("error"));
    let output = run("99%", &["--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.code, &report["passes"], &report["required"]), (3, &false.into(), &99.0.into()));
    assert_eq!(report["bands"], serde_json::json!([0, 1, 2, 0, 1]));
    // Nothing is not enough.
    let nothing = write(&folder, "nothing.xyz", "");
    let arguments = ["deviation", &nothing, &cube, "--tolerance", "1", "--require", "0"];
    assert_eq!(p2m(&arguments).code, 3);
    for wrong in [&["--require", "50"][..], &["--tolerance", "1", "--require", "101"], &["--only-outside"]] {
        failure(&[&["deviation", &scan, &cube], wrong].concat(), 2);
    }
}

#[test]
fn objects_have_statistics_of_their_own() {
    let folder = TempDir::new().unwrap();
    let faces = CUBE.find("f ").unwrap();
    let (vertices, faces) = CUBE.split_at(faces);
    let top = "f 5 6 7 8\n";
    let scene = format!("{vertices}{}o top\n{top}", faces.replace(top, ""));
    let scene = write(&folder, "named.obj", scene.replacen("f ", "o rest\nf ", 1));
    let scan = write(&folder, "scan.xyz", "1 1 3\n1 1 1.5\n3 1 1\n1 1 2.25\n");
    let arguments = ["deviation", &scan, &scene, "--tolerance", "0.75"];
    let report = json(&[&arguments[..], &["--json"]].concat());
    let objects = report["objects"].as_array().unwrap();
    let of = |i: usize, key: &str| objects[i]["statistics"][key].as_f64().unwrap();
    assert_eq!((objects.len(), &objects[0]["name"], &objects[1]["name"]), (2, &"rest".into(), &"top".into()));
    assert_eq!((&objects[0]["deviations"], of(0, "mean"), &objects[0]["above"]), (&1.into(), 1.0, &1.into()));
    assert_eq!((&objects[1]["deviations"], of(1, "mean"), of(1, "min")), (&3.into(), 0.25, -0.5));
    let table = table(&arguments);
    let line = table.lines().find(|line| line.starts_with("top")).unwrap();
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words, ["top", "3", "0.25", "0.6614", "-0.5", "1", "1"], "{table}");
}

#[test]
fn deviations_on_the_part_are_those_of_the_points_around_its_vertices() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    // Only the top is scanned, 0.25 too high at one corner.
    let scan = write(&folder, "scan.xyz", "0 0 2.25\n2 0 2\n2 2 2\n0 2 2\n");
    let out = path(&folder, "part.csv");
    let report = json(&["deviation", &scan, &cube, "--on-part", "--out", &out, "--json"]);
    assert_eq!((&report["deviations"], &report["missing"], statistic(&report, "max")), (&4.into(), &4.into(), 0.25));
    let rows: Vec<String> = fs::read_to_string(&out).unwrap().lines().map(str::to_owned).collect();
    assert_eq!([&rows[0], &rows[1], &rows[5]], ["number,x,y,z,deviation", "0,0.0,0.0,0.0,", "4,0.0,0.0,2.0,0.25"]);
    assert_eq!((rows.len(), rows[7].as_str()), (9, "6,2.0,2.0,2.0,0.0"));
    let arguments = ["--on-part", "--tolerance", "0.1", "--only-outside", "--out", &out];
    let text = table(&[&["deviation", &scan, &cube], &arguments[..]].concat());
    assert!(text.starts_with("vertices with a deviation"), "{text}");
    assert_eq!(fs::read_to_string(&out).unwrap(), "number,x,y,z,deviation\n4,0.0,0.0,2.0,0.25\n");
    // The coloured file is the part.
    let part = path(&folder, "part.ply");
    table(&["deviation", &scan, &cube, "--on-part", "--out", &part]);
    assert_eq!(json(&["info", &part, "--json"])["primitives"]["triangles"], 12);
}

#[test]
fn points_that_are_left_out_are_in_no_statistics() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let mut scan = String::new();
    for i in 0..400 {
        writeln!(scan, "{} {} 2", f64::from(i % 20) * 0.1, f64::from(i / 20) * 0.1).unwrap();
    }
    let scan = write(&folder, "scan.xyz", scan + "1 1 2.5\n1 1 5\n");
    let count = |more: &[&str]| {
        let report = json(&[&["deviation", &scan, &cube, "--json"], more].concat());
        (report["deviations"].clone(), statistic(&report, "max"))
    };
    assert_eq!(count(&[]), (402.into(), 3.0));
    assert_eq!(count(&["--max-distance", "0.5"]), (401.into(), 0.5));
    assert_eq!(count(&["--drop-isolated"]), (400.into(), 0.0));
    let out = path(&folder, "outside.csv");
    let base = ["deviation", &scan, &cube, "--tolerance", "0.1", "--only-outside", "--out", &out];
    table(&base);
    let rows: Vec<String> = fs::read_to_string(&out).unwrap().lines().map(str::to_owned).collect();
    assert_eq!((rows.len(), rows[0].starts_with("number,qx,qy,qz,")), (3, true), "{rows:?}");
    assert!(rows[1].starts_with("400,1.0,1.0,2.5,") && rows[2].starts_with("401,"), "{rows:?}");
    table(&[&base[..], &["--max-distance", "0.6"]].concat());
    assert_eq!(fs::read_to_string(&out).unwrap().lines().count(), 2);
    assert!(failure(&[&base[..6], &["--out", "a.ply"]].concat(), 2).contains("--only-outside needs a table"));
}

#[test]
fn tables_have_the_ids_of_the_scan() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let text = write(&folder, "scan.csv", "id,x,y,z\nP7,1,1,3\nnone,nan,1,1\n\"P,8\",1,1,2.01\n");
    let mut bytes = p2m_core::npy_header("[('id', '<i4'), ('query', '<f8', (3,))]", "(3,)", false);
    for (id, z) in [(41i32, 3.0f64), (0, f64::NAN), (42, 2.01)] {
        bytes.extend(id.to_le_bytes());
        bytes.extend([1.0, 1.0, z].iter().flat_map(|x: &f64| x.to_le_bytes()));
    }
    let array = path(&folder, "scan.npy");
    fs::write(&array, bytes).unwrap();
    let out = path(&folder, "out.csv");
    for (scan, ids) in [(&text, ["P7", "\"P,8\""]), (&array, ["41", "42"])] {
        let output = p2m(&["deviation", scan, &cube, "--out", &out]);
        assert!(self::text(&output.stderr).contains("of the scan is skipped: 1 vertices that are not finite"));
        let rows: Vec<String> = fs::read_to_string(&out).unwrap().lines().map(str::to_owned).collect();
        assert!(rows[0].starts_with("id,qx,qy,qz,"), "{rows:?}");
        assert!(rows[1].starts_with(&format!("{},1.0,1.0,3.0,", ids[0])), "{rows:?}");
        // A point without a deviation keeps its row, so the ids after it are those of their points.
        assert!(rows[3].starts_with(&format!("{},1.0,1.0,2.01,", ids[1])), "{rows:?}");
        table(&["deviation", scan, &cube, "--tolerance", "0.5", "--only-outside", "--out", &out]);
        let rows: Vec<String> = fs::read_to_string(&out).unwrap().lines().map(str::to_owned).collect();
        assert!(rows.len() == 2 && rows[1].starts_with(&format!("0,{},1.0,", ids[0])), "{rows:?}");
        // Answers to queries have them as well.
        table(&["query", &cube, "--points", scan, "--out", &out]);
        assert!(fs::read_to_string(&out).unwrap().lines().nth(3).unwrap().starts_with(ids[1]));
    }
}

#[test]
fn no_number_is_minus_zero() {
    let folder = TempDir::new().unwrap();
    let (cube, scan) = (write(&folder, "cube.obj", CUBE), write(&folder, "scan.xyz", "1 1 3\n1 1 1.5\n"));
    let text = table(&["deviation", &scan, &cube, "--tolerance", "0", "--unit", "mm"]);
    assert!(text.contains("below 0 mm") && !text.contains("-0 "), "{text}");
}

#[test]
fn the_histogram_counts_all_deviations() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let scan = write(&folder, "scan.xyz", "1 1 3\n1 1 2.01\n1 1 1.99\n1 1 1.5\n");
    let out = path(&folder, "histogram.csv");
    table(&["deviation", &scan, &cube, "--tolerance", "0.1", "--histogram", &out]);
    let content = fs::read_to_string(&out).unwrap();
    let rows: Vec<Vec<f64>> =
        content.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert_eq!((rows.len(), content.lines().next()), (62, Some("low,high,count")));
    assert_eq!((&rows[0][1..], &rows[61][..]), (&[-3.0 * 0.1, 1.0][..], &[3.0 * 0.1, f64::INFINITY, 1.0][..]));
    assert_eq!(rows.iter().map(|row| row[2]).sum::<f64>(), 4.0);
    let middle: Vec<f64> = rows[29..33].iter().map(|row| row[2]).collect();
    assert_eq!(middle, [0.0, 1.0, 1.0, 0.0]);
    failure(&["deviation", &scan, &cube, "--histogram", "-"], 2);
}

#[test]
fn a_cloud_has_sides() {
    let folder = TempDir::new().unwrap();
    let mut ground = String::new();
    for i in 0..900 {
        writeln!(ground, "{} {} 0", i % 30, i / 30).unwrap();
    }
    let ground = write(&folder, "ground.xyz", ground);
    let scan = write(&folder, "scan.xyz", "15.5 15.5 0.75\n15.4 10.3 -0.25\n");
    let report = json(&["deviation", &scan, &ground, "--json"]);
    assert_eq!((&report["sign_rule"], &report["signed"]), (&"planes".into(), &true.into()));
    assert!((statistic(&report, "min") + 0.25).abs() < 1e-12 && (statistic(&report, "max") - 0.75).abs() < 1e-12);
    let report = json(&["deviation", &scan, &ground, "--unsigned", "--json"]);
    assert_eq!(statistic(&report, "max"), f64::hypot(0.75, 0.5f64.sqrt()));
}

#[test]
fn a_scan_that_is_not_aligned_is_noticed() {
    let folder = TempDir::new().unwrap();
    let (knot, moved, near) = (path(&folder, "knot.ply"), path(&folder, "moved.ply"), path(&folder, "near.ply"));
    table(&["generate", "torus-knot", "--out", &knot]);
    table(&["convert", &knot, &moved, "--rotate-z", "2", "--translate", "0.05", "0", "0"]);
    table(&["convert", &knot, &near, "--subdivide", "1", "--displace", "0.02"]);
    let warned = |scan: &str, more: &[&str]| {
        let output = p2m(&[&["deviation", scan, &knot], more].concat());
        assert_eq!(output.code, 0, "{}", text(&output.stderr));
        text(&output.stderr).lines().find(|line| line.contains("not to be aligned")).map(str::to_owned)
    };
    let warning = warned(&moved, &["--unit", "mm"]).expect("a warning");
    assert!(warning.contains("and 2 degrees") && warning.contains("--align"), "{warning}");
    assert_eq!([warned(&near, &[]), warned(&knot, &[]), warned(&moved, &["--align"])], [None, None, None]);
}

#[test]
fn reports_have_their_head_and_their_verdict() {
    let folder = TempDir::new().unwrap();
    let cube = write(&folder, "cube.obj", CUBE);
    let scan = write(&folder, "scan.xyz", "1 1 3\n1 1 1.5\n1 1 2\n3 1 1\n");
    let head = ["--head", "Part=Bracket (7)", "--head", "Date = 2026-05-04", "--unit", "mm"];
    let write_to = |out: &str, more: &[&str]| {
        let base = ["deviation", &scan, &cube, "--tolerance", "0.6", "--require", "50", "--out", out];
        let output = p2m(&[&base[..], &head, more].concat());
        assert_eq!(output.code, 0, "{}", text(&output.stderr));
        fs::read(out).unwrap()
    };
    let page = text(&write_to(&path(&folder, "page.html"), &[]));
    for part in ["Part: Bracket (7); Date: 2026-05-04; ", "PASS: 50 % within +-0.6 mm, 50 % required. 4 deviations"] {
        assert!(page.contains(part), "{part}");
    }
    let sheet = path(&folder, "sheet.pdf");
    let pdf = write_to(&sheet, &[]);
    let streams = pdf_streams(&pdf);
    let drawn = streams.iter().find(|stream| stream.windows(2).any(|two| two == b"Tj")).expect("a page");
    let drawn = String::from_utf8_lossy(drawn);
    // Text with other characters than those of ASCII is written in hexadecimal digits.
    let verdict: String = "PASS  50 % within ".bytes().map(|byte| format!("{byte:02X}")).collect();
    for part in ["(Part  Bracket (7))", "(Date  2026-05-04)", &verdict, "2 (50 %)"] {
        assert!(drawn.contains(part), "{part}: {drawn}");
    }
    // Both pictures have points of several colours.
    assert_eq!(streams.len(), 3);
    let picture = path(&folder, "sheet.png");
    let decoder = png::Decoder::new(std::io::Cursor::new(write_to(&picture, &["--up", "y"])));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width, info.height), (1190, 1684));
    let count = |colour: [u8; 3]| bytes.as_chunks().0.iter().filter(|pixel| **pixel == colour).count();
    // The verdict, and points above: 1 is a third of the way from the tolerance of 0.6 to the limit of 1.8.
    assert!(count([0x1d, 0x7a, 0x36]) > 40_000 && count([0xb8, 0x63, 0x0a]) > 20, "{}", count([0xb8, 0x63, 0x0a]));
    for out in ["empty.pdf", "empty.png"] {
        let empty = write(&folder, "empty.xyz", "");
        table(&["deviation", &empty, &cube, "--out", &path(&folder, out)]);
    }
    failure(&["deviation", &scan, &cube, "--head", "nothing"], 2);
}

/// Returns the content of the compressed streams of a PDF file.
fn pdf_streams(file: &[u8]) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    let mut rest = file;
    while let Some(at) = rest.windows(8).position(|window| window == b"\nstream\n") {
        rest = &rest[at + 8..];
        let mut content = Vec::new();
        std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(rest), &mut content).unwrap();
        found.push(content);
    }
    found
}
