#!/bin/sh
# Runs a command, which gives way to others if it is on one process: processes of a test
# on two wait for each other, and keep both processors busy with that.
#
# Usage: give_way.sh COMMAND ARGUMENTS...
[ "${OMPI_COMM_WORLD_SIZE:-${PMI_SIZE:-1}}" -eq 1 ] || exec "$@"
exec nice -n 10 "$@"
