#!/bin/sh
# The step program on input that is wrong, or too much for it: each case ends
# with a status other than 0 and one sentence, and leaves no file behind.
#
# Usage: bad_input.sh PROGRAM SCENES MPIEXEC NUMPROC_FLAG
program=$1
scenes=$2
mpiexec=$3
numproc_flag=$4

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

# Open MPI without a daemon for a single process, which would take time and write
# messages of its own. Without one, programs of other tests would have the same directory
# for their files.
export OMPI_MCA_ess_singleton_isolated=1
export TMPDIR="$work"

# verdict NAME PROBLEM: an empty problem is none.
verdict()
{
  if [ -z "$2" ]; then
    echo "ok      $1"
  else
    echo "FAILED  $1:$2"
    echo "  standard output:"
    sed 's/^/    /' stdout
    echo "  standard error:"
    sed 's/^/    /' stderr
    failures=$((failures + 1))
  fi
}

# start ARGUMENTS...: of the program.
start()
{
  "$program" "$@" >stdout 2>stderr </dev/null
  status=$?
}

# run SCENE OVERRIDES...: with a fresh output directory.
run()
{
  rm -rf results
  scene=$1
  shift
  start "$scene" Output/Directory=results "$@"
}

# expect_sentence NAME PATTERN: what a run with bad input must have done.
expect_sentence()
{
  problem=
  [ $status -eq 2 ] || problem="$problem status $status"
  [ "$(wc -l <stderr)" -eq 1 ] || problem="$problem not one line"
  grep -q '^step-friction-2d: .*[.?]$' stderr || problem="$problem no sentence"
  grep -q -e "$2" stderr || problem="$problem '$2' is not named"
  [ -z "$(find results -type f 2>/dev/null)" ] || problem="$problem left files"
  verdict "$1" "$problem"
}

# bad NAME PATTERN ARGUMENTS...
bad()
{
  name=$1
  pattern=$2
  shift 2
  run "$@"
  [ -s stdout ] && echo "(something on standard output)" >>stderr
  expect_sentence "$name" "$pattern"
}

block=$scenes/block.prm

bad 'unknown entry in an override' \
  "did you mean 'Contact/Friction coefficient'" \
  "$block" 'Contact/Friktion coefficient=0.4'

sed 's/Poisson ratio/Poison ratio/' "$block" >unknown.prm
bad 'unknown entry in a scene file' \
  "unknown.prm:[0-9]*: .*did you mean 'Material/Poisson ratio'" unknown.prm

sed 's/subsection Contact/subsection Contakt/' "$block" >unknown.prm
bad 'unknown section in a scene file' "did you mean 'Contact'" unknown.prm

bad 'not of the form Section/Entry=value' 'Section/Entry=value' "$block" levels
bad 'no number' 'give a number' "$block" 'Material/Poisson ratio=much'
bad 'no expression' "'much' cannot be understood" \
  "$block" 'Contact/Friction coefficient=much'
bad 'infinite number' 'give a number' "$block" "Material/Young's modulus=inf"

bad 'E = 0' 'must be positive' "$block" "Material/Young's modulus=0"
bad 'E < 0' 'must be positive' "$block" "Material/Young's modulus=-1"
bad 'nu = 1/2' 'strictly between' "$block" 'Material/Poisson ratio=0.5'
bad 'nu = -1' 'strictly between' "$block" 'Material/Poisson ratio=-1'
bad 'F < 0' 'must not be negative' "$block" 'Contact/Friction coefficient=-0.1'

bad 'missing scene' 'missing.prm' missing.prm
mkdir folder.prm
bad 'folder in place of a scene' 'folder.prm' folder.prm

bad 'missing mesh' 'missing.msh' "$block" 'Scene/Geometry=mesh file' \
  "Scene/Mesh file=$work/missing.msh"
echo 'This is no mesh.' >text.msh
bad 'mesh file that is none' 'text.msh' "$block" 'Scene/Geometry=mesh file' \
  "Scene/Mesh file=$work/text.msh"

