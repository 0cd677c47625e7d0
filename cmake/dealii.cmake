# deal.II as one imported target, latcon::dealii, for latcon's build and for users of its libraries. deal.II's own macro
# would add -g and a second set of optimisation flags. Input: latcon_dealii_target and latcon_dealii_definitions.
# The configuration of deal.II defers the import of the libraries and of their link dependencies.
include(${DEAL_II_TARGET_CONFIG})
set_target_properties(${latcon_dealii_target} PROPERTIES IMPORTED_GLOBAL TRUE)

add_library(latcon::dealii INTERFACE IMPORTED GLOBAL)
target_include_directories(latcon::dealii INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(latcon::dealii INTERFACE ${latcon_dealii_definitions})
target_link_libraries(latcon::dealii INTERFACE ${latcon_dealii_target})

# A program that links deal.II loads about 200 libraries, and the loader searches them, in the order in which the program names
# them, for each of 300 000 symbols: most of the time before main. The libraries that define most of these symbols come first,
# although latcon itself does not use all of them; a start takes 0.2 s less, of 0.7 s. Sanitizers have to be first themselves.
if(NOT LATCON_SANITIZE)
  get_target_property(latcon_dealii_needs ${latcon_dealii_target} INTERFACE_LINK_LIBRARIES)
  set(latcon_dealii_first "")
  foreach(name gmsh TKSTEPBase trilinos_teuchosparameterlist TKBO TKIGES TKGeomAlgo TKMath TKernel TKXSBase TKSTEPAttr TKG3d
               TKGeomBase TKSTEP TKTopAlgo TKBRep TKBool trilinos_epetra trilinos_ml trilinos_ifpack TKShHealing TKMesh TKFillet)
    set(library ${latcon_dealii_needs})
    list(FILTER library INCLUDE REGEX "/lib${name}[.]so$")
    list(APPEND latcon_dealii_first ${library})
  endforeach()
  if(latcon_dealii_first)
    list(JOIN latcon_dealii_first "," latcon_dealii_first)
    # One option, since CMake removes repeated ones.
    target_link_options(latcon::dealii INTERFACE
      "LINKER:--push-state,--no-as-needed,$<TARGET_FILE:${latcon_dealii_target}>,${latcon_dealii_first},--pop-state")
  endif()
endif()
