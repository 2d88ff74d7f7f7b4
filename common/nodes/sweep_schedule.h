#ifndef friction_nodes_sweep_schedule_h
#define friction_nodes_sweep_schedule_h

#include <common/nodes/node_block_matrix.h>
#include <common/parallel/ghost_exchange.h>

#include <algorithm>
#include <vector>

namespace Friction
{
  /** How often to sweep over the nodes, and in which order. */
  struct Sweeps
  {
    unsigned int number;
    bool         backwards;
  };

  /**
   * Runs several relaxation sweeps through a matrix while reading it from
   * memory only once.
   *
   * A sweep does little arithmetic and takes not much longer than reading the
   * matrix, if that is larger than the cache. But the second sweep may relax a
   * node as soon as the first one is through with all neighbours of that node;
   * it then finds everything still in the cache. The nodes are cut into chunks
   * of consecutive numbers, and each sweep follows the one before it at the
   * distance that the couplings demand. Each node sees exactly the values it
   * would see if the sweeps ran one after the other, so that the result is the
   * same to the last bit.
   *
   * With several processes each sweep works with the ghost values that the
   * sweep before it has left behind, one exchange per sweep. It begins as soon
   * as a sweep has relaxed the nodes at the interfaces, and the next sweep
   * needs it only when it gets there; in between there is the rest of the mesh.
   * Also here the result does not depend on what happens when.
   *
   * How close a sweep can follow depends on the numbering: with one that keeps
   * neighbours close (see renumber_nodes()) a few chunks are enough; with a bad
   * one the sweeps simply run one after the other.
   */
  template <int dim>
  class SweepSchedule
  {
  public:
    SweepSchedule() = default;

    /** For sweeps over @p nodes with the couplings of @p matrix, whose pattern
     * must be symmetric. */
    SweepSchedule(const NodeBlockMatrix<dim> &matrix,
                  const NodeRanges           &nodes,
                  const unsigned int          chunk_size = 128);

    /**
     * Runs sweeps, and one more stage if @p with_residual is set, each over
     * all chunks in ascending or descending order. That last stage is anything
     * that reads neighbours and changes nothing.
     * @param work    called as work(stage, chunk, ahead). While it works on the
     *                chunk it should have the rows @p ahead brought into the
     *                cache: its share of what the first stage needs next.
     * @param ghosts  exchanges what the sweeps change.
     * @param x       which has to have valid ghosts, and has on return.
     */
    template <typename Work>
    void run(const Sweeps  &sweeps,
             const bool     with_residual,
             const Work    &work,
             GhostExchange &ghosts,
             double        *x) const;

    unsigned int
    n_chunks() const
    {
      return chunk_starts.empty() ? 0 : chunk_starts.size() - 1;
    }

    /** All nodes of a chunk, whether to be swept over or not. */
    RowRange
    chunk(const unsigned int c) const
    {
      return {chunk_starts[c], chunk_starts[c + 1]};
    }

    /** The nodes of a chunk that are to be swept over. */
    const NodeRanges &
    nodes(const unsigned int c) const
    {
      return ranges[c];
    }

    /** Which chunk a node is in. */
    unsigned int
    chunk_of(const unsigned int node) const
    {
      return node / chunk_size;
    }

  private:
    unsigned int              chunk_size = 1;
    std::vector<unsigned int> chunk_starts;
    std::vector<NodeRanges>   ranges;

    // The last and the first chunk that a chunk, or one before (after) it,
    // couples to.
    std::vector<unsigned int> reach_up, reach_down;

    // Which chunks couple to ghosts.
    std::vector<char> at_interface;
  };



  template <int dim>
  template <typename Work>
  void
  SweepSchedule<dim>::run(const Sweeps  &sweeps,
                          const bool     with_residual,
                          const Work    &work,
                          GhostExchange &ghosts,
                          double        *x) const
  {
    const bool                backwards = sweeps.backwards;
    const unsigned int        n_sweeps  = sweeps.number;
    const unsigned int        n         = n_chunks();
    const unsigned int        n_stages  = n_sweeps + (with_residual ? 1 : 0);
    std::vector<unsigned int> done(n_stages, 0);

    // The number of the chunk that is c-th in the direction of the sweep.
    const auto chunk_at = [&](const unsigned int c) {
      return backwards ? n - 1 - c : c;
    };
    // The last chunk, counted in this way, that the stage before must be
    // through with when a stage begins with its chunk c.
    const auto needs = [&](const unsigned int c) {
      return backwards ? n - 1 - reach_down[n - 1 - c] : reach_up[c];
    };

    // The first stage waits for memory, the others find their rows in the
    // cache. To spread the waiting over all of them, each fetches a part of a
    // chunk that the first stage is to come to after the next one.
    const auto ahead = [&](const unsigned int stage) -> RowRange {
      const unsigned int next = done[0] + (stage == 0 ? 2 : 1);
      if (next >= n)
        return {0, 0};
      const RowRange     rows = chunk(chunk_at(next));
      const unsigned int size = rows.second - rows.first;
      return {rows.first + size * stage / n_stages,
              rows.first + size * (stage + 1) / n_stages};
    };

    // A sweep is through with the interfaces after this many chunks.
    unsigned int through = 0;
    for (unsigned int c = 0; c < n; ++c)
      if (at_interface[chunk_at(c)])
        through = c + 1;
    const bool exchanges = !ghosts.is_empty();
    Assert(!exchanges || through > 0, ExcInternalError());
    // Exchange number s follows sweep s; how many have begun, and ended.
    unsigned int begun = 0, ended = 0;

    // A sweep that waits for its ghosts lets the first one run ahead, but not
    // so far that what lies between them no longer is in the cache.
    constexpr unsigned int farthest = 64;

    while (n > 0 && n_stages > 0 && done.back() < n)
      for (unsigned int stage = 0; stage < n_stages; ++stage)
        while (done[stage] < n &&
               (stage == 0 || needs(done[stage]) < done[stage - 1]))
          {
            if (exchanges && stage > ended &&
                at_interface[chunk_at(done[stage])])
              {
                if (begun < stage ||
                    (done[0] < n && done[0] < done[stage] + farthest &&
                     !ghosts.arrived()))
                  break;
                ghosts.finish(x);
                ended = stage;
              }
            work(stage, chunk_at(done[stage]), ahead(stage));
            ++done[stage];
            if (exchanges && stage < n_sweeps && done[stage] == through)
              {
                ghosts.start(x, dim);
                begun = stage + 1;
              }
            if (stage == 0)
              break;
          }
    if (begun > ended)
      ghosts.finish(x);
  }
} // namespace Friction

#endif
