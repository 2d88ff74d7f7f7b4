#!/bin/sh
# check_scene.sh PROGRAM SCENE MPIEXEC FLAG
#
# With --check a program says the same on one process and on two, ends with exit
# status 0 on both, and writes nothing.

program=$1
scene=$2
shift 2

directory=$(mktemp -d) || exit 1
trap 'rm -rf "$directory"' EXIT
cd "$directory" || exit 1

for n in 1 2; do
  timeout 120 "$@" "$n" "$program" "$scene" --check >"$n" 2>"errors.$n"
  status=$?
  if [ $status -ne 0 ]; then
    echo "Exit status $status on $n processes:"
    cat "$n" "errors.$n"
    exit 1
  fi
done
grep -q 'with boundary ids' 1 || { echo 'Nothing about the mesh:'; cat 1; exit 1; }
diff 1 2 || exit 1
if [ "$(ls | tr '\n' ' ')" != '1 2 errors.1 errors.2 ' ]; then
  echo 'Files have been written:'
  ls
  exit 1
fi
