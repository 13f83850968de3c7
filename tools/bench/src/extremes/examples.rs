//! Primitives for which external libraries compute a wrong distance. The checks of this command found them.

use crate::backend::{Answer, Unavailable};
use crate::backends::{self, YARDSTICK, YARDSTICK_DOUBLE};
use crate::queries::Queries;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_testkit::truth::Truth;

/// A primitive for which a library computes a wrong distance.
struct Example {
    /// The name of the library in the list of backends.
    library: &'static str,
    query: [f64; 3],
    vertices: &'static [[f64; 3]],
}

const EXAMPLES: [Example; 6] = [
    Example {
        library: YARDSTICK_DOUBLE,
        query: [0.5166426608654923, 4.0, 0.7250360087017615],
        vertices: &[[1.0, 4.0, 0.0], [-1.0, 4.0, 3.0], [1.0, 4.0, 9.60435976984016e-18]],
    },
    Example { library: YARDSTICK_DOUBLE, query: [0.0, 1.158251956379068e279, 0.0], vertices: &[[0.0; 3], [0.0; 3]] },
    Example {
        library: YARDSTICK,
        query: [0.0, 0.0, -2.0719402305198223e-28],
        vertices: &[[0.0; 3], [0.0, -2.0719402305198223e-28, 0.0]],
    },
    Example {
        library: YARDSTICK,
        query: [738859.0, 591240.0, 323303.0],
        vertices: &[
            [738859.6875, 591239.0625, 323303.1875],
            [738859.375, 591239.125, 323302.3125],
            [738858.9375, 591239.0, 323303.28125],
        ],
    },
    Example {
        library: "bvh",
        query: [5.28916626807065, 2.28916626807065, -0.7630554226902166],
        vertices: &[[6.0, 3.0, -1.0], [0.0, -3.0, 1.0], [-3.0, -6.0, 2.0]],
    },
    Example {
        library: "bvh",
        query: [4.5, 9.0, -13.5],
        vertices: &[[6.0, 12.0, -18.0], [6.0, 12.0, -18.0], [3.0, 6.0, -9.0]],
    },
];

impl Example {
    /// Returns the answer of a backend.
    fn answer(&self, backend: &str) -> Result<Answer, Unavailable> {
        let positions = self.vertices.iter().copied().map(Point3::from).collect();
        let element = if self.vertices.len() == 2 { Element::Segment([0, 1]) } else { Element::Triangle([0, 1, 2]) };
        let soup = Soup::new(positions, [element]).expect("vertices are finite");
        let scene = Scene::new("an example".to_owned(), soup).expect("it has a primitive");
        let mut answers = [Answer::NONE];
        backends::by_name(backend)
            .build(&scene)?
            .answer(Queries::new(vec![Point3::from(self.query)]).all(), &mut answers)?;
        Ok(answers[0])
    }

    /// Returns the error of an answer in units of u M, for a scalar with this number of bits.
    fn error(&self, answer: &Answer, bits: u32) -> f64 {
        Truth::new(self.query, self.vertices).error(answer.distance, bits, 0.0)
    }

    /// Returns the bits of the library's scalar, and the name of our backend in that scalar.
    fn scalar(&self) -> (u32, &'static str) {
        if self.library == YARDSTICK { (24, "aabb-f32") } else { (53, "aabb") }
    }
}

/// Formats the answers of the libraries to all examples, beside ours.
pub(super) fn list() -> String {
    let lines = EXAMPLES.iter().map(|example| {
        let &Example { library, query, vertices } = example;
        let (bits, ours) = example.scalar();
        let (theirs, error) = match example.answer(library) {
            Ok(answer) => (format!("answers {:e}", answer.distance), example.error(&answer, bits)),
            Err(Unavailable(_)) => ("panics".to_owned(), f64::INFINITY),
        };
        let ours = example.answer(ours).map_or(f64::NAN, |answer| answer.distance);
        let answers = format!("- {library} {theirs}, ours {ours:e}; the error is {error:.0e} u M:");
        format!("{answers}\n  query `{query:?}`,\n  vertices `{vertices:?}`.\n")
    });
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error in units of u M above which it is not due to rounding: twice the proved bound of our kernel.
    const ROUNDING: f64 = 16.0;

    #[test]
    fn libraries_are_wrong_and_ours_are_right() {
        for example in &EXAMPLES {
            let (bits, ours) = example.scalar();
            let theirs = example.answer(example.library).map_or(f64::INFINITY, |answer| example.error(&answer, bits));
            assert!(theirs.is_nan() || theirs > 1e3 * ROUNDING, "{}: {theirs} {:?}", example.library, example.query);
            let ours = example.answer(ours).unwrap();
            assert!(example.error(&ours, bits) < ROUNDING, "{:?}", example.query);
        }
    }
}
