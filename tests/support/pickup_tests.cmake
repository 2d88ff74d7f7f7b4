# What ctest -L can choose from. Each test has one of these labels, and the name of
# its folder:
#
#   quick      the mathematics of every part, on one and two processes, and the scenes
#              on small meshes, on one
#   full       what takes longer: more processes, solvers on finer meshes and of hard
#              problems, histories, bad input
#
# and in trees in release mode only, whose programs are those that a user has:
#
#   optimised  what is seen on fine meshes only, runs that are killed, files that are
#              damaged, inputs at random, pictures, installing
#   studies    figures, charts and benchmarks, on tiny meshes
#   pages      prose, commands of pages, pages in a browser
#
# Besides there are build, what makes the programs of tests, or sees that they are up to
# date, before these tests, and, with sanitizers, shipped, every scene as it is shipped.
#
# deal.II itself sets a property LABEL, which ctest does not know.

# Open MPI starts under root as well, and more processes than there are cores (one
# word for Open MPI 5, one for earlier ones). All of them are on one machine, so that
# it need not look for a network, which may take a second, and complain if there is
# none: ob1 sends through the memory that processes share, and the others are not
# tried, one of which sleeps for a fifth of a second in each start. Whether a process
# that waits gives its processor away is left to Open MPI, which lets it where there are
# more processes than processors. Where there are not, such a process would starve
# beside any other test that computes (184 seconds instead of 9 for newton_solver on
# two processes). To later versions the last word is deprecated; the one before tells
# them not to say so in the output of each test.
set(FRICTION_MPI_ENVIRONMENT
  OMPI_ALLOW_RUN_AS_ROOT=1
  OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  OMPI_MCA_btl=^tcp,ofi
  OMPI_MCA_pml=ob1
  OMPI_MCA_rmaps_base_oversubscribe=1
  PMIX_MCA_mca_base_suppress_deprecated_warning=1
  PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe)

# Where there are three places for tests on two processors, one on two processes would
# hardly ever find two places free at once, and in the end run alone. So there it needs
# one, but a lock, too, which only one of them has. Tests of deal.II's kind and of scenes,
# those on one process, run beside it, and give way to it. On more than two processes a test
# has the machine for itself: processes that wait give their processors away then, and would
# do so to others as well.
cmake_host_system_information(RESULT FRICTION_PROCESSORS QUERY NUMBER_OF_LOGICAL_CORES)
set(GIVE_WAY)
if(FRICTION_PROCESSORS LESS 4)
  set(GIVE_WAY sh ${CMAKE_CURRENT_LIST_DIR}/give_way.sh)
endif()

# needs_processes(name n): of a test.
function(needs_processes name n)
  if(n EQUAL 2 AND FRICTION_PROCESSORS LESS 4)
    set_property(TEST ${name} APPEND PROPERTY RESOURCE_LOCK processes)
    set_tests_properties(${name} PROPERTIES PROCESSORS 1)
  else()
    set_tests_properties(${name} PROPERTIES PROCESSORS ${n})
  endif()
endfunction()

# label_test(name LABEL label [PROCESSES n] [BUILDS]): a test that was added already. Its
# folder is the part of its name before the first slash. On more than two processes it is
# never quick. If it builds something in this tree, only make can do so several times at
# once.
function(label_test name)
  cmake_parse_arguments(_test "BUILDS" "LABEL;PROCESSES" "" ${ARGN})
  if(NOT _test_PROCESSES)
    set(_test_PROCESSES 1)
  endif()
  if(_test_PROCESSES GREATER 2 AND _test_LABEL STREQUAL "quick")
    set(_test_LABEL full)
  endif()
  string(REGEX REPLACE "/.*" "" _folder ${name})
  set(_labels ${_test_LABEL} ${_folder})
  list(REMOVE_DUPLICATES _labels)
  set_tests_properties(${name} PROPERTIES
    LABELS "${_labels}"
    TIMEOUT ${TEST_TIME_LIMIT})
  set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT
    ${FRICTION_MPI_ENVIRONMENT})
  needs_processes(${name} ${_test_PROCESSES})
  if(_test_BUILDS AND NOT CMAKE_GENERATOR MATCHES "Makefiles")
    set_property(TEST ${name} APPEND PROPERTY RESOURCE_LOCK build_tree)
  endif()
  # What takes long and one processor begins early, or it would have the other
  # processors wait in the end.
  if(NOT _test_LABEL STREQUAL "quick" AND _test_PROCESSES EQUAL 1)
    set_tests_properties(${name} PROPERTIES COST 100)
  endif()
  # And one on two processes before all of them, so that there are always others beside
  # it. (Before that ctest begins what others need, whatever it costs.)
  if(_test_PROCESSES EQUAL 2)
    set_tests_properties(${name} PROPERTIES COST 200)
  endif()
