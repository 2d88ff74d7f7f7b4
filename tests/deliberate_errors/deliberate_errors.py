"""Ten deliberate errors of ten kinds, one after the other, all of which give
plausible pictures; which quick tests notice which.

Works on a copy of the sources with a build tree of its own, so that the one at hand
stays as it is. The result is a table in Markdown.

Usage: deliberate_errors.py SOURCES SCRATCH TABLE [-Ddefinition for CMake ...] [NAME ...]
       deliberate_errors.py --check SOURCES   whether each error still has its place
"""
import pathlib
import re
import shutil
import subprocess
import sys

# What it is, the file, what stands there, and what stands there instead.
ERRORS = [
    ("friction drives", "common/iteration/tresca_functional.cc",
     "sum += problem.effective_coefficient(problem.contact[p]) *",
     "sum -= problem.effective_coefficient(problem.contact[p]) *",
     "the sign of the friction term in the energy"),
    ("hanging row lost", "common/discretization/leaf_matrix.cc",
     "shares.push_back({master->node, v, master->weight});",
     "{\n"
     "              shares.push_back({master->node, v, master->weight});\n"
     "              break;\n"
     "            }",
     "row and column of a hanging node are handed on to one of its masters only"),
    ("truncation in P", "common/levels/level_matrices.cc",
     "            add_to(p->node, p->weight, finer_sums[slot].data());",
     "            {\n"
     "              const LeafNode parent = p->node < level.n_nodes() ?\n"
     "                level.leaf_node(p->node) : LeafNode();\n"
     "              if (parent.exists() &&\n"
     "                  !truncation.is_identity(parent.number()))\n"
     "                continue;\n"
     "              add_to(p->node, p->weight, finer_sums[slot].data());\n"
     "            }",
     "truncated nodes inherit nothing from the finer level"),
    ("restriction", "common/levels/level_transfer.cc",
     "transfer.restrict_and_add(k, coarse, fine);",
     "VectorType half(fine);\n"
     "    for (unsigned int i = 0; i < half.locally_owned_size(); ++i)\n"
     "      half.local_element(i) *= .5;\n"
     "    transfer.restrict_and_add(k, coarse, half);",
     "residuals are restricted with half of their weight"),
    ("normal forces lag", "common/iteration/monotone_smoother.cc",
     "x.updates_normal_forces &&\n          (stage.sweep > 0",
     "false && x.updates_normal_forces &&\n          (stage.sweep > 0",
     "the leading relaxation never updates the normal forces"),
    ("stale level matrix", "common/levels/level_matrices.cc",
     "mark(i, j);\n            mark(j, i);",
     "mark(i, j);",
     "a change of truncation is not seen by the rows of neighbours"),
    ("local reduction", "common/iteration/tresca_functional.cc",
     "values = sum_over_processes(values, problem.communicator());",
     "",
     "each process searches along the line for itself"),
    ("unit of the certificate", "common/contact/certificate.cc",
     "force_for<dim>(problem, node.node, u_T);",
     "u_T.norm();",
     "slip is a length instead of a force"),
    ("frame", "common/iteration/contact_truncation.cc",
     "add(node.frame[t]);",
     "add(node.frame[t - 1]);",
     "a sliding node is free in normal direction"),
    ("level", "common/levels/level_matrices.cc",
     "std::min(hierarchy.finest_level(leaf),\n"
     "                       hierarchy.finest_level(LeafNode(j))) != k)",
     "hierarchy.finest_level(leaf) != k ||\n"
     "              hierarchy.finest_level(LeafNode(j)) != k)",
     "couplings of nodes whose finest levels differ by one belong to no level"),
]


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


def misplaced_errors(sources):
    """What is said of the errors whose place in the sources is not there exactly
    once."""
    sentences = []
    for name, file, right, *_ in ERRORS:
        path = sources / file
        n_places = path.read_text().count(right) if path.is_file() else 0
        if n_places != 1:
            sentences.append(f"{name}: {file} has {n_places} places that read\n"
                             f"{right}")
    return sentences


