#!/usr/bin/env bash
# What works where: makes a bare root of a Debian suite, runs there what README.md
# says, word for word, compares the tables of two scenes with the expected ones,
# runs the quick tests, and replaces one row of doc/portability.md.
#
# Usage: portability.sh SOURCES ROOTS ROW
#   SOURCES  a checkout of this repository; what is in its work tree is tested
#   ROOTS    a folder for the roots; each row has one of its own, a copy of that of
#            its suite, which is made once
#   ROW      suite:compiler, for example trixie:g++ or bookworm:clang++-14, or
#            headers:TAG for the compiler's syntax check of all sources against the
#            headers of a release of deal.II of which there is no package
#
# Ends with an error if anything in the row is not as it should be. Wants to be root,
# debootstrap and git; DEALII_SOURCES, a folder with
# the sources of that release, takes the place of deal.II's public repository.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
sources=$(cd "$1" && pwd)
roots=$2
row=$3
suite=${row%%:*}
compiler=${row#*:}
table=$sources/doc/portability.md
tag=
if [ "$suite" = headers ]; then
  suite=sid
  tag=$compiler
  compiler=g++
fi

[ "$(id -u)" -eq 0 ] || { echo "Roots need the rights of root." >&2; exit 1; }
for program in debootstrap git tar; do
  command -v $program >/dev/null || { echo "$program is needed." >&2; exit 1; }
done
mkdir -p "$roots"
roots=$(cd "$roots" && pwd)
bare=$roots/$suite
root=$roots/$suite.${tag:-$compiler}

unmount() {
  for mount in dev/pts sys proc; do
    if mountpoint -q "$root/$mount"; then
      umount "$root/$mount" 2>/dev/null || umount -l "$root/$mount"
    fi
  done
}
trap unmount EXIT

if [ ! -e "$bare/etc/debian_version" ]; then
  debootstrap --variant=minbase --include=ca-certificates "$suite" "$bare.part"
  mv "$bare.part" "$bare"
fi
# Bare each time, or packages that are missing in a command would not be missed.
unmount
rm -rf --one-file-system "$root"
cp -a "$bare" "$root"
# Packages expect these to be there; without /sys hwloc complains in each program.
for mount in proc sys dev/pts; do
  mount --bind "/$mount" "$root/$mount"
done
echo "127.0.0.1 localhost" >"$root/etc/hosts"
cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
# Unstable is never up to date when a mirror is a day old.
echo 'Acquire::Check-Valid-Until "false";' >"$root/etc/apt/apt.conf.d/99friction"

# Which state of the sources is tried: they may go on in the meantime. With a + what is not
# committed.
git="git -c safe.directory=$sources -C $sources"
state=$($git rev-parse --short=7 HEAD)
[ -z "$($git status --porcelain -- . ':!doc/portability.md')" ] || state=$state+

# The work tree, without what is built in it.
mkdir "$root/friction"
(cd "$sources" &&
  git -c safe.directory="$sources" ls-files --cached --others --exclude-standard |
  while IFS= read -r file; do [ ! -e "$file" ] || echo "$file"; done |
    tar -cf - -T -) | tar -xf - -C "$root/friction"

if [ -n "$tag" ]; then
  [ -z "${DEALII_SOURCES:-}" ] || cp -r "$DEALII_SOURCES" "$root/dealii"
  [ -d "$root/dealii" ] || git clone --quiet --depth 1 --branch "$tag" \
    https://github.com/dealii/dealii "$root/dealii"
fi

# As in_root.sh will call them, for a row in which it could not.
case $suite in
bookworm) system="Debian 12" ;;
trixie) system="Debian 13" ;;
sid) system="Debian unstable${tag:+, headers}" ;;
*) system=$suite ;;
esac
case $compiler in
clang*) name=Clang ;;
*) name=GCC ;;
esac
result=$root/friction/row
chroot "$root" /usr/bin/env -i HOME=/root LC_ALL=C.UTF-8 \
  PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
  DEBIAN_FRONTEND=noninteractive \
  bash /friction/tests/portability/in_root.sh "$compiler" "$tag" /friction/row ||
  echo "in_root.sh ended with an error" >&2
[ -s "$result" ] || echo "| $system | $name | ? | no | ? | none | none | nothing could be installed |" >"$result"
sed -i "s/\$/ $state |/" "$result"
cat "$result"

# The row takes the place of the one that begins with the same two cells.
awk -v row="$(cat "$result")" '
  BEGIN {split(row, wanted, "|"); split(wanted[3], name, " ")}
  /^\| / {
    split($0, cell, "|")
    split(cell[3], its, " ")
    if (cell[2] == wanted[2] && its[1] == name[1]) {print row; done = 1; next}
  }
  /^<!-- end of the table -->/ && !done {print row}
  {print}' "$table" >"$table.part"
mv "$table.part" "$table"

# Nothing missing, and as many tests passed as there are.
awk -F'|' '{
  n = split($8, word, " ")
  exit !($5 ~ /yes/ && $6 + 0 == 0 && $7 ~ /hertz, cylinder|–/ &&
    $8 !~ /none/ && word[n - 2] == word[n] && word[n] > 0 && $9 ~ /^ *$/)
}' "$result" || {
  echo "Not all is well; see $root/friction/*.log" >&2
  exit 1
}
