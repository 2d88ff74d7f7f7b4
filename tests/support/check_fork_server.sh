#!/bin/sh
# What a fork server runs has what it would have without one, and does not outlive who
# wanted it; a server does not outlive who started it. The program is a shell, which can
# say all that.
#
# Usage: check_fork_server.sh LIBRARY CLIENT
library=$1
client=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cp "$(readlink -f "$(command -v sh)")" "$work/program" || exit 1
cd "$work" || exit 1
failures=0

# verdict NAME CONDITION...: a command.
verdict()
{
  name=$1
  shift
  if "$@"; then
    echo "ok      $name"
  else
    echo "FAILED  $name"
    failures=$((failures + 1))
  fi
}

# Without a server the program takes the place of the client, which a shell has started.
is_served()
{
  parent=$("$client" "$work/program" -c 'readlink /proc/$PPID/exe') &&
    [ "$parent" = "$work/program" ]
}

not()
{
  ! "$@"
}

# within SECONDS COMMAND...: until it is true.
within()
{
  tenths=$(($1 * 10))
  shift
  until "$@"; do
    tenths=$((tenths - 1))
    [ $tenths -gt 0 ] || return 1
    sleep 0.1
  done
}

# same NAME LAUNCH SCRIPT ARGUMENTS...: with the client and without, after LAUNCH, which
# makes the circumstances.
same()
{
  name=$1
  launch=$2
  shift 2
  for prefix in "" "$client"; do
    (
      eval "$launch"
      $prefix "$work/program" -c "$@" <"$here/test.h"
      echo "status $?"
    ) >"${prefix:+by-client-}output" 2>/dev/null
  done
  verdict "$name" cmp -s output by-client-output || diff output by-client-output
}

verdict 'no server' not is_served
verdict 'no program' eval '"$client" ./none; [ $? -eq 127 ]' 2>message

sh "$here/fork_server.sh" "$library" "$work/program" true
verdict 'a server' within 10 is_served
same 'arguments' : 'printf "<%s>" "$0" "$@"' zero one '' 'two words' '*'
same 'standard input' : 'cat'
same 'no standard input' 'exec <&-' 'echo no more'
same 'directory' 'cd /' pwd
same 'environment' 'export A=1 B="two words"; unset HOME' \
  'echo "$A $B ${HOME-none} ${LD_PRELOAD-none} ${FORK_SERVER_PARENT-none}"'
same 'limits' 'ulimit -n 77; ulimit -f 1000' 'ulimit -n; ulimit -f'
same 'signals' 'trap "" XFSZ INT' 'grep SigIgn /proc/$$/status'
same 'mode of new files' 'umask 027' umask
same 'priority' : 'ps -o ni= -p $$ 2>/dev/null || cut -d" " -f19 /proc/$$/stat'
allowed='grep Cpus_allowed_list /proc/$$/status'
verdict 'processors' test "$(taskset -c 0 "$client" "$work/program" -c "$allowed")" = \
  "$(taskset -c 0 "$work/program" -c "$allowed")"
group='cat /proc/$$/autogroup 2>/dev/null || :'
verdict 'the group in which priorities count' test \
  "$("$client" "$work/program" -c "$group")" = "$("$work/program" -c "$group")"
"$client" "$work/program" -c 'ls -l /proc/$$/fd >files; :' </dev/null 2>message
verdict 'no file of the server' not grep -q socket files
same 'status' : 'exit 7'
same 'signal' : 'kill -TERM $$'

"$client" "$work/program" -c 'trap "exit 5" TERM; : >ready; while :; do sleep 0.1; done' &
asked=$!
within 10 test -e ready
kill -TERM $asked
wait $asked
verdict 'a signal for the client' test $? -eq 5

"$client" "$work/program" -c 'echo $$ >copy; exec sleep 100' &
asked=$!
within 10 test -s copy
copy=$(cat copy)
verdict 'a copy' kill -0 "$copy"
kill -KILL $asked
wait $asked 2>/dev/null
verdict 'it does not outlive the client' within 10 not kill -0 "$copy" 2>message

sh "$here/with_fork_servers.sh" "$library" "$work/program" -- \
  sh -c 'sleep 1; "$0" "$1" -c "readlink /proc/\$PPID/exe" >exe' "$client" "$work/program"
verdict 'another server' test "$(cat exe)" = "$work/program"
verdict 'the server ends with what has started it' within 10 not is_served 2>message
[ $failures -eq 0 ]