endfunction()

# The programs of all quick tests, and those that the tests of release mode need.
add_custom_target(tests-quick)
add_dependencies(tests-quick step-friction-2d step-friction-3d)
if(NOT FRICTION_ASSERTIONS)
  add_custom_target(tests-optimised)
  add_dependencies(tests-optimised step-friction-2d step-friction-3d)
endif()

# only_for_tests(target): built with all others in debug mode only.
function(only_for_tests target)
  if(NOT FRICTION_ASSERTIONS)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endfunction()

# friction_test_program(target source ...): a program that tests need.
function(friction_test_program target)
  friction_executable(${target} ${ARGN})
  only_for_tests(${target})
  add_dependencies(tests-quick ${target})
endfunction()

# add_build_test(name target [LOADS]): a test that makes a program, and loads it, before
# those that need it. Not even make can do so several times at once where what is to be made
# is the same, like the library.
function(add_build_test name target)
  set(_load)
  if(ARGN AND FORK_SERVER)
    set(_load ${FORK_SERVER} $<TARGET_FILE:${target}>)
    add_dependencies(${target} fork-client fork-server)
  endif()
  add_test(NAME ${name}
    COMMAND ${_load}
      ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target ${target} --parallel 2)
  label_test(${name} LABEL build)
  set_tests_properties(${name} PROPERTIES
    RESOURCE_LOCK build_tree
    TIMEOUT 3600
    COST 1000)
endfunction()

# friction_study_program(target source ...): one that studies need, in release mode.
function(friction_study_program target)
  friction_executable(${target} ${ARGN})
  set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  add_dependencies(tests-optimised ${target})
endfunction()

