#!/bin/sh
# Whether there is a python that can read what runs write. Without one the tests of
# scenes and restarts pass without having verified anything; this one is then skipped
# (exit status 77), so that ctest says so in its summary.
python=$(sh "$(dirname "$0")/../support/find_python.sh")
if [ -z "$python" ]; then
  echo "no run is verified: there is no python3 with h5py and numpy"
  exit 77
fi
echo "runs are verified by $(command -v "$python")"
