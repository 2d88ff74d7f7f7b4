# How everything here is compiled and linked: with the flags that deal.II was
# configured with, since its headers want the same language and its classes the
# same layout, but for optimisation, debug information, paths of the machine that
# built it, and the linker. To be included after project().
#
#   Debug     deal.II's assertions, and -O1: its own -O0 makes our part of the tests
#             several times slower, and finds nothing more
#   Release   -O2, and loops of few passes written out, as those over two or three
#             directions are: a sweep in 3D takes a sixth less time. deal.II's flags
#             unroll all others as well, which costs an eighth of the time of the
#             compiler and makes no sweep faster.
#
# Debug information makes libraries of 100 MB, and lines alone are a sixth of the time
# that compiling takes: it is there if asked for, and lines with sanitizers.
# FRICTION_ASSERTIONS says which of the two it is.
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(FRICTION_ASSERTIONS ON)
else()
  set(FRICTION_ASSERTIONS OFF)
endif()

include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)

option(FRICTION_DEBUG_INFO
  "Full debug information, for a debugger or a profiler" OFF)
set(FRICTION_SANITIZERS "" CACHE STRING
  "Sanitizers to compile and link with, separated by commas: address,undefined")

# Flags without those that match a pattern.
function(friction_drop_flags variable pattern)
  separate_arguments(_flags UNIX_COMMAND "${${variable}}")
  list(FILTER _flags EXCLUDE REGEX ${pattern})
  list(JOIN _flags " " _flags)
  set(${variable} "${_flags}" PARENT_SCOPE)
endfunction()

foreach(_variable DEAL_II_CXX_FLAGS DEAL_II_CXX_FLAGS_DEBUG DEAL_II_CXX_FLAGS_RELEASE)
  friction_drop_flags(${_variable} "^-g|^-O[0-9s]?g?$|^-funroll-|compress-debug-sections|prefix-map")
endforeach()
# deal.II may not want to hear of these of itself, but we do of us.
foreach(_variable DEAL_II_WARNING_FLAGS DEAL_II_CXX_FLAGS DEAL_II_CXX_FLAGS_DEBUG
    DEAL_II_CXX_FLAGS_RELEASE)
  friction_drop_flags(${_variable}
    "^-Wno-(deprecated-declarations|unused-parameter|unused-variable)$")
endforeach()
string(APPEND DEAL_II_CXX_FLAGS_DEBUG " -O1")
string(APPEND DEAL_II_CXX_FLAGS_RELEASE " -O2 -fpeel-loops")
# Library and programs alike, so that headers parsed for one suit the other.
if(NOT DEAL_II_CXX_FLAGS MATCHES "-fPIC")
  string(APPEND DEAL_II_CXX_FLAGS " -fPIC")
endif()
if(FRICTION_DEBUG_INFO)
  string(APPEND DEAL_II_CXX_FLAGS " -g")
elseif(FRICTION_SANITIZERS)
  # What they find, they say in which line.
  string(APPEND DEAL_II_CXX_FLAGS " -g1")
endif()

# Another compiler than deal.II's may not know all of its flags.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  foreach(_variable DEAL_II_WARNING_FLAGS DEAL_II_CXX_FLAGS
      DEAL_II_CXX_FLAGS_DEBUG DEAL_II_CXX_FLAGS_RELEASE)
    separate_arguments(_flags UNIX_COMMAND "${${_variable}}")
    set(_known)
    foreach(_flag ${_flags})
      string(MAKE_C_IDENTIFIER "FRICTION_FLAG${_flag}" _name)
      set(CMAKE_REQUIRED_FLAGS "-Werror")
      set(CMAKE_REQUIRED_QUIET TRUE)
      check_cxx_compiler_flag(${_flag} ${_name})
      unset(CMAKE_REQUIRED_FLAGS)
      if(${_name})
        list(APPEND _known ${_flag})
      endif()
    endforeach()
    list(JOIN _known " " ${_variable})
  endforeach()
endif()

if(FRICTION_SANITIZERS)
  set(_sanitizers
    "-fsanitize=${FRICTION_SANITIZERS} -fno-sanitize-recover=undefined -fno-omit-frame-pointer")
  # Both look into the same memory, and only one of them can be there.
  friction_drop_flags(DEAL_II_CXX_FLAGS "FORTIFY_SOURCE")
  string(APPEND DEAL_II_CXX_FLAGS " ${_sanitizers}")
  string(APPEND DEAL_II_LINKER_FLAGS " ${_sanitizers}")
