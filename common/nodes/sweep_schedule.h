#ifndef friction_nodes_sweep_schedule_h
#define friction_nodes_sweep_schedule_h

#include <common/nodes/node_block_matrix.h>
#include <common/parallel/ghost_exchange.h>

#include <algorithm>
#include <vector>

namespace Friction
{
  /** How many nodes a sweep takes at once. */
  constexpr unsigned int nodes_per_chunk = 128;



  /** What a stage of sweeps has to do. */
  struct Stage
  {
    unsigned int sweep; ///< which one, if it relaxes
    unsigned int chunk;

    /// Whether it changes nothing, behind all sweeps.
    bool computes_residual;

    /// What becomes of sums of the left of the diagonal. If only the residual
    /// follows a sweep, there is nothing on the left that would change any
    /// more: the residual finds the sums of the last sweep, and adds nothing.
    bool clears, adds;
  };



  /**
   * Runs several relaxation sweeps through a matrix while reading it from
   * memory only once, or once for each few of them.
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
   * one the sweeps simply run one after the other. What lies between the first
   * one and the last one has to stay in the cache, so that more than a few at a
   * time are no faster than these: many sweeps are run in groups.
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
                  const unsigned int          chunk_size = nodes_per_chunk);

    /**
     * Runs sweeps, each over all chunks in ascending order, and behind them, if
     * @p with_residual is set, one more stage that changes nothing but reads
     * neighbours.
     * @param work    called as work(stage, ahead) with a Stage. While it works
     *                on its chunk it should have the rows @p ahead brought into
     *                the cache: its share of what the first stage needs next.
     * @param ghosts  exchanges what the sweeps change.
     * @param x       which has to have valid ghosts, and has on return.
     */
    template <typename Work>
    void run(const unsigned int n_sweeps,
             const bool         with_residual,
             const Work        &work,
             GhostExchange     &ghosts,
             double            *x) const;

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

    /** Rows of a chunk, to be swept over or not. */
    struct Part
    {
      RowRange rows;
      bool     is_relaxed;
    };

    /** All rows of a chunk, in ascending order. */
    const std::vector<Part> &
    parts(const unsigned int c) const
    {
      return parts_of_chunk[c];
    }

    /** Whether there is anything to be swept over. */
    bool
    is_empty() const
    {
      return nothing_to_relax;
    }

    /** Which chunk a node is in. */
    unsigned int
    chunk_of(const unsigned int node) const
    {
      return node / chunk_size;
    }

  private:
    struct Group
    {
      unsigned int first, n_sweeps;
      bool         with_residual;
    };

    // Of six sweeps and a residual, four and three stages at a time are some
    // five per cent faster than all seven.
    static constexpr unsigned int max_stages_at_once = 4;

    unsigned int                   chunk_size = 1;
    std::vector<unsigned int>      chunk_starts;
    std::vector<std::vector<Part>> parts_of_chunk;
    bool                           nothing_to_relax = true;

    // The last chunk that a chunk, or one before it, couples to.
    std::vector<unsigned int> reach;

    // Which chunks couple to ghosts.
    std::vector<char> at_interface;

    // From a sweep on so many, and the residual or not.
    template <typename Work>
    void run_at_once(const Group   &group,
                     const Work    &work,
                     GhostExchange &ghosts,
                     double        *x) const;
  };



  template <int dim>
  template <typename Work>
  void
  SweepSchedule<dim>::run(const unsigned int n_sweeps,
                          const bool         with_residual,
                          const Work        &work,
                          GhostExchange     &ghosts,
                          double            *x) const
  {
    const unsigned int n_stages = n_sweeps + (with_residual ? 1 : 0),
                       n_groups = (n_stages + max_stages_at_once - 1) /
      max_stages_at_once;
    unsigned int first = 0;
    for (unsigned int g = 1; g <= n_groups; ++g)
      {
        const unsigned int end = (n_stages * g + n_groups - 1) / n_groups;
        run_at_once({first, std::min(end, n_sweeps) - first, end > n_sweeps},
                    work,
                    ghosts,
                    x);
        first = end;
      }
  }



  template <int dim>
  template <typename Work>
  void
  SweepSchedule<dim>::run_at_once(const Group   &group,
                                  const Work    &work,
                                  GhostExchange &ghosts,
                                  double        *x) const
  {
    const unsigned int        n_sweeps      = group.n_sweeps;
    const bool                with_residual = group.with_residual;
    const unsigned int        n             = n_chunks();
    const unsigned int        n_stages = n_sweeps + (with_residual ? 1 : 0);
    std::vector<unsigned int> done(n_stages, 0);

    const auto at = [&](const unsigned int stage, const unsigned int chunk) {
      const bool is_sweep = stage < n_sweeps;
      return Stage{group.first + stage,
                   chunk,
                   /*computes residual =*/!is_sweep,
                   /*clears =*/!is_sweep || !with_residual ||
                     stage + 1 < n_sweeps,
                   /*adds =*/is_sweep || n_sweeps == 0};
    };

    // The first stage waits for memory, the others find their rows in the
    // cache. To spread the waiting over all of them, each fetches a part of a
    // chunk that the first stage is to come to after the next one.
    const auto ahead = [&](const unsigned int stage) -> RowRange {
      const unsigned int next = done[0] + (stage == 0 ? 2 : 1);
      if (next >= n)
        return {0, 0};
      const RowRange     rows = chunk(next);
      const unsigned int size = rows.second - rows.first;
      return {rows.first + size * stage / n_stages,
              rows.first + size * (stage + 1) / n_stages};
    };

    // A sweep is through with the interfaces after this many chunks.
    unsigned int through = 0;
    for (unsigned int c = 0; c < n; ++c)
      if (at_interface[c])
        through = c + 1;
    const bool exchanges = !ghosts.is_empty();
    Assert(!exchanges || through > 0, ExcInternalError());
    // An exchange follows each sweep; before which stages they have begun, and
    // ended.
    unsigned int begun = 0, ended = 0;

    // A sweep that waits for its ghosts lets the first one run ahead, but not
    // so far that what lies between them no longer is in the cache.
    constexpr unsigned int farthest = 64;

    while (n > 0 && n_stages > 0 && done.back() < n)
      for (unsigned int stage = 0; stage < n_stages; ++stage)
        while (done[stage] < n &&
               (stage == 0 || reach[done[stage]] < done[stage - 1]))
          {
            if (exchanges && stage > ended && at_interface[done[stage]])
              {
                if (begun < stage ||
                    (done[0] < n && done[0] < done[stage] + farthest &&
                     !ghosts.arrived()))
                  break;
                ghosts.finish(x);
                ended = stage;
              }
            work(at(stage, done[stage]), ahead(stage));
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