def copy_sources(sources, copy):
    names = run(["git", "ls-files", "-z", "--cached", "--others",
                 "--exclude-standard"], cwd=sources, check=True).stdout
    for name in filter(None, names.split("\0")):
        origin = sources / name
        if not origin.is_file():
            continue
        target = copy / name
        if target.is_file() and target.read_bytes() == origin.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(origin, target)


def quick_tests(build):
    """Names of tests that ran and failed, and how many there were; None if it
    does not even compile."""
    made = run(["cmake", "--build", str(build), "--target", "tests-quick", "-j2"])
    if made.returncode != 0:
        print(made.stdout[-3000:], made.stderr[-3000:], file=sys.stderr)
        return None, 0
    # Without those that look at the text of the sources.
    result = run(["ctest", "-L", "^quick$", "-j2", "-E",
                  "^(deliberate_errors/places|support/format)$"], cwd=build)
    outcome = re.findall(
        r"^ *\d+/\d+ Test +#\d+: (\S+) \.*.*?(Passed|\*\*\*[A-Z]\w+(?: \w+)?)",
        result.stdout, re.MULTILINE)
    # What only builds is no test.
    outcome = [(name, how) for name, how in outcome
               if not name.startswith(("build/", "load/", "test_dependency/"))]
    # Tests of deal.II's kind are called after the build as well.
    return ([re.sub(r"\.debug$", "", name) for name, how in outcome
             if how not in ("Passed", "***Not Run", "***Skipped")], len(outcome))


def main():
    sources = sys.argv[2 if sys.argv[1] == "--check" else 1]
    sentences = misplaced_errors(pathlib.Path(sources))
    if sentences:
        print("\n".join(sentences), file=sys.stderr)
        return 1
    if sys.argv[1] == "--check":
        return 0
    sources, scratch, table = map(pathlib.Path, sys.argv[1:4])
    definitions = [word for word in sys.argv[4:] if word.startswith("-D")]
    chosen = [word for word in sys.argv[4:] if not word.startswith("-D")]
    copy, build = scratch / "sources", scratch / "build"
    copy_sources(sources, copy)
    subprocess.run(["cmake", "-S", str(copy), "-B", str(build),
                    "-DCMAKE_BUILD_TYPE=Debug", "-DTEST_TIME_LIMIT=100",
                    # One file at a time changes.
                    "-DFRICTION_UNITY_BUILD=OFF",
                    *definitions], check=True,
                   stdout=subprocess.DEVNULL)
    failed, n_tests = quick_tests(build)
    if failed is None or failed or n_tests == 0:
        print("Without any error these fail:", failed, file=sys.stderr)
        return 1
    rows, unnoticed = [], []
    for name, file, right, wrong, what in ERRORS:
        if chosen and name not in chosen:
            continue
        path = copy / file
        text = path.read_text()
        path.write_text(text.replace(right, wrong))
        try:
            failed, _ = quick_tests(build)
        finally:
            path.write_text(text)
        if failed is None:
            print(f"{name}: cannot be compiled", file=sys.stderr)
            return 1
        if not failed:
            unnoticed.append(name)
        tests = ", ".join(f"`{test}`" for test in failed[:6])
        if len(failed) > 6:
            tests += f" and {len(failed) - 6} more"
        rows.append(f"| {name} | {what} (`{file}`) | {tests or '**none**'} |")
        print(rows[-1], flush=True)
    if not chosen:
        text = table.read_text()
        begin, end = "<!-- table of errors -->\n", "<!-- end of the table -->"
        head, rest = text.split(begin)
        table.write_text(
            head + begin + "| error | what it does | noticed by |\n|---|---|---|\n"
            + "\n".join(rows) + "\n" + end + rest.split(end)[1])
    if unnoticed:
        print("FAILED: not noticed:", ", ".join(unnoticed), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
