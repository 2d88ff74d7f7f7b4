# deal.II's own tests of a folder. Those on several processes run with Open MPI
# under root, too, and with more processes than a small machine has cores.
macro(pickup_tests)
  deal_ii_pickup_tests()
  get_property(_tests DIRECTORY PROPERTY TESTS)
  foreach(_test ${_tests})
    if(_test MATCHES "mpirun=")
      set_property(TEST ${_test} APPEND PROPERTY ENVIRONMENT
        "OMPI_ALLOW_RUN_AS_ROOT=1"
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"
        "OMPI_MCA_rmaps_base_oversubscribe=1")
    endif()
  endforeach()
endmacro()