endif()

# A distribution may have linked deal.II with a linker that it does not install along
# with it. Besides, deal.II asks for some two hundred libraries: mold links a program
# with them in half a second, gold in one or two, and GNU ld in a minute, unless it is
# told not to find out which of them are needed.
set(_recorded)
if(DEAL_II_LINKER_FLAGS MATCHES "-fuse-ld=([^ ]+)")
  set(_recorded ${CMAKE_MATCH_1})
  friction_drop_flags(DEAL_II_LINKER_FLAGS "^-fuse-ld=")
endif()
set(CMAKE_REQUIRED_QUIET TRUE)
set(_linkers mold lld ${_recorded} gold)
foreach(_linker ${_linkers})
  unset(FRICTION_LINKER_${_linker} CACHE) # it may have come or gone
  set(CMAKE_REQUIRED_LINK_OPTIONS -fuse-ld=${_linker})
  check_cxx_source_compiles("int main() {}" FRICTION_LINKER_${_linker})
  if(NOT FRICTION_LINKER_${_linker})
    list(REMOVE_ITEM _linkers ${_linker})
  endif()
endforeach()
unset(CMAKE_REQUIRED_LINK_OPTIONS)
unset(CMAKE_REQUIRED_QUIET)
if(_linkers)
  list(GET _linkers 0 _linker)
  set(FRICTION_LINKER_FLAG -fuse-ld=${_linker})
else()
  set(_linker "the compiler's own")
  set(FRICTION_LINKER_FLAG -Wl,--no-as-needed)
endif()
string(APPEND DEAL_II_LINKER_FLAGS " ${FRICTION_LINKER_FLAG}")
if(_recorded AND NOT FRICTION_LINKER_${_recorded})
  message(STATUS
    "deal.II was linked with ${_recorded}, which does not work here; going on with ${_linker}.")
endif()

# Whether two functions of deal.II have the same name for this compiler as in deal.II's
# library: see common/parallel/trilinos_symbols.cc.
set(FRICTION_TRILINOS_SYMBOLS)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # deal.II 9.4 defines its targets only when they are asked for.
  if(DEAL_II_TARGET_CONFIG AND NOT DEAL_II_TARGET_CONFIG_INCLUDED)
    include(${DEAL_II_TARGET_CONFIG})
    set(DEAL_II_TARGET_CONFIG_INCLUDED TRUE)
  endif()
  set(_deal_ii dealii::dealii_release)
  if(NOT TARGET ${_deal_ii})
    set(_deal_ii ${DEAL_II_TARGET_RELEASE})
  endif()
  set(CMAKE_REQUIRED_LIBRARIES ${_deal_ii})
  set(CMAKE_REQUIRED_INCLUDES ${DEAL_II_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_FLAGS "${DEAL_II_CXX_FLAGS}")
  set(CMAKE_REQUIRED_LINK_OPTIONS ${FRICTION_LINKER_FLAG})
  set(_declarations "
    #include <deal.II/lac/dynamic_sparsity_pattern.h>
    #include <deal.II/lac/la_parallel_vector.h>
    #include <deal.II/lac/trilinos_sparse_matrix.h>
    using namespace dealii;
    void call(TrilinosWrappers::SparseMatrix &A, const IndexSet &rows,
              const DynamicSparsityPattern &pattern,
              LinearAlgebra::distributed::Vector<double> &x)")
  # The first one has to be there, or there is something else that cannot be linked.
  foreach(_call "CLEAR:A.clear()"
      "REINIT:A.reinit(rows, rows, pattern, MPI_COMM_WORLD, false)"
      "VMULT:A.vmult(x, x)")
    string(REGEX REPLACE ":.*" "" _name ${_call})
    string(REGEX REPLACE "^[^:]*:" "" _call ${_call})
    check_cxx_source_compiles("${_declarations} {${_call};} int main() {}"
      FRICTION_HAS_TRILINOS_${_name})
    if(FRICTION_HAS_TRILINOS_CLEAR AND NOT FRICTION_HAS_TRILINOS_${_name})
      list(APPEND FRICTION_TRILINOS_SYMBOLS FRICTION_DEFINE_TRILINOS_${_name})
    endif()
  endforeach()
  foreach(_variable LIBRARIES INCLUDES FLAGS LINK_OPTIONS)
    unset(CMAKE_REQUIRED_${_variable})
  endforeach()
endif()
