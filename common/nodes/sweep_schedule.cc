#include <common/nodes/sweep_schedule.h>

namespace Friction
{
  template <int dim>
  SweepSchedule<dim>::SweepSchedule(const NodeBlockMatrix<dim> &matrix,
                                    const NodeRanges           &nodes,
                                    const unsigned int          chunk_size)
    : chunk_size(chunk_size)
  {
    const unsigned int n_nodes = matrix.n_rows();
    for (unsigned int start = 0; start < n_nodes; start += chunk_size)
      chunk_starts.push_back(start);
    chunk_starts.push_back(n_nodes);

    parts_of_chunk.resize(n_chunks());
    const auto add =
      [&](unsigned int begin, const unsigned int end, const bool is_relaxed) {
        while (begin < end)
          {
            const unsigned int c    = chunk_of(begin);
            const unsigned int stop = std::min(end, chunk_starts[c + 1]);
            parts_of_chunk[c].push_back({{begin, stop}, is_relaxed});
            begin = stop;
          }
      };
    unsigned int done = 0;
    for (const RowRange &range : nodes)
      {
        add(done, range.first, false);
        add(range.first, range.second, true);
        done             = range.second;
        nothing_to_relax = false;
      }
    add(done, n_nodes, false);

    at_interface.assign(n_chunks(), 0);
    reach.resize(n_chunks());
    for (unsigned int c = 0; c < n_chunks(); ++c)
      {
        unsigned int last = chunk_starts[c + 1] - 1;
        for (std::size_t e = matrix.row_begin(chunk_starts[c]);
             e < matrix.row_begin(chunk_starts[c + 1]);
             ++e)
          if (matrix.column(e) < n_nodes)
            last = std::max(last, matrix.column(e));
          else
            at_interface[c] = 1;
        reach[c] = chunk_of(last);
      }

    // A stage never overtakes, so that the bounds may as well be monotone.
    for (unsigned int c = 1; c < n_chunks(); ++c)
      reach[c] = std::max(reach[c], reach[c - 1]);
  }



  template class SweepSchedule<2>;
  template class SweepSchedule<3>;
} // namespace Friction
