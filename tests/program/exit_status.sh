#!/bin/sh
# The exit status of a program on several processes, one of which decides about
# it; the others must neither hang nor say anything.
#
# Usage: exit_status.sh PROGRAM SCENE N MPIEXEC NUMPROC_FLAG
program=$1
scene=$2
n=$3
mpiexec=$4
numproc_flag=$5
failures=0
# One process as users start it, which is quicker, too.
launched=yes
[ "$n" -gt 1 ] || launched=
messages=$(mktemp) || exit 1
trap 'rm -f "$messages"' EXIT

# expect MODE STATUS MESSAGES ARGUMENTS...: so many messages of our own.
expect()
{
  MODE=$1
  export MODE
  wanted=$2
  n_messages=$3
  shift 3
  if [ -z "$launched" ]; then
    timeout 60 "$program" "$@" >"$messages" 2>&1
  else
    timeout 60 "$mpiexec" "$numproc_flag" "$n" "$program" "$@" >"$messages" 2>&1
  fi
  status=$?
  if [ $status -eq "$wanted" ] &&
    [ "$(grep -c '^exit_status: ' "$messages")" -eq "$n_messages" ]; then
    echo "ok      $MODE $*"
  else
    echo "FAILED  $MODE $*: status $status"
    sed 's/^/    /' "$messages"
    failures=$((failures + 1))
  fi
}

expect solved 0 0 "$scene"
expect unsolved 1 0 "$scene"
expect input 2 1 "$scene"
expect unexpected 3 1 "$scene"
expect restart 0 0 "$scene" --restart
expect restart 0 0 --restart "$scene" Refinement/Levels=3
expect restart 1 0 "$scene"
expect solved 2 1 --restart
expect solved 2 1 "$scene.missing"

# One process may as well be launched like several.
if [ -z "$launched" ]; then
  launched=yes
  expect solved 0 0 "$scene"
  expect unsolved 1 0 "$scene"
  expect unexpected 3 1 "$scene"
fi

[ $failures -eq 0 ]
