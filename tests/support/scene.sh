#!/bin/sh
# The step program on a scene: its console output must be the expected one, and
# the output directory must hold complete files. Numbers of cycles are only
# compared with a bound, and rates not at all: they depend on the order of nodes
# and on rounding.
#
# Usage: scene.sh PROGRAM SCENE EXPECTED NUMDIFF CYCLES
program=$1
scene=$2
expected=$3
numdiff=$4
cycles=$5

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

"$program" "$scene" "Output/Directory=$work/results" >"$work/output" 2>&1
status=$?
cat "$work/output"
if [ $status -ne 0 ]; then
  echo "FAILED: status $status"
  exit 1
fi

awk -v bound="$cycles" '
  /^level/ && NF == 9 {print $1, $2, $3, $4, $5, $6, $7, $9; next}
  NF == 9 && $1 ~ /^[0-9]+$/ {
    print $1, $2, $3, $4, $5, $6, ($7 <= bound ? "few" : $7), $9
    next
  }
  /exact to/ {sub(/energy norm [^,]*,/, "rounding,")}
  {print}' "$work/output" >"$work/table"

# Energies may be small numbers: what counts is the relative difference.
if ! "$numdiff" -a 1e-13 -r 2e-6 -s ' \t\r\n=,:;<>[](){}^' \
  "$expected" "$work/table" >"$work/difference"; then
  echo "FAILED: not as expected"
  cat "$work/difference"
  exit 1
fi

for file in history.h5 body.pvd contact.pvd; do
  if [ ! -s "$work/results/$file" ]; then
    echo "FAILED: there is no $file"
    exit 1
  fi
done
if [ -n "$(find "$work/results" -name '*.part*')" ]; then
  echo "FAILED: half-written files are left"
  exit 1
fi
