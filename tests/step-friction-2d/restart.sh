#!/bin/sh
# A run that is killed again and again, and continued: no file is damaged in
# between, and in the end table and files are those of a run that was left alone.
#
# Usage: restart.sh PROGRAM LOADED SCENE LAST_LEVEL BOUND N [MPIEXEC NUMPROC_FLAG]
#
# LOADED: what runs in the place of the program where it is left alone. BOUND: by how
# much the number of cycles on a level may differ. N: number of processes; without MPIEXEC,
# or for N = 1, the program is called directly. In the environment OVERRIDE may have an
# entry that is to be different in the scene, and TOLERANCE the relative difference that
# histories, and numbers of cells and of degrees of freedom, may have then.
program=$1
loaded=$2
scene=$3
last=$4
bound=$5
n=$6
mpiexec=$7
numproc_flag=$8
tests=$(cd "$(dirname "$0")/.." && pwd)

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

# A file that grows beyond all measure is an error, too; in blocks of 512 bytes.
ulimit -f 1000000

# Some python that can read what we write; without one, files are not looked at.
python=$(sh "$tests/support/find_python.sh")

# verdict NAME PROBLEM: an empty problem is none.
verdict()
{
  if [ -z "$2" ]; then
    echo "ok      $1"
  else
    echo "FAILED  $1:$2"
    for file in stdout stderr; do
      echo "  $file:"
      sed 's/^/    /' $file
    done
    failures=$((failures + 1))
  fi
}

# run PROCESSES DIRECTORY ARGUMENTS...: until it ends.
run()
{
  run_program "$loaded" "$@"
}

# run_program PROGRAM PROCESSES DIRECTORY ARGUMENTS...: until it ends or is killed.
run_program()
{
  executable=$1
  processes=$2
  directory=$3
  shift 3
  set -- "$executable" "$scene" "Output/Directory=$directory" \
    Output/Checkpoint=true Output/Format=hdf5 Output/Times=false \
    Output/Verification=true \
    ${OVERRIDE:+"$OVERRIDE"} "$@"
  [ "$processes" -gt 1 ] && set -- "$mpiexec" "$numproc_flag" "$processes" "$@"
  "$@" >stdout 2>stderr
  status=$?
}

# The processes of the program, but not their launcher. Nothing is started for those
# of others, since what is to be killed goes on meanwhile.
processes_in()
{
  for process in /proc/[0-9]*; do
    [ "$process/exe" -ef "$program" ] &&
      tr '\0' '\n' <"$process/cmdline" 2>/dev/null |
      grep -q -x "Output/Directory=$1" && echo "${process#/proc/}"
  done
}

# check_files NAME DIRECTORY [--unfinished]
check_files()
{
  [ -n "$python" ] || { echo "skipped $1: no python3 with h5py"; return; }
  problem=
  "$python" -B "$tests/output/check_results.py" "$2" $3 >message 2>&1 ||
    problem=" $(tail -1 message)"
  verdict "$1" "$problem"
}

# check_certificate NAME DIRECTORY: by the program that shares no code with this one.
# On one and two processes, which is enough: what it reads is the same on more.
check_certificate()
{
  [ "$n" -le 2 ] || return
  [ -n "$python" ] || { echo "skipped $1: no python3 with h5py"; return; }
  problem=
  "$python" -B "$tests/verify/friction_verify.py" "$2" >message 2>&1 ||
    problem=" $(tail -1 message)"
  verdict "$1" "$problem"
}

# The table without its header and remarks.
table()
{
  grep '^ *[0-9]* ' "$1"
}

run "$n" "$work/whole" "Refinement/Levels=$last"
cp stdout whole.txt
problem=
[ $status -eq 0 ] || problem=" status $status"
[ -d "whole/checkpoint-0$last" ] || problem="$problem no checkpoint"
[ -d "whole/checkpoint-0$((last - 1))" ] || problem="$problem only one"
[ "$(find whole -name 'checkpoint*' -prune | wc -l)" -eq 2 ] ||
  problem="$problem old checkpoints"
