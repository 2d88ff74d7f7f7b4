#!/bin/sh
# Cycles per level of an adaptive scene for the variants of the method, one
# column per level, and the solve and set-up time of all levels together.
# Usage: cycles.sh PROGRAM SCENE DOFS DOFS_OF_W_CYCLES F ...
program=$1
scene=$2
dofs=$3
dofs_of_w=$4
shift 4
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT

row() {
  label=$1
  shift
  "$program" "$scene" Output/Fields=false Output/Verbosity=levels \
    "Output/Directory=$directory" "Refinement/Maximum dofs=$dofs" \
    'Solver/Maximum cycles=100' Solver/Safeguards=false "$@" |
    awk -v label="$label" '
      $1 ~ /^[0-9]+$/ && NF >= 10 {cycles = cycles sprintf(" %3d", $7)
                                   seconds += $10; dofs = $3}
      /^No (convergence|solution)/ {failed = ", fails"}
      END {printf "%-44s%s  | %5.1f s, %d dofs%s\n", label, cycles, seconds,
                  dofs, failed}'
}

monotone='Solver/Coarse correction=monotone'
without='Solver/Truncation=phases without second order'
echo "cycles on levels 0, 1, ...; all levels to a relative increment of 1e-9"
for F in "$@"; do
  echo "F = $F"
  friction="Contact/Friction coefficient=$F"
  row "default: truncated, V, 3+3 leaf, 6+6 coarse" "$friction"
  row "  without recombination" "$friction" 'Solver/Recombined steps=0'
  row "  two recombined steps" "$friction" 'Solver/Recombined steps=2'
  row "  damping at most 1" "$friction" 'Solver/Maximum step length=1'
  row "  neither" "$friction" 'Solver/Maximum step length=1' \
    'Solver/Recombined steps=0'
  row "  3+3 coarse" "$friction" 'Solver/Coarse smoothing steps=3'
  row "  3+3 coarse, neither" "$friction" 'Solver/Coarse smoothing steps=3' \
    'Solver/Maximum step length=1' 'Solver/Recombined steps=0'
  row "  all contact nodes truncated" "$friction" 'Solver/Truncation=contact'
  case $program in
  *3d) row "  without second order" "$friction" "$without" ;;
  esac
  row "monotone, 6+6 coarse" "$friction" "$monotone"
  row "monotone, plain V(3,3)" "$friction" "$monotone" \
    'Solver/Coarse smoothing steps=3'
  case $program in
  *3d) row "monotone, without second order" "$friction" "$monotone" "$without" ;;
  esac
done
echo "W-cycles, to $dofs_of_w dofs"
dofs=$dofs_of_w
row "truncated, W(3,3)" 'Solver/Cycle=W' 'Solver/Coarse smoothing steps=3'
row "monotone, W(3,3)" 'Solver/Cycle=W' 'Solver/Coarse smoothing steps=3' \
  "$monotone"