bad 'scene of three dimensions' 'give the scene to step-friction-3d' \
  "$scenes/../../step-friction-3d/scenes/block.prm"
bad 'body that there is in three dimensions' \
  'give the scene to step-friction-3d' "$block" Scene/Geometry=cylinder
bad 'too few components' 'needs 2 components, but has 1; correct it.' \
  "$block" 'Boundary conditions/Displacement=3: 0.02'

bad 'contact boundary that does not exist' \
  'boundary id 7, but the mesh has only 0, 1, 2, 3' \
  "$block" 'Contact/Boundary id=7'
bad 'displacement on a boundary that does not exist' 'boundary id 7' \
  "$block" 'Boundary conditions/Displacement=3: 0.02, -0.02; 7: 0, 0'
bad 'traction on a boundary that does not exist' 'boundary id 7' \
  "$block" 'Boundary conditions/Traction=7: 0, 0'

bad 'prescribed displacement into the obstacle' 'into the obstacle' \
  "$block" 'Boundary conditions/Displacement=3: 0.02, -0.02; 0: 0.02, -0.02'
bad 'prescribed displacement that competes with contact' 'competes' \
  "$block" 'Boundary conditions/Displacement=3: 0.02, -0.02; 0: free, 0'

bad 'nothing prescribed' 'not held against' "$block" 'Boundary conditions/Displacement='
bad 'nothing prescribed vertically' 'y direction' \
  "$block" 'Boundary conditions/Displacement=3: 0.02, free'
bad 'nothing prescribed horizontally' 'x direction' \
  "$block" 'Boundary conditions/Displacement=3: free, -0.02'

# What is said of the input is a line that fits a screen or two, with nothing in it
# that a terminal would obey.
quoted()
{
  bad "$@"
  problem=
  [ "$(wc -c <stderr)" -lt 700 ] || problem="$problem $(wc -c <stderr) bytes"
  LC_ALL=C grep -q '[^ -~]' stderr && problem="$problem something unprintable"
  [ -z "$problem" ] || sed 's/[^ -~]/?/g' stderr | cut -c -700 >short
  [ -z "$problem" ] || mv short stderr
  verdict "$1, quoted" "$problem"
}
head -c 10000000 /dev/zero | tr '\0' a >long
{ cat "$block" && cat long; } >long.prm
quoted 'a line of 10 MB' 'long.prm:[0-9]*: .aaa.*aaa. is neither' long.prm
{ echo 'subsection Material' && printf 'set ' && cat long && echo ' = 1'; } >long.prm
quoted 'an entry of 10 MB' 'no entry .Material/aaa.*aaa.; did you mean' long.prm
{ echo 'subsection Material' && printf 'set Poisson ratio = ' && cat long; } >long.prm
quoted 'a value of 10 MB' 'aaa. is no value for .Material/Poisson ratio' long.prm
{ printf 'subsection ' && cat long; } >long.prm
quoted 'a section of 10 MB' 'no section .aaa.*aaa.; did you mean' long.prm
{ cat "$block" && echo 'subsection Boundary conditions' &&
  printf 'set Body force = 0, ' && cat long && printf '\nend\n'; } >long.prm
quoted 'an expression of 10 MB' 'aaa.* cannot be understood' long.prm
{ sed /Directory/d "$block" && echo 'subsection Output' &&
  printf 'set Directory = ' && cat long && printf '\nend\n'; } >long.prm
start long.prm
expect_sentence 'a directory of 10 MB' 'cannot be created'
[ "$(wc -c <stderr)" -lt 700 ] || verdict 'a directory of 10 MB' ' is long'
printf 'set \033[31mred\007 \377\302\233 = 1\n' >binary.prm
quoted 'bytes that are no text' \
  'entry .\\x1b\[31mred\\x07 \\xff\\xc2\\x9b.; did' binary.prm
