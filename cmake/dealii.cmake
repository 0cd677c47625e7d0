# deal.II as one imported target, latcon::dealii, for latcon's build and for those who use its libraries. deal.II's own macro
# would add -g and a second set of optimisation flags to theirs. Takes latcon_dealii_target and latcon_dealii_definitions.

# The configuration leaves the imported libraries, and so all that they need at link time, to be read on demand.
include(${DEAL_II_TARGET_CONFIG})
set_target_properties(${latcon_dealii_target} PROPERTIES IMPORTED_GLOBAL TRUE)

add_library(latcon::dealii INTERFACE IMPORTED GLOBAL)
target_include_directories(latcon::dealii INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(latcon::dealii INTERFACE ${latcon_dealii_definitions})
target_link_libraries(latcon::dealii INTERFACE ${latcon_dealii_target})
