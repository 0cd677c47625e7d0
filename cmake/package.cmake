# Debian packages by `cpack` in the build folder: latcon, the program, latcon-dev, the libraries, and python3-latcon, the Python
# package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The latcon developers <latcon@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME latcon)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "The program: it simulates cracks in stretched rubber on a triangular lattice
of bonds, compares it with the finite element continuum that it approximates,
and runs a crack only once the two agree.")
# Libraries, and the Python modules of studies and of the report.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libjs-dygraphs, python3, python3-jinja2, python3-matplotlib, python3-numpy, python3-pil, python3-scipy, python3-vtk9")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "libopenblas0-pthread, openmpi-bin")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "paraview")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME latcon-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "The libraries: headers, static libraries and CMake targets, for programs that
give the lattice a bond law, or the continuum a material or gradient law, of
their own.")
# Dependencies of latconConfig.cmake.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libdeal.ii-dev, libeigen3-dev, libhwy-dev, libopenmpi-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "latcon, cmake")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-latcon)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The Python package: it runs latcon and reads its results as numbers with
uncertainties, tables and arrays.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "latcon (= ${PROJECT_VERSION}), python3, python3-numpy, python3-pandas")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-matplotlib, python3-vtk9, python3-xarray")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-optuna, python3-scipy, python3-tqdm")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/ship_verdicts.cmake)
include(CPack)
