#!/usr/bin/env bash
# All rows of doc/portability.md, one after the other: see portability.sh. A row that
# is not as it should be does not keep the others from being tried.
#
# Usage: all_rows.sh SOURCES ROOTS ROW ...
here=$(cd "$(dirname "$0")" && pwd)
sources=$1
roots=$2
shift 2
failed=
for row in "$@"; do
  bash "$here/portability.sh" "$sources" "$roots" "$row" || failed="$failed $row"
done
if [ -n "$failed" ]; then
  echo "Not all is well with$failed" >&2
  exit 1
fi
