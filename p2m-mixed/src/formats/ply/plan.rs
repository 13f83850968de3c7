//! The plan of a PLY file: how each element of its header is read.

use super::header;
use crate::HeaderProblem;
use crate::parse::bytes::Scalar;
use crate::parse::text::quote;
use header::Layout;

/// The property with the id of a primitive, for files that have primitives in another order.
const ID_PROPERTY: &str = "p2m_id";

/// The index among the properties and the type of each coordinate.
pub(super) type Coordinates<const N: usize> = [(usize, Scalar); N];

/// How an element is read, with the indices and types of its properties.
pub(super) enum ElementPlan {
    Vertices(Coordinates<3>),
    Members(MemberPlan),
    Skip,
}

/// The plan of an element that makes primitives.
pub(super) struct MemberPlan {
    pub(super) form: Form,
    pub(super) vertices: Vertices,
    /// The index and type of the property with the id.
    pub(super) id: Option<(usize, Scalar)>,
}

/// The properties with the vertices of a member, with their indices and types.
pub(super) enum Vertices {
    List(usize, List),
    Single(Vec<(usize, Scalar)>),
}

/// The form in which the vertices of a member make primitives.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Polygon,
    Strip,
    Segment,
    Point,
}

/// The types of the count and of the items of a list of vertices.
#[derive(Clone, Copy)]
pub(super) struct List {
    pub(super) count: Scalar,
    pub(super) item: Scalar,
}

impl ElementPlan {
    pub(super) fn of(element: &header::Element) -> Result<Self, HeaderProblem> {
        let (form, vertices) = match element.name.as_slice() {
            b"vertex" => return Ok(Self::Vertices(coordinates(element, ["x", "y", "z"])?)),
            b"edge" => {
                let ends = [scalar(element, "edge", "vertex1", true)?, scalar(element, "edge", "vertex2", true)?];
                (Form::Segment, Vertices::Single(ends.to_vec()))
            }
            b"face" => (Form::Polygon, list(element, "face")?),
            b"tristrips" => (Form::Strip, list(element, "tristrips")?),
            // Another program may use an element of this name for something else.
            b"point" => match scalar(element, "point", "vertex_index", true) {
                Ok(vertex) => (Form::Point, Vertices::Single(vec![vertex])),
                Err(_) => return Ok(Self::Skip),
            },
            _ => return Ok(Self::Skip),
        };
        let id = match element.find(&[ID_PROPERTY]) {
            Some(_) if form != Form::Strip => Some(scalar(element, "face", ID_PROPERTY, true)?),
            _ => None,
        };
        Ok(Self::Members(MemberPlan { form, vertices, id }))
    }
}

impl MemberPlan {
    /// Returns the indices of the properties that are read.
    pub(super) fn used(&self) -> Vec<usize> {
        let mut used = match &self.vertices {
            Vertices::List(at, _) => vec![*at],
            Vertices::Single(all) => all.iter().map(|(at, _)| *at).collect(),
        };
        used.extend(self.id.map(|(at, _)| at));
        used
    }
}

/// Returns the number of primitives if they have ids, and `None` if they have none. It is an error if only some of them
/// have ids.
pub(super) fn ids(elements: &[header::Element], plans: &[ElementPlan]) -> Result<Option<u64>, HeaderProblem> {
    let (mut with, mut without) = (0u64, None);
    for (element, plan) in elements.iter().zip(plans) {
        if let ElementPlan::Members(members) = plan
            && element.count > 0
        {
            match (&members.id, members.form) {
                (Some(_), _) => with = with.saturating_add(element.count),
                (None, Form::Polygon) => without = Some("face"),
                (None, Form::Strip) => without = Some("tristrips"),
                (None, Form::Segment) => without = Some("edge"),
                (None, Form::Point) => without = Some("point"),
            }
        }
    }
    match without {
        _ if with == 0 => Ok(None),
        Some(element) => Err(HeaderProblem::MissingProperty { element, property: ID_PROPERTY }),
        None => Ok(Some(with)),
    }
}

pub(super) fn coordinates<const N: usize>(
    element: &header::Element,
    names: [&'static str; N],
) -> Result<Coordinates<N>, HeaderProblem> {
    let mut found = [(0, Scalar::F64); N];
    for (found, name) in found.iter_mut().zip(names) {
        *found = scalar(element, "vertex", name, false)?;
    }
    Ok(found)
}

/// Returns whether an element has a list of vertices, by the usual names of such a list.
pub(super) fn has_vertex_list(element: &header::Element) -> bool {
    // The grid of a raw scan says where its vertices were seen.
    element.name != b"range_grid"
        && element
            .properties
            .iter()
            .any(|p| matches!(p.layout, Layout::List { .. }) && p.name.starts_with(b"vertex_ind"))
}

fn scalar(
    element: &header::Element,
    name: &'static str,
    property: &'static str,
    integer: bool,
) -> Result<(usize, Scalar), HeaderProblem> {
    let at = element.find(&[property]).ok_or(HeaderProblem::MissingProperty { element: name, property })?;
    match element.properties[at].layout {
        Layout::Scalar(scalar) if scalar.is_integer() || !integer => Ok((at, scalar)),
        _ => {
            Err(HeaderProblem::BadType { name: property.to_owned(), declared: element.properties[at].declared.clone() })
        }
    }
}

fn list(element: &header::Element, name: &'static str) -> Result<Vertices, HeaderProblem> {
    let property = "vertex_indices";
    let at =
        element.find(&[property, "vertex_index"]).ok_or(HeaderProblem::MissingProperty { element: name, property })?;
    match element.properties[at].layout {
        Layout::List { count, item } if item.is_integer() => Ok(Vertices::List(at, List { count, item })),
        _ => {
            let header::Property { name, declared, .. } = &element.properties[at];
            Err(HeaderProblem::BadType { name: quote(name), declared: declared.clone() })
        }
    }
}
