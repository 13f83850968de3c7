//! The functions that the script of a page calls.
//!
//! The script asks for the address of an array, writes it, and calls [`p2m_load`]. Then it builds indexes one by one,
//! and queries them: a query returns 1 if there is an answer, whose values are at [`p2m_answer`]. The memory may
//! grow in each call, which detaches the arrays that the script has made over it. Backends have the
//! numbers of [`backend`](crate::backend).
#![allow(unsafe_code, reason = "names that are exported as they are could be those of other functions of a program")]

use crate::far::FarAnswer;
use crate::scene::{self, Answer, Live};
use p2m::nalgebra::Point3;
use std::cell::RefCell;

/// The arrays that the script writes, the scene, and the values that the script reads.
#[derive(Default)]
struct State {
    coordinates: Vec<f64>,
    sizes: Vec<u8>,
    indices: Vec<u32>,
    live: Live,
    values: [f64; if FarAnswer::LEN > Answer::LEN { FarAnswer::LEN } else { Answer::LEN }],
}

thread_local! {
    /// The module has one thread.
    static STATE: RefCell<State> = RefCell::default();
}

fn with_state<R>(use_it: impl FnOnce(&mut State) -> R) -> R {
    STATE.with_borrow_mut(use_it)
}

/// Makes room for an array and returns its address: the coordinates of the vertices (f64) for 0, the sizes of the
/// primitives (u8) for 1, and the vertices of the primitives (u32) for other numbers.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_reserve(array: u32, length: usize) -> *mut u8 {
    with_state(|state| match array {
        0 => {
            state.coordinates = vec![0.0; length];
            state.coordinates.as_mut_ptr().cast()
        }
        1 => {
            state.sizes = vec![0; length];
            state.sizes.as_mut_ptr()
        }
        _ => {
            state.indices = vec![0; length];
            state.indices.as_mut_ptr().cast()
        }
    })
}

/// Makes the scene of the arrays that were written. It returns 1, or 0 if they do not fit each other.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_load() -> u32 {
    with_state(|state| {
        let live = Live::new(&state.coordinates, &state.sizes, &state.indices);
        let is_made = live.is_some();
        *state = State { live: live.unwrap_or_default(), ..State::default() };
        u32::from(is_made)
    })
}

/// Builds the index of a backend. It returns its size in bytes, or 0 if there is none.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_build(backend: usize) -> usize {
    let Some(backend) = scene::backend(backend) else { return 0 };
    with_state(|state| state.live.build(backend).ok().flatten().unwrap_or(0))
}

/// Builds the scene far from the origin. It returns the scale of the scene, or 0 if there is none.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_build_far() -> f64 {
    with_state(|state| state.live.build_far().unwrap_or(0.0))
}

/// Answers a query with the index of a backend. The values are those of [`Answer::values`].
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_query(backend: usize, x: f64, y: f64, z: f64) -> u32 {
    let Some(backend) = scene::backend(backend) else { return 0 };
    with_state(|state| {
        let answer = state.live.query(backend, &Point3::new(x, y, z));
        state.write(answer.map(|answer| answer.values()))
    })
}

/// Answers a query far from the origin. The values are those of [`FarAnswer::values`].
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_query_far(x: f64, y: f64, z: f64) -> u32 {
    with_state(|state| {
        let answer = state.live.far().and_then(|far| far.query(&Point3::new(x, y, z)));
        state.write(answer.map(|answer| answer.values()))
    })
}

/// Answers `count` queries around the scene, and returns the number of answers.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_answer_many(backend: usize, count: u32) -> usize {
    let Some(backend) = scene::backend(backend) else { return 0 };
    with_state(|state| state.live.answer_many(backend, count))
}

/// Returns the address of the values of the last answer.
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn p2m_answer() -> *const f64 {
    with_state(|state| state.values.as_ptr())
}

impl State {
    /// Keeps the values of an answer, and returns 1 if there is one.
    fn write<const N: usize>(&mut self, values: Option<[f64; N]>) -> u32 {
        let Some(values) = values else { return 0 };
        self.values[..N].copy_from_slice(&values);
        1
    }
}