verdict 'a run that is left alone' "$problem"
check_files 'files of a run that is left alone' whole

# Killed when it has written a checkpoint, a little later each time. A run may be
# faster than we are: one that has not been killed at all is begun anew.
restart=
kills=0
level=1
runs=0
while [ "$kills" -eq 0 ] || [ "$level" -lt "$last" ]; do
  if [ -d "killed/checkpoint-0$last" ]; then
    [ "$kills" -eq 0 ] || break
    rm -rf killed
    restart=
    level=1
  fi
  # A run that does not get to its next checkpoint fails below, when it is left alone.
  runs=$((runs + 1))
  [ "$runs" -le 40 ] || break
  processes=$n
  # Once with fewer processes.
  [ "$kills" -eq 1 ] && processes=$(((n + 1) / 2))
  run_program "$program" "$processes" "$work/killed" "Refinement/Levels=$last" $restart &
  launched=$!
  while kill -0 $launched 2>/dev/null &&
    [ ! -d "killed/checkpoint-0$level" ]; do
    sleep 0.002
  done
  sleep "0.0$level"
  # All of them at once, or one of them, which leaves the others in the middle of
  # something that they do together until mpirun ends them.
  victims=$(processes_in "$work/killed")
  [ $((kills % 2)) -eq 1 ] && victims=${victims##* }
  [ -n "$victims" ] && kill -9 $victims 2>/dev/null && kills=$((kills + 1))
  wait $launched 2>/dev/null
  newest=$(find killed -name 'checkpoint-0[0-9]' | sort | tail -1)
  problem=
  [ -n "$newest" ] || problem=' no checkpoint'
  verdict "killed, with ${newest:-nothing}" "$problem"
  check_files 'files of a run that was killed' killed --unfinished
  [ -n "$newest" ] || break
  level=$((${newest#killed/checkpoint-0} + 1))
  restart=--restart
done
problem=
[ $kills -gt 0 ] || problem=' always too late'
verdict "killed $kills times" "$problem"

# What a run leaves that is killed while it writes a checkpoint.
mkdir -p killed/checkpoint.part killed/checkpoint-99.part
echo half >killed/checkpoint.part/record
echo half >killed/checkpoint-99.part/record

run "$n" "$work/killed" "Refinement/Levels=$last" --restart
problem=
[ $status -eq 0 ] || problem=" status $status"
table stdout >killed.txt
# Runs that stop early have indicators that differ a little, and may refine some cells
# more or less in the body. Contact nodes, and which of them stick, are the same.
table whole.txt | paste - killed.txt | awk -v bound="$bound" -v sizes="${TOLERANCE:-0}" '
  {
    if (NF != 18) { print "rows"; next }
    for (i = 1; i <= 6; ++i)
    {
      difference = $i - $(i + 9)
      allowed = i == 2 || i == 3 ? sizes * $i : 0
      if (difference > allowed || -difference > allowed)
        print "column", i, "of level", $1
    }
    if ($7 - $16 > bound || $16 - $7 > bound) print "cycles of level", $1
    if (($9 - $18)^2 > (1e-5 * $9)^2) print "energy of level", $1
  }' >differences
[ "$(table whole.txt | wc -l)" -eq $((last + 1)) ] || problem="$problem rows"
[ -s differences ] && problem="$problem $(tr '\n' ',' <differences)"
verdict 'a run that was killed and continued' "$problem"
check_files 'files of a run that was continued' killed --unfinished
check_certificate 'certificate of a run that was continued' killed

if [ -n "$python" ]; then
  problem=
  tolerance=${TOLERANCE:-1e-5}
  "$python" - $tolerance >message 2>&1 <<'END' || problem=" $(tail -1 message)"
import sys

import h5py
import numpy as np

tolerance = float(sys.argv[1])

with h5py.File("whole/history.h5") as a, h5py.File("killed/history.h5") as b:
    for key in a["levels"]:
        if key.endswith("seconds") or key in ("cycles", "contraction",
                                              "certificate",
                                              "algebraic_error"):
            continue
        # As numbers that have a sign, for the sake of differences.
        x, y = (h["levels"][key][()].astype(float) for h in (a, b))
        assert x.shape == y.shape, key
        # An error is a difference of values, each of which has the tolerance;
        # total forces have that of the normal one.
        size = np.abs(x)
        if key.endswith("_error") and key != "estimated_error":
            value = key.removesuffix("_error").replace("tangential", "normal")
            size = np.abs(a["levels"][value][()])
        assert np.all(np.abs(x - y) <= 1e-9 + tolerance * size), key
    assert sum(b["levels/cycles"]) == len(b["cycles/level"])
    assert list(a["contact"]) == list(b["contact"])
    for level in a["contact"]:
        x, y = a["contact"][level], b["contact"][level]
        assert np.array_equal(x["point"], y["point"]), level
        assert np.array_equal(x["state"], y["state"]), level
        force = np.abs(x["force"][()]).max()
        assert np.abs(x["force"][()] - y["force"][()]).max() < tolerance * force
END
  verdict 'histories' "$problem"
fi

# A run that has finished can be given one more level.
run "$n" "$work/killed" "Refinement/Levels=$((last + 1))" --restart
problem=
[ $status -eq 0 ] || problem=" status $status"
[ "$(table stdout | wc -l)" -eq $((last + 2)) ] || problem="$problem rows"
[ -d "killed/checkpoint-0$((last + 1))" ] || problem="$problem no checkpoint"
ls killed/checkpoint*.part >/dev/null 2>&1 && problem="$problem left-overs"
verdict 'one more level' "$problem"
check_files 'files of one more level' killed --unfinished
check_certificate 'certificate of one more level' killed

# expect_sentence NAME PATTERN
expect_sentence()
{
  problem=
  [ $status -eq 2 ] || problem="$problem status $status"
  [ "$(grep -c '^step-friction-[23]d: .*[.?]$' stderr)" -eq 1 ] ||
    problem="$problem no sentence"
  grep -q -e "$2" stderr || problem="$problem '$2' is not named"
  [ -s stdout ] && problem="$problem something on standard output"
  verdict "$1" "$problem"
}

run "$n" "$work/empty" --restart
expect_sentence 'no checkpoint' 'no checkpoint'
run "$n" "$work/killed" --restart "Refinement/Levels=$((last - 1))"
expect_sentence 'fewer levels' 'Refinement/Levels'
run "$n" "$work/killed" --restart "Refinement/Levels=$((last + 1))" \
  'Contact/Friction coefficient=0.3'
expect_sentence 'another problem' "'Contact/Friction coefficient' has changed"

# One that is damaged is not read; the one before is there for that.
echo damaged >"killed/checkpoint-0$((last + 1))/record"
run "$n" "$work/killed" --restart "Refinement/Levels=$((last + 1))"
problem=
[ $status -eq 0 ] || problem=" status $status"
grep -q "^Warning: .*checkpoint-0$((last + 1)).*'record'.*checkpoint-0$last" \
  stdout || problem="$problem no warning"
[ "$(table stdout | wc -l)" -eq $((last + 2)) ] || problem="$problem rows"
verdict 'a damaged checkpoint' "$problem"
for level in "$last" $((last + 1)); do
  echo damaged >"killed/checkpoint-0$level/record"
done
run "$n" "$work/killed" --restart "Refinement/Levels=$((last + 1))"
expect_sentence 'two damaged checkpoints' 'cannot be used'

# A new run in the same directory begins with a clean slate.
run "$n" "$work/killed" Refinement/Levels=0
problem=
[ $status -eq 0 ] || problem=" status $status"
find killed -name 'checkpoint*' | grep -q . && problem="$problem old checkpoint"
verdict 'a new run' "$problem"

[ $failures -eq 0 ]
