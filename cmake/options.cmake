# Compile options that hold for every target of latcon: one interface target, linked by all.
add_library(latcon_options INTERFACE)
target_include_directories(latcon_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(latcon_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc takes uninitialised lanes of Eigen's SSE packets for a mistake.
  target_compile_options(latcon_options INTERFACE -Wno-maybe-uninitialized)
endif()
# Contraction to fused multiply-add would make the bits of a result depend on the instruction set.
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

# deal.II as one interface target. Its own macro would add -g and a second set of optimisation flags to ours.
add_library(latcon_dealii INTERFACE)
target_include_directories(latcon_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(latcon_dealii INTERFACE ${DEAL_II_USER_DEFINITIONS})
if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR LATCON_AUDIT)
  target_compile_definitions(latcon_dealii INTERFACE ${DEAL_II_USER_DEFINITIONS_DEBUG})
  target_link_libraries(latcon_dealii INTERFACE ${DEAL_II_TARGET_DEBUG})
else()
  target_link_libraries(latcon_dealii INTERFACE ${DEAL_II_TARGET_RELEASE})
endif()

# The libraries behind deal.II make linking the slowest step; lld takes a tenth of the time of the default linker.
add_link_options(-fuse-ld=lld)
