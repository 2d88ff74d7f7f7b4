#!/usr/bin/env python3
"""Projects a cycle of the solver on many processes from what parallel.py has
measured on few.

Usage: parallel_model.py RESULTS_OF_PARALLEL.TXT

A cycle on P processes with n unknowns takes the sum of

  work        w n/P,            w seconds per cycle and unknown of a process,
                                measured with two processes that share a memory
  latency     a m(L) v,         m(L) exchanges per cycle with a neighbour, linear
                                in the number of levels L; v neighbours
  bandwidth   c (n/P)^(1-1/d)/b bytes of the interfaces, all levels together
  reductions  r 2a log2 P       r reductions per cycle
  coarsest    2 (a log2 P + 8 N0/b)  the coarsest residual gathered on one
                                process and its solution sent back, N0 unknowns

where m, c, r, w are measured and a, b, v, N0 are assumed. All are upper bounds
in that nothing is hidden behind work, although most exchanges of the leading
sweeps are.
"""
import math
import re
import sys

LATENCY = 2e-6       # a, seconds per message
BANDWIDTH = 1e9      # b, bytes per second and process
NEIGHBOURS = {2: 8, 3: 26}
COARSEST = 2000      # N0, the largest level that is solved directly

text = open(sys.argv[1]).read()
print(f"Assumed: {LATENCY * 1e6:g} us per message, {BANDWIDTH / 1e9:g} GB/s per "
      f"process, {NEIGHBOURS[2]} (2D) and {NEIGHBOURS[3]} (3D)\nneighbours, a "
      f"coarsest level of {COARSEST} unknowns.")

for dim, scene, timed in ((2, "hertz", "hertz"), (3, "block", "cylinder")):
    sent = [[float(x) for x in line.split()[2:]]
            for line in text.splitlines()
            if re.match(rf"{scene} \({dim}D\) +\d+ +[248] +\d+ +[\d.]+ +\d+ +"
                        r"[\d.]+ +\d+$", line)]
    # Columns: dofs, N, levels, messages, bytes, reductions, ...
    pair = sorted(row for row in sent if row[1] == 2)
    first, last = pair[0], pair[-1]
    slope = (last[3] - first[3]) / (last[2] - first[2])
    intercept = last[3] - slope * last[2]
    most = max((row for row in sent if row[1] == 8), key=lambda row: row[0])
    c = most[4] / (most[0] / most[1]) ** (1 - 1 / dim)
    reductions = max(row[5] for row in sent)
    speed = re.search(rf"{timed}, (\d+) dofs, \d+ and (\d+) cycles\n(.*\n)*?"
                      r"  all +([\d.]+) +([\d.]+)", text)
    work = float(speed[5]) / int(speed[2]) / (int(speed[1]) / 2)

    print(f"\n{dim}D: work {work * 1e6:.2f} us per cycle and unknown of a "
          f"process; {slope:.1f} exchanges per level\nand {intercept:.1f} "
          f"besides; {c:.0f} (n/P)^{'1/2' if dim == 2 else '2/3'} bytes; "
          f"{reductions:.0f} reductions")
    print("       dofs  processes  levels      work   latency  bandwidth  "
          "reductions  coarsest   cycle in ms")
    for dofs, processes in ((1e9, 1e3), (1e9, 1e4), (1e9, 1e5), (4e9, 1e5)):
        levels = 1 + math.ceil(math.log(dofs / COARSEST, 2 ** dim))
        terms = [work * dofs / processes,
                 LATENCY * (slope * levels + intercept) * NEIGHBOURS[dim],
                 c * (dofs / processes) ** (1 - 1 / dim) / BANDWIDTH,
                 reductions * 2 * LATENCY * math.log2(processes),
                 2 * (LATENCY * math.log2(processes) + 8 * COARSEST /
                      BANDWIDTH)]
        print(f"{dofs:11.0e}{processes:11.0e}{levels:8d}"
              + "".join(f"{1e3 * t:{w}.2f}"
                        for t, w in zip(terms, (10, 10, 11, 12, 10)))
              + f"{1e3 * sum(terms):14.2f}")
        if processes == 1e4:
            names = ("work", "latency", "bandwidth", "reductions", "coarsest")
            largest = max(range(1, 5), key=lambda i: terms[i])
            share = sum(terms[1:]) / sum(terms)
            summary = (f"At 1e9 unknowns on 1e4 processes communication is "
                       f"{100 * share:.0f} % of a cycle, most of it "
                       f"{names[largest]};")
            # Where does it become half?
            p = 1e4
            while p < 1e9:
                p *= 1.1
                rest = (terms[1] + c * (1e9 / p) ** (1 - 1 / dim) / BANDWIDTH +
                        reductions * 2 * LATENCY * math.log2(p) + terms[4])
                if rest > work * 1e9 / p:
                    break
            summary += (f" it\nbecomes half of it at {p:.0e} processes, "
                        f"{1e9 / p:.0f} unknowns each.")
    print(summary)
