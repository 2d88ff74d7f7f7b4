#!/bin/sh
# What can only be wrong in three dimensions: each case ends with status 2 and
# one sentence that names the entry, and leaves no file behind. All the rest is
# in step-friction-2d/bad_input.sh.
#
# Usage: bad_input.sh PROGRAM SCENES_3D SCENES_2D
program=$1
scenes=$2
scenes_2d=$3

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

# refused PATTERN SCENE OVERRIDES...
refused() {
  pattern=$1
  shift
  "$program" "$@" Output/Directory=results >stdout 2>stderr
  status=$?
  if [ $status -eq 2 ] && [ ! -e results/history.h5 ] &&
    [ "$(wc -l <stderr)" -eq 1 ] &&
    grep -q "^step-friction-3d: .*$pattern.*[.?]$" stderr; then
    echo "ok      $pattern"
  else
    echo "FAILED  $pattern: status $status"
    cat stdout stderr
    failures=$((failures + 1))
  fi
  rm -rf results
}

refused "step-friction-2d" "$scenes_2d/block.prm"
refused "three-dimensional\|two dimensions\|step-friction-2d" "$scenes_2d/hertz.prm"
refused "Obstacle/Axes" "$scenes/cylinder.prm" "Obstacle/Axes=0, 0, 1"
refused "Scene/Size" "$scenes/block.prm" "Scene/Size=1, 1"
refused "Ignore prescribed penetration" "$scenes/cylinder.prm" \
  "Contact/Ignore prescribed penetration=false"
refused "Local solver" "$scenes/block.prm" "Solver/Local solver=Newton"
refused "Coarse grid" "$scenes/cylinder.prm" "Scene/Coarse grid=two cells"
[ $failures -eq 0 ]
