//! A candidate for the nearest primitive.

use super::double_double::Square;
use super::feature::ends;
use super::feature_certificate;
use crate::kernel::vector::V3;
use crate::{Feature, PrimitiveId};

/// A primitive that may be nearest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<'a> {
    pub(super) id: PrimitiveId,
    /// The finite vertices: one of a point, two of a segment, three of a triangle.
    pub(super) vertices: &'a [[f64; 3]],
    /// The feature that contains the nearest point according to the kernel.
    pub(super) feature: Feature,
}

impl Candidate<'_> {
    /// Returns whether the features of two candidates are the same set of points. Both features are proved to contain
    /// the nearest point of their candidate.
    ///
    /// -0 equals 0. The vertices of a proved feature are distinct, so it suffices to find each vertex of one feature
    /// among the vertices of the other.
    #[allow(clippy::float_cmp, reason = "the same vertices, not near ones")]
    pub(super) fn shares_feature(&self, other: &Self) -> bool {
        match (self.feature, other.feature) {
            (Feature::Vertex(i), Feature::Vertex(j)) => self.vertices[usize::from(i)] == other.vertices[usize::from(j)],
            (Feature::Edge(i), Feature::Edge(j)) => {
                let ([a, b], [c, d]) = (ends(i, self.vertices), ends(j, other.vertices));
                a == c && b == d || a == d && b == c
            }
            (Feature::Face, Feature::Face) => self.vertices.iter().all(|v| other.vertices.contains(v)),
            _ => false,
        }
    }

    /// Returns the bits of the vertices of the feature, in an order that is the same for all proved candidates that
    /// share it.
    pub(super) fn feature_bits(&self) -> [[u64; 3]; 3] {
        let vertices = self.vertices;
        // The sum turns -0 into 0. Unused entries differ from the bits of all finite coordinates.
        let bits = |v: V3| v.map(|x| (x + 0.0).to_bits());
        let unused = [u64::MAX; 3];
        let mut all = match self.feature {
            Feature::Vertex(i) => [bits(vertices[usize::from(i)]), unused, unused],
            Feature::Edge(i) => {
                let [a, b] = ends(i, vertices);
                [bits(a), bits(b), unused]
            }
            Feature::Face => std::array::from_fn(|i| bits(vertices[i])),
        };
        all.sort_unstable();
        all
    }

    /// Returns whether the feature is proved to contain the nearest point.
    pub(super) fn is_proved(&self, query: V3) -> bool {
        feature_certificate::is_proved(query, self.vertices, self.feature)
    }

    /// Returns the squared distance of the feature, or `None` if double-double arithmetic could overflow or underflow.
    pub(super) fn square(&self, query: V3) -> Option<Square> {
        Square::new(query, self.vertices, self.feature)
    }
}
