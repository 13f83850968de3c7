//! Cases that external libraries answer wrongly. They were found by the checks of this command and reduced to the
//! primitives that they need.

use crate::backend::{Answer, Unavailable, catch};
use crate::backends::{self, YARDSTICK, YARDSTICK_DOUBLE};
use crate::queries::Queries;
use crate::scene::Scene;
use nalgebra::Point3;
use p2m_core::{Element, Soup};
use p2m_testkit::oracle::Distance;
use p2m_testkit::truth::Truth;

/// A case that a library answers wrongly.
struct Example {
    /// The name of the library in the list of backends.
    library: &'static str,
    query: [f64; 3],
    /// The vertices of each primitive.
    primitives: &'static [&'static [[f64; 3]]],
}

const EXAMPLES: [Example; 10] = [
    Example {
        library: YARDSTICK_DOUBLE,
        query: [0.5166426608654923, 4.0, 0.7250360087017615],
        primitives: &[&[[1.0, 4.0, 0.0], [-1.0, 4.0, 3.0], [1.0, 4.0, 9.60435976984016e-18]]],
    },
    Example {
        library: YARDSTICK_DOUBLE,
        query: [0.0, 1.158251956379068e279, 0.0],
        primitives: &[&[[0.0; 3], [0.0; 3]]],
    },
    Example {
        library: YARDSTICK_DOUBLE,
        query: [996495282407518.0, 14141192300305.5, 82445004820704.0],
        primitives: &[&[
            [996495282407519.3, 14141192300305.756, 82445004820701.47],
            [996495282407519.1, 14141192300306.738, 82445004820701.95],
        ]],
    },
    Example { library: YARDSTICK, query: [0.0, 0.0, 2.6740488989739244e29], primitives: &[&[[0.0; 3], [0.0; 3]]] },
    Example {
        library: YARDSTICK,
        query: [0.0, 0.0, -2.0719402305198223e-28],
        primitives: &[&[[0.0; 3], [0.0, -2.0719402305198223e-28, 0.0]]],
    },
    Example {
        library: YARDSTICK,
        query: [738859.0, 591240.0, 323303.0],
        primitives: &[&[
            [738859.6875, 591239.0625, 323303.1875],
            [738859.375, 591239.125, 323302.3125],
            [738858.9375, 591239.0, 323303.28125],
        ]],
    },
    Example {
        library: YARDSTICK,
        query: [-938624.75, -287470.28125, -190637.21875],
        primitives: &[
            &[
                [-938624.875, -287469.375, -190637.921875],
                [-938625.0625, -287470.59375, -190637.59375],
                [-938624.8125, -287471.15625, -190637.78125],
            ],
            &[
                [-938626.0, -287469.8125, -190637.53125],
                [-938626.3125, -287470.03125, -190637.5],
                [-938624.8125, -287470.4375, -190636.609375],
            ],
        ],
    },
    Example {
        library: "bvh",
        query: [5.28916626807065, 2.28916626807065, -0.7630554226902166],
        primitives: &[&[[6.0, 3.0, -1.0], [0.0, -3.0, 1.0], [-3.0, -6.0, 2.0]]],
    },
    Example {
        library: "bvh",
        query: [4.5, 9.0, -13.5],
        primitives: &[&[[6.0, 12.0, -18.0], [6.0, 12.0, -18.0], [3.0, 6.0, -9.0]]],
    },
    Example {
        library: "bvh",
        query: [1.9049375998892603e307; 3],
        primitives: &[
            &[
                [f64::MAX, 2.784692759779172e188, -f64::MAX],
                [-f64::MAX, 3.8869071096299284e150, 2.784692759779172e188],
                [3.8869071096299284e150, -f64::MAX, -f64::MAX],
            ],
            &[[f64::MAX; 3], [f64::MAX; 3]],
        ],
    },
];

impl Example {
    /// Returns the answer of a backend.
    fn answer(&self, backend: &str) -> Result<Answer, Unavailable> {
        let (mut positions, mut elements) = (Vec::new(), Vec::new());
        for vertices in self.primitives {
            let first = u32::try_from(positions.len()).expect("few");
            elements.push(match vertices.len() {
                2 => Element::Segment([first, first + 1]),
                _ => Element::Triangle([first, first + 1, first + 2]),
            });
            positions.extend(vertices.iter().map(|vertex| Point3::from(*vertex)));
        }
        let soup = Soup::new(positions, elements).expect("vertices are finite");
        let scene = Scene::new("an example".to_owned(), soup).expect("it has primitives");
        let queries = Queries::new(vec![Point3::from(self.query)]);
        catch(|| {
            let index = ((backends::by_name(backend).prepare)(&scene)?.build)()?;
            let mut answers = [Answer::NONE];
            index.answer(queries.all(), &mut answers)?;
            Ok(answers[0])
        })
    }

    /// Returns the bits of the library's scalar, and the name of a backend of ours in that scalar.
    fn scalar(&self) -> (u32, &'static str) {
        if self.library == YARDSTICK { (24, "aabb-f32") } else { (53, "aabb") }
    }

    /// Returns the number of a nearest primitive by rational arithmetic.
    fn nearest(&self) -> usize {
        let distances: Vec<Distance> = self.primitives.iter().map(|v| Distance::new(self.query, v)).collect();
        let nearer = |a: &usize, b: &usize| distances[*a].compare(&distances[*b]);
        (0..distances.len()).min_by(nearer).expect("it has primitives")
    }

    /// Returns the error of an answer in u M, for a scalar with so many bits.
    fn error(&self, answer: &Answer, bits: u32) -> f64 {
        Truth::new(self.query, self.primitives[self.nearest()]).error(answer.distance, bits, 0.0)
    }
}

/// Formats the answers of the libraries to all examples beside ours.
pub(super) fn list() -> String {
    let lines = EXAMPLES.iter().map(|example| {
        let &Example { library, query, primitives } = example;
        let (bits, ours) = example.scalar();
        let (theirs, error) = match example.answer(library) {
            Ok(answer) => (format!("answers {:e}", answer.distance), example.error(&answer, bits)),
            Err(Unavailable(_)) => ("panics".to_owned(), f64::INFINITY),
        };
        let ours = example.answer(ours).map_or(f64::NAN, |answer| answer.distance);
        format!("- {library} {theirs}, ours {ours:e}; the error is {error:.0e} u M: query `{query:?}`, primitives `{primitives:?}`.\n")
    });
    lines.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extremes::ROUNDING;

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
