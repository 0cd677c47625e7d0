# Generates headers in the build folder that record the source and the compiler of a build.
#
# latcon_build_facts(TARGET) adds two headers to TARGET:
#   latcon_build_facts.h   version, compiler, flags, versions of libraries; written when CMake configures
#   latcon_git_commit.h    the commit; determined at every build, rewritten only when it has changed, so that only the sources
#                          that include it are recompiled
# The second half of this file determines the commit; it is run by `cmake -P` with SOURCE and HEADER.

if(CMAKE_SCRIPT_MODE_FILE AND SOURCE AND HEADER)
  cmake_minimum_required(VERSION 3.25)
  set(commit "unknown")
  find_program(git git)
  if(git)
    # A hook or a caller may point git at another repository.
    set(in_source ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE --unset=GIT_INDEX_FILE ${git} --no-optional-locks -C ${SOURCE})
    # Not empty if an unpacked archive is inside another project's checkout.
    execute_process(COMMAND ${in_source} rev-parse --show-prefix
      RESULT_VARIABLE failed OUTPUT_VARIABLE prefix ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed AND prefix STREQUAL "")
      # The hash without tags, and a suffix if tracked files have changed.
      execute_process(COMMAND ${in_source} describe --always --abbrev=40 --dirty "--exclude=*"
        RESULT_VARIABLE failed OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
      if(NOT failed AND described MATCHES "^[0-9a-f]+(-dirty)?$")
        set(commit "${described}")
      endif()
    endif()
  endif()
  file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define LATCON_GIT_COMMIT \"@commit@\"\n" @ONLY)
  return()
endif()

set(latcon_git_commit_script ${CMAKE_CURRENT_LIST_FILE})

# The options of a target as one line.
function(latcon_options_of target property result)
  get_target_property(options ${target} ${property})
  if(NOT options)
    set(options "")
  endif()
  list(JOIN options " " options)
  set(${result} "${options}" PARENT_SCOPE)
endfunction()

function(latcon_build_facts target)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/build_facts)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  latcon_options_of(latcon_options INTERFACE_COMPILE_OPTIONS own)
  latcon_options_of(latcon_lattice COMPILE_OPTIONS lattice)
  list(JOIN latcon_warnings " " warnings)
  string(REGEX REPLACE " +" " " flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${warnings} ${own}")
  string(STRIP "${flags}" flags)
  file(CONFIGURE OUTPUT ${folder}/latcon_build_facts.h @ONLY CONTENT
"#define LATCON_VERSION \"@PROJECT_VERSION@\"
#define LATCON_COMPILER \"@CMAKE_CXX_COMPILER_ID@ @CMAKE_CXX_COMPILER_VERSION@\"
#define LATCON_BUILD_TYPE \"@CMAKE_BUILD_TYPE@\"
#define LATCON_FLAGS R\"(@flags@)\"
#define LATCON_LATTICE_FLAGS R\"(@lattice@)\"
#define LATCON_VTK_VERSION \"@VTK_VERSION@\"
#define LATCON_DEALII_VERSION \"@DEAL_II_VERSION@\"
#define LATCON_TRILINOS_VERSION \"@DEAL_II_TRILINOS_VERSION@\"
#define LATCON_EIGEN_VERSION \"@Eigen3_VERSION@\"
#define LATCON_P4EST_VERSION \"@DEAL_II_P4EST_VERSION@\"
")
  add_custom_target(latcon_git_commit
    COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D HEADER=${folder}/latcon_git_commit.h -P ${latcon_git_commit_script}
    BYPRODUCTS ${folder}/latcon_git_commit.h
    COMMENT "Commit of the sources" VERBATIM)
  add_dependencies(${target} latcon_git_commit)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
