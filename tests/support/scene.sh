#!/bin/sh
# The step program on a scene: its console output must be the expected one,
# whatever the number of processes, and the output directory must hold complete
# files. Numbers of cycles are only compared with a bound, and rates not at all:
# they depend on the order of nodes and on rounding. The numbers in history.h5 of
# several processes are compared with those of one, energies to ten digits.
#
# Usage: scene.sh PROGRAM SCENE EXPECTED NUMDIFF CYCLES COMPARE MPIEXEC NUMPROC_FLAG N...
program=$1
scene=$2
expected=$3
numdiff=$4
cycles=$5
compare=$6
mpiexec=$7
numproc_flag=$8
shift 8

# Open MPI: under root, and with more processes than cores.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

for n in "$@"; do
  results=$work/results-$n
  echo "$n process(es):"
  if [ "$n" -eq 1 ]; then
    "$program" "$scene" "Output/Directory=$results" >"$work/output" 2>&1
  else
    "$mpiexec" "$numproc_flag" "$n" "$program" "$scene" \
      "Output/Directory=$results" >"$work/output" 2>&1
  fi
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
    if [ ! -s "$results/$file" ]; then
      echo "FAILED: there is no $file"
      exit 1
    fi
  done
  if [ -n "$(find "$results" -name '*.part*')" ]; then
    echo "FAILED: half-written files are left"
    exit 1
  fi

  if [ "$n" -ne 1 ] &&
    ! "$compare" "$work/results-1/history.h5" "$results/history.h5" "$n"; then
    exit 1
  fi
done
