# Compile options of latcon. Those of latcon_options apply to users of the libraries as well, the warnings do not.
set(latcon_warnings -Wall -Wextra -Wpedantic)
# Names of another source that is compiled together with one are not hidden by it.
if(NOT CMAKE_UNITY_BUILD)
  list(APPEND latcon_warnings -Wshadow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc warns about uninitialised lanes of Eigen's SSE packets.
  list(APPEND latcon_warnings -Wno-maybe-uninitialized)
  # Memory is not collected below 1 GB: a twentieth of the time.
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()
add_compile_options(${latcon_warnings})

get_filename_component(latcon_root ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
add_library(latcon_options INTERFACE)
target_include_directories(latcon_options INTERFACE $<BUILD_INTERFACE:${latcon_root}> $<INSTALL_INTERFACE:include/latcon>)
target_compile_features(latcon_options INTERFACE cxx_std_17)
# Contraction to fused multiply-add would make results depend on the instruction set. This includes a user's laws, and inline
# functions compiled into a user's program.
target_compile_options(latcon_options INTERFACE -ffp-contract=off)
# Libraries are part of the program and of the modules that it and Python load. Their functions are not replaced by others of the
# same name, so that they cost no more for it.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
add_compile_options(-fno-semantic-interposition)

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
