#!/bin/sh
# The rate of the multigrid iteration for materials that can hardly be
# compressed: cycles, contraction per cycle and solve time on the finest level,
# with the sweeps of compressible materials, with the automatic ones, and with
# more recombined steps besides, all without safeguards. Then cycles and seconds
# of the last three levels as they come, on contact nodes alone or not.
# Usage: incompressible.sh PROGRAM_2D SCENES_2D PROGRAM_3D SCENES_3D
program_2d=$1
scenes_2d=$2
program_3d=$3
scenes_3d=$4
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT

# The rows of the run's table: cycles, contraction and seconds of each level. None
# if a level was not solved.
rows() {
  "$@" Output/Fields=false Output/Verbosity=levels \
    'Refinement/Estimate error=false' "Output/Directory=$directory" |
    awk '$1 ~ /^[0-9]+$/ && NF >= 10 {row[++n] = $7 " " $8 " " $10}
         /^No (convergence|solution)/ {failed = 1}
         END {for (k = 1; k <= n && !failed; ++k) print row[k]}'
}

# Of the last row.
run() {
  rows "$@" Solver/Safeguards=false 'Solver/Maximum cycles=200' |
    awk '{cycles = $1; rate = $2; seconds = $3}
         END {if (!NR) printf "       fails       ";
              else printf "%4d  %5.3f %6.2f s", cycles, rate, seconds}'
}

table() {
  echo
  echo "$1"
  shift
  echo "    nu  strain     3+3 and 6+6 sweeps       automatic sweeps" \
    "        5 recombined steps"
  for nu in 0.3 0.45 0.49 0.499 0.4999; do
    for strain in pointwise mean; do
      printf '%6s  %-9s  ' $nu $strain
      run "$@" "Material/Poisson ratio=$nu" \
        "Material/Volumetric strain=$strain" 'Solver/Smoothing steps=3' \
        'Solver/Coarse smoothing steps=6' 'Solver/Recombined steps=1'
      printf '  | '
      run "$@" "Material/Poisson ratio=$nu" \
        "Material/Volumetric strain=$strain" 'Solver/Recombined steps=1'
      printf '  | '
      run "$@" "Material/Poisson ratio=$nu" \
        "Material/Volumetric strain=$strain" 'Solver/Recombined steps=5'
      echo
    done
  done
}

# Of the last three rows.
levels() {
  rows "$@" |
    awk '{row[NR] = sprintf("%4d %7.2f s", $1, $3)}
         END {if (!NR) printf "fails";
              else printf "%s  | %s  | %s", row[NR - 2], row[NR - 1], row[NR]}'
}

as_it_comes() {
  echo
  echo "$1"
  shift
  for nu in 0.3 0.49 0.499 0.4999; do
    for strain in pointwise mean; do
      printf '%6s  %-9s  ' $nu $strain
      levels "$@" "Material/Poisson ratio=$nu" \
        "Material/Volumetric strain=$strain"
      echo
    done
  done
}

echo "cycles, contraction per cycle and seconds on the finest level, to a"
echo "relative increment of 1e-9; 'fails' if a level takes more than 200 cycles"
table "linear: block bonded to its support, 33282 dofs" \
  "$program_2d" "$scenes_2d/block.prm" Refinement/Levels=5 \
  'Boundary conditions/Displacement=3: 0.02, -0.02; 2: 0, 0' \
  'Contact/Boundary id=-1' Obstacle/Kind=none
table "friction: block, F = 0.05, 33282 dofs" \
  "$program_2d" "$scenes_2d/block.prm" Refinement/Levels=5 \
  'Contact/Friction coefficient=0.05'
table "friction: hertz, F = 0.4, adaptive to 30000 dofs" \
  "$program_2d" "$scenes_2d/hertz.prm" 'Refinement/Maximum dofs=30000'
table "linear: cube bonded to its support, 14739 dofs" \
  "$program_3d" "$scenes_3d/block.prm" Refinement/Levels=3 \
  'Boundary conditions/Displacement=5: 0.02, 0.01, -0.02; 4: 0, 0, 0' \
  'Contact/Boundary id=-1' Obstacle/Kind=none
table "friction: cube, F = 0.4, 14739 dofs" \
  "$program_3d" "$scenes_3d/block.prm" Refinement/Levels=3
echo
echo "cycles and seconds, with safeguards"
as_it_comes "friction: block, F = 0.4, 33282, 132098 and 526338 dofs" \
  "$program_2d" "$scenes_2d/block.prm" Refinement/Levels=7
as_it_comes "friction: cube, F = 0.4, 2187, 14739 and 107811 dofs" \
  "$program_3d" "$scenes_3d/block.prm" Refinement/Levels=4
