#!/bin/sh
# The step program on a scene: its console output must be the expected one,
# whatever the number of processes, and the output directory must hold complete
# files. Numbers of cycles are only compared with a bound, and rates not at all:
# they depend on the order of nodes and on rounding; so does the number of solutions
# where forces are given, which together may take twice as many, or four times on
# the first mesh, where nothing is known. The numbers in history.h5 of
# several processes are compared with those that one process has left in
# RESULTS-1, energies to ten digits. A program that shares no code with the one that
# is run, tests/verify/friction_verify.py, confirms the certificate of every level.
#
# Usage: scene.sh PROGRAM SCENE EXPECTED RESULTS N CYCLES NUMDIFF COMPARE MPIEXEC \
#          NUMPROC_FLAG [OVERRIDES...]
#
# PYTHON in the environment: see find_python.sh.
program=$1
scene=$2
expected=$3
results=$4-$5
alone=$4-1
n=$5
cycles=$6
numdiff=$7
compare=$8
mpiexec=$9
shift 9
numproc_flag=$1
shift

rm -rf "$results"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# A program on one process starts no daemon of Open MPI 4, which takes longer than many
# of these runs; for its files it has a directory of its own.
on_one_process()
{
  OMPI_MCA_ess_singleton_isolated=1 TMPDIR="$work" "$@"
}

if [ "$n" -eq 1 ]; then
  on_one_process "$program" "$scene" "Output/Directory=$results" Output/Verification=true "$@" \
    >"$work/output" 2>&1
else
  "$mpiexec" "$numproc_flag" "$n" "$program" "$scene" \
    "Output/Directory=$results" Output/Verification=true "$@" >"$work/output" 2>&1
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
    one = $6 == 1
    print $1, $2, $3, $4, $5, (one ? 1 : "several"),
      ($7 <= (one ? 1 : $1 == 0 ? 4 : 2) * bound ? "few" : $7), $9
    next
  }
  /^Peak pressure/ {next}
  /They balance to/ {
    for (i = 1; i < NF; ++i)
      if ($i == "balance" && $(i + 2) + 0 <= 1e-6) $(i + 2) = "rounding"
  }
  /exact to/ {sub(/energy norm [^,]*,/, "rounding,")}
  / took [0-9]+ cycles?\.$/ {sub(/took [0-9]+ cycles?/, "took some cycles")}
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

if [ "$n" -ne 1 ]; then
  on_one_process "$compare" "$alone/history.h5" "$results/history.h5" "$n" || exit 1
fi

python=$(sh "$(dirname "$0")/find_python.sh")
if [ -z "$python" ]; then
  echo "not verified: there is no python3 with h5py"
else
  "$python" -B "$(dirname "$0")/../verify/friction_verify.py" "$results" || exit 1
fi
