# Targets that are set up alike: with deal.II's flags and headers, and, in debug mode, with
# what most files include, parsed beforehand. That takes a minute, of which three quarters
# are spent on writing it, and as long as parsing it five times does: it pays for dozens of
# tests, and not for the few files of release mode.
option(FRICTION_PRECOMPILED_HEADERS
  "Parse the headers of deal.II once and not in each file, for 850 MB of disk"
  ${FRICTION_ASSERTIONS})

# friction_precompile(target library): the target takes the headers that were parsed
# for the library. It has to be compiled with the same flags.
function(friction_precompile target library)
  if(FRICTION_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${library})
  endif()
endfunction()

# friction_executable(target source ...): a program that uses the library.
function(friction_executable target)
  add_executable(${target} ${ARGN})
  deal_ii_setup_target(${target})
  target_link_libraries(${target} friction)
  friction_precompile(${target} friction)
endfunction()

# friction_step(name source): a step program. LOADED is what runs in its place in tests, see
# tests/support/load_once.cmake.
function(friction_step name source)
  friction_executable(${name} ${source})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin
    LOADED ${CMAKE_BINARY_DIR}/bin/${name})
endfunction()
