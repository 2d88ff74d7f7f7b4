# Programs that tests run many times are loaded once: a program of deal.II's takes half a
# second of a processor to find its symbols in two hundred libraries, which is longer than
# many tests. A test load/<program> sees that it is up to date and begins a server
# (fork_server.cc), and what runs in the place of the program asks it for a copy
# (fork_client.cc), or, where there is no server, as in what is not a test, runs the program.
#
# Programs with sanitizers want these to be loaded before anything else, and on other
# systems and processors main() is called in other ways.
set(FORK_SERVER)
set(FORK_CLIENT)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT FRICTION_SANITIZERS AND
    CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|aarch64|arm64)$")
  set(FORK_SERVER sh ${CMAKE_CURRENT_LIST_DIR}/fork_server.sh $<TARGET_FILE:fork-server>)
  set(FORK_CLIENT ${CMAKE_BINARY_DIR}/tests/loaded/fork-client)

  set(_here ${CMAKE_CURRENT_LIST_DIR})
  add_library(fork-server SHARED ${_here}/fork_server.cc)
  target_link_libraries(fork-server ${CMAKE_DL_LIBS})
  add_executable(fork-client ${_here}/fork_client.cc)
  foreach(_target fork-server fork-client)
    deal_ii_setup_target(${_target})
    target_include_directories(${_target} PRIVATE ${PROJECT_SOURCE_DIR})
    set_target_properties(${_target} PROPERTIES
      RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests/loaded)
    add_dependencies(tests-quick ${_target})
  endforeach()
endif()

# load_once(program): LOADED_<program> is what runs in its place, a file like itself.
function(load_once program)
  set(LOADED_${program} $<TARGET_FILE:${program}> PARENT_SCOPE)
  if(FORK_SERVER)
    set(_file ${CMAKE_BINARY_DIR}/tests/loaded/${program})
    file(GENERATE OUTPUT ${_file}
      CONTENT "#!/bin/sh\nexec \"${FORK_CLIENT}\" \"$<TARGET_FILE:${program}>\" \"$@\"\n"
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
        WORLD_READ WORLD_EXECUTE)
    set(LOADED_${program} ${_file} PARENT_SCOPE)
    set_target_properties(${program} PROPERTIES LOADED ${_file})
    add_build_test(load/${program} ${program} LOADS)
    set_tests_properties(load/${program} PROPERTIES
      FIXTURES_SETUP loaded-${program}
      COST 3000)
  endif()
endfunction()

# runs_loaded(test program ...): of a test that uses LOADED_<program>.
function(runs_loaded test)
  foreach(_program ${ARGN})
    set_property(TEST ${test} APPEND PROPERTY FIXTURES_REQUIRED loaded-${_program})
  endforeach()
endfunction()
