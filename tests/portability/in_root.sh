#!/usr/bin/env bash
# Inside a root: see portability.sh. Everything that is said goes to /friction/*.log.
#
# Usage: in_root.sh COMPILER TAG RESULT
set -uo pipefail
compiler=$1
tag=$2
result=$3
cd /friction || exit 1

# The fenced block of README.md after the line that names it.
readme_command() {
  awk -v name="<!-- $1 command -->" '
    $0 == name {wanted = 1; next}
    wanted && /^```/ {if (inside) exit; inside = 1; next}
    inside' README.md
}

# Warnings of our sources, each once, in what a build has printed.
n_warnings() {
  cat "$@" |
    grep -E '(/friction/|^)(common|step-friction-..|tests)/[^ ]*: warning:|^cc1plus: warning|^CMake Warning' |
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
    >dealii.log 2>&1 || exit 1
  configured=no
  cmake -S . -B build/headers -G Ninja -DCMAKE_BUILD_TYPE=Debug \
    -DDEAL_II_DIR=/dealii-build -DFRICTION_PRECOMPILED_HEADERS=OFF \
    -DFRICTION_UNITY_BUILD=OFF \
    >configure.log 2>&1 && configured=yes
  # Not the one that the system has as well.
  grep -q '^deal.II_DIR:PATH=/dealii-build' build/headers/CMakeCache.txt || exit 1
  version=$(sed -n 's/.*DEAL_II_PACKAGE_VERSION "\([^"]*\)".*/\1/p' \
    /dealii-build/include/deal.II/base/config.h)
  checked=$(python3 -B tests/portability/check_syntax.py \
    build/headers/compile_commands.json 2>syntax.log)
  warnings=$(n_warnings syntax.log)
  echo "| $suite, headers | $(version_of_compiler) | $version | $configured | $warnings | – | syntax: $checked |" \
    >"$result"
  exit 0
fi

command=$(readme_command run | with_compiler)
configured=no
bash -euo pipefail -c "$command" >run.log 2>&1 && configured=yes
dealii=$(sed -n 's/.*DEAL_II_PACKAGE_VERSION "\([^"]*\)".*/\1/p' \
  "$(find /usr/include -path '*deal.II/base/config.h' | head -1)")

# What tests need, without browsers and pictures.
apt-get install -y --no-install-recommends make numdiff >>packages.log 2>&1

tables=
for scene in hertz:2d cylinder:3d; do
  name=${scene%:*}
  step=step-friction-${scene#*:}
  { cat $step/scenes/$name.prm
    printf 'subsection Output\n  set Times = false\nend\n'; } >$name.prm
  if sh tests/support/scene.sh build/release/bin/$step $name.prm \
    tests/portability/$name.output "$PWD/$name-results" 1 20 numdiff true \
    mpirun -np >$name.log 2>&1; then
    tables="$tables${tables:+, }$name"
  fi
done

command="cmake --preset debug &&
cmake --build --preset debug --target tests-quick"
bash -euo pipefail -c "$(echo "$command" | with_compiler)" >debug.log 2>&1
ctest --preset debug -L quick >quick.log 2>&1
quick=$(sed -n 's/^[0-9]*% tests passed, \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' quick.log |
  awk '{print $2 - $1 " of " $2}')
# The library as other programs get it.
sh tests/install/install.sh cmake build/release tests/install/program \
  "$(command -v "$compiler")" "$(sed -n 's/^project(friction VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)" \
  >install.log 2>&1 || quick="installed library FAILED, $quick"

echo "| $suite | $(version_of_compiler) | $dealii | $configured | $(n_warnings run.log debug.log) | ${tables:-none} | ${quick:-none} |" \
  >"$result"
