#!/bin/sh
# Runs a command, if there is one, which makes the program, say, and has fork_server.cc
# load the program. The server ends when what has called this script does, or the process
# FORK_SERVER_PARENT. Nothing waits for it: as long as it is not there, fork_client.cc runs
# the program itself.
#
# Usage: fork_server.sh LIBRARY PROGRAM [COMMAND ARGUMENTS...]
library=$1
program=$2
shift 2
if [ $# -gt 0 ]; then
  "$@" || exit 1
fi
cd "$(dirname "$program")" || exit 1
program=$(basename "$program")
rm -f "$program.socket"
# As many threads as deal.II lets its tests have.
FORK_SERVER_PARENT=${FORK_SERVER_PARENT:-$PPID} OMP_NUM_THREADS=${OMP_NUM_THREADS:-2} \
  LD_PRELOAD=$library "./$program" </dev/null >"$program.server" 2>&1 &
