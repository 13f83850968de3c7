"""Recipe for Conan 2: conan create bindings/c/recipes. It needs cargo."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy


class P2m(ConanFile):
    name = "p2m"
    version = "0.1.0"
    license = "MIT OR Apache-2.0"
    url = "https://github.com/p2m-rs/p2m"
    description = "Closest points of scenes of triangles, segments and points"
    settings = "os", "arch", "compiler", "build_type"

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..", "..")
        copy(self, "*", root, self.export_sources_folder, excludes=["target/*", ".git/*"])

    def generate(self):
        CMakeToolchain(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure(build_script_folder="bindings/c")
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE-*", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "p2m")]
        self.cpp_info.libs = ["p2m"]
