# A port for vcpkg, which has not been run: vcpkg install p2m --overlay-ports=bindings/c/recipes
# SHA512 is that of the archive of the release.
vcpkg_from_github(OUT_SOURCE_PATH source REPO p2m-rs/p2m REF "v${VERSION}" SHA512 0)
vcpkg_cmake_configure(SOURCE_PATH "${source}/bindings/c")
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/p2m)
vcpkg_fixup_pkgconfig()
# Neither the files of the package nor the library differ for debugging.
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug")
set(VCPKG_POLICY_MISMATCHED_NUMBER_OF_BINARIES enabled)
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE-MIT" "${source}/LICENSE-APACHE")
