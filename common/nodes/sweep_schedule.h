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

  /** How many nodes a sweep takes at once. */
  constexpr unsigned int nodes_per_chunk = 128;



  /** What a stage of sweeps has to do. */
  struct Stage
  {
    enum Kind
    {
      adds_shares,
      relaxes,
      computes_residual
    };
    Kind         kind;
    unsigned int sweep; ///< which one, if it relaxes
    unsigned int chunk;

    /// The sums of a row are needed once more if only the residual follows a
    /// sweep forwards: there the left of the diagonal does not change any more.
    bool clears;

    /// Sweeps forwards need the shares of their own rows, those backwards those
    /// of the stage before.
    bool adds;
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
                  const unsigned int          chunk_size = nodes_per_chunk);

    /**
     * Runs sweeps, each over all chunks in ascending or descending order, and
     * stages that change nothing: before sweeps backwards, where half of the
     * matrix is stored, one that adds up the shares of all rows in sums of
     * others, see stores_half, and behind all sweeps, if @p with_residual is
     * set, one more that reads neighbours.
     * @param work    called as work(stage, ahead) with a Stage. While it works
     *                on its chunk it should have the rows @p ahead brought into
     *                the cache: its share of what the first stage needs next.
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
    unsigned int                   chunk_size = 1;
    std::vector<unsigned int>      chunk_starts;
    std::vector<std::vector<Part>> parts_of_chunk;
    bool                           nothing_to_relax = true;

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
    const bool         backwards       = sweeps.backwards && sweeps.number > 0;
    const unsigned int n               = n_chunks();
    const unsigned int first           = backwards && stores_half<dim> ? 1 : 0,
                       end             = first + sweeps.number;
    const unsigned int        n_stages = end + (with_residual ? 1 : 0);
    std::vector<unsigned int> done(n_stages, 0);

    const auto at = [&](const unsigned int stage, const unsigned int chunk) {
      Stage result{Stage::relaxes, stage - first, chunk, true, true};
      if (stage < first)
        {
          result.kind   = Stage::adds_shares;
          result.clears = false;
        }
      else if (stage == end)
        {
          // With no sweep there is nothing that it could go by.
          result.kind = Stage::computes_residual;
          result.adds = (sweeps.number == 0);
        }
      else if (backwards)
        result.adds = stage + 1 < end || with_residual;
      else
        result.clears = stage + 1 < end || !with_residual;
      return result;
    };

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
    // An exchange follows each sweep; before which stages they have begun, and
    // ended.
    unsigned int begun = first, ended = first;

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
            work(at(stage, chunk_at(done[stage])), ahead(stage));
            ++done[stage];
            if (exchanges && stage >= first && stage < end &&
                done[stage] == through)
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
