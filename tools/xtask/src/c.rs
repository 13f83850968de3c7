//! Checks the C interface: its header, C and C++ programs that use it, and that its answers are those of Rust.

use crate::python::text;
use crate::{Outcome, absolute_target_folder, build_for_tests, cargo, output, read, run, skip};
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
        [] => header(false)?,
        [argument] if argument == "--build" => return header(true),
        [argument, seconds] if argument == "--fuzz" => return fuzz(seconds),
        _ => return Err("the arguments of this task are --build, or --fuzz and a number of seconds".to_owned()),
    }
    if cfg!(windows) {
        return skip("the C interface is tested with gcc and clang");
    }
    build_for_tests()?;
    let target = absolute_target_folder()?;
    let (libraries, programs) = (target.join("debug"), target.join("c-tests"));
    fs::create_dir_all(&programs).map_err(|error| format!("{}: {error}", programs.display()))?;
    let library = ["-L", &text(&libraries)?, "-lp2m", "-lm", &format!("-Wl,-rpath,{}", text(&libraries)?)];
    let test = |compiler: &str, source: &str, options: &[&str]| {
        let program = text(&programs.join("test"))?;
        let source = format!("{CRATE}/{source}");
        run(compiler, &[options, &WARNINGS, &[&source, "-o", &program], &library].concat(), &[])?;
        run(&program, &[&text(&programs)?], &[])
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
    let file = |name: &str| text(&programs.join(name));
    let (program, queries, rust, c) = (file("answers")?, file("queries.bin")?, file("rust.bin")?, file("c.bin")?);
    let (source, library) = (format!("{CRATE}/tests/answers.c"), text(&libraries.join("libp2m.a"))?);
    let linked = [&source, &library, "-lm", "-lpthread", "-ldl", "-o", &program];
    run(compiler, &[&["-std=c11", "-O1"], &WARNINGS[..], &linked].concat(), &[])?;
    let (scene, count) = COMPARED;
    for backend in ["aabb", "p2m"] {
        run(&text(&libraries.join("examples/answers"))?, &[scene, backend, count, &queries, &rust], &[])?;
        run(&program, &[scene, backend, &queries, &c], &[])?;
        let bytes = |path: &str| fs::read(path).map_err(|error| format!("{path}: {error}"));
        if bytes(&rust)? != bytes(&c)? {
            return Err(format!("{c} differs from {rust}: the answers of C are not those of Rust"));
        }
        println!("{count} answers of \"{backend}\" in C are those of Rust");
    }
    [queries, rust, c].iter().try_for_each(|path| fs::remove_file(path).map_err(|error| format!("{path}: {error}")))
}

/// Compares the header with what cbindgen makes, or says why it cannot. With `builds` it writes the header.
fn header(builds: bool) -> Outcome {
    let folder = absolute_target_folder()?.join("cbindgen");
    let installed = text(&folder.join("bin/cbindgen"))?;
    let is_wanted = |program: &&str| {
        output(program, &["--version"]).is_ok_and(|version| version.trim() == format!("cbindgen {CBINDGEN_VERSION}"))
    };
    let found = ["cbindgen", &installed].into_iter().find(is_wanted);
    let installs = builds || std::env::var_os("P2M_REQUIRE_TOOLS").is_some();
    let program = match found {
        Some(program) => program,
        None if installs => {
            let install = ["install", "cbindgen", "--locked", "--version", CBINDGEN_VERSION, "--root"];
            cargo(&[&install[..], &[&text(&folder)?]].concat(), &[])?;
            &installed
        }
        None => return skip(&format!("there is no cbindgen {CBINDGEN_VERSION} (cargo xtask c --build installs it)")),
    };
    let made = text(&absolute_target_folder()?.join("p2m.h"))?;
    output(program, &["--quiet", "--config", &format!("{CRATE}/cbindgen.toml"), "--output", &made, CRATE])?;
    let made = read(Path::new(&made))?;
    if builds {
        return fs::write(HEADER, made).map_err(|error| format!("{HEADER}: {error}"));
    }
    if made == read(Path::new(HEADER))? {
        Ok(())
    } else {
        Err(format!("{HEADER} is not that of its sources: run `cargo xtask c --build`"))
    }
}

/// Runs the fuzz target of the interface, with a library in which overflows are errors.
fn fuzz(seconds: &str) -> Outcome {
    cargo(&["build", "--profile", "test", "--locked", "--package", "p2m-c"], &[])?;
    let target = absolute_target_folder()?;
    let (libraries, corpus) = (text(&target.join("debug"))?, target.join("c-corpus"));
    fs::create_dir_all(&corpus).map_err(|error| format!("{}: {error}", corpus.display()))?;
    let program = text(&target.join("c-tests-fuzz"))?;
    let options = ["-g", "-O1", "-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=undefined"];
    let library = ["-L", &libraries, "-lp2m", "-lm", &format!("-Wl,-rpath,{libraries}")];
    let source = [&format!("{CRATE}/tests/fuzz.c"), "-o", &program];
    run("clang", &[&options[..], &WARNINGS, &source, &library].concat(), &[])?;
    run(&program, &[&format!("-max_total_time={seconds}"), "-max_len=4096", &text(&corpus)?], &[])
}
