#!/bin/sh
# A failed check ends a program with an exit status other than 0, also if it is
# the check of one process among several; without one the status is 0.
#
# Usage: failed_check.sh PROGRAM MPIEXEC NUMPROC_FLAG N
program=$1
mpiexec=$2
numproc_flag=$3
n=$4

if ! "$mpiexec" "$numproc_flag" "$n" "$program"; then
  echo "FAILED: good checks end with an error"
  exit 1
fi
# fails_with WHICH MESSAGE
fails_with() {
  output=$("$mpiexec" "$numproc_flag" "$n" "$program" "$1" 2>&1)
  status=$?
  echo "$output"
  if [ $status -eq 0 ]; then
    echo "FAILED: a failed check ends with status 0"
    exit 1
  fi
  case $output in
  *"FAILED  $2"*) ;;
  *)
    echo "FAILED: nothing tells which check it was"
    exit 1
    ;;
  esac
}
fails_with own "rounding of the last process: 3e-13 instead of 2e-13"
fails_with everywhere "what all processes have to agree on"
