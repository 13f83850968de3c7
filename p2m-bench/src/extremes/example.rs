//! Answers of external libraries about small scenes that are wrong, made as small as possible and checked again.

use super::counts::ROUNDING;
use super::external::Kind;
use crate::backend::{Answer, ScalarKind, Unavailable, catch};
use crate::backends::ALL;
use crate::queries::Queries;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_testkit::oracle::Distance;
use p2m_testkit::truth::Truth;
use std::cmp::Ordering;

/// A wrong answer of an external library about a scene of a few primitives.
#[derive(Clone, Debug)]
pub(super) struct Example {
    pub(super) library: &'static str,
    pub(super) kind: Kind,
    pub(super) query: [f64; 3],
    /// The vertices of each primitive.
    pub(super) vertices: Vec<Vec<[f64; 3]>>,
}

/// Returns the error of an answer in u M, and whether it names a primitive that is not the nearest beyond rounding, if
/// ids are to be checked.
pub(super) fn judged(
    query: [f64; 3],
    vertices: &[Vec<[f64; 3]>],
    nearest: usize,
    answer: &Answer,
    names: bool,
    (bits, eta): (u32, f64),
) -> (f64, bool) {
    let truth = Truth::new(query, &vertices[nearest]);
    let limit = if bits == 24 { f64::from(f32::MAX) } else { f64::MAX };
    let beyond = answer.distance == f64::INFINITY && truth.is_at_least(limit);
    let error = if beyond { 0.0 } else { truth.error(answer.distance, bits, eta) };
    let named = vertices.get(answer.id as usize).filter(|_| names && answer.id as usize != nearest && !beyond);
    let wrong = named.is_some_and(|named| {
        // The distance of the nearest primitive may be above the true one by the rounding of both.
        let least =
            truth.exact().length()[0] + truth.times_max_vertex_distance(ROUNDING * 2f64.powi(-bits.cast_signed()));
        let theirs = Truth::new(query, named);
        theirs.is_at_least(least + theirs.times_max_vertex_distance(ROUNDING * 2f64.powi(-bits.cast_signed())) + eta)
    });
    (error, wrong)
}

impl Example {
    /// Returns a sort key: ordinary magnitudes first, then few primitives, then short text.
    pub(super) fn plainness(&self) -> (bool, usize, usize) {
        let ordinary = |x: &f64| *x == 0.0 || (1e-30..1e30).contains(&x.abs());
        let all = self.vertices.iter().flatten().chain([&self.query]);
        (!all.flatten().all(ordinary), self.vertices.len(), self.text().len())
    }

    /// Formats the example as Rust source.
    pub(super) fn text(&self) -> String {
        format!("query `{:?}`, primitives `{:?}`", self.query, self.vertices)
    }

    /// Queries the library again and describes its answer, if that is still wrong in the same way
    /// by rational arithmetic.
    pub(super) fn confirmed(&self) -> Option<String> {
        let backend = ALL.iter().find(|backend| backend.name == self.library).expect("a name of the list");
        let (mut positions, mut elements) = (Vec::new(), Vec::new());
        for vertices in &self.vertices {
            let first = u32::try_from(positions.len()).expect("few");
            elements.push(match vertices.len() {
                1 => Element::Point(first),
                2 => Element::Segment([first, first + 1]),
                _ => Element::Triangle([first, first + 1, first + 2]),
            });
            positions.extend(vertices.iter().map(|v| Point3::from(*v)));
        }
        let scene = Scene::new("an example".to_owned(), Soup::new(positions, elements).ok()?).ok()?;
        let queries = Queries::new(vec![Point3::from(self.query)]);
        let said = catch(|| {
            let index = ((backend.prepare)(&scene)?.build)()?;
            let mut answers = [Answer::NONE];
            index.answer(queries.all(), &mut answers)?;
            Ok(answers[0])
        });
        let answer = match said {
            Ok(answer) => answer,
            Err(Unavailable(why)) => {
                return (self.kind == Kind::Panic && why == "it panicked").then(|| "panics".to_owned());
            }
        };
        let truths: Vec<_> = self.vertices.iter().map(|v| Distance::new(self.query, v)).collect();
        let less = |a: usize, b: usize| if truths[b].compare(&truths[a]) == Ordering::Less { b } else { a };
        let nearest = (0..truths.len()).reduce(less)?;
        let (bits, eta) = match backend.scalar {
            ScalarKind::Single => (24, f64::from(f32::from_bits(1))),
            ScalarKind::Double => (53, f64::from_bits(1)),
        };
        let names = self.kind == Kind::WrongPrimitive;
        let (error, is_another) = judged(self.query, &self.vertices, nearest, &answer, names, (bits, eta));
        let (named, truth) = (answer.id, truths[nearest].length()[0]);
        match self.kind {
            Kind::Panic => None,
            Kind::WrongPrimitive => is_another.then(|| {
                let theirs = truths[named as usize].length()[0];
                format!("answers primitive {named}, which is {theirs:e} away; nearest is {nearest}, at {truth:e}")
            }),
            kind => (Kind::of_error(error) == Some(kind))
                .then(|| format!("answers {:e}; the distance is {truth:e}, of primitive {nearest}", answer.distance)),
        }
    }

    pub(super) fn is_confirmed(&self) -> bool {
        self.confirmed().is_some()
    }

    /// Removes primitives as long as the answer stays wrong.
    pub(super) fn reduced(mut self) -> Self {
        let mut at = 0;
        while at < self.vertices.len() && self.vertices.len() > 1 {
            let mut fewer = self.clone();
            fewer.vertices.remove(at);
            if fewer.is_confirmed() {
                self = fewer;
            } else {
                at += 1;
            }
        }
        self
    }
}