head -c 100000 "$(command -v sh)" >binary.prm
quoted 'a file that is no text' 'binary.prm' binary.prm
quoted 'an argument that is no text' 'override .\\x1b\[2Jx' "$block" \
  "$(printf '\033[2Jx')"
quoted 'a long argument' 'override .aaa.*aaa.: ' "$block" \
  "$(head -c 100000 long)"
quoted 'a long path' 'cannot read the scene file .aaa.*aaa.' \
  "$(head -c 100000 long)"

# Options.
bad 'an option that does not exist' \
  "'--foo' is no option; there are '--check'" --foo
bad 'an option that does not exist, after the scene' \
  "'--restrat' is no option" "$block" --restrat
bad 'an option that stands alone' "'--help' has to be" "$block" --help

# Permissions do not stop root, but not even root can create a folder below a file.
echo 'a file' >file
start "$block" Output/Directory=file/results
expect_sentence 'output directory that cannot be created' 'file/results'
start "$block" Output/Directory=
expect_sentence 'no output directory' 'name a directory'

# A limit on the size of files stands for a full device; with the signal
# ignored, writing fails like on one.
full()
{
  (
    trap '' XFSZ
    # Open MPI's shared memory is a file, too, and longer than that.
    export OMPI_MCA_btl=self
    ulimit -f "$1"
    shift
    run "$@"
    exit $status
  )
  status=$?
}
full 4 "$block" Refinement/Levels=0
expect_sentence 'full device: the history' 'history.h5'
full 100 "$block" Refinement/Levels=0 'Refinement/Initial refinements=6'
problem=
[ $status -eq 2 ] || problem="$problem status $status"
grep -q '^step-friction-2d: .*cannot be written' stderr ||
  problem="$problem no sentence"
[ -z "$(find results -name '*part*')" ] || problem="$problem half-written files"
verdict 'full device: the fields' "$problem"

# A warning, and a solution all the same.
warned()
{
  name=$1
  pattern=$2
  shift 2
  run "$block" "$@" Refinement/Levels=0
  problem=
  [ $status -eq 0 ] || problem="$problem status $status"
  cat stdout stderr | grep -q -e "$pattern" || problem="$problem no warning"
  [ -s results/history.h5 ] || problem="$problem no history"
  verdict "$name" "$problem"
}
warned "F above Eck's bound" "Eck's bound 0.958" \
  'Contact/Friction coefficient=2'
warned 'obstacle that nothing may touch' "Warning.*set 'Contact/Boundary id'" \
  'Contact/Boundary id=-1'
warned 'nothing to touch' "Warning.*set 'Obstacle/Kind'" Obstacle/Kind=none

run "$block" 'Contact/Friction coefficient=0.95' Refinement/Levels=0
problem=
[ $status -eq 0 ] || problem="$problem status $status"
cat stdout stderr | grep -q 'Warning' && problem="$problem a warning"
verdict "F below Eck's bound" "$problem"

# No solution, and the program says so.
run "$scenes/raous.prm" 'Solver/Maximum cycles=2' Solver/Safeguards=false
problem=
[ $status -eq 1 ] || problem="$problem status $status"
cat stdout stderr |
  grep -q 'No convergence on level 0 within 2 cycles.*equilibrium [0-9]' ||
  problem="$problem no certificate"
verdict 'no convergence' "$problem"

run "$scenes/raous.prm" 'Solver/Algorithm=fixed point' \
  'Solver/Maximum outer iterations=2' Solver/Safeguards=false
problem=
[ $status -eq 1 ] || problem="$problem status $status"
cat stdout stderr | grep -q 'No convergence on level 0.*equilibrium [0-9]' ||
  problem="$problem no certificate"
verdict 'no convergence of the outer iteration' "$problem"

# All positions that are tried for a force have a budget together.
run "$block" 'Boundary conditions/Displacement=3: 0, -0.01' \
  'Boundary conditions/Force=3: 0.01, -0.02' 'Solver/Total cycles=20'
