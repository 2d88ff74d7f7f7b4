#!/bin/sh
# Cycles per level of the adaptive Hertz scene for the variants of the method, one
# column per level, and the solve and set-up time of all levels together.
# Usage: cycles.sh step-friction-2d hertz.prm
program=$1
scene=$2
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT

row() {
  label=$1
  shift
  "$program" "$scene" Output/Fields=false Output/Verbosity=levels \
    "Output/Directory=$directory" 'Refinement/Maximum dofs=100000' "$@" |
    awk -v label="$label" '
      $1 ~ /^[0-9]+$/ && NF >= 10 {cycles = cycles sprintf(" %3d", $7)
                                   seconds += $10; dofs = $3}
      END {printf "%-44s%s  | %5.1f s, %d dofs\n", label, cycles, seconds, dofs}'
}

echo "cycles on levels 0, 1, ...; all levels to a relative increment of 1e-9"
for F in 0.4 0.05 1.0; do
  echo "F = $F"
  friction="Contact/Friction coefficient=$F"
  row "default: truncated, V, 3+3 leaf, 6+6 coarse" "$friction"
  row "  without recombination" "$friction" 'Solver/Recombined steps=0'
  row "  two recombined steps" "$friction" 'Solver/Recombined steps=2'
  row "  damping at most 1" "$friction" 'Solver/Maximum damping=1'
  row "  neither" "$friction" 'Solver/Maximum damping=1' \
    'Solver/Recombined steps=0'
  row "  3+3 coarse" "$friction" 'Solver/Coarse smoothing steps=3'
  row "  3+3 coarse, neither" "$friction" 'Solver/Coarse smoothing steps=3' \
    'Solver/Maximum damping=1' 'Solver/Recombined steps=0'
  row "  all contact nodes truncated" "$friction" 'Solver/Truncation=contact'
  row "monotone, 6+6 coarse" "$friction" 'Solver/Coarse correction=monotone'
  row "monotone, plain V(3,3)" "$friction" 'Solver/Coarse correction=monotone' \
    'Solver/Coarse smoothing steps=3'
done
F=0.4
echo "F = $F, W-cycles, to 30000 dofs"
row "truncated, W(3,3)" 'Solver/Cycle=W' 'Solver/Coarse smoothing steps=3' \
  'Refinement/Maximum dofs=30000'
row "monotone, W(3,3)" 'Solver/Cycle=W' 'Solver/Coarse smoothing steps=3' \
  'Solver/Coarse correction=monotone' 'Refinement/Maximum dofs=30000'
