# deal.II as one imported target, latcon::dealii, for latcon's build and for users of its libraries. deal.II's own macro
# would add -g and a second set of optimisation flags. Input: latcon_dealii_target and latcon_dealii_definitions.
# The configuration of deal.II defers the import of the libraries and of their link dependencies.
include(${DEAL_II_TARGET_CONFIG})
set_target_properties(${latcon_dealii_target} PROPERTIES IMPORTED_GLOBAL TRUE)

add_library(latcon::dealii INTERFACE IMPORTED GLOBAL)
target_include_directories(latcon::dealii INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(latcon::dealii INTERFACE ${latcon_dealii_definitions})
target_link_libraries(latcon::dealii INTERFACE ${latcon_dealii_target})