problem=
[ $status -eq 1 ] || problem="$problem status $status"
cat stdout stderr |
  grep -q 'No convergence on level 0 within [2-4][0-9] cycles' ||
  problem="$problem more cycles"
verdict 'a budget for a force that cannot be reached' "$problem"

# Help needs no scene; without any argument it is an error.
start --help
problem=
[ $status -eq 0 ] || problem="$problem status $status"
grep -q '^Usage: ' stdout || problem="$problem no usage"
verdict 'help' "$problem"

start
problem=
[ $status -eq 2 ] || problem="$problem status $status"
grep -q '^Usage: ' stderr || problem="$problem no usage"
verdict 'no argument' "$problem"

# What is printed as defaults can be read back.
start --parameters
problem=
[ $status -eq 0 ] || problem="$problem status $status"
grep -q 'subsection Solver' stdout || problem="$problem no parameters"
cp stdout defaults.prm
run defaults.prm 'Boundary conditions/Displacement=3: 0, -0.01; 2: 0, 0'
[ $status -eq 0 ] || problem="$problem cannot be read back"
verdict 'parameters' "$problem"

# run_on_two ARGUMENTS...
run_on_two()
{
  rm -rf results
  env -u OMPI_MCA_ess_singleton_isolated "$mpiexec" "$numproc_flag" 2 \
    "$program" "$@" >stdout 2>stderr
  status=$?
}

# With several processes, every message comes once, and the status is the same.
# mpirun may add remarks of its own, none of which begins like ours. It gives programs
# a terminal, on which progress is overwritten by what comes next, if the machine has
# so much else to do that there is progress to show.
on_two()
{
  name=$1
  wanted=$2
  pattern=$3
  shift 3
  run_on_two "$@"
  problem=
  [ $status -eq "$wanted" ] || problem="$problem status $status"
  [ "$(cat stdout stderr | sed 's/\r$//; s/.*\r//' | grep -c -e "$pattern")" -eq 1 ] ||
    problem="$problem '$pattern' not once"
  verdict "two processes: $name" "$problem"
}

if [ -n "$mpiexec" ]; then
  on_two 'help' 0 '^Usage: ' --help
  on_two 'no argument' 2 '^Usage: '
  on_two 'missing scene' 2 '^step-friction-2d: .*missing.prm' missing.prm
  on_two 'output directory that cannot be created' 2 \
    '^step-friction-2d: .*file/results' "$block" Output/Directory=file/results
  # Only one of them gets to the place.
  on_two 'load that is no number somewhere' 2 'is not a number at' "$block" \
    Output/Directory=results 'Boundary conditions/Body force=0, 1e-9*sqrt(y-0.1)' \
    'Refinement/Initial refinements=3'
  on_two 'bound that is no number in one point' 2 "'1/x' is inf at (0, 0)" \
    "$block" Output/Directory=results 'Contact/Friction law=Tresca' \
    'Contact/Friction bound=1/x' 'Refinement/Initial refinements=3'
  on_two 'body that is not held' 2 'is not held against' "$block" \
    Output/Directory=results 'Boundary conditions/Displacement=3: 0, free'
  on_two 'mesh that is too large' 2 'degrees of freedom' "$block" \
    Output/Directory=results 'Refinement/Initial refinements=15'
  on_two 'prescribed displacement into the obstacle' 2 \
    '^step-friction-2d: .*into the obstacle' "$block" Output/Directory=results \
    'Boundary conditions/Displacement=3: 0.02, -0.02; 0: 0.02, -0.02'
  on_two 'no convergence' 1 'No convergence on level 0 within 2 cycles' \
    "$scenes/raous.prm" Output/Directory=results 'Solver/Maximum cycles=2' \
    Solver/Safeguards=false
  on_two 'a solution' 0 '^level ' "$block" Output/Directory=results \
    Refinement/Levels=0
fi

[ $failures -eq 0 ]