# friction_tests_program(target [ALONE] source ...): one that runs tests of deal.II's kind,
# each by its name, see test.h. In debug mode it is built with all others, otherwise when a
# test wants it. deal.II's macro makes a program for each test, unless it is there: here
# it is, as a file. A test of its own, build/<target>, makes the file, or sees that it is up
# to date, before all others that need it: make takes half a second for that, as long as many
# of them. If the program is not alone, it also loads it, see load_once.cmake. deal.II's
# targets <test>.test, called by hand, do not make the program. For pickup_tests(), which says
# what the category is.
function(friction_tests_program target)
  cmake_parse_arguments(_test "ALONE" "" "" ${ARGN})
  set(_sources ${_test_UNPARSED_ARGUMENTS})
  friction_executable(${target} ${_sources})
  target_link_libraries(${target} test-main ${TEST_LIBRARIES})
  target_compile_definitions(${target} PRIVATE SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
  set_target_properties(${target} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
    UNITY_BUILD ${FRICTION_UNITY_BUILD}
    UNITY_BUILD_BATCH_SIZE 8)
  only_for_tests(${target})
  string(TOLOWER ${CMAKE_BUILD_TYPE} _mode)
  foreach(_source ${_sources})
    string(REPLACE ".cc" "" _name ${_source})
    set(_program ${_category}.${_name}.${_mode})
    add_executable(${_program} IMPORTED)
    set_target_properties(${_program} PROPERTIES
      IMPORTED_LOCATION ${CMAKE_CURRENT_BINARY_DIR}/${target})
  endforeach()
  if(_test_ALONE)
    add_build_test(build/${target} ${target})
  else()
    add_build_test(build/${target} ${target} LOADS)
  endif()
  set_tests_properties(build/${target} PROPERTIES FIXTURES_SETUP ${target})
endfunction()

# pickup_tests([OPTIMISED] [FULL name ...] [ALONE name ...]): deal.II's tests of a folder,
# which are one program, but for those that are alone, since they replace functions of the
# system; their program has their name, like output-checkpoint. Those after FULL have that
# label, the others quick, and all of them optimised if it says so.
function(pickup_tests)
  cmake_parse_arguments(_pickup "OPTIMISED" "" "FULL;ALONE" ${ARGN})
  get_filename_component(_category ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  file(GLOB _outputs RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS *.output)
  list(TRANSFORM _outputs REPLACE "\\..*" "")
  list(REMOVE_DUPLICATES _outputs)
  foreach(_name ${_pickup_ALONE})
    if(NOT _name IN_LIST _outputs)
      message(FATAL_ERROR "There is no test ${_name} in ${CMAKE_CURRENT_SOURCE_DIR}.")
    endif()
  endforeach()
  set(_sources)
  set(_programs ${_category}-tests)
  foreach(_name ${_outputs})
    set(_prefix ${GIVE_WAY} env FRICTION_TEST=${_name})
    if(_name IN_LIST _pickup_ALONE)
      friction_tests_program(${_category}-${_name} ALONE ${_name}.cc)
      list(APPEND _programs ${_category}-${_name})
    else()
      list(APPEND _sources ${_name}.cc)
      list(APPEND _prefix ${FORK_CLIENT})
    endif()
    set(${_category}_${_name}_RUNARGS_PREFIX ${_prefix})
  endforeach()
  friction_tests_program(${_category}-tests ${_sources})
  # deal.II's macro pads the category, for its messages.
  set(_folder ${_category})
  deal_ii_pickup_tests()

  set(_found)
  set(_is_quick OFF)
  get_property(_tests DIRECTORY PROPERTY TESTS)
  foreach(_test ${_tests})
    # Others of this folder have theirs.
    get_test_property(${_test} LABELS _labels)
    if(_labels)
      continue()
    endif()
    # Since 9.5 deal.II builds a program that several tests need in a test of its own,
    # test_dependency/<folder>.<test>.<mode>; others are <folder>/<test>.<mode>.
    string(REGEX REPLACE "^(test_dependency/[^.]*\\.|[^/]*/)([^.]*)\\..*" "\\2" _name ${_test})
    set(_program ${_folder}-tests)
    if(_name IN_LIST _pickup_ALONE)
      set(_program ${_folder}-${_name})
    endif()
    set_property(TEST ${_test} APPEND PROPERTY FIXTURES_REQUIRED ${_program})
    if(_test MATCHES "^test_dependency/")
      label_test(${_test} LABEL build BUILDS)
      continue()
    endif()
    set(_label quick)
    if(_pickup_OPTIMISED)
      set(_label optimised)
    elseif(_name IN_LIST _pickup_FULL)
      set(_label full)
      list(APPEND _found ${_name})
    else()
      set(_is_quick ON)
    endif()
    set(_processes 1)
    if(_test MATCHES "mpirun=([0-9]+)")
      set(_processes ${CMAKE_MATCH_1})
    endif()
    label_test(${_test} LABEL ${_label} PROCESSES ${_processes} BUILDS)
    # A single process of Open MPI 4 starts a daemon, unless it is told that it will
    # not want others. Programs beside it would have the same directory then.
    if(_processes EQUAL 1)
      string(MAKE_C_IDENTIFIER ${_test} _directory)
      set(_directory ${CMAKE_CURRENT_BINARY_DIR}/files_of_mpi/${_directory})
      file(MAKE_DIRECTORY ${_directory})
      set_property(TEST ${_test} APPEND PROPERTY ENVIRONMENT
        OMPI_MCA_ess_singleton_isolated=1 TMPDIR=${_directory})
    endif()
  endforeach()
  foreach(_name ${_pickup_FULL})
    if(NOT _name IN_LIST _found AND NOT TEST_PICKUP_REGEX)
      message(FATAL_ERROR "There is no test ${_name} in ${CMAKE_CURRENT_SOURCE_DIR}.")
    endif()
  endforeach()

  if(_pickup_OPTIMISED)
    add_dependencies(tests-optimised ${_programs})
  elseif(_is_quick)
    add_dependencies(tests-quick ${_programs})
  endif()
endfunction()
