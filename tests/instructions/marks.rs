//! Runs of the queries between marks, for the counter of `cargo xtask arm --instructions`.

use crate::tasks::{Indexes, SCENES, scene};
use p2m::core::Isa;

/// The argument with which this program runs all queries between marks.
pub(crate) const MARK: &str = "--between-marks";

/// Runs the queries of each task between two marks, with each instruction set in turn, and prints the names of the
/// tasks.
pub(crate) fn run_between_marks() {
    for name in SCENES {
        let soup = scene(name);
        let indexes = Indexes::build(&soup);
        for isa in Isa::available() {
            for task in indexes.clone().with_isa(isa).tasks() {
                mark();
                (task.run)();
                mark();
                println!("{name},{},{},{isa}", task.backend, task.set);
            }
        }
    }
}

/// Makes a mark: a system call (the number of this process) that nothing else here makes, at which the counter writes
/// its count.
#[inline(never)]
fn mark() {
    std::hint::black_box(std::process::id());
}
