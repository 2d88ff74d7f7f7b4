# Targets that are set up alike: with deal.II's flags and headers, and with what
# most files include, parsed beforehand.
#
# In a tree in debug mode library and programs exist a second time, optimised:
# friction-optimised, step-friction-2d-optimised and step-friction-3d-optimised.
# Studies and pages run these in any tree. In release mode they are other names.
option(FRICTION_PRECOMPILED_HEADERS
  "Parse the headers of deal.II once and not in each file: a build in 60 % of the time, for 800 MB of disk"
  ON)

# friction_precompile(target library): the target takes the headers that were parsed
# for the library. It has to be compiled with the same flags.
function(friction_precompile target library)
  if(FRICTION_PRECOMPILED_HEADERS)
    get_target_property(_aliased ${library} ALIASED_TARGET)
    if(_aliased)
      set(library ${_aliased})
    endif()
    target_precompile_headers(${target} REUSE_FROM ${library})
  endif()
endfunction()

# friction_executable(target [OPTIMISED] source ...): a program
# that uses the library.
function(friction_executable target)
  cmake_parse_arguments(_program "OPTIMISED" "" "" ${ARGN})
  set(_library friction)
  set(_kind)
  if(_program_OPTIMISED)
    set(_library friction-optimised)
    set(_kind RELEASE)
  endif()
  add_executable(${target} ${_program_UNPARSED_ARGUMENTS})
  deal_ii_setup_target(${target} ${_kind})
  target_link_libraries(${target} ${_library})
  friction_precompile(${target} ${_library})
endfunction()

# friction_step(name source): a step program, for the build tree and optimised.
function(friction_step name source)
  friction_executable(${name} ${source})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    friction_executable(${name}-optimised OPTIMISED ${source})
    set_target_properties(${name}-optimised PROPERTIES
      OUTPUT_NAME ${name}
      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin/optimised)
  else()
    add_executable(${name}-optimised ALIAS ${name})
  endif()
endfunction()
