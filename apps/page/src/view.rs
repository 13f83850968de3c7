//! The page of a scene.

use crate::decimate::{MAX_PRIMITIVES, is_distinct, representatives};
use crate::deviations::Deviations;
use crate::frame::Frame;
use crate::packed::{Packed, compressed_text};
use crate::template::{STYLE, escape, fill, script_data};
use nalgebra::{Matrix4, Point3};
use p2m_core::{Aabb, Closest, Element, Feature, PrimitiveId, PrimitiveSet, Soup};
use p2m_field::Grid;
use p2m_mixed::Scene;
use p2m_mixed::statistics::figure::Count;
use serde::Serialize;
use serde_json::{Value, json};

const TEMPLATE: &str = include_str!("view.html");
/// The script, which begins with the licence of what it contains.
const SCRIPT: &str = include_str!("../assets/viewer.js");
/// Where the licence ends.
const LICENCE_END: &str = "*/\n";
/// The module of WebAssembly of the npm package, compressed by Zstandard, which `cargo xtask wasm --build` makes.
const MODULE: &[u8] = include_bytes!("../assets/p2m.wasm.zst");

/// The axis that points up in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum UpAxis {
    /// The axis y, as in most scans and in models for films and games.
    Y,
    /// The axis z, as in CAD and maps.
    #[default]
    Z,
}

/// The boxes of one level of a tree.
#[derive(Clone, Debug)]
pub struct Level {
    /// The text above the level.
    pub title: String,
    /// The boxes.
    pub boxes: Vec<Aabb<f64>>,
}

/// The content of a page. Everything but the scene is optional.
///
/// # Limits
/// A scene of more than 10^6 primitives is drawn coarser, with a note on the page: vertices in the same cell of a grid
/// become one. Answers are not affected.
#[derive(Debug)]
pub struct View<'a> {
    scene: &'a Scene,
    frame: Frame,
    data: Data,
    /// The heading of the page.
    pub title: String,
    /// A sentence below the heading, which is also the text alternative of the picture.
    pub summary: String,
    /// The command and the versions that made the page.
    pub about: String,
}

/// The data of a page. Each optional part is an object as the script reads it.
#[derive(Debug, Default, Serialize)]
struct Data {
    unit: String,
    up: UpAxis,
    notes: Vec<String>,
    frame: Frame,
    scene: SceneData,
    object_names: Vec<String>,
    has_object_colours: bool,
    /// The kinds of primitives because of which the scene has no inside.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_inside: Option<&'static str>,
    /// Arrays with an entry for each query. A distance that is no number stands for no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    answers: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cells: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    field: Option<FieldData>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lists: Option<FieldData>,
    /// The data of live queries: the module, and the exact scene with its primitives in the order of their ids.
    #[serde(skip_serializing_if = "Option::is_none")]
    live: Option<Value>,
    /// Lines with lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    measures: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    moved: Option<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    deviations: Option<Value>,
}

/// A line between two points, with its length.
#[derive(Clone, Debug)]
pub struct Measure {
    /// The name that the page shows, or nothing for one of many lines.
    pub name: String,
    /// The two ends of the line.
    pub ends: [Point3<f64>; 2],
    /// The length that the page shows, such as a certified distance.
    pub length: f64,
}

/// How the second object of a scene was moved to where it is.
#[derive(Clone, Debug)]
pub struct Moved {
    /// The matrix of the motion, for column vectors (x, y, z, 1).
    pub matrix: Matrix4<f64>,
    /// Names and numbers that describe the motion.
    pub facts: Vec<(&'static str, f64)>,
}

/// The primitives of a scene.
#[derive(Debug, Default, Serialize)]
struct SceneData {
    /// The primitives that are drawn, or nothing if the exact scene of live queries has the same ones.
    #[serde(flatten)]
    drawn: Option<DrawnData>,
    objects: Vec<ObjectData>,
}

/// Positions in the frame, and the numbers of vertices of each kind of primitives.
#[derive(Debug, Serialize)]
struct DrawnData {
    positions: Packed,
    triangles: Packed,
    segments: Packed,
    points: Packed,
}

/// The first and the last number of an object's primitives of each kind, or those between objects, without a name.
#[derive(Debug, Serialize)]
struct ObjectData {
    name: Option<String>,
    /// The number of its primitives in the scene. Fewer are drawn of a scene that is drawn coarser.
    count: usize,
    triangles: [usize; 2],
    segments: [usize; 2],
    points: [usize; 2],
}

#[derive(Debug, Serialize)]
struct FieldData {
    counts: [usize; 3],
    origin: [f32; 3],
    spacing: f64,
    values: Packed,
}

impl<'a> View<'a> {
    /// Starts a page of a scene, whose picture contains the box `around` as well.
    #[must_use]
    pub fn new(scene: &'a Scene, around: &Aabb<f64>) -> Self {
        let frame = Frame::of(&scene.soup.aabb().union(around));
        let mut notes = Vec::new();
        let data = Data {
            unit: "units".to_owned(),
            scene: scene_data(scene, &frame, &mut notes),
            notes,
            frame,
            object_names: scene.objects.iter().map(|object| object.name.clone()).collect(),
            no_inside: match [scene.soup.segments().is_empty(), scene.soup.points().is_empty()] {
                [false, false] => Some("lines and points"),
                [false, true] => Some("lines"),
                [true, false] => Some("points"),
                [true, true] => None,
            },
            ..Data::default()
        };
        Self { scene, frame, data, title: "A scene".to_owned(), summary: String::new(), about: String::new() }
    }

