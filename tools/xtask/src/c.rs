//! Checks the C interface: its header, C and C++ programs that use it, and that its answers are those of Rust.

use crate::{
    Outcome, build_for_tests, cargo, compare_or_write, go_on, make_folder, output, read, run, skip, target, text, tools,
};
use std::fs;
use std::path::Path;

const CRATE: &str = "bindings/c";
const HEADER: &str = "bindings/c/include/p2m.h";
/// The program that makes the header. Another version may write another one.
const CBINDGEN_VERSION: &str = "0.29.4";
const WARNINGS: [&str; 6] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I", "bindings/c/include"];
const SANITIZERS: [&str; 3] = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"];
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
    let library = ["-L", &text(&libraries), "-lp2m", "-lm", &format!("-Wl,-rpath,{}", text(&libraries))];
    let test = |compiler: &str, source: &str, options: &[&str]| {
        let program = text(programs.join("test"));
        let source = format!("{CRATE}/{source}");
        run(compiler, &[options, &WARNINGS, &[&source, "-o", &program], &library].concat(), &[])?;
        run(&program, &[&text(&programs)], &[])
    };
    // Each compiler has each standard and each mode of errors once.
    let results = ["-DP2M_NO_EXCEPTIONS", "-fno-exceptions"];
    for (c, cpp, is_first) in [("gcc", "g++", true), ("clang", "clang++", false)] {
        if output(c, &["--version"]).is_err() || output(cpp, &["--version"]).is_err() {
            skip(&format!("there is no {c} with {cpp} for the tests of the C interface"))?;
            continue;
        }
        test(c, "tests/c_api.c", &[&["-std=c11"], &SANITIZERS[..]].concat())?;
        let standards = if is_first { ["-std=c++17", "-std=c++20"] } else { ["-std=c++20", "-std=c++17"] };
        test(cpp, "tests/cpp_api.cpp", &[&[standards[0]], &SANITIZERS[..]].concat())?;
        test(cpp, "tests/cpp_api.cpp", &[&[standards[1]], &results[..], &SANITIZERS].concat())?;
        test(cpp, "examples/replacements.cpp", &[standards[0]])?;
    }
    for compiler in ["gcc", "clang"] {
        if output(compiler, &["--version"]).is_ok() {
            return compare(compiler, &libraries, &programs);
        }
    }
    Ok(())
}

/// Compares the answers of a C program, which has the static library, with those of Rust.
fn compare(compiler: &str, libraries: &Path, programs: &Path) -> Outcome {
    let [program, queries, rust, c] =
        ["answers", "queries.bin", "rust.bin", "c.bin"].map(|name| text(programs.join(name)));
    let (source, library) = (format!("{CRATE}/tests/answers.c"), text(libraries.join("libp2m.a")));
    let linked = [&source, &library, "-lm", "-lpthread", "-ldl", "-o", &program];
    run(compiler, &[&["-std=c11", "-O1"], &WARNINGS[..], &linked].concat(), &[])?;
    let (scene, count) = COMPARED;
    for backend in ["aabb", "p2m"] {
        run(&text(libraries.join("examples/answers")), &[scene, backend, count, &queries, &rust], &[])?;
        run(&program, &[scene, backend, &queries, &c], &[])?;
        let bytes = |path: &str| fs::read(path).map_err(|error| format!("{path}: {error}"));
        if bytes(&rust)? != bytes(&c)? {
            return Err(format!("{c} differs from {rust}: the answers of C are not those of Rust").into());
        }
        println!("{count} answers of \"{backend}\" in C are those of Rust");
    }
    [queries, rust, c].iter().try_for_each(fs::remove_file).map_err(|error| error.to_string().into())
}

/// Compares the header with what cbindgen makes, or says why it cannot. With `builds` it writes the header.
fn header(builds: bool) -> Outcome {
    let installs = builds || std::env::var_os("P2M_REQUIRE_TOOLS").is_some();
    let program = tools::program("cbindgen", CBINDGEN_VERSION, &[], installs)?;
    let made = text(target("p2m.h"));
    output(&program, &["--quiet", "--config", &format!("{CRATE}/cbindgen.toml"), "--output", &made, CRATE])?;
    compare_or_write(HEADER, &read(made)?, "cargo xtask c --build", builds)
}

/// Runs the fuzz target of the interface, with a library in which overflows are errors.
fn fuzz(seconds: &str) -> Outcome {
    cargo(&["build", "--profile", "test", "--locked", "--package", "p2m-c"], &[])?;
    let (libraries, corpus, program) = (text(target("debug")), target("c-corpus"), text(target("c-tests-fuzz")));
    make_folder(&corpus)?;
    let options = ["-g", "-O1", "-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=undefined"];
    let library = ["-L", &libraries, "-lp2m", "-lm", &format!("-Wl,-rpath,{libraries}")];
    let source = [&format!("{CRATE}/tests/fuzz.c"), "-o", &program];
    run("clang", &[&options[..], &WARNINGS, &source, &library].concat(), &[])?;
    run(&program, &[&format!("-max_total_time={seconds}"), "-max_len=4096", &text(corpus)], &[])
}
