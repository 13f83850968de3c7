//! Files that other libraries wrote, whole and damaged. They are the seeds of the fuzz targets.

#![allow(clippy::float_cmp, reason = "numbers of files are read as they are")]

use laz::LazVlrBuilder;
use laz::laszip::{ChunkTable, ChunkTableEntry};
use p2m_core::PrimitiveSet;
use p2m_formats::{FileFormat, read_points_from, read_scene, read_scene_from};
use p2m_mixed::{FileLocation, PointColumns, ReadError, Scene, Unit};
use p2m_testkit::{amount, restore_e57_checksums};
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tools/fuzz/seeds")
}

/// Returns all seeds of a format, with their names.
fn seeds(format: &str) -> Vec<(String, Vec<u8>)> {
    let files = fs::read_dir(folder().join(format)).unwrap().map(|entry| entry.unwrap().path());
    let mut seeds: Vec<_> =
        files.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap())).collect();
    seeds.sort();
    assert!(!seeds.is_empty());
    seeds
}

fn seed(name: &str) -> Vec<u8> {
    fs::read(folder().join(name)).unwrap()
}

fn read(name: &str, bytes: &[u8]) -> Result<Scene, ReadError> {
    read_scene_from(bytes, FileFormat::from_path(name.as_ref()).unwrap(), name, None)
}

/// Reads a 3MF file with this model.
fn read_model(text: &str) -> Result<Scene, ReadError> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    archive.start_file("3D/3dmodel.model", zip::write::SimpleFileOptions::default()).unwrap();
    std::io::Write::write_all(&mut archive, text.as_bytes()).unwrap();
    read("a.3mf", &archive.finish().unwrap().into_inner())
}

/// Returns the error of a seed, parts of which are replaced.
fn error(name: &str, changes: &[(usize, &[u8])]) -> String {
    let mut bytes = seed(name);
    for &(at, change) in changes {
        bytes[at..at + change.len()].copy_from_slice(change);
    }
    if name.ends_with("e57") {
        restore_e57_checksums(&mut bytes);
    }
    read(name.rsplit('/').next().unwrap(), &bytes).unwrap_err().to_string()
}