    /// Sets the axis that points up.
    #[must_use]
    pub fn with_up(mut self, up: UpAxis) -> Self {
        self.data.up = up;
        self
    }

    /// Sets the name of the unit of lengths, which legends show.
    #[must_use]
    pub fn with_unit(mut self, unit: &str) -> Self {
        unit.clone_into(&mut self.data.unit);
        self
    }

    /// Shows queries with their closest points. `signed` has signed distances, or is empty.
    ///
    /// # Panics
    /// If the slices have different lengths, or an answer names a primitive that the scene does not have.
    #[must_use]
    pub fn with_answers(
        mut self,
        queries: &[Point3<f64>],
        answers: &[Option<Closest<f64>>],
        signed: Option<&[f64]>,
    ) -> Self {
        assert_eq!(queries.len(), answers.len(), "an answer for each query");
        assert!(signed.is_none_or(|signed| signed.len() == queries.len()), "a signed distance for each query");
        let number = |get: fn(&Closest<f64>) -> f64| -> Vec<f64> {
            answers.iter().map(|answer| answer.as_ref().map_or(f64::NAN, get)).collect()
        };
        let soup = &self.scene.soup;
        let vertices = |answer: &Option<Closest<f64>>| {
            let mut vertices = [[0.0; 3]; 3];
            if let Some(answer) = answer {
                for (vertex, &i) in vertices.iter_mut().zip(soup.element(answer.primitive).indices()) {
                    *vertex = self.frame.position(&soup.positions()[i as usize]);
                }
            }
            vertices
        };
        let size = |answer: &Option<Closest<f64>>| answer.map_or(0, |a| vertex_count(&soup.element(a.primitive)));
        let object = |answer: &Option<Closest<f64>>| {
            let number = answer.and_then(|answer| self.scene.object_number(answer.primitive));
            number.and_then(|number| u32::try_from(number + 1).ok()).unwrap_or(0)
        };
        let feature = |answer: &Option<Closest<f64>>| answer.map_or(Feature::Face, |answer| answer.feature).code();
        let point = |answer: &Option<Closest<f64>>| answer.map_or([f64::NAN; 3], |answer| answer.point.coords.into());
        let mut data = json!({
            "queries": Packed::new(&queries.iter().flat_map(|q| [q.x, q.y, q.z]).collect::<Vec<f64>>()),
            "points": Packed::new(&answers.iter().flat_map(point).collect::<Vec<f64>>()),
            "distances": Packed::new(&number(|answer| answer.distance)),
            "lower_bounds": Packed::new(&number(|answer| answer.lower_bound)),
            "signed": signed.map(Packed::new),
            "primitives": Packed::new(&answers.iter().map(primitive).collect::<Vec<u32>>()),
            // The codes of the features.
            "features": Packed::new(&answers.iter().map(feature).collect::<Vec<u8>>()),
            // The numbers of vertices of the primitives, and these vertices in the frame, three for each.
            "sizes": Packed::new(&answers.iter().map(size).collect::<Vec<u8>>()),
            "vertices": Packed::new(&answers.iter().flat_map(vertices).flatten().collect::<Vec<f32>>()),
            // The numbers of objects from 1, and 0 for none.
            "objects": Packed::new(&answers.iter().map(object).collect::<Vec<u32>>()),
        });
        if let (Value::Object(data), None) = (&mut data, signed) {
            data.shift_remove("signed");
        }
        self.data.answers = Some(data);
        self
    }

