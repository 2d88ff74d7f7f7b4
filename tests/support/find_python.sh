#!/bin/sh
# Prints a python that can read what the programs have written, if there is one: that of
# the variable PYTHON without trying it, or one that is found.
for python in $PYTHON python3 /usr/bin/python3; do
  if [ "$python" = "$PYTHON" ] || "$python" -c 'import h5py, numpy' 2>/dev/null; then
    echo "$python"
    break
  fi
done
