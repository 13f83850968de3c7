//! Checks the C interface: its header, C and C++ programs that use it, and that its answers are those of Rust.

use crate::{
    Outcome, build_for_tests, command, compare_or_write, exists, failed, go_on, make_folder, output, read, run, skip,
    start, target, tools,
};
use std::fs;
use std::path::Path;
use std::process::Command;

const CRATE: &str = "bindings/c";
const HEADER: &str = "bindings/c/include/p2m.h";
/// The program that makes the header. Another version may write another one.
const CBINDGEN_VERSION: &str = "0.29.4";
const WARNINGS: &str = "-Wall -Wextra -Wpedantic -Werror -I bindings/c/include";
const SANITIZERS: &str = "-g -fsanitize=address,undefined -fno-sanitize-recover=undefined";
/// The scene, and the number of queries, by which C and Rust are compared.
const COMPARED: (&str, &str) = ("scenes/knot_and_cables.obj", "1000000");

/// Compares the header with what cbindgen makes, compiles and runs the tests with the compilers that are here, and
/// compares the answers. With `--build` it writes the header, with a cbindgen that it installs. With `--fuzz` it calls all
/// functions with random arguments for so many seconds.
pub(crate) fn check(arguments: &[String]) -> Outcome {
    match arguments {
        [] => go_on(header(false))?,
        [argument] if argument == "--build" => return header(true),
        [argument, seconds] if argument == "--fuzz" => return fuzz(seconds),
        _ => return Err("the arguments of this task are --build, or --fuzz and a number of seconds".into()),
    }
    if cfg!(windows) {
        return skip("the C interface is tested with gcc and clang");
    }
    build_for_tests()?;
    let (libraries, programs) = (target("debug"), target("c-tests"));
    make_folder(&programs)?;
    let program = programs.join("test");
    let test = |compiler: &str, source: &str, options: &str| {
        let mut compile = command(&format!("{compiler} {options} {WARNINGS} {CRATE}/{source}"));
        start(link(compile.arg("-o").arg(&program), &libraries))?;
        start(Command::new(&program).arg(&programs))
    };
    // Each compiler has each standard and each mode of errors once.
    let results = "-DP2M_NO_EXCEPTIONS -fno-exceptions";
    for (c, cpp, [first, other]) in
        [("gcc", "g++", ["-std=c++17", "-std=c++20"]), ("clang", "clang++", ["-std=c++20", "-std=c++17"])]
    {
        if !exists(c) || !exists(cpp) {
            skip(&format!("there is no {c} with {cpp} for the tests of the C interface"))?;
            continue;
        }
        test(c, "tests/c_api.c", &format!("-std=c11 {SANITIZERS}"))?;
        test(cpp, "tests/cpp_api.cpp", &format!("{first} {SANITIZERS}"))?;
        test(cpp, "tests/cpp_api.cpp", &format!("{other} {results} {SANITIZERS}"))?;
        test(cpp, "examples/replacements.cpp", first)?;
    }
    let compiler = ["gcc", "clang"].into_iter().find(|compiler| exists(compiler));
    compiler.map_or(Ok(()), |compiler| compare(compiler, &libraries, &programs))
}

/// Links a program to the shared library, which it finds when it runs.
fn link<'a>(compile: &'a mut Command, libraries: &Path) -> &'a mut Command {
    compile.arg("-L").arg(libraries).args(["-lp2m", "-lm", &format!("-Wl,-rpath,{}", libraries.display())])
}

/// Compares the answers of a C program, which has the static library, with those of Rust.
fn compare(compiler: &str, libraries: &Path, programs: &Path) -> Outcome {
    let [program, queries, rust, c] = ["answers", "queries.bin", "rust.bin", "c.bin"].map(|name| programs.join(name));
    let mut compile = command(&format!("{compiler} -std=c11 -O1 {WARNINGS} {CRATE}/tests/answers.c"));
    compile.arg(libraries.join("libp2m.a")).args(["-lm", "-lpthread", "-ldl", "-o"]);
    start(compile.arg(&program))?;
    let (scene, count) = COMPARED;
    for backend in ["aabb", "p2m"] {
        let mut answers = Command::new(libraries.join("examples/answers"));
        start(answers.args([scene, backend, count]).args([&queries, &rust]))?;
        start(Command::new(&program).args([scene, backend]).args([&queries, &c]))?;
        let bytes = |path: &Path| fs::read(path).map_err(|error| failed(path, error));
        if bytes(&rust)? != bytes(&c)? {
            let c = c.display();
            return Err(format!("{c} differs from {}: the answers of C are not those of Rust", rust.display()).into());
        }
        println!("{count} answers of \"{backend}\" in C are those of Rust");
    }
    [queries, rust, c].iter().try_for_each(fs::remove_file).map_err(|error| error.to_string().into())
}

/// Compares the header with what cbindgen makes, or says why it cannot. With `builds` it writes the header.
fn header(builds: bool) -> Outcome {
    let installs = builds || std::env::var_os("P2M_REQUIRE_TOOLS").is_some();
    let program = tools::program("cbindgen", CBINDGEN_VERSION, "", installs)?;
    let made = target("p2m.h");
    let options = format!("--quiet --config {CRATE}/cbindgen.toml {CRATE} --output");
    output(Command::new(program).args(options.split(' ')).arg(&made))?;
    compare_or_write(HEADER, &read(made)?, "cargo xtask c --build", builds)
}

/// Runs the fuzz target of the interface, with a library in which overflows are errors.
fn fuzz(seconds: &str) -> Outcome {
    run("cargo build --profile test --locked --package p2m-c")?;
    let (libraries, corpus, program) = (target("debug"), target("c-corpus"), target("c-tests-fuzz"));
    make_folder(&corpus)?;
    let options = "-g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined";
    let mut compile = command(&format!("clang {options} {WARNINGS} {CRATE}/tests/fuzz.c -o"));
    start(link(compile.arg(&program), &libraries))?;
    start(Command::new(program).arg(format!("-max_total_time={seconds}")).arg("-max_len=4096").arg(corpus))
}
