# Every shipped scene of a step program runs in a test, on one process and on
# several. What shortens the run is in NAME.overrides: lines like those of a command
# (without semicolons, which separate lists of CMake), and comments.
#
# Not one of deal.II's own parameter file tests, since those would compare
# numbers of cycles to the last one; BOUND is what they must not exceed. Scenes that stop
# when they are as exact as their mesh go on here, so that runs on several processes can
# be compared to ten digits, and by cycles also where contact nodes alone are quicker.
function(add_scene_tests PROGRAM BOUND)
  file(GLOB _scenes CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${PROGRAM}/scenes/*.prm)
  foreach(_scene ${_scenes})
    get_filename_component(_name ${_scene} NAME_WE)
    set(_overrides_file ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.overrides)
    if(NOT EXISTS ${_overrides_file} OR
        NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.output)
      message(FATAL_ERROR "The scene ${_scene} has no test: write "
        "${_overrides_file} and ${_name}.output.")
    endif()
    file(STRINGS ${_overrides_file} _overrides REGEX "^[^#]")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${_overrides_file})

    foreach(_n 1 2 4)
      set(_test ${PROGRAM}/${_name})
      set(_give_way ${GIVE_WAY})
      if(_n GREATER 1)
        set(_test ${_test}.mpirun=${_n})
        set(_give_way)
      endif()
      add_test(NAME ${_test}
        COMMAND ${_give_way} sh ${CMAKE_SOURCE_DIR}/tests/support/scene.sh
          ${LOADED_${PROGRAM}}
          ${_scene}
          ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.output
          ${CMAKE_CURRENT_BINARY_DIR}/${_name}
          ${_n}
          ${BOUND}
          ${NUMDIFF_EXECUTABLE}
          $<TARGET_FILE:compare_histories>
          ${DEAL_II_MPIEXEC} ${DEAL_II_MPIEXEC_NUMPROC_FLAG}
          "Solver/Inner tolerance=1e-9"
          "Solver/Condensation=where cycles are many"
          ${_overrides})
      set(_label quick)
      if(_n GREATER 1)
        set(_label full)
      endif()
      label_test(${_test} LABEL ${_label} PROCESSES ${_n})
      runs_loaded(${_test} ${PROGRAM})
      set_property(TEST ${_test} APPEND PROPERTY ENVIRONMENT PYTHON=${FRICTION_PYTHON})
      # Those on several processes wait for those on one.
      if(_n EQUAL 1)
        set_tests_properties(${_test} PROPERTIES
          FIXTURES_SETUP ${PROGRAM}.${_name})
      else()
        set_property(TEST ${_test} APPEND PROPERTY FIXTURES_REQUIRED
          ${PROGRAM}.${_name})
      endif()
    endforeach()

    # Under sanitizers, which end a program as soon as they find anything, besides as
    # it is shipped.
    if(FRICTION_SANITIZERS)
      foreach(_n 1 2)
        set(_test ${PROGRAM}/${_name}.shipped)
        set(_launch)
        if(_n GREATER 1)
          set(_test ${_test}.mpirun=${_n})
          set(_launch ${DEAL_II_MPIEXEC} ${DEAL_II_MPIEXEC_NUMPROC_FLAG} ${_n})
        endif()
        add_test(NAME ${_test}
          COMMAND ${_launch} $<TARGET_FILE:${PROGRAM}> ${_scene}
            Output/Directory=${CMAKE_CURRENT_BINARY_DIR}/${_name}-shipped-${_n})
        label_test(${_test} LABEL shipped PROCESSES ${_n})
        set_tests_properties(${_test} PROPERTIES TIMEOUT 3600)
      endforeach()
    endif()
  endforeach()
endfunction()