/// Returns the error of a text that replaces one of a seed.
fn text_error(name: &str, from: &str, to: &str) -> String {
    let text = String::from_utf8(seed(name)).unwrap();
    assert!(text.contains(from), "{name} has no {from}");
    read(name.rsplit('/').next().unwrap(), text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
}

fn counts(name: &str) -> [usize; 3] {
    let soup = read_scene(&folder().join(name)).unwrap().soup;
    [soup.triangles().len(), soup.segments().len(), soup.points().len()]
}

fn names(scene: &Scene) -> Vec<&str> {
    scene.objects.iter().map(|object| object.name.as_str()).collect()
}

#[test]
fn scenes_have_their_primitives_names_and_units() {
    for name in ["format0.las", "format3.laz", "format7.las", "format7.laz", "format8.laz"] {
        assert_eq!(counts(&format!("las/{name}")), [0, 0, 12], "{name}");
    }
    // Their chunks have 1, 6, 2 and 3 points.
    for format in [3, 7] {
        let [plain, varying] = [format!("format{format}.las"), format!("varying{format}.laz")]
            .map(|name| read_scene(&folder().join("las").join(name)).unwrap());
        assert_eq!(varying.soup, plain.soup, "{format}");
    }
    let feet = read_scene(&folder().join("las/format7.laz")).unwrap();
    assert_eq!(feet.unit, Some(Unit::Foot));
    for name in ["ascii", "binary", "binary_compressed"] {
        assert_eq!(counts(&format!("pcd/{name}.pcd")), [0, 0, 6], "{name}");
    }
    let scans = read_scene(&folder().join("e57/scans.e57")).unwrap();
    assert_eq!((names(&scans), scans.unit, scans.soup.len()), (vec!["station0", "station1"], Some(Unit::Metre), 10));
    let [glb, gltf] = ["scene.glb", "scene.gltf"].map(|name| read_scene(&folder().join("gltf").join(name)).unwrap());
    assert_eq!((names(&glb), glb.unit), (vec!["ball", "box", "cloud"], Some(Unit::Metre)));
    assert_eq!(glb, gltf);
    assert_eq!(counts("gltf/scene.glb"), [32, 0, 4]);
    let parts = read_scene(&folder().join("3mf/two.3mf")).unwrap();
    assert_eq!((parts.unit, parts.soup.triangles().len()), (Some(Unit::Millimetre), 32));
    let map = read_scene(&folder().join("geojson/mixed.geojson")).unwrap();
    assert_eq!(counts("geojson/mixed.geojson"), [8 + 1, 3, 2]);
    assert_eq!((names(&map), map.unit, map.is_flat), (vec!["stop", "park"], Some(Unit::Degree), false));
    assert_eq!(map.sources, [0, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 3, 3]);
    assert_eq!(map.skipped[0].to_string(), "1 x feature without geometry");
    assert_eq!(
        ["points", "lines", "polygons", "patches"].map(|name| counts(&format!("shp/{name}.shp"))),
        [[0, 0, 2], [0, 3, 0], [8 + 1, 0, 0], [2 + 2 + 1, 0, 0]]
    );
    let polygons = read_scene(&folder().join("shp/polygons.shp")).unwrap();
    assert!(polygons.is_flat && polygons.unit.is_none());
}

#[test]
fn vertices_are_points_and_a_prj_file_has_the_unit() {
    let path = folder().join("shp/points.shp");
    let points =
        read_points_from(&*seed("shp/points.shp"), "shp".parse().unwrap(), "p", Some(&path), &PointColumns::default());
    assert_eq!(points.unwrap().points, [nalgebra::Point3::new(1.0, 2.0, 0.0), nalgebra::Point3::new(3.0, 4.0, 0.0)]);
    let target = std::env::temp_dir().join(format!("p2m-formats-{}", std::process::id()));
    fs::create_dir_all(&target).unwrap();
    fs::copy(path, target.join("a.shp")).unwrap();
    fs::write(target.join("a.prj"), r#"GEOGCS["WGS 84"]"#).unwrap();
    assert_eq!(read_scene(&target.join("a.shp")).unwrap().unit, Some(Unit::Degree));
    fs::remove_dir_all(target).unwrap();
}

#[test]
fn invalid_points_of_scans_keep_their_numbers() {
    use e57::{E57Writer, Record, RecordDataType, RecordName, RecordValue};
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut bytes, "file").unwrap();
    let state =
        Record { name: RecordName::CartesianInvalidState, data_type: RecordDataType::Integer { min: 0, max: 2 } };
    let records = vec![Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64, state];
    let mut scan = writer.add_pointcloud("scan", records).unwrap();
    // Four states fill a byte.
    for (x, state) in [(1.0, 0), (2.0, 2), (3.0, 0), (4.0, 0)] {
        let mut values = vec![RecordValue::Double(x); 3];
        values.push(RecordValue::Integer(state));
        scan.add_point(values).unwrap();
    }
    scan.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    let scene = read("a.e57", bytes.get_ref()).unwrap();
    assert_eq!((scene.soup.len(), &scene.sources[..]), (3, &[0, 2, 3][..]));
    assert_eq!((scene.skipped.len(), scene.skipped[0].count), (1, 1));
    let table = read_points_from(&bytes.get_ref()[..], "e57".parse().unwrap(), "a", None, &PointColumns::default());
    let x: Vec<f64> = table.unwrap().points.iter().map(|point| point.x).collect();
    assert!(x[0] == 1.0 && x[1].is_nan() && x[2..] == [3.0, 4.0], "{x:?}");
}

#[test]
fn unknown_chunks_of_glb_files_are_ignored() {
    let bytes = seed("gltf/scene.glb");
    let json_end = 20 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let chunk = [&4u32.to_le_bytes()[..], b"ABCD", b"data"].concat();
    let expected = read("a.glb", &bytes).unwrap();
    for at in [json_end, bytes.len()] {
        assert_eq!(read("a.glb", &[&bytes[..at], &chunk, &bytes[at..]].concat()).unwrap(), expected);
    }
    let cut = [&bytes[..json_end], &chunk[..11]].concat();
    assert!(read("a.glb", &cut).unwrap_err().to_string().ends_with(": unexpected end of file"));
}

/// Returns six times the volume inside of the triangles of a scene, which is negative if they face inside.
fn volume(scene: &Scene) -> f64 {
    let corners = |t: &[u32; 3]| t.map(|i| scene.soup.positions()[i as usize].coords);
    scene.soup.triangles().iter().map(corners).map(|[a, b, c]| a.dot(&b.cross(&c))).sum()
}

#[test]
fn mirrored_nodes_face_outside() {
    let text = String::from_utf8(seed("gltf/scene.gltf")).unwrap();
    let plain = read("a.gltf", text.as_bytes()).unwrap();
    let mut description: serde_json::Value = serde_json::from_str(&text).unwrap();
    for node in description["nodes"].as_array_mut().unwrap() {
        let children = node.get("children").cloned();
        let mesh = node.get("mesh").cloned();
        *node = serde_json::json!({ "scale": [if mesh.is_some() { -1.0 } else { 1.0 }, 1.0, 1.0] });
        mesh.into_iter().for_each(|mesh| node["mesh"] = mesh);
        children.into_iter().for_each(|children| node["children"] = children);
    }
    let mirrored = read("a.gltf", description.to_string().as_bytes()).unwrap();
    assert_eq!(mirrored.soup.triangles().len(), plain.soup.triangles().len());
    assert!(volume(&plain) > 1.0 && volume(&mirrored) > 1.0, "{}", volume(&mirrored));
}

#[test]
fn mirrored_parts_of_3mf_files_face_outside() {
    let mirror = "-1 0 0 0 1 0 0 0 1 5 6 7";
    let model = |item: &str, component: &str| {
        read_model(&format!(
            r#"<model><resources><object id="1"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
            <vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
            <triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="0" v2="3" v3="2"/></triangles>
            </mesh></object><object id="2"><components><component objectid="1" transform="{component}"/></components>
            </object></resources><build><item objectid="2" transform="{item}"/></build></model>"#
        ))
        .unwrap()
    };
    let plain = "1 0 0 0 1 0 0 0 1 0 0 0";
    for (item, component) in [(plain, plain), (mirror, plain), (plain, mirror), (mirror, mirror)] {
        let scene = model(item, component);
        assert!((volume(&scene) - 1.0).abs() < 1e-12, "{item}, {component}: {}", volume(&scene));
    }
    // Only the mirrored object has another direction.
    let triangles = |item| model(item, plain).soup.triangles().to_vec();
    assert_eq!((triangles(plain)[0], triangles(mirror)[0]), ([0, 2, 1], [0, 1, 2]));
}

#[test]
fn single_features_have_coordinate_systems() {
    let system = r#""crs": {"type": "name", "properties": {"name": "EPSG:28992"}}"#;
    let geometry = r#""type": "Point", "coordinates": [155000.0, 463000.0]"#;
    for (system, unit) in [(system, None), (r#""crs": {"properties": {"name": "OGC:CRS84"}}"#, Some(Unit::Degree))] {
        for file in [
            format!("{{{geometry}, {system}}}"),
            format!(r#"{{"type": "Feature", "properties": null, "geometry": {{{geometry}}}, {system}}}"#),
        ] {
            assert_eq!(read("a.geojson", file.as_bytes()).unwrap().unit, unit, "{file}");
        }
    }
}

#[test]
fn slices_of_3mf_files_are_left_out_unless_they_are_required() {
    let model = |required: &str| {
        let text = format!(
            r#"<model unit="millimeter" xmlns:s="http://schemas.microsoft.com/3dmanufacturing/slice/2015/07" {required}>
            <resources><s:slicestack id="1" zbottom="0"><s:slice ztop="1"><s:vertices><s:vertex x="1" y="2"/>
            </s:vertices><s:polygon startv="0"><s:segment v2="1"/></s:polygon></s:slice></s:slicestack>
            <object id="2" s:slicestackid="1"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
            <vertex x="1" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>
            </resources><build><item objectid="2"/></build></model>"#
        );
        read_model(&text)
    };
    for required in ["", r#"recommendedextensions="s""#, r#"requiredextensions="p""#] {
        assert_eq!(model(required).unwrap().soup.triangles().len(), 1, "{required}");
    }
    let error = model(r#"requiredextensions="p s""#).unwrap_err().to_string();
    assert!(error.contains("requires the extension for slices"), "{error}");
}

/// Damages each seed of a format: it ends early, and each of its bytes is replaced.
fn damage(format: &str) {
    let [mut cases, mut errors] = [0; 2];
    for (name, bytes) in seeds(format) {
        let mut check = |mut bytes: Vec<u8>| {
            if format == "e57" {
                restore_e57_checksums(&mut bytes);
            }
            let mut result = None;
            let taken = allocation_counter::measure(|| result = Some(read(&name, &bytes))).bytes_max;
            assert!(taken < 1 << 22, "{name} takes {taken} bytes");
            cases += 1;
            let Err(error) = result.unwrap() else { return };
            errors += 1;
            let text = error.to_string();
            assert!(!text.contains("failed at damaged data"), "{text}");
            let names_place = ["header", "archive", "container", "description", "top level"];
            let has_place = error.location != FileLocation::File
                || names_place.iter().any(|place| text.contains(place))
                || text.trim_start_matches(&name).contains(|c: char| c.is_ascii_digit());
            assert!(has_place, "{text}");
        };
        let step = bytes.len().div_ceil(amount(10_000, 100));
        for at in (0..bytes.len()).step_by(step) {
            check(bytes[..at].to_vec());
            for value in [0, 1, 0x20, 0x7f, 0x80, 0xff, bytes[at] ^ 2] {
                let mut bytes = bytes.clone();
                bytes[at] = value;
                check(bytes);
            }
        }
        // Four bytes are a count or a length.
        for at in (0..bytes.len().saturating_sub(4)).step_by(step) {
            let mut bytes = bytes.clone();
            bytes[at..at + 4].fill(0xff);
            check(bytes);
        }
    }
    println!("{format}: {errors} errors in {cases} files");
    assert!(errors > 100);
}

#[test]
fn damaged_las_files_are_errors() {
    damage("las");
    assert_eq!(error("las/format3.las", &[(0, b"X")]), "format3.las at byte 0: the file does not start with 'LASF'");
    assert_eq!(
        error("las/format3.las", &[(107, &[0xff; 4])]),
        "format3.las at byte 107: the header announces 4294967295 points, but the file has 12"
    );
    assert_eq!(error("las/format3.las", &[(104, &[99])]), "format3.las at byte 104: point format 35 is unknown");
    assert_eq!(
        error("las/format3.las", &[(105, &[3, 0])]),
        "format3.las at byte 105: records of 3 bytes are too short for point format 3"
    );
    assert_eq!(
        error("las/format3.las", &[(139, &f64::NAN.to_le_bytes())]),
        "format3.las at byte 131: the scale or the offset of y is not finite"
    );
    assert_eq!(
        error("las/format3.las", &[(96, &[0xff; 4])]),
        "format3.las at byte 107: the header announces 12 points, but the file has 0"
    );
    let count = 1_000_000_000_000u64.to_le_bytes();
    assert!(
        error("las/format7.laz", &[(247, &count)])
            .starts_with("format7.laz at byte 107: the header announces 1000000000000 points, more")
    );
    assert_eq!(error("las/format7.las", &[(100, &[0xff; 4])]), "format7.las at byte 990: unexpected end of file");
    let chunks = seed("las/format7.laz");
    let start = u32::from_le_bytes(chunks[96..100].try_into().unwrap()) as usize;
    assert!(error("las/format7.laz", &[(start + 8 + 36, &[0; 4])]).ends_with(": a chunk has no points"));
    assert!(error("las/format7.laz", &[(start + 8 + 40, &[0xff; 4])]).contains("the layers of a chunk take 42949"));
    let table = u64::from_le_bytes(chunks[start..start + 8].try_into().unwrap()) as usize;
    let expected = format!("format7.laz at byte {table}: the table of chunks announces 4294967295 chunks, more than");
    assert!(error("las/format7.laz", &[(table + 4, &[0xff; 4])]).starts_with(&expected));
    let start = u32::from_le_bytes(seed("las/varying7.laz")[96..100].try_into().unwrap()) as usize;
    let sizes = start + 8 + 36;
    assert_eq!(
        error("las/varying7.laz", &[(sizes, &[2])]),
        format!("varying7.laz at byte {sizes}: a chunk has 2 points, but the table of chunks says 1")
    );
    assert!(
        error("las/varying3.laz", &[(107, &[11])]).ends_with("the chunks have 12 points, but the header announces 11")
    );
    let mut empty_chunk = seed("las/varying3.laz");
    let start = u32::from_le_bytes(empty_chunk[96..100].try_into().unwrap()) as usize;
    empty_chunk.truncate(u64::from_le_bytes(empty_chunk[start..start + 8].try_into().unwrap()) as usize);
    let mut table = ChunkTable::default();
    [12, 0].into_iter().for_each(|point_count| table.push(ChunkTableEntry { point_count, byte_count: 1 }));
    let vlr = LazVlrBuilder::default().with_point_format(3, 0).unwrap().with_variable_chunk_size().build();
    table.write_to(&mut empty_chunk, &vlr).unwrap();
    assert!(read("a.laz", &empty_chunk).unwrap_err().to_string().ends_with("decompressed: a chunk has no points"));
}

#[test]
fn damaged_pcd_files_are_errors() {
    damage("pcd");
    let text = |from, to| text_error("pcd/ascii.pcd", from, to);
    assert_eq!(
        text("POINTS 6", "POINTS 999999999999"),
        "ascii.pcd:17: the header announces 999999999999 points, but there are 6"
    );
    assert_eq!(text("POINTS 6", "POINTS -6"), "ascii.pcd:9: '-6' is not a whole number");
    assert_eq!(text("FIELDS x y", "FIELDS x w"), "ascii.pcd:10: the fields x, y, z are not among x, w, z, intensity");
    assert_eq!(text("SIZE 4 4", "SIZE 3 4"), "ascii.pcd:10: the type or the size of x is unknown");
    assert_eq!(
        text("TYPE F F F F", "TYPE F"),
        "ascii.pcd:10: FIELDS, SIZE, TYPE and COUNT have different numbers of words"
    );
    assert_eq!(text("DATA ascii", "DATA none"), "ascii.pcd:10: DATA 'none' is unknown");
    assert_eq!(text("DATA ascii", "#"), "ascii.pcd:17: the header ends without a line DATA");
    assert_eq!(text("0.6630633473", "much"), "ascii.pcd:11: 'much' is not a number");
    assert_eq!(text("0.6630633473 ", "1 2\n"), "ascii.pcd:11: a point has too few values");
    let nan = String::from_utf8(seed("pcd/ascii.pcd")).unwrap().replace("0.6630633473", "nan");
    assert_eq!(read("a.pcd", nan.as_bytes()).unwrap().skipped[0].to_string(), "1 vertices that are not finite");
    let binary = String::from_utf8_lossy(&seed("pcd/binary.pcd")).replacen("POINTS 6", "POINTS 9999999", 1);
    assert!(read("b.pcd", binary.as_bytes()).unwrap_err().to_string().ends_with(": unexpected end of file"));
    let start = seed("pcd/binary_compressed.pcd").windows(11).position(|w| w == b"compressed\n").unwrap() + 11;
    assert_eq!(
        error("pcd/binary_compressed.pcd", &[(start + 4, &[0xff; 4])]),
        format!("binary_compressed.pcd at byte {}: 4294967295 bytes of data are not those of 6 points", start + 4)
    );
    assert!(
        error("pcd/binary_compressed.pcd", &[(start + 8, &[0xff; 3])]).ends_with(": the compressed data is damaged")
    );
}

#[test]
fn damaged_e57_files_are_errors() {
    damage("e57");
    let bytes = seed("e57/scans.e57");
    let without = |name: &str| read("a.e57", &bytes[..bytes.len() - name.len()]).unwrap_err().to_string();
    assert!(without("x").starts_with("a.e57: header: "), "{}", without("x"));
    let mut damaged = bytes.clone();
    damaged[1500] ^= 1;
    assert!(read("a.e57", &damaged).unwrap_err().to_string().contains("checksum"));
    let at = |text: &str| bytes.windows(text.len()).position(|w| w == text.as_bytes()).unwrap();
    let count = at("recordCount=\"5\"") + 13;
    assert_eq!(error("e57/scans.e57", &[(count, b"9")]).split(": ").nth(1), Some("scan 0, counted from 0"));
}

#[test]
fn damaged_gltf_files_are_errors() {
    damage("gltf");
    let text = |from, to| text_error("gltf/scene.gltf", from, to);
    assert!(text("\"asset\"", "\"asses\"").starts_with("scene.gltf:1: description: "));
    assert!(text("\"byteLength\":", "\"byteLength\":9").contains("buffer 0: it has "));
    assert!(text("\"count\":", "\"count\":999999999").contains("items are outside of its view"));
    assert!(text("base64,", "base64,*").contains("buffer 0: Invalid"));
    assert!(text("\"uri\":\"data:", "\"uri\":\"../data:").contains("buffer 0: '../data"));
    assert!(text("\"mesh\":0", "\"mesh\":99").contains("description: "));
    assert!(text("\"nodes\":[", "\"nodes\":[1,1,").contains("node 1 has two parents"));
    assert!(text("\"nodes\":[", "\"nodes\":[99,").ends_with("description: there is no node 99"));
    assert!(text("\"componentType\":", "\"componentType\":9").contains("the type 95125 of its numbers is unknown"));
    assert!(text("\"VEC3\"", "\"VEC4\"").contains("accessor 1: its type is VEC4 instead of VEC3"));
    assert!(text("\"mode\":4", "\"mode\":7").contains("mesh 0, primitive 0: mode 7 is unknown"));
    assert!(
        text("\"asset\":{", "\"extensionsRequired\":[\"KHR_mesh_quantization\",\"A\"],\"asset\":{")
            .ends_with("extension A: files that need it are not read")
    );
    assert!(
        text("\"asset\":{", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\":{")
            .contains("gltf-transform")
    );
    assert!(error("gltf/scene.glb", &[(4, &[1])]).starts_with("scene.glb at byte 4: version 1 is not 2"));
    assert!(error("gltf/scene.glb", &[(12, &[0xff; 4])]).ends_with(": unexpected end of file"));
    assert!(error("gltf/scene.glb", &[(20, b"[")]).starts_with("scene.glb: description: "));
}

#[test]
fn damaged_3mf_files_are_errors() {
    damage("3mf");
    let object = |inside: &str| {
        format!(
            "<model unit=\"inch\"><resources><object id=\"1\" name=\"a\">{inside}</object></resources><build><item objectid=\"1\" transform=\"1 0 0 0 2 0 0 0 1 5 6 7\"/></build></model>"
        )
    };
    let corners = "<vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"1\" z=\"0\"/>";
    let scene = read_model(&object(&format!("{corners}<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>"))).unwrap();
    assert_eq!((scene.unit, names(&scene)), (Some(Unit::Inch), vec!["a"]));
    assert_eq!(scene.soup.positions()[2], nalgebra::Point3::new(6.0, 8.0, 7.0));
    let error = |inside: &str| read_model(&object(inside)).unwrap_err().to_string();
    assert_eq!(
        error(&format!("{corners}<triangle v1=\"0\" v2=\"1\" v3=\"4294967295\"/>")),
        "a.3mf: item 0 of the build, counted from 0: object 1: vertex 4294967295 is out of range, there are 3"
    );
    assert_eq!(
        error("<components><component objectid=\"1\"/></components>"),
        "a.3mf: item 0 of the build, counted from 0: object 1 is part of itself, or nested too deeply"
    );
    assert!(
        error("<components><component objectid=\"1\"/><component objectid=\"1\"/></components>")
            .contains("part of itself")
    );
    assert!(error("<components><component objectid=\"2\"/></components>").ends_with("there is no object 2"));
    assert_eq!(error("<vertex x=\"0\" y=\"0\"/>"), "a.3mf: 3D/3dmodel.model at byte 75: <vertex> has no z");
    assert!(error("<vertex x=\"0\" y=\"zero\" z=\"0\"/>").ends_with("'zero' is not a number that fits here"));
    assert!(error("</object><object id=\"1\">").ends_with("there is another object 1"));
    assert!(error("<vertex x=\"0").contains(": 3D/3dmodel.model at byte "));
    assert!(
        error(&format!("{}<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>", corners.replace("\"1\"", "\"nan\"")))
            .ends_with("coordinate that is not finite")
    );
    assert!(read_model("<model unit=\"ell\"/>").unwrap_err().to_string().ends_with("unit 'ell' is unknown"));
    assert!(
        read_model("<vertex x=\"0\" y=\"0\" z=\"0\"/>")
            .unwrap_err()
            .to_string()
            .ends_with("<vertex> is outside of an object")
    );
    assert!(read_model(&" ".repeat(1 << 27)).unwrap_err().to_string().contains("expands to more than"));
    // Nested components multiply, and take no more memory than the file allows.
    let many: String = (1..30)
        .map(|i| {
            format!(
                "<object id=\"{i}\"><components>{}</components></object>",
                format!("<component objectid=\"{}\"/>", i + 1).repeat(2)
            )
        })
        .collect();
    let bomb = read_model(&format!(
        "<model><resources>{many}<object id=\"30\">{corners}</object></resources><build><item objectid=\"1\"/></build></model>"
    ));
    assert!(bomb.unwrap_err().to_string().contains("more than 1,000 times the size of its file"));
}

#[test]
fn damaged_geojson_files_are_errors() {
    damage("geojson");
    let text = |from, to| text_error("geojson/mixed.geojson", from, to);
    assert!(
        text("[4.5, 52.0]", "[4.5]")
            .ends_with("A position must contain two or more elements, but got `1` at line 1 column 156")
    );
    assert!(text("[4.5, 52.0]", "[4.5, \"north\"]").starts_with("mixed.geojson:1: "));
    assert!(text("[4.5, 52.0]", "[4.5, 1e999]").contains("mixed.geojson:1: number out of range"));
    assert!(text("[4.5, 52.0]", "[4.5, NaN]").starts_with("mixed.geojson:1: "));
    assert!(text("\"Polygon\"", "\"Pentagon\"").starts_with("mixed.geojson:1: unknown variant `Pentagon`"));
    assert!(text("\"FeatureCollection\"", "\"Features\"").starts_with("mixed.geojson"));
    assert!(text("}", "").starts_with("mixed.geojson:1: "));
    assert!(text("\"type\"", "type").starts_with("mixed.geojson:1: "));
    assert_eq!(read("a.json", b"{\"a\": \xff}").unwrap_err().to_string(), "a.json at byte 6: the text is not UTF-8");
    let nested =
        format!("{}{}", "{\"type\": \"GeometryCollection\", \"geometries\": [".repeat(1000), "]}".repeat(1000));
    assert!(read("a.json", nested.as_bytes()).unwrap_err().to_string().contains("recursion limit"));
    assert!(read("a.json", b"").unwrap_err().to_string().starts_with("a.json:1: "));
}

#[test]
fn damaged_shapefiles_are_errors() {
    damage("shp");
    assert!(error("shp/lines.shp", &[(0, &[1])]).starts_with("lines.shp at byte 0: "));
    assert!(
        error("shp/lines.shp", &[(108, &[77])])
            .starts_with("lines.shp: record 0, counted from 0: The code ' 77 ' does not")
    );
    assert_eq!(
        error("shp/lines.shp", &[(104, &[1])]),
        "lines.shp: record 0, counted from 0: it has 33554676 bytes, but the file has 244 more"
    );
    // The numbers of parts and of positions.
    assert!(
        error("shp/lines.shp", &[(144, &[0xff, 0xff, 0xff, 0x7f])])
            .starts_with("lines.shp: record 0, counted from 0: ")
    );
    assert!(
        error("shp/lines.shp", &[(148, &[0xff, 0xff, 0xff, 0x7f])])
            .starts_with("lines.shp: record 0, counted from 0: ")
    );
    assert!(error("shp/lines.shp", &[(148, &[0xff; 4])]).starts_with("lines.shp: record 0, counted from 0: "));
    assert!(error("shp/lines.shp", &[(104, &[0xff; 4])]).starts_with("lines.shp: record 0, counted from 0: "));
    assert!(error("shp/lines.shp", &[(160, &f64::NAN.to_le_bytes())]).ends_with(
        "record 0, counted from 0: vertex 0 is part of a primitive, but has a coordinate that is not finite"
    ));
    assert_eq!(
        error("shp/lines.shp", &[(152, &[9])]),
        "lines.shp: record 0, counted from 0: part 0 starts at position 9 of 5, after one at 0"
    );
    assert!(error("shp/patches.shp", &[(152, &[9])]).starts_with("patches.shp: record 0, counted from 0: "));
    assert!(error("shp/polygons.shp", &[(164, &f64::INFINITY.to_le_bytes())]).contains("not finite"));
}
