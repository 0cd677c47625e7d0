# Compile options of latcon. Those of latcon_options hold for whoever uses the libraries as well, the warnings do not.
set(latcon_warnings -Wall -Wextra -Wpedantic -Wshadow -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc takes uninitialised lanes of Eigen's SSE packets for a mistake.
  list(APPEND latcon_warnings -Wno-maybe-uninitialized)
endif()
add_compile_options(${latcon_warnings})

add_library(latcon_options INTERFACE)
target_include_directories(latcon_options INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/latcon>)
target_compile_features(latcon_options INTERFACE cxx_std_17)
# Contraction to fused multiply-add would make the bits of a result depend on the instruction set. A user's laws are part of
# the result, and so are the functions that headers bring into a user's program.
target_compile_options(latcon_options INTERFACE -ffp-contract=off)

if(LATCON_SANITIZE)
  target_compile_options(latcon_options INTERFACE -fsanitize=${LATCON_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(latcon_options INTERFACE -fsanitize=${LATCON_SANITIZE})
endif()
if(LATCON_FUZZ)
  target_compile_options(latcon_options INTERFACE -O1 -gline-tables-only)
  target_compile_definitions(latcon_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(LATCON_AUDIT)
  target_compile_options(latcon_options INTERFACE -UNDEBUG)
  target_compile_definitions(latcon_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()

# deal.II's debug build checks what it is given; programs must not mix it with the other.
set(latcon_dealii_target ${DEAL_II_TARGET_RELEASE})
set(latcon_dealii_definitions ${DEAL_II_USER_DEFINITIONS})
if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR LATCON_AUDIT)
  set(latcon_dealii_target ${DEAL_II_TARGET_DEBUG})
  list(APPEND latcon_dealii_definitions ${DEAL_II_USER_DEFINITIONS_DEBUG})
endif()
include(cmake/dealii.cmake)

# The libraries behind deal.II make linking the slowest step; lld takes a tenth of the time of the default linker.
add_link_options(-fuse-ld=lld)