    /// Shows the boxes of an index, level by level, under a title.
    #[must_use]
    pub fn with_levels(mut self, title: &str, levels: &[Level]) -> Self {
        let level = |level: &Level| {
            let ends = level.boxes.iter().flat_map(|bounds| [bounds.min, bounds.max]);
            let boxes: Vec<f32> = ends.flat_map(|point| self.frame.position(&point)).collect();
            json!({ "title": level.title, "boxes": Packed::new(&boxes) })
        };
        let data = || json!({ "title": title, "levels": levels.iter().map(level).collect::<Value>() });
        self.data.cells = (!levels.is_empty()).then(data);
        self
    }

    /// Shows slices of a field, whose values are those of [`p2m_field::distances`]: x runs fastest. The page has them
    /// rounded to a 256th of the spacing of the grid, or to a 65534th of their range if that is more. Linear
    /// interpolation between the points of the grid has larger errors.
    ///
    /// # Panics
    /// If the number of values is not that of the points of the grid.
    #[must_use]
    pub fn with_field(mut self, grid: &Grid, values: &[f32]) -> Self {
        self.data.field = Some(self.field_data(grid, values, Packed::rounded(values, grid.spacing())));
        self
    }

    /// Shows slices through the cells of an index, coloured by the lengths of their lists: for each point of a grid, x
    /// running fastest, the number of primitives in the list there, or no number where the tree answers.
    ///
    /// # Panics
    /// If the number of lengths is not that of the points of the grid.
    #[must_use]
    pub fn with_list_lengths(mut self, grid: &Grid, lengths: &[f32]) -> Self {
        self.data.lists = Some(self.field_data(grid, lengths, Packed::new(lengths)));
        self
    }

    fn field_data(&self, grid: &Grid, values: &[f32], packed: Packed) -> FieldData {
        assert_eq!(grid.len(), values.len(), "a value for each point of the grid");
        FieldData {
            counts: grid.counts(),
            origin: self.frame.position(&grid.origin()),
            spacing: self.frame.length(grid.spacing()),
            values: packed,
        }
    }

    /// Lets the page answer queries wherever the mouse is: it gets the library, compiled to WebAssembly, and the exact
    /// vertices of the scene. The page builds the indexes itself when it is opened.
    #[must_use]
    pub fn with_live_queries(mut self) -> Self {
        let soup = &self.scene.soup;
        let coordinates: Vec<f64> = soup.positions().iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let (mut sizes, mut indices) = (Vec::with_capacity(soup.len()), Vec::new());
        for element in soup.elements() {
            sizes.push(vertex_count(&element));
            indices.extend_from_slice(element.indices());
        }
        if soup.len() <= MAX_PRIMITIVES {
            self.data.scene.drawn = None;
        }
        self.data.live = Some(json!({
            "module": Packed::zstandard(MODULE),
            "coordinates": Packed::new(&coordinates),
            // The numbers of vertices of the primitives, and these vertices one after the other.
            "sizes": Packed::new(&sizes),
            "indices": Packed::new(&indices),
        }));
        self
    }

    /// Shows lines with their lengths under a title, and above them a sentence about all of them with remarks on it. The
    /// box that the page was started with has to contain their ends.
    #[must_use]
    pub fn with_measures(mut self, title: &str, verdict: &str, remarks: &[String], measures: &[Measure]) -> Self {
        let ends = measures.iter().flat_map(|measure| measure.ends).flat_map(|p| [p.x, p.y, p.z]);
        let names = measures.iter().map(|measure| &measure.name).filter(|name| !name.is_empty());
        self.data.measures = Some(json!({
            "title": title,
            "verdict": verdict,
            "remarks": remarks,
            "names": names.collect::<Vec<_>>(),
            "lengths": Packed::new(&measures.iter().map(|measure| measure.length).collect::<Vec<f64>>()),
            // Six coordinates for each line.
            "ends": Packed::new(&ends.collect::<Vec<f64>>()),
        }));
        self
    }

    /// Gives each of the first two objects a colour of its own.
    #[must_use]
    pub fn with_object_colours(mut self) -> Self {
        self.data.has_object_colours = true;
        self
    }

