#!/bin/sh
# Runs a command while fork_server.cc has programs loaded.
#
# Usage: with_fork_servers.sh LIBRARY PROGRAM ... -- COMMAND ARGUMENTS...
export FORK_SERVER_PARENT=$$
library=$1
shift
while [ "$1" != -- ]; do
  sh "$(dirname "$0")/fork_server.sh" "$library" "$1"
  shift
done
shift
unset FORK_SERVER_PARENT
exec "$@"
