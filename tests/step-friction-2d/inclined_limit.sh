#!/bin/sh
# Both sides of the limit, on the scene 'inclined': with a coefficient of friction that
# is larger than the slope by a thousandth, F = tan(alpha) (1 + 1e-3), something sticks
# and the slope bears all of the weight; with one that is smaller by a thousandth the
# run ends with an error that names the force which cannot be reached. Nearest to the
# weight is then a force on a block that slides: F times what presses it.
#
# Usage: inclined_limit.sh PROGRAM SCENE
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# The time is the slope, of F: tan(alpha) = F t.
run() {
  "$program" "$scene" "Output/Directory=$work/results" Refinement/Levels=2 \
    Output/Fields=false Output/Forces=true "Load steps/Times=$1" >"$work/output" 2>&1
  status=$?
  cat "$work/output"
  if [ $status -ne "$2" ]; then
    echo "FAILED: exit status $status instead of $2"
    exit 1
  fi
}

# Compares forces on the platen, a line "F_x F_y", with the weight for a slope of F t.
check='
  function near(got, wanted, what) {
    if (!(got - wanted < tolerance*wanted && wanted - got < tolerance*wanted)) {
      print "FAILED: " what " is " got " instead of " wanted
      bad = 1
    }
  }
  BEGIN { F = 0.4; G = 0.02; alpha = atan2(F*t, 1) }'

program=$1
scene=$2
run '0.5, 0.9, 0.99, 1/1.001' 0
awk '$1 ~ /^[0-9]+$/ { sticking = $5 } END { exit !(sticking > 0) }' "$work/output" || {
  echo "FAILED: nothing sticks"
  exit 1
}
sed -n 's/^Forces .* holds boundary 3 (\([^,]*\), -\([^)]*\)).*/\1 \2/p' "$work/output" |
  awk -v t=0.999000999 -v tolerance=1e-5 "$check"'
  { near($1, G*sin(alpha), "the force down the slope")
    near($2, G*cos(alpha), "the force onto the slope")
    seen = 1 }
  END { exit bad || !seen }' || exit 1

run '0.5, 0.9, 0.99, 1/1.001, 1/0.999' 2
number='[-+.0-9e]*[0-9]'
of="is \($number\) instead of \($number\), .*"
sed -n "s/.*at the time t = 1.001: the forces .* cannot be reached; .* component 1 on \
boundary 3 ${of}component 2 on boundary 3 ${of}/\1 \2 \3 \4/p" "$work/output" |
  awk -v t=1.001001001 -v tolerance=1e-5 "$check"'
  { near($2, G*sin(alpha), "what has to be reached down the slope")
    near(-$4, G*cos(alpha), "what has to be reached onto the slope")
    tolerance = 1e-4
    near($1, -F*$3, "the nearest force down the slope")
    seen = 1 }
  END { if (!seen) print "FAILED: the forces are not named"
        exit bad || !seen }'