    /// Shows the second of two objects where it is and where it was before it was moved, under a title, with a sentence
    /// about the motion and remarks on it. The box that the page was started with has to contain the object at both.
    ///
    /// # Panics
    /// If the scene has not two objects.
    #[must_use]
    pub fn with_moved(mut self, title: &str, verdict: &str, remarks: &[String], moved: &Moved) -> Self {
        assert_eq!(self.scene.objects.len(), 2, "the second of two objects was moved");
        // The 16 numbers of the matrix are there row by row.
        let rows: Vec<f64> = moved.matrix.transpose().iter().copied().collect();
        let facts = &moved.facts;
        self.data.moved =
            Some(json!({ "title": title, "verdict": verdict, "remarks": remarks, "matrix": rows, "facts": facts }));
        self
    }

    /// Shows a scan, coloured by its deviations from the scene, with their histogram and their statistics.
    ///
    /// Of more than 10^6 points only every second one, or every third one and so on, is drawn, with a note on the page.
    /// The statistics are those of all points.
    ///
    /// # Panics
    /// If there is not one value and one primitive for each position of the scan.
    #[must_use]
    pub fn with_deviations(mut self, deviations: &Deviations<'_>) -> Self {
        let (data, note) = deviations.data();
        self.data.deviations = Some(data);
        self.data.notes.extend(note);
        self
    }

    /// Returns the page as HTML.
    ///
    /// # Errors
    /// An error of the conversion to JSON, which all pages that this type can hold are free of.
    pub fn html(&self) -> serde_json::Result<String> {
        let [about, summary, title] = [&self.about, &self.summary, &self.title].map(|text| escape(text));
        let data = script_data(&self.data)?;
        let (licence, script) = SCRIPT.split_once(LICENCE_END).unwrap_or_default();
        let script = compressed_text(script.as_bytes());
        let texts = [("about", &*about), ("summary", &summary), ("title", &title), ("data", &data)];
        Ok(fill(TEMPLATE, &[&texts[..], &[("style", STYLE), ("licence", licence), ("script", &script)]].concat()))
    }
}

/// Returns the id of the primitive of an answer.
fn primitive(answer: &Option<Closest<f64>>) -> u32 {
    answer.and_then(|answer| u32::try_from(answer.primitive.index()).ok()).unwrap_or(u32::MAX)
}

/// Packs the primitives of a scene, object by object.
fn scene_data(scene: &Scene, frame: &Frame, notes: &mut Vec<String>) -> SceneData {
    let soup = &scene.soup;
    let positions: Vec<[f32; 3]> = soup.positions().iter().map(|p| frame.position(p)).collect();
    let stand_ins = (soup.len() > MAX_PRIMITIVES).then(|| representatives(soup, &positions));
    let mut drawn = Drawn::default();
    let mut objects = Vec::new();
    let mut next = 0;
    for object in &scene.objects {
        objects.extend(drawn.object(soup, None, next..object.ids.start, stand_ins.as_deref()));
        objects.extend(drawn.object(soup, Some(&object.name), object.ids.clone(), stand_ins.as_deref()));
        next = object.ids.end;
    }
    objects.extend(drawn.object(soup, None, next..soup.len(), stand_ins.as_deref()));
    if stand_ins.is_some() {
        let count = (drawn.triangles.len() / 3) + (drawn.segments.len() / 2) + drawn.points.len();
        notes.push(format!(
            "The scene has {} primitives. The picture has {}: vertices that are close to each other are drawn as \
             one. Answers are those of the whole scene.",
            Count(soup.len() as u64),
            Count(count as u64)
        ));
    }
    let drawn = DrawnData {
        positions: Packed::new(positions.as_flattened()),
        triangles: Packed::new(&drawn.triangles),
        segments: Packed::new(&drawn.segments),
        points: Packed::new(&drawn.points),
    };
    SceneData { drawn: Some(drawn), objects }
}

/// Returns the number of vertices of a primitive.
fn vertex_count(element: &Element) -> u8 {
    u8::try_from(element.indices().len()).unwrap_or(0)
}

/// The numbers of the vertices of all primitives that are drawn.
#[derive(Default)]
struct Drawn {
    triangles: Vec<u32>,
    segments: Vec<u32>,
    points: Vec<u32>,
}

impl Drawn {
    /// Adds the primitives with these ids, unless there are none.
    fn object(
        &mut self,
        soup: &Soup<f64>,
        name: Option<&String>,
        ids: std::ops::Range<usize>,
        stand_ins: Option<&[u32]>,
    ) -> Option<ObjectData> {
        if ids.is_empty() {
            return None;
        }
        let (before, count, first_id) = (self.counts(), ids.len(), ids.start);
        for element in ids.map(|id| soup.element(PrimitiveId::new(id))) {
            let indices = element.indices();
            let is_kept = stand_ins.is_none_or(|stand_ins| match indices {
                &[i] => stand_ins[i as usize] == i,
                _ => is_distinct(indices, stand_ins),
            });
            if is_kept {
                let list = match indices.len() {
                    1 => &mut self.points,
                    2 => &mut self.segments,
                    _ => &mut self.triangles,
                };
                list.extend(indices.iter().map(|&i| stand_ins.map_or(i, |stand_ins| stand_ins[i as usize])));
            }
        }
        if let Some(stand_ins) = stand_ins.filter(|_| self.counts() == before) {
            // An object that is smaller than a cell of the grid is drawn as a point, so that it can be seen.
            let vertex = soup.element(PrimitiveId::new(first_id)).indices()[0];
            self.points.push(stand_ins[vertex as usize]);
        }
        let after = self.counts();
        let [triangles, segments, points] = std::array::from_fn(|k| [before[k], after[k]]);
        Some(ObjectData { name: name.cloned(), count, triangles, segments, points })
    }

