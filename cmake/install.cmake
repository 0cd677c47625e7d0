# Rules for `cmake --install`, for any prefix: installed files contain neither the prefix nor the source folder.
# There are three components: `runtime` (the program and its data), `development` (the libraries) and `python` (the Python package).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME runtime)
install(TARGETS latcon latcon_elements LIBRARY DESTINATION lib/latcon)
# verification/input/files.h looks for it.
foreach(folder cases studies paraview)
  install(DIRECTORY verification/${folder} DESTINATION share/latcon PATTERN __pycache__ EXCLUDE)
endforeach()
# Plots of the claims in the report.
file(GLOB files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/verification verification/claims/*/plots.py)
foreach(file IN LISTS files)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES verification/${file} DESTINATION share/latcon/${folder})
endforeach()
install(FILES README.md LICENSE CITATION.cff cmake/copyright DESTINATION share/doc/latcon)
# Manual page and completion are generated from the program's help. Debian requires compressed documents, with reproducible bits.
set(latcon_shell_files latcon.1.gz latcon.bash)
add_custom_command(OUTPUT ${latcon_shell_files}
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/shell_files.py $<TARGET_FILE:latcon> ${PROJECT_SOURCE_DIR}/verification .
  COMMAND gzip -9nf latcon.1
  DEPENDS latcon cmake/shell_files.py VERBATIM)
add_custom_command(OUTPUT changelog.gz COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > changelog.gz DEPENDS CHANGELOG.md VERBATIM)
add_custom_target(documents ALL DEPENDS ${latcon_shell_files} changelog.gz)
install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION share/doc/latcon)
install(FILES ${PROJECT_BINARY_DIR}/latcon.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PROJECT_BINARY_DIR}/latcon.bash DESTINATION share/bash-completion/completions RENAME latcon)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(latcon_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/latcon)
set_target_properties(latcon_support PROPERTIES EXPORT_NAME support)
set_target_properties(latcon_lattice PROPERTIES EXPORT_NAME lattice)
set_target_properties(latcon_continuum PROPERTIES EXPORT_NAME continuum)
install(TARGETS latcon_options latcon_support latcon_lattice latcon_continuum EXPORT latconTargets)
install(EXPORT latconTargets NAMESPACE latcon:: DESTINATION ${latcon_cmake_folder})
install(DIRECTORY support lattice continuum DESTINATION include/latcon FILES_MATCHING PATTERN "*.h" PATTERN "*.inc")
configure_package_config_file(cmake/latconConfig.cmake.in latconConfig.cmake INSTALL_DESTINATION ${latcon_cmake_folder})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(latconConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/latconConfig.cmake ${PROJECT_BINARY_DIR}/latconConfigVersion.cmake cmake/dealii.cmake
        DESTINATION ${latcon_cmake_folder})
install(DIRECTORY examples/own-laws DESTINATION share/doc/latcon-dev/examples)
install(FILES docs/library.md cmake/copyright ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION share/doc/latcon-dev)

# The program starts it for studies and reports, whatever package is installed beside it.
install(DIRECTORY python/latcon DESTINATION share/latcon/python COMPONENT runtime PATTERN __pycache__ EXCLUDE)
# Module path of Debian's interpreter below /usr.
install(DIRECTORY python/latcon DESTINATION lib/python3/dist-packages COMPONENT python PATTERN __pycache__ EXCLUDE)
install(FILES docs/python.md cmake/copyright ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION share/doc/python3-latcon COMPONENT python)
install(DIRECTORY examples/fit-fig1 DESTINATION share/doc/python3-latcon/examples COMPONENT python PATTERN __pycache__ EXCLUDE)
