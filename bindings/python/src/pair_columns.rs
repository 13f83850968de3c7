//! Columns of near pairs of primitives in NumPy arrays. Arrays with two items per pair have the first scene first.

use crate::columns::{NO_FEATURE, NO_PRIMITIVE, answer_list, columns};
use p2m_core::Feature;
use p2m_core::pair::ClosestPair;
use pyo3::prelude::*;

columns! { PairArrays, PairColumns, ClosestPair<f64>, {
    distance: f64 = f64::INFINITY, |pair| pair.distance;
    primitive: i64 = NO_PRIMITIVE, |pair| i64::from(pair.primitives[0].number());
    primitives: [i64; 2] = [NO_PRIMITIVE; 2], |pair| pair.primitives.map(|id| i64::from(id.number()));
    points: [[f64; 3]; 2] = [[f64::NAN; 3]; 2], |pair| pair.points.map(|point| point.coords.into());
    features: [u8; 2] = [NO_FEATURE; 2], |pair| pair.features.map(Feature::code);
    barycentric: [[f64; 3]; 2] = [[f64::NAN; 3]; 2], |pair| pair.barycentric;
    lower_bound: f64 = f64::INFINITY, |pair| pair.lower_bound;
    is_intersecting: bool = false, |pair| pair.is_intersecting;
}}

answer_list!(PairList, Option<ClosestPair<f64>>, PairArrays, Option::as_ref);