    fn counts(&self) -> [usize; 3] {
        [self.triangles.len() / 3, self.segments.len() / 2, self.points.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use p2m_mixed::Object;

    fn scene() -> Scene {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from).to_vec();
        let elements = [Element::Point(0), Element::Segment([0, 1]), Element::Triangle([0, 1, 2]), Element::Point(2)];
        let mut scene = Scene::from(Soup::new(positions, elements).unwrap());
        scene.objects = vec![Object { name: "<b>".to_owned(), ids: 1..3 }];
        scene
    }

    fn data(page: &str) -> Value {
        let (_, rest) = page.split_once("id=\"data\">").unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    }

    #[test]
    fn a_page_has_all_parts_once_and_nothing_is_from_elsewhere() {
        let scene = scene();
        let mut view = View::new(&scene, &Aabb::empty());
        view.title = "a < b & {{data}}".to_owned();
        let page = view.html().unwrap();
        assert!(page.contains("<title>a &lt; b &amp; {{data}}</title>"));
        assert_eq!(page.matches("</script>").count(), 2);
        assert!(page.contains("The MIT License") && page.len() < 500_000, "{}", page.len());
        for foreign in [" src=", "<link", "@import", "url("] {
            assert!(!page.contains(foreign), "{foreign}");
        }
    }

    #[test]
    fn an_object_in_one_cell_of_the_grid_is_drawn_as_a_point() {
        let scene = scene();
        let mut drawn = Drawn::default();
        let object = drawn.object(&scene.soup, Some(&"small".to_owned()), 1..3, Some(&[0, 0, 0])).unwrap();
        assert_eq!((object.count, object.triangles, object.segments, object.points), (2, [0, 0], [0, 0], [0, 1]));
        assert_eq!(drawn.points, [0]);
    }

    #[test]
    fn a_page_with_the_exact_scene_has_no_copy_of_it() {
        let scene = scene();
        let view = View::new(&scene, &Aabb::empty());
        let drawn = |html: &str| ["positions", "triangles"].map(|key| data(html)["scene"][key].is_null());
        assert_eq!(drawn(&view.html().unwrap()), [false, false]);
        let page = view.with_live_queries().html().unwrap();
        assert_eq!(drawn(&page), [true, true]);
        assert_eq!(data(&page)["scene"]["objects"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn objects_have_the_ranges_of_their_primitives() {
        let page = View::new(&scene(), &Aabb::empty()).html().unwrap();
        let objects = data(&page)["scene"]["objects"].clone();
        let ranges = |i: usize| ["triangles", "segments", "points"].map(|kind| objects[i][kind].to_string());
        assert_eq!(objects.as_array().unwrap().len(), 3);
        assert_eq!((objects[0]["name"].is_null(), ranges(0)), (true, ["[0,0]", "[0,0]", "[0,1]"].map(String::from)));
        assert_eq!((&objects[1]["name"], ranges(1)), (&"<b>".into(), ["[0,1]", "[0,1]", "[1,1]"].map(String::from)));
        assert_eq!((objects[2]["name"].is_null(), ranges(2)), (true, ["[1,1]", "[1,1]", "[1,2]"].map(String::from)));
        let numbers = [0, 1, 2, 3].map(|id| scene().object_number(PrimitiveId::new(id)).map_or(0, |number| number + 1));
        assert_eq!(numbers, [0, 1, 1, 0]);
    }
}
