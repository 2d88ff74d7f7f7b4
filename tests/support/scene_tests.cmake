# Compares results of one process with those of several.
if(NOT TARGET compare_histories)
  add_executable(compare_histories EXCLUDE_FROM_ALL
    ${CMAKE_SOURCE_DIR}/tests/support/compare_histories.cc)
  deal_ii_setup_target(compare_histories)
  add_test(NAME support/compare_histories.build
    COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target compare_histories)
  set_tests_properties(support/compare_histories.build PROPERTIES
    LABELS support FIXTURES_SETUP compare_histories TIMEOUT ${TEST_TIME_LIMIT})
endif()

# Every shipped scene of a step program runs in a test, on one process and on
# several: NAME.prm.in is the shipped file, put in place of @scene_NAME@, and
# after it what shortens the run.
#
# Not one of deal.II's own parameter file tests, since those would compare
# numbers of cycles to the last one; BOUND is what they must not exceed.
function(add_scene_tests PROGRAM BOUND)
  file(GLOB _scenes CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${PROGRAM}/scenes/*.prm)
  foreach(_scene ${_scenes})
    get_filename_component(_name ${_scene} NAME_WE)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.prm.in)
      message(FATAL_ERROR "The scene ${_scene} has no test: write "
        "${CMAKE_CURRENT_SOURCE_DIR}/${_name}.prm.in and ${_name}.output.")
    endif()
    file(READ ${_scene} scene_${_name})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${_scene})
    configure_file(${_name}.prm.in ${_name}.prm @ONLY)

    add_test(NAME ${PROGRAM}/${_name}
      COMMAND sh ${CMAKE_SOURCE_DIR}/tests/support/scene.sh
        $<TARGET_FILE:${PROGRAM}>
        ${CMAKE_CURRENT_BINARY_DIR}/${_name}.prm
        ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.output
        ${NUMDIFF_EXECUTABLE}
        ${BOUND}
        $<TARGET_FILE:compare_histories>
        ${DEAL_II_MPIEXEC} ${DEAL_II_MPIEXEC_NUMPROC_FLAG}
        1 2 4)
    set_tests_properties(${PROGRAM}/${_name} PROPERTIES
      LABELS ${PROGRAM} FIXTURES_REQUIRED compare_histories
      TIMEOUT ${TEST_TIME_LIMIT})
  endforeach()
endfunction()
