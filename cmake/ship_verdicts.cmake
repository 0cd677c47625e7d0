# Run by `cpack` on what it is about to pack: verdicts on the shipped materials, by the packed program, so that their first
# crack need not wait for its claims (verification/claims/verdict_store.h). Elsewhere they serve where the
# libraries that the program loads have the same names, as those of a Debian release have.
file(GLOB programs ${CPACK_TEMPORARY_DIRECTORY}/*${CPACK_PACKAGING_INSTALL_PREFIX}/bin/latcon)
if(NOT programs)
  message(FATAL_ERROR "No program below ${CPACK_TEMPORARY_DIRECTORY}")
endif()
foreach(program IN LISTS programs)
  cmake_path(GET program PARENT_PATH prefix)
  cmake_path(GET prefix PARENT_PATH prefix)
  set(data ${prefix}/share/latcon)
  set(scratch ${CPACK_TEMPORARY_DIRECTORY}-verdicts)
  foreach(case quick start fig1 fig1-wide spectrum)
    execute_process(
      COMMAND ${CMAKE_COMMAND} -E env XDG_CACHE_HOME=${scratch} ${program} gate ${case} --quiet
              --output-dir ${scratch}/${case}
      OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE code)
    if(NOT code EQUAL 0)
      message(FATAL_ERROR "The packed program cannot verify ${case}:\n${log}")
    endif()
  endforeach()
  file(GLOB verdicts ${scratch}/latcon/verdicts/*.json)
  file(COPY ${verdicts} DESTINATION ${data}/verdicts
       FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ
       DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  file(REMOVE_RECURSE ${scratch})
endforeach()
