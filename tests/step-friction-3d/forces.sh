#!/bin/sh
# The forces that the program prints in the end, against those of a constant stress:
# a block is pressed on a plane by the stress p and sheared by q = F p until all of
# its bottom slips. See scenes/stick-slip.prm.
#
# Usage: forces.sh PROGRAM SCENES
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
"$1" "$2/stick-slip.prm" "Output/Directory=$work/results" Refinement/Levels=0 \
  >"$work/output" 2>&1 || { cat "$work/output"; exit 1; }
cat "$work/output"

sed -n 's/^Force .* body (\(.*\)), moment .* (\(.*\)), work .* \(.*\)\.$/\1, \2, \3/p' \
  "$work/output" | tr -d ',' | awk '
  function near(got, wanted) {
    if ((got - wanted)^2 > (5e-4 * scale)^2) {
      print "FAILED: " got " instead of " wanted
      bad = 1
    }
  }
  {
    E = 1; nu = .3; L = 1.5; W = 1; H = 1; U = .04; d = .02; F = .4
    alpha = atan2(1, sqrt(3))
    mu = E/(2*(1 + nu)); lambda = E*nu/((1 + nu)*(1 - 2*nu))
    p = (lambda + 2*mu)*d/H; q = F*p; slip = U - q*H/mu
    if (slip <= 0) { print "FAILED: nothing slips"; bad = 1 }
    fx = -q*cos(alpha)*L*W; fy = -q*sin(alpha)*L*W; fz = p*L*W
    scale = fz
    near($1, fx); near($2, fy); near($3, fz)
    near($4, W/2*fz); near($5, -L/2*fz); near($6, L/2*fy - W/2*fx)
    scale = q*slip*L*W
    near($7, q*slip*L*W)
    seen = 1
  }
  END {
    if (!seen) { print "FAILED: no forces are printed"; bad = 1 }
    exit bad
  }'
