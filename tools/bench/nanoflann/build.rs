//! Compiles the adapter in C++, or explains what is missing.

fn main() {
    println!("cargo:rerun-if-changed=src/tree.cpp");
    let compiled = cc::Build::new()
        .cpp(true)
        .std("c++17")
        .flag_if_supported("-fno-math-errno")
        .opt_level(3)
        .file("src/tree.cpp")
        .try_compile("p2m_nanoflann");
    if let Err(error) = compiled {
        println!("cargo:error=the feature `nanoflann` needs a C++ compiler and the header nanoflann.hpp, which is in");
        println!("cargo:error=the package libnanoflann-dev of Debian: {error}");
    }
}
