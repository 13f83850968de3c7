//! Files of the wild, with the counts that their list states.

use p2m_mixed::read_scene;

/// Name, triangles, segments.
const MODELS: &[(&str, usize, usize)] = &[
    ("bunny.obj", 28_576, 0),
    ("armadillo.obj", 86_482, 0),
    ("dragon_100k.obj", 100_000, 0),
    ("lucy_100k.ply", 99_970, 0),
    ("dragon_871k.ply", 871_414, 0),
    ("dragon_48k_nonmanifold.ply", 47_794, 0),
    ("bunny_subdivided_278k.ply", 277_804, 0),
    ("gear_skewed_57k.ply", 56_692, 0),
    ("gear_skewed_57k_rotated.ply", 56_692, 0),
    ("mixed_armadillo_camel_wireframe.obj", 86_482, 29_304),
    ("rotterdam_city_far_from_origin.obj", 38_772, 0),
    ("hotel_room_nonmanifold.ply", 99_029, 0),
    ("heavily_nonmanifold.obj", 41_262, 0),
    ("political_borders_lines.obj", 0, 94_161),
    ("track_lines.obj", 0, 16_266),
    ("rings_lines.obj", 0, 6_144),
    ("degenerate_small.obj", 24, 0),
    // 40,211 faces, quadrilaterals among them.
    ("sponza_66k.obj", 66_450, 0),
];

#[test]
fn models_have_the_counts_of_their_list() {
    let Some(folder) = p2m_testkit::models() else { return };
    for &(name, triangles, segments) in MODELS {
        let scene = read_scene(&folder.join(name)).unwrap();
        let found = (scene.soup.triangles().len(), scene.soup.segments().len(), scene.soup.points().len());
        assert_eq!(found, (triangles, segments, 0), "{name}");
    }
}
