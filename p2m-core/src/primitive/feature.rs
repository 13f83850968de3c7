//! The features of a primitive: vertices, edges and the face.

/// The feature of a primitive that contains its nearest point. Features are numbered within their primitive, so
/// neighbours in a mesh number the same vertex or edge differently.
///
/// A point has `Vertex(0)`; a segment has `Vertex(0)`, `Vertex(1)` and `Edge(0)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// The vertex i.
    Vertex(u8),
    /// The interior of edge i, which runs from vertex i to vertex i + 1 (cyclically).
    Edge(u8),
    /// The interior of the face.
    Face,
}

impl Feature {
    /// Returns the code of the feature in arrays: 0 to 2 for the vertices, 3 to 5 for the edges, and 6 for the face.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Vertex(i) => i,
            Self::Edge(i) => 3 + i,
            Self::Face => 6,
        }
    }

    /// Returns the feature of a code, or `None` for other numbers.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        match code {
            0..=2 => Some(Self::Vertex(code)),
            3..=5 => Some(Self::Edge(code - 3)),
            6 => Some(Self::Face),
            _ => None,
        }
    }
}

impl std::fmt::Display for Feature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Vertex(i) => write!(f, "vertex{i}"),
            Self::Edge(i) => write!(f, "edge{i}"),
            Self::Face => f.write_str("face"),
        }
    }
}
