#!/usr/bin/env bash
# Inside a root: see portability.sh. Everything that is said goes to /friction/*.log.
#
# Usage: in_root.sh COMPILER TAG RESULT
set -uo pipefail
compiler=$1
tag=$2
result=$3
cd /friction || exit 1

# What a row says that is not as it should be, with the reason in its last cell.
reason=
because() {
  reason="$reason${reason:+; }$*"
}

# Where a log says first that something is wrong, for a cell of the row.
first_error() {
  grep -m1 -E '(^|[^a-zA-Z-])([Ee]rror|ERROR|FAILED)|^E: ' "$1" | tr '|' ' '
}

# Warnings of our sources, each once, in what a build has printed.
n_warnings() {
  cat "$@" |
    grep -E '(/friction/|^)(common|step-friction-..|tests)/[^ ]*: warning:|^(cc1plus|clang|g\+\+|ld|mold|/usr/bin/)[^ ]*: warning|^CMake (Deprecation )?Warning' |
    sort -u | tee warnings.log | wc -l
}

suite="Debian $(cut -d. -f1 /etc/debian_version)"
[[ $suite == *sid* ]] && suite="Debian unstable"

# Another compiler than the default one takes a word in each command.
package=
if [ "$compiler" != g++ ]; then
  package=${compiler/clang++/clang}
fi
with_compiler() {
  if [ -n "$package" ]; then
    sed "s/--no-install-recommends/& $package/; s/^cmake --preset [a-z]*/& -DCMAKE_CXX_COMPILER=$compiler/"
  else
    cat
  fi
}
version_of_compiler() {
  case $compiler in
  clang*) echo "Clang $($compiler --version | sed -n '1s/.*version \([0-9.]*\).*/\1/p')" ;;
  *) echo "GCC $($compiler -dumpfullversion)" ;;
  esac
}

if [ -n "$tag" ]; then
  {
    apt-get update &&
      apt-get install -y --no-install-recommends cmake ninja-build g++ python3 \
        mold libdeal.ii-dev libeigen3-dev numdiff
  } >packages.log 2>&1
  cmake -S /dealii -B /dealii-build -G Ninja -DDEAL_II_WITH_MPI=ON \
    -DDEAL_II_WITH_P4EST=ON -DDEAL_II_WITH_TRILINOS=ON -DDEAL_II_WITH_HDF5=ON \
    -DHDF5_DIR="/usr/lib/$(gcc -dumpmachine)/hdf5/openmpi" \
    -DDEAL_II_WITH_MUPARSER=ON -DDEAL_II_COMPONENT_EXAMPLES=OFF \
    >dealii.log 2>&1 || because "deal.II cannot be configured"
  configured=yes
  lists=
  for mode in Debug Release; do
    cmake -S . -B build/headers-$mode -G Ninja -DCMAKE_BUILD_TYPE=$mode \
      -DDEAL_II_DIR=/dealii-build -DFRICTION_UNITY_BUILD=OFF \
      -DFRICTION_PRECOMPILED_HEADERS=ON \
      >>configure.log 2>&1 || configured=no
    lists="$lists build/headers-$mode/compile_commands.json"
    # Not the one that the system has as well.
    grep -q '^deal.II_DIR:PATH=/dealii-build' build/headers-$mode/CMakeCache.txt || {
      configured=no
      because "another deal.II was found"
    }
    # Without them the check takes three times as long.
    cmake --build build/headers-$mode \
      --target common/CMakeFiles/friction.dir/cmake_pch.hxx.gch >>configure.log 2>&1 ||
      because "the precompiled header cannot be compiled"
  done
  version=$(sed -n 's/.*DEAL_II_PACKAGE_VERSION "\([^"]*\)".*/\1/p' \
    /dealii-build/include/deal.II/base/config.h)
  # One word for each list.
  # shellcheck disable=SC2086
  checked=$(python3 -B tests/portability/check_syntax.py $lists \
    tests/install/program/block.cc 2>syntax.log) ||
    because "$(grep -m1 'error:' syntax.log | tr '|' ' ')"
  warnings=$(n_warnings configure.log syntax.log)
  echo "| $suite, headers | $(version_of_compiler) | $version | $configured | $warnings | – | syntax: $checked | $reason |" \
    >"$result"
  exit 0
fi

command=$(.ci/readme-command run | with_compiler)
configured=no
bash -euo pipefail -c "$command" >run.log 2>&1 && configured=yes ||
  because "$(first_error run.log)"
dealii=$(sed -n 's/.*DEAL_II_PACKAGE_VERSION "\([^"]*\)".*/\1/p' \
  "$(find /usr/include -path '*deal.II/base/config.h' | head -1)")

# The command for tests, word for word but for the label. Before they are run, all that the
# other tests need is built, warned of and linked.
tests=$(.ci/readme-command test)
command="$(echo "$tests" | sed '$d')
cmake --preset release &&
cmake --build --preset release --target tests-optimised"
bash -euo pipefail -c "$(echo "$command" | with_compiler)" >debug.log 2>&1 ||
  because "$(first_error debug.log)"
bash -c "$(echo "$tests" | tail -1) -L quick" >quick.log 2>&1

tables=
for scene in hertz:2d cylinder:3d; do
  name=${scene%:*}
  step=step-friction-${scene#*:}
  if sh tests/support/scene.sh build/release/bin/$step $step/scenes/$name.prm \
    tests/portability/$name.output "$PWD/$name-results" 1 20 numdiff true \
    mpirun -np Output/Times=false >$name.log 2>&1; then
    tables="$tables${tables:+, }$name"
  fi
done

# What only builds is no test: fixtures of ours, and from 9.5 on of deal.II.
quick=$(awk '/^ *[0-9]+\/[0-9]+ Test +#/ && !/: (build|load|test_dependency)\// {n++; passed += / Passed /}
  END {if (n) print passed + 0 " of " n}' quick.log)
failed=$(sed -n 's/^[^0-9]*[0-9]* - \([^ ]*\) (.*/\1/p' quick.log | head -3 | tr '\n' ' ')
[ -z "$failed" ] || because "failed: $failed"
# The library as other programs get it.
sh tests/install/install.sh cmake build/release tests/install/program \
  "$(command -v "$compiler")" "$(sed -n 's/^project(friction VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)" \
  >install.log 2>&1 || because "the installed library: $(grep -m1 FAILED install.log)"

# Where deal.II was linked with mold, and mold is not there, CMake says so, and the
# library and programs that use it can be linked all the same.
if grep -q 'fuse-ld=mold' "$(find /usr/share /usr/lib -name deal.IIConfig.cmake | head -1)"; then
  apt-get remove -y mold >>packages.log 2>&1
  cmake --preset release -B build/no-mold ${package:+-DCMAKE_CXX_COMPILER=$compiler} \
    >no-mold.log 2>&1
  grep -q 'deal.II was linked with mold, which does not work here' no-mold.log ||
    because "CMake does not say that mold is missing"
  cmake --build build/no-mold --target step-friction-2d >>no-mold.log 2>&1 ||
    because "cannot be built without mold"
fi

echo "| $suite | $(version_of_compiler) | $dealii | $configured | $(n_warnings run.log debug.log) | ${tables:-none} | ${quick:-none} | $reason |" \
  >"$result"
