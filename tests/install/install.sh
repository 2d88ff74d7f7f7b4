#!/bin/sh
# What is installed works on its own: a program of thirty lines is built against it
# in an empty place and solves a scene, and the installed step program says which
# version it is and solves the same scene with the same result; the installed programs
# that verify and draw runs do so, the latter as well with a sweep of its own.
#
# Usage: install.sh CMAKE BUILD_TREE PROGRAM_SOURCES CXX_COMPILER VERSION
cmake=$1
build=$2
sources=$3
compiler=$4
version=$5

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

# Moved afterwards, so that nothing can depend on where it was.
"$cmake" --install "$build" --prefix "$work/first" >"$work/log" 2>&1 ||
  { cat "$work/log"; fail "nothing can be installed"; }
mv "$work/first" "$work/prefix"

cp -r "$sources" "$work/program"
# Besides, a file with every header that is installed: all that they include is there.
(cd "$work/prefix/include/friction" && find common -name '*.h' | sort |
  sed 's/.*/#include <&>/') >"$work/program/headers.cc"
echo 'target_sources(block PRIVATE headers.cc)' >>"$work/program/CMakeLists.txt"
{
  "$cmake" -S "$work/program" -B "$work/build" \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" &&
    "$cmake" --build "$work/build" -j 2
} >"$work/log" 2>&1 || { cat "$work/log"; fail "the program cannot be built"; }
grep -q "warning:" "$work/log" && { cat "$work/log"; fail "there are warnings"; }

scene=$work/prefix/share/friction/step-friction-2d/scenes/block.prm
outside=$("$work/build/block" "$scene") || fail "the program does not run"
echo "$outside"

for name in step-friction-3d step-friction-2d; do
  step=$work/prefix/bin/$name
  said=$("$step" --version) || fail "the installed $name does not run"
  echo "$said"
  case $said in
  "$name $version "*) ;;
  *) fail "--version does not begin with $name $version" ;;
  esac
done

# The fourth and fifth column of the only row: contact, sticky.
row=$(cd "$work" && "$step" "$scene" "Refinement/Initial refinements=4" \
  Refinement/Levels=0 Output/Times=false Output/Directory=run \
  Output/Verification=true | awk '$1 == 0 {print $4, $5}')
[ "$outside" = "${row% *} nodes in contact, ${row#* } of them stick, solved" ] ||
  fail "the step program finds $row"

# Without h5py it says in one sentence what is missing.
said=$("$work/prefix/bin/friction-verify" "$work/run" 2>&1)
status=$?
echo "$said" | tail -1
case $status,$said in
0,*"is confirmed on 1 level."* | 2,*"has no module"*) ;;
*) fail "the installed program does not confirm the run" ;;
esac

said=$("$work/prefix/bin/friction-plot" "$work/run" 2>&1)
status=$?
echo "$said" | tail -1 | sed "s|$work/||"
case $status,$said in
0,*) [ -s "$work/run/picture.png" ] || fail "there is no picture" ;;
2,*"has no module"*) echo "No picture and no sweep: there is no matplotlib." && exit 0 ;;
*) fail "the installed program does not draw the run" ;;
esac
(cd "$work" && "$work/prefix/bin/friction-plot" sweep "$scene" Refinement/Levels=0 \
  "Refinement/Initial refinements=3" Output/Fields=false \
  --set "Contact/Friction coefficient" 0.1 0.5) || fail "there is no sweep"
